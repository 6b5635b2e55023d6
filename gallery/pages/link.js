// In the page of a view: the views beside it turn with it. The pages are files, which may not read one
// another, but may send messages. All places are measured from where the first camera looks.
addEventListener('vizlight-ready', () => {
  const app = window.vizlight;
  if (window.parent === window) return;
  const first = JSON.stringify(app.first.camera);
  let known = first;
  const { draw } = app;
  app.draw = () => {
    draw.call(app);
    const moved = JSON.stringify(app.state.camera);
    if (moved === known) return;
    known = moved;
    const { length } = window.parent;
    for (let i = 0; i < length; i += 1) window.parent[i].postMessage({ first, moved }, '*');
  };
  window.addEventListener('message', ({ source, data }) => {
    // Views that began elsewhere are of other things.
    if (source === window || !data || data.first !== first) return;
    known = data.moved;
    app.state.camera = JSON.parse(data.moved);
    app.move();
  });
});
