// In the page of a view: the views beside it turn with it. The pages are files, which may not read one
// another, but may send messages. All places are measured from where the first camera looks.
(() => {
  const { camera, page, render } = window.vizlight || {};
  if (!camera || window.parent === window) return;
  const keys = ['Position', 'FocalPoint', 'ViewUp', 'ViewAngle', 'ParallelScale'];
  const first = JSON.stringify(page.camera);
  const read = () => keys.map((key) => camera[`get${key}`]());
  let known = JSON.stringify(read());
  let waiting = false;
  camera.onModified(() => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      const moved = read();
      // Each drawing also changes the planes that clip.
      if (JSON.stringify(moved) === known) return;
      known = JSON.stringify(moved);
      const { length } = window.parent;
      for (let i = 0; i < length; i += 1) window.parent[i].postMessage({ first, moved }, '*');
    });
  });
  window.addEventListener('message', ({ source, data }) => {
    // Views that began elsewhere are of other things.
    if (source === window || !data || data.first !== first) return;
    keys.forEach((key, i) => camera[`set${key}`](...[].concat(data.moved[i])));
    known = JSON.stringify(read());
    render();
  });
})();
