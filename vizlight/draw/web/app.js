// One state, from which picture, panel and copied texts follow; undo keeps earlier states.

const BALL = 176; // pixels across a lit ball
const SLOW = 50; // ms for a frame above which fewer samples are drawn while something moves
const MOST_LAMPS = 4;
const DARK = matchMedia('screen and (prefers-color-scheme: dark)');
const byId = (id) => document.getElementById(id);
const copyOf = (x) => JSON.parse(JSON.stringify(x));
const short = (x, digits = 3) => String(Number(Number(x).toPrecision(digits)));
const inDegrees = (x) => Math.round((x * 180) / Math.PI);
const hex = (rgb) => `#${rgb.map((c) => Math.round(255 * Math.min(1, Math.max(0, c))).toString(16).padStart(2, '0')).join('')}`;
const shares = (text) => text.match(/\w\w/g).slice(0, 3).map((c) => parseInt(c, 16) / 255);
const AXES = ['x', 'y', 'z'];

class App {
  constructor(page) {
    Object.assign(this, { page, past: [], future: [], lamp: 0, set: 0, watchers: [], ratio: 1, programs: new Map() });
    this.first = {
      sets: page.lights, materials: page.meshes.map((mesh) => mesh.material), look: '', color: '', cmap: page.cmap, clim: null,
      frame: page.frame, split: 0.5, cut: { axis: -1, at: 0.5, far: false }, free: false, sky: true, fade: page.fade, camera: page.camera, hidden: [], background: '',
    };
    // Frames with names in place of numbers stand side by side, left and right of a divider.
    this.isSplit = typeof page.frames?.values[0] === 'string';
    Object.assign(this.first.camera, { up: uprightOf(page.camera), above: null });
    this.state = copyOf(this.first);
    this.saved = JSON.stringify(this.state);
    this.canvas = byId('canvas');
    // The picture is kept after it was shown, for who saves or prints it; without alpha, as else
    // the page would shine through what is translucent.
    const gl = this.canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true, alpha: false });
    if (!gl) throw new Error('this page needs WebGL 2 to draw, which this browser does not have or has switched off');
    this.gl = gl;
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    // The balls are drawn beside the canvas, and without depths: half a ball hides nothing of
    // itself.
    this.small = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.small);
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, BALL, BALL);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  async load() {
    const { gl, page } = this;
    const texts = JSON.parse(new TextDecoder().decode(await inflated(page.texts)));
    this.tables = Object.create(null);
    await Promise.all(Object.entries(page.maps).map(async ([name, packed]) => { this.tables[name] = await unpack(packed); }));
    this.meshes = await Promise.all(page.meshes.map((given) => Mesh.read(gl, given, texts)));
    this.keys = Object.fromEntries(FORMS.map((form) => [form, keyOf(gl, form)]));
    this.leader = this.meshes.find((mesh) => mesh.given.live);
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    this.meshes.forEach(({ places }) => {
      for (let i = 0; i < places.length; i += 1) {
        // What is not finite is neither less nor more, and so is left out.
        if (places[i] < low[i % 3]) low[i % 3] = places[i];
        if (places[i] > high[i % 3]) high[i % 3] = places[i];
      }
    });
    if (low[0] > high[0]) { low.fill(0); high.fill(0); }
    const { up, position, focal } = this.first.camera;
    const [wide, deep, tall] = minus(high, low);
    // Of what is lower than wide z is up, also where it is seen along z.
    if (tall < 0.5 * Math.min(wide, deep) && Math.abs(up[2]) < 1e-5 && unit(minus(position, focal))[2] > 0.999) this.first.camera.above = this.state.camera.above = [0, 0, 1];
    Object.assign(this, { low, high, centre: scaled(plus(low, high), 0.5), radius: norm(minus(high, low)) / 2 || 1 });
  }

  // ---- state
  change(values, done = true) {
    Object.assign(this.state, values);
    if ('color' in values || 'cmap' in values || 'clim' in values) this.recolor();
    if (done) this.commit();
    this.render();
    this.watchers.forEach((watch) => watch());
  }

  commit() {
    const now = JSON.stringify(this.state);
    if (now === this.saved) return;
    this.past.push(this.saved);
    this.future = [];
    this.saved = now;
    if (this.past.length > 100) this.past.shift();
  }

  travel(from, to) {
    if (!from.length) return;
    to.push(this.saved);
    this.saved = from.pop();
    this.state = JSON.parse(this.saved);
    this.lamp = Math.max(0, Math.min(this.lamp, this.lamps.length - 1));
    // It names the colour, so that the meshes get the colour they had then.
    this.change({ color: this.state.color }, false);
  }

  get lamps() { return this.state.sets[this.set] || []; }

  get material() { return this.state.materials[this.meshes.indexOf(this.leader)]; }

  // Light by question; none is the light that the page was written with.
  look(name) {
    const look = this.page.looks[name];
    const values = { look: name, free: Boolean(look?.free), sets: copyOf(this.first.sets), materials: copyOf(this.first.materials), color: this.first.color };
    if (look) {
      values.sets = values.sets.map(() => copyOf(look.lamps));
      values.materials = values.materials.map((m) => m && { ...m, ...look.material });
      const names = Object.keys(this.page.arrays);
      const own = this.meshes.some((mesh) => mesh.own && mesh.given.colored);
      values.color = look.colored ? (own ? '' : names.find((n) => n !== this.page.frames?.label) || '') : own ? '-' : '';
    }
    this.lamp = 0;
    this.change(values);
  }

  // Colours: '' as the page was written, '-' none, otherwise an array.
  recolor() {
    const { color, cmap, clim } = this.state;
    this.meshes.forEach((mesh) => {
      if (mesh.values[color]) mesh.colorBy(color, this.page.arrays[color], clim || this.page.arrays[color], this.tables[cmap]);
      else if (mesh.given.live) mesh.paint(color === '-' ? null : mesh.own);
    });
  }

  // ---- picture
  // A background that nobody chose is dark on dark pages, but not on paper.
  get background() {
    const { auto, background } = this.page;
    return this.state.background || (auto && DARK.matches ? '#16181d' : background);
  }

  shown(mesh, frame = this.state.frame) {
    return (mesh.given.frame === undefined || mesh.given.frame === frame) && !this.state.hidden.includes(mesh.name);
  }

  // The axis that is cut, the place of the cut along it, and the side that is left out.
  get cut() {
    const { axis, at, far } = this.state.cut;
    return axis < 0 ? null : { axis, place: this.low[axis] + at * (this.high[axis] - this.low[axis]), sign: far ? 1 : -1 };
  }

  // What all programs are given, in the coordinates of the eye.
  numbers(view, aspect) {
    const { camera } = this.state;
    const middle = -place(view, this.centre)[2];
    const far = middle + 1.01 * this.radius;
    // The near plane stays off the eye, next to which most steps of a depth buffer lie.
    const near = Math.max(middle - 1.01 * this.radius, camera.parallel ? -Infinity : Math.abs(far) / 5000 || 1e-9);
    const found = {
      // Far stays beyond near, even where all of the meshes are behind the eye.
      MCVCMatrix: view, MCPCMatrix: product(lens(camera, aspect, near, Math.max(far, 2 * near)), view),
      normalMatrix: [0, 1, 2, 4, 5, 6, 8, 9, 10].map((i) => view[i]),
      // A direction has 0 as its fourth number, a position 1.
      vizEye: camera.parallel ? [0, 0, 1, 0] : [0, 0, 0, 1], vizAxis: [0, 0, 1, 0], vizFrom: [0, 0, 0],
      ownCut: [0, 0, 0, 0], ownSize: [this.canvas.width, this.canvas.height],
    };
    const { cut } = this;
    if (cut) {
      const normal = rotate(view, AXES.map((_, i) => (i === cut.axis ? cut.sign : 0)));
      found.ownCut = [...normal, -dot(normal, place(view, AXES.map((_, i) => (i === cut.axis ? cut.place : this.centre[i]))))];
    }
    return found;
  }

  // Light and material of one mesh, and the key of its text: lamps with a place come first.
  lightOf(mesh, view) {
    const { given } = mesh;
    const material = this.state.materials[this.meshes.indexOf(mesh)];
    const lamps = this.state.sets[given.lights].filter((l) => l.intensity > 0);
    const ordered = [...lamps.filter((l) => l.position), ...lamps.filter((l) => !l.position)];
    const numbers = {
      vizAmbientGain: given.ambientColor.map((c) => c * material.ambient), vizDiffuseGain: [material.diffuse],
      vizSpecularGain: given.specularColor.map((c) => c * material.specular), vizShininess: [material.shininess],
      vizSky: [Number(this.state.sky)],
    };
    ordered.forEach((l, i) => {
      if (l.position) {
        numbers[`vizLight${i}`] = l.eye ? l.value : place(view, l.value);
        numbers[`vizFade${i}`] = l.attenuation;
      } else numbers[`vizLight${i}`] = unit(l.eye ? l.value : rotate(view, l.value));
      numbers[`vizColor${i}`] = l.color.map((c) => c * l.intensity);
    });
    if (given.field) {
      Object.assign(numbers, given.field.numbers, { vizFieldFrom: place(view, given.field.numbers.vizFieldFrom) });
      ['X', 'Y', 'Z'].forEach((axis) => {
        const row = given.field.numbers[`vizField${axis}`];
        numbers[`vizField${axis}`] = [...rotate(view, row), row[3]];
      });
    }
    const cue = given.cue || (this.state.fade > 0 ? { front: null, back: null, scales: [1, 1 - this.state.fade] } : null);
    if (cue) numbers.vizCueEnds = this.endsOf(cue, mesh, view);
    const near = ordered.filter((l) => l.position).length;
    const free = given.free && this.state.free ? 'free ' : '';
    return { numbers, key: `${free}${near} ${ordered.length - near}${cue ? ' cue' : ''}` };
  }

  // Depths at which a depth cue begins and ends, those of the points where they are not given.
  endsOf({ front, back, scales }, { places }, view) {
    let [near, far] = [Infinity, -Infinity];
    if (front === null || back === null) {
      for (let i = 0; i < places.length; i += 3) {
        const depth = -(view[2] * places[i] + view[6] * places[i + 1] + view[10] * places[i + 2] + view[14]);
        if (depth < near) near = depth;
        if (depth > far) far = depth;
      }
      if (!(near <= far)) [near, far] = [0, 1];
    }
    const start = front ?? (back === null || near < back ? near : back - 1);
    const end = back ?? (far > start ? far : start + 1);
    return [start, end, ...scales];
  }

  render() {
    this.due ??= requestAnimationFrame(() => { this.due = null; this.draw(); });
  }

  // Strokes run, and go on from where they stood; readers who want no motion start them.
  play(on) {
    this.playing = on;
    const moving = this.meshes.filter((mesh) => mesh.moving);
    let before = performance.now();
    const step = (now) => {
      if (!this.playing) return;
      this.time = ((this.time || 0) + Math.max(0, now - before) / 1000) % 3600;
      before = now;
      moving.forEach((mesh) => mesh.move((this.time / mesh.given.moving.seconds) % 1));
      this.draw();
      requestAnimationFrame(step);
    };
    if (on) requestAnimationFrame(step);
  }

  // Pixels of the canvas for each of the window, fewer while a slow picture moves; whether they have changed.
  sized(ratio = window.devicePixelRatio || 1) {
    const { clientWidth, clientHeight } = this.canvas;
    const [width, height] = [clientWidth, clientHeight].map((x) => Math.max(1, Math.round(x * ratio)));
    if (this.canvas.width === width && this.canvas.height === height) return false;
    Object.assign(this.canvas, { width, height });
    return true;
  }

  draw() {
    const { gl, canvas, state } = this;
    const whole = window.devicePixelRatio || 1;
    const ratio = this.moving && this.slow ? whole / this.slow : whole;
    this.sized(ratio);
    const started = performance.now();
    const view = viewOf(state.camera);
    // The weights are about those of luminance: words over the picture are dark or light by it.
    canvas.parentElement.dataset.tone = dot(shares(this.background), [0.3, 0.6, 0.1]) < 0.5 ? 'dark' : 'light';
    // Title and keys stand beside the canvas, on the same ground.
    canvas.parentElement.style.background = this.background;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...shares(this.background), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const common = { ...this.numbers(view, canvas.width / canvas.height), ownGround: shares(this.background) };
    const draw = (mesh, sorted) => {
      const { numbers, key } = mesh.given.live ? this.lightOf(mesh, view) : { numbers: this.lightOfBalls(mesh, view), key: '' };
      mesh.draw({ ...common, ...numbers }, key, view, sorted, ratio);
    };
    const layers = (meshes) => {
      meshes.filter((m) => m.given.opacity >= 1).forEach((m) => draw(m));
      gl.enable(gl.BLEND);
      // What is opaque hides what is translucent, which hides nothing itself.
      gl.depthMask(false);
      meshes.filter((m) => m.given.opacity < 1).forEach((m) => draw(m, !this.moving || !this.slow));
      gl.depthMask(true);
      gl.disable(gl.BLEND);
    };
    if (this.isSplit) {
      const middle = Math.round(state.split * canvas.width);
      gl.enable(gl.SCISSOR_TEST);
      [[0, middle], [middle, canvas.width - middle]].forEach(([from, width], frame) => {
        gl.scissor(from, 0, width, canvas.height);
        layers(this.meshes.filter((mesh) => this.shown(mesh, frame)));
      });
      gl.disable(gl.SCISSOR_TEST);
    } else layers(this.meshes.filter((mesh) => this.shown(mesh)));
    this.ontriad?.(view);
    if (!this.moving || !this.slow) this.drawBalls(view);
    if (!this.moving) return;
    // The time of a frame is known when a pixel of it is read.
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    // As if at all pixels, whose number goes with the square of the ratio.
    const took = (performance.now() - started) * (ratio < whole ? this.slow ** 2 : 1);
    if (took > SLOW && !this.slow) this.slow = Math.min(4, Math.max(2, Math.round(Math.sqrt(took / SLOW))));
  }

  // Something moves until nothing has moved for a while.
  move() {
    this.moving = true;
    clearTimeout(this.rest);
    this.rest = setTimeout(() => {
      this.moving = false;
      this.render();
    }, 180);
    this.render();
    this.onmove?.();
  }

  // The ball of the lamps and the one of the key are drawn when their light changes.
  drawBalls(view) {
    const targets = [...document.querySelectorAll('canvas[data-ball]')];
    if (!this.leader || !targets.length) return;
    const { gl } = this;
    const { given } = this.leader;
    const { numbers } = this.lightOf(this.leader, view);
    const lit = this.lightOfBall(numbers, view);
    const said = JSON.stringify([lit, this.leader.data, targets.length, this.form]);
    if (said === this.drawn) return;
    this.drawn = said;
    const flat = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
    const all = {
      // Depths in clip space grow away from the eye, and z toward it; halved, none reaches the end.
      ...lit.numbers, MCVCMatrix: flat, MCPCMatrix: flat.map((x, i) => (i === 10 ? -0.5 : x)), normalMatrix: [1, 0, 0, 0, 1, 0, 0, 0, 1],
      vizEye: [0, 0, 1, 0], ownCut: [0, 0, 0, 0], ownSize: [BALL, BALL], ownOpacity: [1], ownWide: [1], ...given.numbers, vizNormalMCSize: [1], vizTangentMCSize: [1], vizSky: [0],
    };
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.small);
    gl.viewport(0, 0, BALL, BALL);
    gl.clearColor(0, 0, 0, 0);
    targets.forEach((target) => {
      gl.clear(gl.COLOR_BUFFER_BIT);
      this.leader.program(lit.key, false).use(all);
      this.keys[target.dataset.ball === 'key' ? this.form : 'ball'].draw();
      const image = new ImageData(BALL, BALL);
      gl.readPixels(0, 0, BALL, BALL, gl.RGBA, gl.UNSIGNED_BYTE, image.data);
      Object.assign(target, { width: BALL, height: BALL });
      target.getContext('2d').putImageData(image, 0, 0); // upside down, which the style turns
    });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  // The figure of the key, the same as in pictures.
  get form() {
    const { page, state: { look }, leader } = this;
    return (look === '' ? page : page.looks[look])?.form || (leader.given.surface ? 'ball' : 'hemisphere');
  }

  // A ball is far from all lamps: those with a place shine from where they stand about the centre.
  lightOfBall(numbers, view) {
    const lamps = this.state.sets[this.leader.given.lights].filter((l) => l.intensity > 0);
    // A ball casts no shadow of the field.
    const found = { ...numbers, vizDepth: [0] };
    lamps.forEach((l, i) => {
      found[`vizLight${i}`] = this.seen(l, view);
      found[`vizColor${i}`] = l.color.map((c) => c * l.intensity);
    });
    return { numbers: found, key: `${this.leader.given.free && this.state.free ? 'free ' : ''}0 ${lamps.length}` };
  }

  lightOfBalls({ given: { ball, lamps = [] } }, view) {
    if (!ball) return {};
    const numbers = { ownBall: ball, ownNearer: this.nearer };
    for (let i = 0; i < MOST_OF_BALLS; i += 1) {
      numbers[`ownWays[${i}]`] = lamps[i] ? this.seen(lamps[i], view) : [0, 0, 0];
      numbers[`ownGlows[${i}]`] = lamps[i] ? scaled(lamps[i].color, lamps[i].intensity) : [0, 0, 0];
    }
    return numbers;
  }

  // Size in the window of what had a size in the picture, in its pixels.
  get nearer() {
    const { state: { camera }, first, page, canvas } = this;
    const high = (c) => (c.parallel ? c.scale : norm(minus(c.position, c.focal)) * Math.tan((c.angle * Math.PI) / 360));
    return (high(first.camera) / high(camera)) * (Math.min(canvas.clientWidth, canvas.clientHeight) / page.high);
  }

  // Direction from the centre to a lamp, in the coordinates of the eye; and a lamp put there.
  seen(l, view) {
    if (!l.position) return unit(l.eye ? l.value : rotate(view, l.value));
    return unit(minus(l.eye ? l.value : place(view, l.value), place(view, this.centre)));
  }

  put(l, direction) {
    const view = viewOf(this.state.camera);
    if (l.position) {
      const middle = place(view, this.centre);
      const at = plus(middle, direction, norm(minus(l.eye ? l.value : place(view, l.value), middle)));
      l.value = l.eye ? at : placeBack(view, at);
    } else l.value = l.eye ? direction : rotateBack(view, direction);
    this.state.look = '*';
  }

  // A lamp that turns with the eye from now on, or stays beside the mesh; it shines as before.
  fix(l, eye) {
    const view = viewOf(this.state.camera);
    const [turned, moved] = eye ? [rotate, place] : [rotateBack, placeBack];
    l.value = (l.position ? moved : turned)(view, l.value);
    l.eye = eye;
  }

  async save() {
    this.moving = false;
    this.draw();
    const blob = await new Promise((done) => { this.canvas.toBlob(done, 'image/png'); });
    const link = make('a', { href: URL.createObjectURL(blob), download: `${this.page.stem}.png` });
    link.click();
    // The browser reads the picture after the click, and would find nothing if it were freed now.
    setTimeout(() => URL.revokeObjectURL(link.href), 5000);
  }

  // ---- camera
  // About the axis that is up and stays so, as far as its ends: who comes back finds the first view.
  orbit(dx, dy) {
    const { camera } = this.state;
    let away = minus(camera.position, camera.focal);
    // A map that is seen from above stands upright once it is tilted.
    if (camera.above) {
      away = plus(away, camera.up, -0.011 * norm(away));
      Object.assign(camera, { up: camera.above, above: null });
    }
    const up = unit(camera.up);
    const angle = Math.acos(dot(up, unit(away)));
    // Beyond the ends nothing turns until the pointer is back.
    const wanted = angle - dy + (this.beyond || 0);
    const raised = Math.max(0.01, Math.min(Math.PI - 0.01, wanted)) - angle;
    this.beyond = wanted - angle - raised;
    camera.position = plus(camera.focal, spun(spun(away, unit(cross(up, away)), raised), up, -dx));
    this.move();
  }

  pan(dx, dy) {
    const { camera, canvas } = { ...this.state, canvas: this.canvas };
    const away = minus(camera.position, camera.focal);
    const high = camera.parallel ? 2 * camera.scale : 2 * norm(away) * Math.tan((camera.angle * Math.PI) / 360);
    // The size of a pixel where the focal point is, which then stays under the pointer.
    const pixel = high / Math.min(canvas.clientHeight, canvas.clientWidth);
    const right = unit(cross(camera.up, away));
    const shift = plus(scaled(right, -dx * pixel), unit(cross(away, right)), dy * pixel);
    camera.position = plus(camera.position, shift);
    camera.focal = plus(camera.focal, shift);
    this.move();
  }

  zoom(factor) {
    const { camera } = this.state;
    if (camera.parallel) camera.scale /= factor;
    else camera.position = plus(camera.focal, minus(camera.position, camera.focal), 1 / factor);
    this.move();
  }

  // See along an axis, or as at first.
  see(direction, up) {
    const camera = copyOf(this.first.camera);
    if (direction) {
      const away = norm(minus(camera.position, camera.focal));
      Object.assign(camera, { focal: this.centre, position: plus(this.centre, direction, away), up, above: direction[2] ? [0, 0, 1] : null });
    }
    this.change({ camera });
  }

  // ---- what is copied
  undo() { this.travel(this.past, this.future); }

  redo() { this.travel(this.future, this.past); }

  texts() { return { python: pythonOf(this), command: commandOf(this) }; }
}

// Pointers and keys on the picture.
function steer(app) {
  const { canvas } = app;
  const held = new Map();
  const spread = () => {
    const [a, b] = [...held.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y) };
  };
  canvas.onpointerdown = (e) => {
    // A drag goes on where the pointer leaves the picture.
    canvas.setPointerCapture(e.pointerId);
    held.set(e.pointerId, { x: e.clientX, y: e.clientY });
  };
  canvas.onpointermove = (e) => {
    const last = held.get(e.pointerId);
    if (!last) return;
    const before = held.size === 2 ? spread() : null;
    const [dx, dy] = [e.clientX - last.x, e.clientY - last.y];
    held.set(e.pointerId, { x: e.clientX, y: e.clientY });
    // Two fingers shift and zoom; the right and the middle button, 2 and 4, shift too.
    if (before) {
      const after = spread();
      app.pan(after.x - before.x, after.y - before.y);
      app.zoom(after.apart / (before.apart || 1));
    } else if (e.shiftKey || e.buttons & 6) app.pan(dx, dy);
    // In a text, fingers that move up and down scroll it.
    else app.orbit((dx * 4) / canvas.clientHeight, app.isSplit && e.pointerType === 'touch' ? 0 : (dy * 4) / canvas.clientHeight);
  };
  canvas.onpointerup = (e) => {
    held.delete(e.pointerId);
    app.beyond = 0;
    app.change({});
  };
  canvas.onpointercancel = canvas.onpointerup;
  canvas.oncontextmenu = (e) => e.preventDefault();
  canvas.addEventListener('wheel', (e) => {
    // A scene without a panel stands within a text, which the wheel scrolls.
    if (app.isSplit && !e.ctrlKey) return;
    e.preventDefault();
    // By factors, so that as many turns of the wheel back end where it began.
    app.zoom(Math.exp(-e.deltaY / 600));
    clearTimeout(app.wheel);
    // A wheel tells no end of its motion: after a pause it is one step to undo.
    app.wheel = setTimeout(() => app.change({}), 300);
  }, { passive: false });
  const step = Math.PI / 36;
  const acts = {
    ArrowLeft: () => app.orbit(-step, 0), ArrowRight: () => app.orbit(step, 0), ArrowUp: () => app.orbit(0, -step), ArrowDown: () => app.orbit(0, step),
    '+': () => app.zoom(1.1), '=': () => app.zoom(1.1), '-': () => app.zoom(1 / 1.1),
  };
  canvas.onkeydown = (e) => {
    if (!acts[e.key] || e.ctrlKey || e.metaKey || e.altKey) return;
    e.preventDefault();
    acts[e.key]();
    app.change({});
  };
}
