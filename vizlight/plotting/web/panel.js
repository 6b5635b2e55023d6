// The panel of the page: sliders for light and material, buttons, a checkbox for each mesh.

const degrees = (x) => (x * 180) / Math.PI;

function element(kind, properties = {}, ...children) {
  const made = Object.assign(document.createElement(kind), properties);
  made.append(...children);
  return made;
}

// One labelled slider with its number; `get` and `set` are those of what it moves.
function slider(label, [low, high, step], get, set) {
  const number = element('output');
  const input = element('input', { type: 'range', min: low, max: high, step });
  const show = () => {
    input.value = get();
    number.textContent = Number(get().toPrecision(3));
  };
  input.addEventListener('input', () => {
    set(Number(input.value));
    number.textContent = Number(get().toPrecision(3));
  });
  return { row: element('label', {}, element('span', { textContent: label }), input, number), show };
}

// The direction from the centre of the picture to a light as azimuth about z and altitude above xy.
function angles(light, centre) {
  const v = light.position ? light.value.map((x, i) => x - centre[i]) : light.value;
  const size = Math.hypot(...v);
  return { azimuth: degrees(Math.atan2(v[1], v[0])), altitude: degrees(Math.asin(v[2] / (size || 1))), size };
}

function setAngles(light, centre, azimuth, altitude, size) {
  const [a, h] = [azimuth, altitude].map((x) => (x * Math.PI) / 180);
  const v = [Math.cos(h) * Math.cos(a), Math.cos(h) * Math.sin(a), Math.sin(h)];
  light.value = v.map((x, i) => x * size + (light.position ? centre[i] : 0));
}

function lightControls(app, shown) {
  const { lightSets, page } = app;
  const every = lightSets.flatMap((set, i) => set.map((light, j) => ({ light, given: page.lights[i][j] })));
  if (!every.length) return [];
  const centre = page.camera.focal;
  let current = every[0].light;
  let turned = angles(current, centre);
  const change = (key, x) => {
    turned = { ...turned, [key]: x };
    setAngles(current, centre, turned.azimuth, turned.altitude, turned.size);
    app.render();
  };
  const azimuth = slider('azimuth (\u00b0)', [-180, 180, 1], () => turned.azimuth, (x) => change('azimuth', x));
  const altitude = slider('altitude (\u00b0)', [-90, 90, 1], () => turned.altitude, (x) => change('altitude', x));
  const most = Math.max(2, ...every.map(({ given }) => 2 * given.intensity));
  const intensity = slider('intensity', [0, most, most / 200], () => current.intensity, (x) => {
    current.intensity = x;
    app.render();
  });
  const eye = element('input', { type: 'checkbox' });
  const follow = element('label', { className: 'check' }, eye, 'follows the eye');
  const update = () => {
    eye.checked = current.eye;
    follow.hidden = current.position;
    [azimuth, altitude].forEach(({ row }) => { row.querySelector('input').disabled = current.eye; });
    turned = angles(current, centre);
    [azimuth, altitude, intensity].forEach(({ show }) => show());
  };
  eye.addEventListener('change', () => {
    // A headlight shines along the view; let go, it stays where it was.
    const m = app.camera.getViewMatrix();
    current.value = eye.checked ? [0, 0, 1] : [m[8], m[9], m[10]];
    current.eye = eye.checked;
    update();
    app.render();
  });
  shown.push(update);
  const rows = [follow, azimuth.row, altitude.row, intensity.row];
  if (every.length > 1) {
    const choice = element('select', {}, ...every.map((_, i) => new Option(`light ${i + 1}`, i)));
    choice.addEventListener('change', () => {
      current = every[choice.value].light;
      update();
    });
    rows.unshift(element('label', {}, element('span', { textContent: 'light' }), choice));
  }
  return [element('fieldset', {}, element('legend', { textContent: 'Light' }), ...rows)];
}

function materialControls(app, shown) {
  const live = app.meshes.filter((mesh) => mesh.material);
  if (!live.length) return [];
  const first = live[0].material;
  const set = (key, x) => {
    live.forEach((mesh) => { mesh.material[key] = x; });
    app.render();
  };
  const sliders = ['ambient', 'diffuse', 'specular'].map((key) => {
    const most = Math.max(1, ...live.map((mesh) => mesh.material[key]));
    return slider(key, [0, most, most / 100], () => first[key], (x) => set(key, x));
  });
  // Shininess as its logarithm: from 1 to 1000, or as far as the scene goes.
  const most = Math.max(3, Math.log10(first.shininess || 1));
  sliders.push(slider('shininess', [0, most, 0.01], () => first.shininess, (x) => set('shininess', 10 ** x)));
  const { row, show } = sliders[3];
  sliders[3].show = () => {
    show();
    row.querySelector('input').value = Math.log10(Math.max(first.shininess, 1));
  };
  shown.push(() => sliders.forEach((one) => one.show()));
  return [element('fieldset', {}, element('legend', { textContent: 'Material' }), ...sliders.map((one) => one.row))];
}

const FEW = 6;

function meshControls(app) {
  if (app.meshes.length < 2) return [];
  const boxes = app.meshes.map((mesh) => {
    const box = element('input', { type: 'checkbox', checked: true });
    box.addEventListener('change', () => {
      mesh.actor.setVisibility(box.checked);
      show();
      app.render();
    });
    return box;
  });
  const every = element('input', { type: 'checkbox', checked: true });
  const show = () => {
    const on = boxes.filter((box) => box.checked).length;
    every.checked = on === boxes.length;
    every.indeterminate = on > 0 && !every.checked;
  };
  every.addEventListener('change', () => {
    boxes.forEach((box, i) => {
      box.checked = every.checked;
      app.meshes[i].actor.setVisibility(every.checked);
    });
    app.render();
  });
  const row = (box, name) => element('label', { className: 'check' }, box, name);
  const rows = boxes.map((box, i) => row(box, app.meshes[i].name));
  // Few meshes are in sight at once; many open on demand, in a list that scrolls by itself.
  return [element(
    'details',
    { className: 'meshes', open: boxes.length <= FEW },
    element('summary', { textContent: `Meshes (${boxes.length})` }),
    ...(boxes.length > FEW ? [row(every, 'all')] : []),
    element('div', { role: 'group', ariaLabel: 'Meshes' }, ...rows),
  )];
}

async function save(app) {
  const [picture] = [app.canvas.captureNextImage('image/png')];
  app.render();
  const link = element('a', { href: await picture, download: `${document.title || 'scene'}.png` });
  link.click();
}

export function buildPanel(app) {
  const shown = [];
  const show = () => shown.forEach((update) => update());
  const button = (textContent, act) => {
    const made = element('button', { type: 'button', textContent });
    made.addEventListener('click', act);
    return made;
  };
  const resetLight = () => {
    app.resetLight();
    show();
  };
  const panel = document.getElementById('panel');
  if (window.innerWidth < 600) panel.parentElement.open = false;
  panel.append(
    ...lightControls(app, shown),
    ...materialControls(app, shown),
    element(
      'p',
      {},
      ...(shown.length ? [button('Reset light', resetLight)] : []),
      button('Reset view', app.resetView),
      button('Save picture', () => save(app)),
    ),
    ...meshControls(app),
  );
  show();
}

// Gradients with the numbers at their ends; more of them stand above each other.
export function buildScalarBars(bars) {
  const place = document.getElementById('bars');
  bars.forEach(({ title, colors, numbers }) => {
    const strip = element('div', { className: 'strip' });
    strip.style.background = `linear-gradient(to right, ${colors.join(', ')})`;
    const ends = element('div', { className: 'numbers' }, ...numbers.map((x) => element('span', { textContent: x })));
    place.append(element('figure', {}, element('figcaption', { textContent: title }), strip, ends));
  });
}
