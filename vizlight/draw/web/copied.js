// The picture as a program in Python and as a command of a shell.

// A string of JSON is one of Python, but for characters of more than 16 bits.
const quoted = (text) => JSON.stringify(text).replace(/[^ -~]/gu, (c) => {
  const code = c.codePointAt(0).toString(16);
  return code.length > 4 ? `\\U${code.padStart(8, '0')}` : `\\u${code.padStart(4, '0')}`;
});
const row = (xs, digits = 9) => `(${xs.map((x) => short(x, digits)).join(', ')})`;
const isWhite = (rgb) => rgb.every((c) => c === 1);

// Camera and lights in the coordinates of the mesh; in an upright window the angle is across it.
function sceneOf(app) {
  const { state: { camera }, page, canvas } = app;
  const narrow = Math.min(canvas.clientWidth / canvas.clientHeight, 1);
  const [position, focal] = [camera.position, camera.focal].map((v) => plus(v, page.origin));
  const angle = (360 / Math.PI) * Math.atan(Math.tan((camera.angle * Math.PI) / 360) / narrow);
  return { position, focal, up: camera.up, angle, parallel: camera.parallel, scale: camera.scale / narrow };
}

function lampsOf(app) {
  const view = viewOf(app.state.camera);
  return app.lamps.filter((l) => l.intensity > 0).map((l) => {
    const at = l.position && plus(l.eye ? placeBack(view, l.value) : l.value, app.page.origin);
    return { ...l, at, value: l.position ? at : unit(l.value) };
  });
}

function fadeOf(app) {
  const cue = app.leader.given.cue;
  if (cue) return cue;
  return app.state.fade > 0 ? { front: null, back: null, scales: [1, 1 - app.state.fade] } : null;
}

function pythonOf(app) {
  const { page: { recipe, frames, arrays, stem }, state, material, canvas } = app;
  const camera = sceneOf(app);
  const cue = fadeOf(app);
  const lights = lampsOf(app).map((l) => {
    const words = [l.at ? `position=${row(l.at)}` : `direction=${row(l.value)}`, `intensity=${short(l.intensity, 6)}`];
    if (!isWhite(l.color)) words.push(`color=${row(l.color, 6)}`);
    if (l.at && l.attenuation.join() !== '1,0,0') words.push(`attenuation=${row(l.attenuation)}`);
    if (l.eye && !l.at) words.push('follows_view=True');
    return `        Light(${words.join(', ')}),`;
  });
  const words = ['ambient', 'diffuse', 'specular', 'shininess'].map((name) => `${name}=${short(material[name], 6)}`);
  if (!isWhite(app.leader.given.color)) words.push(`color=${row(app.leader.given.color, 6)}`);
  const ends = cue && ['front', 'back'].filter((name) => cue[name] !== null).map((name) => `${name}=${short(cue[name], 9)}, `).join('');
  const shaped = (recipe.command || []).some((w) => /^--(clip|threshold|contour|level|slice|warp)/.test(w));
  const file = recipe.file && !shaped && !frames ? `vizlight.read(${quoted(recipe.file)})` : '...  # the mesh of the page';
  const level = frames && short(frames.values[state.frame], 9);
  const lines = ['import pyvista as pv', 'import vizlight', `from vizlight import ${cue ? 'DepthCue, ' : ''}Light, Material, Scene`, '', `mesh = ${file}`];
  if (frames) lines.push(`# ${frames.label.replace(/\s+/g, ' ')}: ${level}`);
  const { cut } = app;
  if (cut) {
    const at = app.centre.map((x, i) => (i === cut.axis ? cut.place : x));
    lines.push(`mesh = mesh.clip(normal=${quoted(AXES[cut.axis])}, origin=${row(plus(at, app.page.origin))}, invert=${cut.sign < 0 ? 'True' : 'False'})`);
  }
  lines.push('scene = Scene(', '    lights=[', ...lights, '    ],', `    material=Material(${words.join(', ')}),`);
  if (cue) lines.push(`    depth_cue=DepthCue(${ends}front_scale=${short(cue.scales[0], 6)}, back_scale=${short(cue.scales[1], 6)}),`);
  if (app.leader.given.exposure) lines.push(`    exposure=${short(app.leader.given.exposure, 9)},`);
  lines.push(')', `plotter = pv.Plotter(window_size=(${canvas.clientWidth}, ${canvas.clientHeight}))`, `plotter.background_color = ${quoted(app.background)}`);
  const kept = Object.entries(recipe.options).filter(([name]) => (name !== 'conditioned' || !state.free) && (name !== 'occlusion' || state.sky));
  const how = kept.map(([name, value]) => `, ${name}=${value}`).join('');
  const range = state.clim || arrays[state.color];
  const color = arrays[state.color] ? `, scalars=${quoted(state.color)}, cmap=${quoted(state.cmap)}, clim=${row(range)}` : state.color === '' ? recipe.color : '';
  const width = app.leader.given.lineWidth === 1 ? '' : `, line_width=${short(app.leader.given.lineWidth)}`;
  lines.push(`plotter.vizlight.add_mesh(mesh, scene=scene${how}${color}${width})`);
  lines.push(`plotter.camera_position = [${row(camera.position)}, ${row(camera.focal)}, ${row(camera.up)}]`);
  lines.push(camera.parallel ? `plotter.enable_parallel_projection()\nplotter.camera.parallel_scale = ${short(camera.scale, 9)}` : `plotter.camera.view_angle = ${short(camera.angle, 9)}`);
  lines.push(`plotter.show(screenshot=${quoted(`${stem}.png`)})`);
  return `${lines.join('\n')}\n`;
}

const ANGLE = 30; // the angle of view of the command, in degrees

// A word of a shell, as it is or in quotes that nothing ends.
const word = (text) => (/^[\w./:,+=-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

function commandOf(app) {
  const { page: { recipe, stem }, state, canvas, material } = app;
  if (!recipe.command) return '';
  const camera = sceneOf(app);
  const cue = fadeOf(app);
  const scene = {
    lights: lampsOf(app).map((l) => ({
      [l.at ? 'position' : 'direction']: l.value, intensity: l.intensity, ...(isWhite(l.color) ? {} : { color: l.color }),
      ...(l.at ? { attenuation: l.attenuation } : {}), ...(l.eye && !l.at ? { follows_view: true } : {}),
    })),
    material: { ambient: material.ambient, diffuse: material.diffuse, specular: material.specular, shininess: material.shininess },
    ...(app.leader.given.exposure ? { exposure: app.leader.given.exposure } : {}),
    ...(cue ? { depth_cue: { front: cue.front, back: cue.back, front_scale: cue.scales[0], back_scale: cue.scales[1] } } : {}),
  };
  const { cut } = app;
  const half = Math.tan((ANGLE * Math.PI) / 360);
  const words = [
    // A name that begins with a minus would be taken for an option.
    'vizlight', 'light', recipe.file.startsWith('-') ? `./${recipe.file}` : recipe.file, ...recipe.command.filter((w) => w !== '--occlusion=sky' || state.sky),
    '--scene', `${stem}.scene.json`, '--view', `${stem}.view.json`,
    ...(camera.parallel ? ['--parallel', '--zoom', short(norm(minus(camera.position, camera.focal)) * half / camera.scale, 9)] : ['--zoom', short(ANGLE / camera.angle, 9)]),
    ...(cut ? [`--clip=${cut.sign < 0 ? '' : '-'}${AXES[cut.axis]}:${short(-cut.sign * (cut.place + app.page.origin[cut.axis]), 9)}`] : []),
    ...(app.page.arrays[state.color] ? ['--scalars', state.color, '--cmap', state.cmap] : recipe.plain ? ['--for', 'shape'] : []),
    '--no-key', '--background', app.background, '--size', `${canvas.clientWidth}x${canvas.clientHeight}`, '-o', `${stem}.png`,
  ];
  const file = (name, value) => `cat > ${word(name)} <<'END'\n${JSON.stringify(value)}\nEND\n`;
  const view = [camera.position, camera.focal, camera.up];
  return `${file(`./${stem}.scene.json`, scene)}${file(`./${stem}.view.json`, view)}${words.map(word).join(' ')}\n`;
}
