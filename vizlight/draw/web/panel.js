// The panel: what is asked, lamps on a ball, material, colour, view, and what is copied.

const ICONS = {
  undo: 'M8 13 3 8l5-5M3 8h11a6 6 0 0 1 0 12H9', redo: 'm16 13 5-5-5-5m5 5H10a6 6 0 0 0 0 12h5', home: 'm3 11 9-8 9 8M6 9v11h12V9',
  fold: 'm6 9 6 6 6-6', more: 'M12 5v14M5 12h14', less: 'M5 12h14', full: 'M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5',
};

function make(kind, properties = {}, ...children) {
  const made = document.createElement(kind);
  Object.entries(properties).forEach(([key, value]) => {
    // An element has properties, such as onclick; the rest, such as aria-label, are attributes.
    if (key in made) made[key] = value;
    else made.setAttribute(key, value);
  });
  made.append(...children);
  return made;
}
const span = (textContent) => make('span', { textContent });
function drawing(box, ...paths) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  made.setAttribute('viewBox', box);
  made.setAttribute('aria-hidden', 'true');
  paths.forEach(([kind, attributes, text = '']) => {
    const part = document.createElementNS('http://www.w3.org/2000/svg', kind);
    Object.entries(attributes).forEach(([key, value]) => part.setAttribute(key, value));
    part.textContent = text;
    made.append(part);
  });
  return made;
}
const icon = (name) => drawing('0 0 24 24', ['path', { d: ICONS[name] }]);
const tool = (name, label, onclick) => make('button', { type: 'button', className: 'tool', title: label, 'aria-label': label, onclick }, icon(name));

// A slider with its number; a double click gives the first value back.
function slider(label, [low, high, step], get, set, first, says = short) {
  const input = make('input', { type: 'range', min: low, max: high, step, 'aria-label': label });
  const number = make('output');
  const show = () => {
    input.value = get();
    input.style.setProperty('--at', `${(100 * (input.value - low)) / (high - low || 1)}%`);
    number.textContent = says(get());
    input.setAttribute('aria-valuetext', number.textContent);
  };
  // While it is dragged nothing is kept for undo: the whole drag is one step.
  input.oninput = () => {
    set(Number(input.value), false);
    show();
  };
  input.onchange = () => set(Number(input.value), true);
  if (first) input.addEventListener('dblclick', () => set(first(), true));
  return { row: make('label', { className: 'row' }, span(label), input, number), show };
}

let groups = 0;
// One of some, as radio buttons that look like one control.
function choice(label, items, get, set, className = 'segments') {
  groups += 1;
  const inputs = items.map(([value]) => make('input', { type: 'radio', name: `choice${groups}`, value, onchange: () => set(value) }));
  const labels = items.map(([, text, strip], i) => make('label', { title: strip ? text : '' }, inputs[i], strip || span(text)));
  inputs.forEach((input, i) => input.setAttribute('aria-label', items[i][1]));
  const show = () => inputs.forEach((input, i) => { input.checked = items[i][0] === get(); });
  return { row: make('div', { className, role: 'radiogroup', 'aria-label': label }, ...labels), show };
}
const line = (text, part) => make('div', { className: 'line' }, span(text), part);
const section = (title, open, ...parts) => make('details', { open }, make('summary', {}, span(title), icon('fold')), make('div', { className: 'body' }, ...parts));

// ---- lamps on the ball
const RIM = 0.72; // share of the pad that is the ball; beyond its rim lamps shine from behind

function lampPad(app) {
  const pad = make('div', { className: 'pad', role: 'group', 'aria-label': 'Lamps: drag them over the ball, or past its rim to shine from behind' }, make('canvas', { 'data-ball': 'pad', 'aria-hidden': 'true' }));
  const spot = (v) => {
    const flat = Math.hypot(v[0], v[1]);
    // Straight from behind all of the rim is right, and one place of it is taken.
    if (flat < 1e-9) return v[2] >= 0 ? [0, 0] : [1, 0];
    // In front a lamp is where the ball is brightest; beyond the rim the distance tells its angle.
    const behind = Math.acos(Math.max(-1, Math.min(1, v[2]))) / (Math.PI / 2) - 1;
    const r = v[2] >= 0 ? flat * RIM : RIM + (1 - RIM) * behind;
    return [(v[0] / flat) * r, (v[1] / flat) * r];
  };
  const directionAt = (e) => {
    const box = pad.getBoundingClientRect();
    const x = ((e.clientX - box.left) / box.width) * 2 - 1;
    const y = 1 - ((e.clientY - box.top) / box.height) * 2;
    const r = Math.hypot(x, y) || 1e-9;
    if (r <= RIM) return [x / RIM, y / RIM, Math.sqrt(1 - (r / RIM) ** 2)];
    const away = (Math.PI / 2) * (1 + Math.min((r - RIM) / (1 - RIM), 1));
    return [(x / r) * Math.sin(away), (y / r) * Math.sin(away), Math.cos(away)];
  };
  let dots = [];
  const drag = (e) => {
    app.put(app.lamps[app.lamp], directionAt(e));
    app.move();
    // The whole drag is one step to undo, which its end commits.
    app.change({}, false);
  };
  pad.onpointerdown = (e) => {
    if (e.button || !app.lamps.length) return;
    if (dots.includes(e.target)) app.lamp = dots.indexOf(e.target);
    e.preventDefault();
    pad.setPointerCapture(e.pointerId);
    drag(e);
    dots[app.lamp].focus({ preventScroll: true });
  };
  pad.onpointermove = (e) => { if (pad.hasPointerCapture(e.pointerId)) drag(e); };
  pad.onlostpointercapture = () => app.change({});
  pad.onkeydown = (e) => {
    const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[e.key];
    const i = dots.indexOf(e.target);
    if (!turns || i < 0) return;
    e.preventDefault();
    const by = ((e.shiftKey ? 1 : 5) * Math.PI) / 180;
    const v = app.seen(app.lamps[i], viewOf(app.state.camera));
    app.put(app.lamps[i], spun(spun(v, [0, 1, 0], turns[0] * by), [1, 0, 0], -turns[1] * by));
    app.change({});
  };
  const choose = (i) => {
    if (app.lamp === i) return;
    app.lamp = i;
    app.watchers.forEach((watch) => watch());
  };
  function show() {
    const { lamps } = app;
    if (dots.length !== lamps.length) {
      dots.forEach((dot) => dot.remove());
      dots = lamps.map((_, i) => make('button', { type: 'button', className: 'lamp', onfocus: () => choose(i) }));
      pad.append(...dots);
    }
    const view = viewOf(app.state.camera);
    dots.forEach((dot, i) => {
      const v = app.seen(lamps[i], view);
      const [x, y] = spot(v);
      dot.style.left = `${50 + 50 * x}%`;
      dot.style.top = `${50 - 50 * y}%`;
      dot.style.setProperty('--lamp', hex(lamps[i].color));
      dot.classList.toggle('chosen', i === app.lamp);
      dot.classList.toggle('behind', v[2] < 0);
      const said = `Lamp ${i + 1}: ${inDegrees(Math.atan2(v[0], v[2]))}\u00b0 across, ${inDegrees(Math.asin(Math.max(-1, Math.min(1, v[1]))))}\u00b0 up`;
      dot.title = said;
      dot.setAttribute('aria-label', said);
    });
  }
  app.onmove = show;
  return { row: pad, show };
}

function lightControls(app) {
  if (!app.leader) return null;
  const pad = lampPad(app);
  const one = () => app.lamps[app.lamp] || { intensity: 0, color: [1, 1, 1], eye: false };
  const own = (values, done = true) => {
    Object.assign(one(), values);
    app.change({ look: '*' }, done);
  };
  const most = Math.max(2, ...app.first.sets.flat().map((l) => 2 * l.intensity));
  const power = slider('Brightness', [0, most, most / 200], () => one().intensity, (intensity, done) => own({ intensity }, done), () => 1);
  const color = make('input', { type: 'color', 'aria-label': 'Colour of the lamp', oninput: () => own({ color: shares(color.value) }, false), onchange: () => app.commit() });
  const fixed = choice('What the lamp turns with', [[true, 'Eye'], [false, 'Object']], () => one().eye, (eye) => {
    app.fix(one(), eye);
    own({});
  });
  const more = tool('more', 'Add a lamp', () => {
    app.lamps.push({ value: unit([0.6, 0.3, 0.7]), position: false, eye: true, intensity: 0.5, color: [1, 0.85, 0.63], attenuation: [1, 0, 0] });
    app.lamp = app.lamps.length - 1;
    own({});
  });
  const less = tool('less', 'Remove the lamp', () => {
    app.lamps.splice(app.lamp, 1);
    app.lamp = Math.max(0, app.lamp - 1);
    own({});
  });
  const title = make('b');
  // What stands beside the data has lamps that no one moves.
  const sets = app.first.sets.map((_, i) => i).filter((i) => app.meshes.some((mesh) => mesh.name && mesh.given.lights === i));
  const set = choice('Meshes that the lamps light', sets.map((i) => [i, `Lamps ${i + 1}`]), () => app.set, (i) => {
    Object.assign(app, { set: i, lamp: 0 });
    app.change({});
  });
  const beside = make('div', { className: 'beside' }, make('div', { className: 'line' }, title, more, less), make('label', { className: 'line' }, span('Colour'), color));
  const show = () => {
    title.textContent = app.lamps.length ? `Lamp ${app.lamp + 1} of ${app.lamps.length}` : 'No lamp';
    color.value = hex(one().color);
    color.disabled = !app.lamps.length;
    more.disabled = app.lamps.filter((l) => !l.position).length >= Math.max(MOST_LAMPS, app.page.most);
    less.disabled = !app.lamps.length;
    [pad, power, fixed, set].forEach((part) => part.show());
  };
  return { row: section('Light', true, ...(sets.length > 1 ? [set.row] : []), make('div', { className: 'lamps' }, pad.row, beside), power.row, line('Turns with', fixed.row)), show };
}

function materialControls(app) {
  if (!app.leader) return null;
  const first = () => app.first.materials[app.meshes.indexOf(app.leader)];
  const set = (name) => (x, done) => app.change({ materials: app.state.materials.map((m) => m && { ...m, [name]: x }), look: '*' }, done);
  const of = (label, name, most) => slider(label, [0, Math.max(most, first()[name]), 0.01], () => app.material[name], set(name), () => first()[name]);
  const log = (m) => Math.log10(Math.max(m.shininess, 1));
  const parts = [
    of('Ambient', 'ambient', 1), of('Diffuse', 'diffuse', 1.5), of('Highlight', 'specular', 1.5),
    // By its logarithm: from 10 to 20 changes a highlight as much as from 100 to 200.
    slider('Sharpness', [0, Math.max(3, log(first())), 0.01], () => log(app.material), (x, done) => set('shininess')(Number(short(10 ** x)), done), () => log(first()), (x) => short(10 ** x, 2)),
  ];
  if (!app.meshes.some((mesh) => mesh.given.cue)) parts.push(slider('Depth fade', [0, 1, 0.01], () => app.state.fade, (fade, done) => app.change({ fade }, done), () => 0));
  if (app.meshes.some((mesh) => mesh.given.sky)) {
    const box = make('input', { type: 'checkbox', onchange: () => app.change({ sky: box.checked }) });
    parts.push({ row: make('label', { className: 'check' }, box, span('Light of the sky in hollows')), show: () => { box.checked = app.state.sky; } });
  }
  return { row: section('Material', innerHeight > 760, ...parts.map((part) => part.row)), show: () => parts.forEach((part) => part.show()) };
}

// Every 17th of 256 colours, three bytes each: both ends are among the 16.
const gradient = (table) => `linear-gradient(to right, ${Array.from({ length: 16 }, (_, i) => `rgb(${table.slice(51 * i, 51 * i + 3).join(',')})`).join(', ')})`;

function colorControls(app) {
  const names = Object.keys(app.page.arrays);
  const own = app.meshes.some((mesh) => mesh.own && mesh.given.live);
  if (!names.length && !own) return null;
  const options = [['', own ? 'As at first' : 'None, light alone'], ...(own ? [['-', 'None, light alone']] : []), ...names.map((name) => [name, name])];
  const select = make('select', { 'aria-label': 'Array that gives the colours', onchange: () => app.change({ color: select.value, clim: null }) }, ...options.map(([value, text]) => new Option(text, value)));
  const maps = choice('Colour map', Object.entries(app.tables).map(([name, table]) => {
    const strip = make('span', { className: 'strip' });
    strip.style.background = gradient(table);
    return [name, name, strip];
  }), () => app.state.cmap, (cmap) => app.change({ cmap }), 'maps');
  const show = () => {
    select.value = app.state.color;
    maps.row.hidden = !app.page.arrays[app.state.color];
    maps.show();
  };
  return { row: section('Colour', true, make('label', { className: 'line' }, span('Colour by'), select), maps.row), show };
}

const FEW = 6;

function meshControls(app) {
  const names = [...new Set(app.meshes.filter((mesh) => mesh.name && mesh.given.frame === undefined).map((mesh) => mesh.name))];
  if (names.length < 2) return null;
  const hide = (hidden) => app.change({ hidden });
  const boxes = names.map((name) => make('input', { type: 'checkbox', onchange: (e) => hide(e.target.checked ? app.state.hidden.filter((n) => n !== name) : [...app.state.hidden, name]) }));
  const every = make('input', { type: 'checkbox', onchange: () => hide(every.checked ? [] : names) });
  const row = (box, name) => make('label', { className: 'check' }, box, span(name));
  const show = () => {
    boxes.forEach((box, i) => { box.checked = !app.state.hidden.includes(names[i]); });
    every.checked = !app.state.hidden.length;
    every.indeterminate = app.state.hidden.length > 0 && app.state.hidden.length < names.length;
  };
  const rows = [...(names.length > FEW ? [row(every, 'All')] : []), make('div', { className: 'meshes', role: 'group', 'aria-label': 'Meshes' }, ...boxes.map((box, i) => row(box, names[i])))];
  return { row: section(`Meshes (${names.length})`, names.length <= FEW, ...rows), show };
}

function viewControls(app) {
  const axis = choice('Cut across', [[-1, 'No cut'], [0, 'x'], [1, 'y'], [2, 'z']], () => app.state.cut.axis, (a) => app.change({ cut: { ...app.state.cut, axis: a } }));
  const at = slider('Place of cut', [0, 1, 0.005], () => app.state.cut.at, (x, done) => app.change({ cut: { ...app.state.cut, at: x } }, done), () => 0.5, (x) => `${Math.round(100 * x)} %`);
  const side = choice('Side that stays', [[false, 'Below'], [true, 'Above']], () => app.state.cut.far, (far) => app.change({ cut: { ...app.state.cut, far } }));
  const lensOf = choice('Projection', [[false, 'Perspective'], [true, 'Parallel']], () => app.state.camera.parallel, (parallel) => {
    const camera = copyOf(app.state.camera);
    const half = Math.tan((camera.angle * Math.PI) / 360);
    const away = minus(camera.position, camera.focal);
    // What is as far away as the focal point keeps its size in the picture.
    if (parallel) camera.scale = norm(away) * half;
    else camera.position = plus(camera.focal, unit(away), camera.scale / half);
    app.change({ camera: { ...camera, parallel } });
  });
  const eyes = [['x', [1, 0, 0], [0, 0, 1]], ['y', [0, -1, 0], [0, 0, 1]], ['z', [0, 0, 1], [0, 1, 0]], ['First', null]];
  const from = make('div', { className: 'segments', role: 'group', 'aria-label': 'See from' }, ...eyes.map(([name, v, up]) => make('button', { type: 'button', textContent: name, 'aria-label': v ? `See along ${name}` : 'First view', onclick: () => app.see(v, up) })));
  const back = make('input', { type: 'color', 'aria-label': 'Background colour', oninput: () => app.change({ background: back.value }, false), onchange: () => app.commit() });
  const show = () => {
    [axis, at, side, lensOf].forEach((part) => part.show());
    at.row.hidden = app.state.cut.axis < 0;
    side.row.parentElement.hidden = at.row.hidden;
    back.value = app.background;
  };
  const rows = [line('See from', from), line('Lens', lensOf.row), line('Cut', axis.row), at.row, line('Keep', side.row), make('label', { className: 'line' }, span('Background'), back)];
  return { row: section('View', innerHeight > 900, ...rows), show };
}

// ---- over the picture: key, colour bars, axes, frames
function bar(title, background, marks) {
  const strip = make('div', { className: 'strip' });
  strip.style.background = background;
  const ticks = marks.map(([share, word]) => {
    const tick = span(word);
    tick.style.left = `${100 * share}%`;
    return tick;
  });
  return make('figure', { className: 'bar' }, make('figcaption', { textContent: title }), strip, make('div', { className: 'ticks' }, ...ticks));
}

function legend(app) {
  const { page } = app;
  const words = make('figcaption');
  const key = make('figure', { className: 'key' }, make('canvas', { 'data-ball': 'key', role: 'img' }), words);
  const bars = make('div', { className: 'bars' });
  byId('legend').append(key, bars);
  const own = page.bars.map(({ title, colors, marks }) => bar(title, `linear-gradient(to right, ${colors.join(', ')})`, marks));
  return () => {
    const { look, color, cmap, clim } = app.state;
    key.hidden = !app.leader || app.leader.data || !(page.looks[look] || (page.key && look === '') || look === '*');
    const said = look === '' ? page.key : page.looks[look]?.key;
    words.replaceChildren(...(said || [app.leader?.given.surface ? 'a ball in this light' : 'lines along each radius']).map(span));
    key.dataset.form = app.leader ? app.form : '';
    key.firstChild.setAttribute('aria-label', `Key: ${words.textContent}`);
    if (page.arrays[color]) {
      const [low, high] = clim || page.arrays[color];
      bars.replaceChildren(bar(color, gradient(app.tables[cmap]), [0, 0.5, 1].map((at) => [at, short(low + at * (high - low))])));
    } else bars.replaceChildren(...(color === '-' ? [] : own));
  };
}

function triad(app) {
  const svg = drawing('-32 -32 64 64', ...AXES.flatMap((name) => [['line', { 'data-axis': name }], ['text', {}, name]]));
  byId('triad').append(svg);
  const parts = [...svg.children];
  app.ontriad = (view) => AXES.forEach((_, i) => {
    const [x, y] = [view[4 * i] * 20, -view[4 * i + 1] * 20];
    parts[2 * i].setAttribute('x2', x);
    parts[2 * i].setAttribute('y2', y);
    parts[2 * i + 1].setAttribute('x', x * 1.4 - 3);
    parts[2 * i + 1].setAttribute('y', y * 1.4 + 4);
  });
}

function frameControl(app) {
  const { frames } = app.page;
  if (!frames) return () => {};
  const { row, show } = slider(frames.label, [0, frames.values.length - 1, 1], () => app.state.frame, (frame, done) => app.change({ frame }, done), null, (i) => short(frames.values[i], 4));
  byId('frames').append(row);
  return show;
}

// A line between two frames that pointers and keys move.
function divider(app) {
  const { label, values } = app.page.frames;
  const input = make('input', { id: 'divider', type: 'range', max: 1, step: 0.01, 'aria-label': label, oninput: () => app.change({ split: Number(input.value) }, false) });
  const show = () => {
    input.value = app.state.split;
    input.setAttribute('aria-valuetext', `${Math.round(100 * app.state.split)} % ${values[0]}`);
  };
  const words = ['left', 'right'].map((side, i) => make('p', { className: `words top ${side}`, textContent: values[i] }));
  byId('stage').append(...words, input);
  document.body.classList.add('split');
  byId('panel').remove();
  app.watchers.push(show);
  show();
  legend(app)();
}

// Strokes that move can be held.
function motionControl(app) {
  if (!app.meshes.some((mesh) => mesh.moving)) return;
  const button = make('button', { type: 'button', onclick: () => play(!app.playing) });
  const play = (on) => {
    app.play(on);
    button.textContent = on ? 'Hold' : 'Move';
  };
  byId('frames').append(button);
  play(!matchMedia('(prefers-reduced-motion: reduce)').matches);
}

function copies(app) {
  const text = make('pre', { tabIndex: 0 });
  const said = make('span', { role: 'status' });
  const title = make('b');
  const box = make('dialog', { 'aria-label': 'Copied text' }, make('header', {}, title, said, make('button', { type: 'button', textContent: 'Close', onclick: () => box.close() })), text);
  document.body.append(box);
  return async (name, content) => {
    title.textContent = name;
    text.textContent = content;
    said.textContent = '';
    box.showModal();
    try {
      await navigator.clipboard.writeText(content);
      said.textContent = 'Copied';
    } catch {
      getSelection().selectAllChildren(text);
      said.textContent = 'Press Ctrl+C to copy';
    }
  };
}

function build(app) {
  const { page } = app;
  const panel = byId('panel');
  const fold = () => {
    const folded = document.body.classList.toggle('folded');
    folder.setAttribute('aria-expanded', String(!folded));
  };
  const folder = Object.assign(tool('fold', 'Show or hide the panel (H)', fold), { className: 'tool fold' });
  folder.setAttribute('aria-expanded', String(!document.body.classList.contains('folded')));
  const [undo, redo] = [tool('undo', 'Undo (Ctrl+Z)', () => app.undo()), tool('redo', 'Redo (Ctrl+Y)', () => app.redo())];
  const full = tool('full', 'Full screen (F)', () => (document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen()));
  full.hidden = !document.fullscreenEnabled;
  const names = Object.keys(page.looks);
  const looks = choice('Light by question', [['', 'As at first'], ...names.map((name) => [name, page.looks[name].title])], () => app.state.look, (name) => app.look(name), 'chips');
  const hint = make('p', { className: 'hint', role: 'status' });
  const copy = copies(app);
  const parts = [lightControls(app), materialControls(app), colorControls(app), meshControls(app), viewControls(app)].filter(Boolean);
  const button = (textContent, onclick, className = '') => make('button', { type: 'button', textContent, onclick, className });
  const writes = [
    ...(app.leader ? [button('Copy as Python', () => copy('This picture in Python', app.texts().python), 'first')] : []),
    ...(page.recipe.command && app.leader ? [button('Command', () => copy('This picture as a command', app.texts().command))] : []),
    button('Save picture', () => app.save()),
  ];
  panel.append(
    make('header', {}, make('b', { textContent: page.name, title: page.name }), undo, redo, tool('home', 'First view (R)', () => app.see()), full, folder),
    make('div', { className: 'scroll', tabIndex: -1 }, ...(app.leader ? [make('div', { className: 'ask' }, make('h2', { textContent: 'What should be seen?' }), looks.row, hint)] : []), ...parts.map((part) => part.row)),
    make('footer', {}, ...writes),
  );
  const over = [legend(app), frameControl(app)];
  triad(app);
  const show = () => {
    parts.forEach((part) => part.show());
    over.forEach((update) => update());
    looks.show();
    hint.textContent = page.looks[app.state.look]?.says || (app.state.look === '*' ? 'Your own light; undo goes back.' : 'The light that the page was written with.');
    undo.disabled = !app.past.length;
    redo.disabled = !app.future.length;
  };
  app.watchers.push(show);
  show();
  // Keys that come later stand over the picture, which stays where it is.
  if (byId('legend').innerText) byId('stage').style.setProperty('--foot', `${byId('legend').offsetHeight}px`);
  addEventListener('keydown', (e) => {
    if (e.target.closest?.('input[type=text], select, dialog')) return;
    const key = e.key.toLowerCase();
    if (e.ctrlKey || e.metaKey) {
      if (key !== 'z' && key !== 'y') return;
      e.preventDefault();
      if (key === 'y' || e.shiftKey) app.redo();
      else app.undo();
    } else if (e.altKey) return;
    else if (names[Number(key) - 1]) app.look(names[Number(key) - 1]);
    else if (key === 'h') fold();
    else if (key === 'r') app.see();
    else if (key === 'f' && !full.hidden) full.click();
  });
}

const notice = (textContent) => byId('notice').append(make('p', { role: 'alert', textContent }));

async function start() {
  const sheet = new CSSStyleSheet(); // a strict policy allows it, unlike an element of style
  sheet.replaceSync(STYLE);
  document.adoptedStyleSheets = [sheet];
  const page = JSON.parse(byId('scene').textContent);
  if (!page.panel || innerWidth <= 760) document.body.classList.add('folded');
  page.notices.forEach(notice);
  page.texts2d.forEach(([at, text]) => byId('stage').append(make('p', { className: `words ${at}`, textContent: text })));
  try {
    const app = new App(page);
    await app.load();
    byId('picture')?.remove();
    app.draw();
    // The picture is seen before the panel is made.
    await new Promise((done) => { requestAnimationFrame(() => setTimeout(done)); });
    (app.isSplit ? divider : build)(app);
    steer(app);
    motionControl(app);
    new ResizeObserver(() => { if (app.sized()) app.draw(); }).observe(app.canvas);
    DARK.onchange = () => app.draw();
    addEventListener('beforeprint', () => app.draw());
    app.ontriad?.(viewOf(app.state.camera));
    setTimeout(() => app.drawBalls(viewOf(app.state.camera)));
    window.vizlight = app;
    document.body.dataset.ready = String(Math.round(performance.now()));
    dispatchEvent(new Event('vizlight-ready'));
  } catch (error) {
    // The picture that Python drew stays in place of the scene.
    byId('panel').remove();
    document.body.classList.add('folded');
    notice(`The scene cannot be turned: ${error.message}`);
    // Without WebGL 2 the notice says all; any other fault is for the console too.
    if (document.createElement('canvas').getContext('webgl2')) throw error;
  }
}
start();
