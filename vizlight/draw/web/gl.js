// WebGL 2 draws triangles, strokes and points whose light is a text that Python wrote.

const KINDS = { i2: Int16Array, i4: Int32Array, u1: Uint8Array, u2: Uint16Array, u4: Uint32Array };
const NO_NUMBER = -(2 ** 31); // stands for a coordinate that is not finite
const NO_VALUE = 65535; // stands for a value that is not finite
const GREY = 128;

// ---- vectors; matrices are lists of columns
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const plus = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const minus = (a, b) => plus(a, b, -1);
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => scaled(a, 1 / (norm(a) || 1));
const rotate = (m, v) => [0, 1, 2].map((r) => m[r] * v[0] + m[r + 4] * v[1] + m[r + 8] * v[2]);
const rotateBack = (m, v) => [0, 4, 8].map((c) => m[c] * v[0] + m[c + 1] * v[1] + m[c + 2] * v[2]);
const place = (m, v) => plus(rotate(m, v), m.slice(12, 15));
const placeBack = (m, v) => rotateBack(m, minus(v, m.slice(12, 15)));
function spun(v, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return plus(plus(scaled(v, c), cross(axis, v), s), axis, dot(axis, v) * (1 - c));
}
function product(a, b) {
  const m = new Array(16).fill(0);
  for (let c = 0; c < 4; c += 1) for (let r = 0; r < 4; r += 1) for (let k = 0; k < 4; k += 1) m[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return m;
}

function viewOf({ position, focal, up }) {
  const z = unit(minus(position, focal));
  const x = unit(cross(up, z));
  const y = cross(z, x);
  return [x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, -dot(x, position), -dot(y, position), -dot(z, position), 1];
}

// The axis of space that stands upright in a picture, z before others, or else the picture's own.
function uprightOf({ position, focal, up }) {
  const right = unit(cross(up, minus(position, focal)));
  const axes = [[0, 0, 1], [0, 1, 0], [1, 0, 0]].flatMap((axis) => [axis, scaled(axis, -1)]);
  return axes.find((axis) => Math.abs(dot(axis, right)) < 1e-5 && dot(axis, unit(up)) > 0.1) || up;
}

// In an upright window the angle and the scale are those from side to side.
function lens({ angle, parallel, scale }, aspect, near, far) {
  const narrow = Math.min(aspect, 1);
  const depth = far - near;
  if (parallel) {
    const half = scale / narrow;
    return [1 / (half * aspect), 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, -2 / depth, 0, 0, 0, -(far + near) / depth, 1];
  }
  const f = narrow / Math.tan((angle * Math.PI) / 360);
  return [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, -(far + near) / depth, -1, 0, 0, (-2 * far * near) / depth, 0];
}

// ---- numbers, as Python packs them
// Several bytes come as differences from row to row (order 1) or differences of those (order 2), the
// sign in the last bit, bytes of equal rank together.
function rowsOf(bytes, width, columns, order) {
  const count = bytes.length / width;
  const rows = count / columns;
  const found = new (width === 4 ? Uint32Array : Uint16Array)(count);
  for (let c = 0; c < columns; c += 1) {
    let [step, value] = [0, 0];
    for (let r = 0; r < rows; r += 1) {
      let folded = 0;
      for (let b = 0; b < width; b += 1) folded |= bytes[b * count + c * rows + r] << (8 * b);
      const change = (folded >>> 1) ^ -(folded & 1);
      step = order === 2 ? step + change : change;
      value = (value + step) | 0;
      found[r * columns + c] = value;
    }
  }
  return found.buffer;
}

async function inflated(data) {
  const packed = Uint8Array.from(atob(data), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function unpack({ data, kind, columns, order }) {
  const bytes = await inflated(data);
  return columns ? new KINDS[kind](rowsOf(bytes, KINDS[kind].BYTES_PER_ELEMENT, columns, order)) : bytes;
}

async function unpackPlaces(packed) {
  const whole = await unpack(packed);
  const found = new Float32Array(whole.length);
  for (let i = 0; i < whole.length; i += 1) found[i] = whole[i] === NO_NUMBER ? NaN : whole[i] * packed.scale;
  return found;
}

// ---- cells [n, i, j, ..., n, i, ...] as corners of triangles, ends of strokes or points
const SHAPES = {
  fan: (c, put) => { for (let i = 2; i < c.length; i += 1) put(c[0], c[i - 1], c[i]); },
  // Every other triangle of a strip runs the other way round, so two of its corners change places.
  strip: (c, put) => { for (let i = 2; i < c.length; i += 1) put(c[i - 2], c[i - 1 + (i % 2)], c[i - (i % 2)]); },
  path: (c, put) => c.forEach((x) => put(x)),
  ring: (c, put) => { c.forEach((x) => put(x)); put(c[0]); },
};
function cornersOf(cells, shape) {
  const [ids, owners] = [[], []];
  let cell = 0;
  const put = (...some) => some.forEach((i) => { ids.push(i); owners.push(cell); });
  for (let at = 0; at < cells.length; at += cells[at] + 1, cell += 1) shape(cells.subarray(at + 1, at + 1 + cells[at]), put);
  return { ids: Uint32Array.from(ids), owners: Uint32Array.from(owners) };
}
function gathered(rows, ids, width) {
  if (!ids) return rows;
  const found = new rows.constructor(ids.length * width);
  for (let k = 0; k < ids.length; k += 1) for (let c = 0; c < width; c += 1) found[k * width + c] = rows[ids[k] * width + c];
  return found;
}

// ---- programs; places of the text that Python writes have the marks of VTK
const VERTEX = `#version 300 es
#define attribute in
#define varying out
precision highp float;
attribute vec3 ownPlace; attribute vec4 ownColor;
#define vertexMC vec4(ownPlace, 1.0)
uniform vec2 ownSize; uniform float ownWide;
varying vec4 ownShade;
//VTK::Camera::Dec
//VTK::Normal::Dec
void main() {
//VTK::Normal::Impl
  ownShade = ownColor;
  gl_Position = MCPCMatrix * vertexMC;
  gl_PointSize = ownWide;
//STROKE
}`;
// Four corners: the last bit of their number tells the side of a stroke, the other one its end.
// Clip space is 2 wide: half a width to a side is the width over that of the picture.
const STROKE = `
  vec4 a = MCPCMatrix * vec4(ownPlaceA, 1.0); vec4 b = MCPCMatrix * vec4(ownPlaceB, 1.0);
  vec2 way = (b.xy / b.w - a.xy / a.w) * ownSize;
  vec2 side = length(way) > 1e-6 ? normalize(vec2(-way.y, way.x)) : vec2(0.0, 1.0);
  gl_Position.xy += (float(gl_VertexID % 2) * 2.0 - 1.0) * side * ownWide / ownSize * gl_Position.w;
  if (ownGap > 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);`;
// Depths of what is nearer to the eye: half of a pixel at this depth, and the change of depths in clip space.
const NEARER = `
  #define ROW(m, r) vec3(m[0][r], m[1][r], m[2][r])
  float slope = -length(ROW(MCPCMatrix, 2)) / length(ROW(MCVCMatrix, 2));
  float focus = float(ROW(MCPCMatrix, 3) != vec3(0.0));
  float pixel = gl_Position.w * length(ROW(MCVCMatrix, 1)) / length(ROW(MCPCMatrix, 1)) / ownSize.y;`;
// A stroke with a halo, or with widths at its points, is a capsule: places and sizes are in pixels, times
// the w of its corner, so that what is interpolated is linear on the screen. Depths are of what is nearer
// to the eye by the width of the line, and of the border of its halo, which is behind it. Ends go on along
// the line in depth too, so that of two that join none has its border before the other.
const CAPSULE = `
  vec4 a = MCPCMatrix * vec4(ownPlaceA, 1.0); vec4 b = MCPCMatrix * vec4(ownPlaceB, 1.0);
  vec2 span = (b.xy / b.w - a.xy / a.w) * ownSize * 0.5;
  float size = length(span); vec2 way = size > 1e-6 ? span / size : vec2(1.0, 0.0);
  bool last = gl_VertexID > 1; float flank = float(gl_VertexID % 2) * 2.0 - 1.0; float w = gl_Position.w;
  vec2 halves = 0.5 * ownWide * vec2(ownShareA * turned(ownLeanA, ownPlaceA), ownShareB * turned(ownLeanB, ownPlaceB));
  float reach = (last ? halves.y : halves.x) + ownHalo + 1.0;
  float far = last ? reach : -reach;
  ownAt = w * vec3(flank * reach, far + (last ? size : 0.0), size);
  ownHalves = w * halves;
  gl_Position.xy += (far * way + flank * reach * vec2(-way.y, way.x)) * 2.0 / ownSize * w;
  gl_Position.z += far / max(size, reach) * (b.z / b.w - a.z / a.w) * w;
  ${NEARER}
  float nearer = 2.0 * ownWide * pixel;
  vec2 moved = vec2(min(nearer, focus > 0.0 ? 0.5 * w : nearer), -ownDepth * nearer);
  ownDeep = 0.5 * w * ((gl_Position.z + slope * moved) / (w - focus * moved) - gl_Position.z / w);
  if (ownGap > 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);`;
const CAPSULE_VERTEX = 'uniform float ownHalo; uniform float ownDepth; varying vec3 ownAt; varying vec2 ownHalves; varying vec2 ownDeep;\nin float ownShareA; in float ownShareB; in vec3 ownLeanA; in vec3 ownLeanB;' + `
float turned(vec3 lean, vec3 at) {
  if (lean == vec3(0.0)) return 1.0;
  vec3 eye = MCPCMatrix[2][3] == 0.0 ? vec3(0.0, 0.0, 1.0) : normalize((MCVCMatrix * vec4(at, 1.0)).xyz);
  return smoothstep(0.05, 0.3, abs(dot(mat3(MCVCMatrix) * (lean * 2.0 - 1.0), eye)));
}\n`;
const CAPSULE_FRAGMENT = 'uniform float ownHalo; uniform float ownDarker; uniform vec3 ownGround; varying vec3 ownAt; varying vec2 ownHalves; varying vec2 ownDeep;';
const CAPSULE_SHAPE = `
  vec3 at = ownAt * gl_FragCoord.w; vec2 halves = ownHalves * gl_FragCoord.w; vec2 deep = ownDeep * gl_FragCoord.w;
  float away = length(vec2(at.x, max(max(-at.y, at.y - at.z), 0.0))) - mix(halves.x, halves.y, clamp(at.y / max(at.z, 1e-6), 0.0, 1.0));
  float border = 0.5 * fwidth(away);
  // Where the width changes fast, as in the head of an arrow, ends are straight.
  bool steep = abs(halves.x - halves.y) > 0.2 * at.z && (at.y < 0.0 || at.y > at.z);
  if (away >= max(ownHalo, 0.0) + border || steep) discard;
  float near = deep.x * (1.0 - 0.75 * clamp(0.5 + 0.5 * away / border, 0.0, 1.0));
  gl_FragDepth = clamp(gl_FragCoord.z + near, 1e-3, 1.0) + clamp((away - border) / max(ownHalo, 1e-3), 0.0, 1.0) * (deep.y - near);`;
const CAPSULE_GROUND = `
  if (ownHalo > 0.0) {
    // The rim of a line that is nearly as light as its ground is darker, as in pictures, but of colours of data.
    vec3 luma = vec3(0.2126, 0.7152, 0.0722);
    float ground = dot(ownGround, luma);
    float pale = ground < 0.5 ? 0.0 : clamp(1.0 - (ground - dot(ownOut.rgb, luma)) / 0.4, 0.0, 1.0);
    ownOut.rgb *= 1.0 - ownDarker * pale * smoothstep(-2.5, -0.5, away);
    ownOut.rgb = mix(ownOut.rgb, ownGround, smoothstep(-border, border, away));
    ownOut.a *= 1.0 - smoothstep(-border, border, away - ownHalo);
  } else ownOut.a *= 1.0 - smoothstep(-border, border, away);
}`;
const FRAGMENT = `#version 300 es
#define varying in
precision highp float;
precision highp sampler2D;
varying vec4 ownShade;
uniform vec4 ownCut; uniform float ownOpacity;
out vec4 ownOut;
//VTK::Normal::Dec
//VTK::Light::Dec
void main() {
  if (dot(ownCut, vec4(vizPVSOutput, 1.0)) < 0.0) discard;
  vec3 ambientColor = ownShade.rgb; vec3 diffuseColor = ownShade.rgb; float opacity = ownOpacity * ownShade.a;
//VTK::Light::Impl
}`;
// Colours that have their light already.
const UNLIT = [
  ['Vertex', '//VTK::Camera::Dec', 'uniform mat4 MCPCMatrix; uniform mat4 MCVCMatrix; varying vec3 vizPVSOutput;'],
  ['Vertex', '//VTK::Normal::Impl', 'vizPVSOutput = (MCVCMatrix * vertexMC).xyz;'],
  ['Fragment', '//VTK::Normal::Dec', 'varying vec3 vizPVSOutput;'],
  ['Fragment', '//VTK::Light::Impl', 'ownOut = vec4(diffuseColor, opacity);'],
];
// Points that stand for balls have the light of all lamps, and depths.
const MOST_OF_BALLS = 8;
const BALLS = [
  [...UNLIT[0].slice(0, 2), `${UNLIT[0][2]} flat out float ownNear;`],
  UNLIT[1],
  ['Vertex', '//STROKE', `
  ${NEARER}
  float radius = gl_PointSize * pixel;
  ownNear = 0.5 * ((gl_Position.z + slope * radius) / (gl_Position.w - focus * min(radius, 0.5 * gl_Position.w)) - gl_Position.z / gl_Position.w);`],
  ['Fragment', '//VTK::Normal::Dec', `varying vec3 vizPVSOutput; flat in float ownNear; uniform vec3 ownWays[${MOST_OF_BALLS}]; uniform vec3 ownGlows[${MOST_OF_BALLS}]; uniform vec2 ownBall; uniform float ownWide;`],
  ['Fragment', '//VTK::Light::Impl', `
  vec2 at = gl_PointCoord * 2.0 - 1.0; float size = length(at);
  if (size > 1.0) discard;
  vec3 normal = vec3(at.x, -at.y, sqrt(1.0 - size * size));
  vec3 lit = vec3(ownBall.x);
  for (int i = 0; i < ${MOST_OF_BALLS}; i++) lit += ownBall.y * max(0.0, dot(ownWays[i], normal)) * ownGlows[i];
  gl_FragDepth = gl_FragCoord.z + ownNear * normal.z;
  ownOut = vec4(diffuseColor * min(lit, vec3(1.0)), opacity * min(1.0, 0.5 * ownWide * (1.0 - size) + 0.3));`],
];
const SLOTS = { ownPlace: 0, ownColor: 2, vizNormalMC: 4, vizTangentMC: 6, ownGap: 8, ownShare: 9, ownLean: 11 };

class Program {
  constructor(gl, text, strokes, capsules) {
    const source = { Vertex: VERTEX, Fragment: FRAGMENT };
    // Put in by a function, as a $ in a text would stand for a part of what is replaced.
    text.forEach(([stage, mark, put]) => { source[stage] = source[stage].replace(mark, () => put); });
    // No eye turns the normals of closed surfaces, or those of a lean of 1; behind a cut their inner side is seen, and lit.
    const lines = /vec3 vizT\b/.test(source.Fragment);
    if (source.Fragment.includes('vizLean')) source.Fragment = source.Fragment.replace(/float vizLean = .*/, '$&\n  if (ownCut != vec4(0.0) && vizLean > 0.985) vizLean = 0.0;');
    else if (!lines && /vec3 vizN\b/.test(source.Fragment)) source.Fragment = source.Fragment.replace(/vec3 vizWo = .*/, '$&\n  if (ownCut != vec4(0.0) && dot(vizN, vizWo) < 0.0) vizN = -vizN;');
    // Both ends of a stroke are at hand in each of its corners; directions are whole numbers.
    let more = '';
    source.Vertex = source.Vertex.replace(/attribute (vec\d) (\w+);/g, (_, kind, name) => {
      const size = name.startsWith('viz') ? ` * ${name}Size` : '';
      const one = size ? `uniform float ${name}Size; ` : '';
      const end = strokes ? `(gl_VertexID > 1 ? ${name}B : ${name}A)` : `${name}A`;
      return `${one}in ${kind} ${name}A; ${strokes ? `in ${kind} ${name}B;` : ''}\n#define ${name} (${end}${size})\n`;
    });
    if (strokes) more = `${capsules ? CAPSULE_VERTEX : ''}in float ownGapA;\n#define ownGap ownGapA\nvoid main() {`;
    source.Vertex = source.Vertex.replace('//STROKE', () => (capsules ? CAPSULE : strokes ? STROKE : ''));
    if (capsules) source.Fragment = source.Fragment.replace('void main() {', () => `${CAPSULE_FRAGMENT}\nvoid main() {${CAPSULE_SHAPE}`).replace(/}\s*$/, () => CAPSULE_GROUND);
    if (more) source.Vertex = source.Vertex.replace('void main() {', more);
    this.gl = gl;
    this.program = gl.createProgram();
    ['Vertex', 'Fragment'].forEach((stage) => {
      const shader = gl.createShader(gl[`${stage.toUpperCase()}_SHADER`]);
      gl.shaderSource(shader, source[stage].replaceAll('gl_FragData[0]', 'ownOut'));
      gl.compileShader(shader);
      gl.attachShader(this.program, shader);
    });
    // All programs have their attributes at the same places, so that the buffers of a batch serve
    // each.
    Object.entries(SLOTS).forEach(([name, at]) => ['A', 'B'].forEach((end, i) => gl.bindAttribLocation(this.program, at + i, name + end)));
    gl.linkProgram(this.program);
    // One question at the end lets both shaders be compiled at once.
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error([gl.getProgramInfoLog(this.program), ...gl.getAttachedShaders(this.program).map((x) => gl.getShaderInfoLog(x))].join('\n'));
    this.uniforms = new Map();
  }

  use(numbers) {
    const { gl, uniforms } = this;
    gl.useProgram(this.program);
    Object.entries(numbers).forEach(([name, value]) => {
      if (!uniforms.has(name)) uniforms.set(name, gl.getUniformLocation(this.program, name));
      const at = uniforms.get(name);
      // A compiler drops what a text does not use.
      if (!at) return;
      if (value.length === 16) gl.uniformMatrix4fv(at, false, value);
      else if (value.length === 9) gl.uniformMatrix3fv(at, false, value);
      else gl[`uniform${value.length}fv`](at, value);
    });
  }
}

// What one call draws. `from` is the point (or, of colours, the cell) of each corner, null where the
// corners are the points themselves.
class Batch {
  constructor(gl, kind, count, order) {
    Object.assign(this, { gl, kind, count, order, state: gl.createVertexArray(), buffers: {} });
    if (order) {
      gl.bindVertexArray(this.state);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, order, gl.DYNAMIC_DRAW);
    }
  }

  put(name, values, width) {
    const { gl, buffers } = this;
    const at = SLOTS[name];
    const whole = !(values instanceof Float32Array);
    const type = { Float32Array: gl.FLOAT, Int16Array: gl.SHORT, Uint8Array: gl.UNSIGNED_BYTE }[values.constructor.name];
    const stride = width * values.BYTES_PER_ELEMENT;
    buffers[name] ??= gl.createBuffer();
    gl.bindVertexArray(this.state);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    // A stroke is an instance, one point of the buffer further on each time; its other end is the
    // same buffer one point later.
    (this.kind === 'strokes' && name !== 'ownGap' ? [0, 1] : [0]).forEach((end) => {
      gl.enableVertexAttribArray(at + end);
      // Colours in bytes become shares from 0 to 1; directions stay whole, and the program scales
      // them.
      gl.vertexAttribPointer(at + end, width, type, whole && /Color|Share|Lean/.test(name), stride, end * stride);
      gl.vertexAttribDivisor(at + end, this.kind === 'strokes' ? 1 : 0);
    });
  }

  // One colour for all.
  plain(color) {
    const { gl } = this;
    gl.bindVertexArray(this.state);
    [2, 3].forEach((at) => gl.disableVertexAttribArray(at));
    this.color = color;
  }

  // Farthest triangles first, so that what is translucent blends.
  sort(view, places) {
    const { gl, order } = this;
    const count = order.length / 3;
    const depths = new Float32Array(count);
    for (let k = 0; k < order.length; k += 1) {
      const i = 3 * order[k];
      // The sum orders triangles as the mean does, without the shift, which all have alike.
      depths[(k / 3) | 0] += view[2] * places[i] + view[6] * places[i + 1] + view[10] * places[i + 2];
    }
    const ranks = Uint32Array.from(depths, (_, t) => t).sort((a, b) => depths[a] - depths[b]);
    const sorted = new Uint32Array(order.length);
    ranks.forEach((from, to) => sorted.set(order.subarray(3 * from, 3 * from + 3), 3 * to));
    gl.bindVertexArray(this.state);
    gl.bufferSubData(gl.ELEMENT_ARRAY_BUFFER, 0, sorted);
  }

  draw() {
    const { gl } = this;
    gl.bindVertexArray(this.state);
    if (this.color) [2, 3].forEach((at) => gl.vertexAttrib4f(at, ...this.color));
    // One stroke from each point to the next, also between two cells, where the gap hides it.
    if (this.kind === 'strokes') gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count - 1);
    else if (this.order) gl.drawElements(gl.TRIANGLES, this.count, gl.UNSIGNED_INT, 0);
    else gl.drawArrays(this.kind === 'points' ? gl.POINTS : gl.TRIANGLES, 0, this.count);
  }
}

const MOST_SORTED = 3e5;

class Mesh {
  static async read(gl, given, texts) {
    const mesh = Object.assign(new Mesh(), { gl, given, texts, name: given.name, programs: new Map(), batches: [], edges: [], values: Object.create(null) });
    const keys = ['normals', 'tangents', 'colors', 'widths', 'leans', 'verts', 'lines', 'polys', 'strips'].filter((k) => given[k]);
    const found = Object.fromEntries(await Promise.all(keys.map(async (k) => [k, await unpack(given[k])])));
    mesh.places = await unpackPlaces(given.points);
    if (given.field) {
      const [columns, rows] = given.field.numbers.vizFieldSize;
      const heights = await unpackPlaces(given.field.heights);
      mesh.heights = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, mesh.heights);
      // Floats that are not filtered may be read everywhere.
      [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER].forEach((name) => gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST));
      gl.texStorage2D(gl.TEXTURE_2D, 1, gl.R32F, columns, rows);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, columns, rows, gl.RED, gl.FLOAT, heights);
    }
    mesh.capsules = Boolean(given.halo || given.widths);
    if (given.moving) mesh.moving = Object.fromEntries(await Promise.all(['phase', 'passing', 'grown'].map(async (k) => [k, await unpack(given.moving[k])])));
    await Promise.all(Object.entries(given.values || {}).map(async ([name, packed]) => { mesh.values[name] = await unpack(packed); }));
    // VTK's numbers: 0 for points, 1 for wires, 2 for faces.
    const style = given.representation;
    const dots = style === 0;
    [['lines', 'path', 'path'], ['polys', 'fan', 'ring'], ['strips', 'strip', 'path'], ['verts', 'path', 'path']].forEach(([key, full, thin]) => {
      if (!found[key]) return;
      const points = dots || key === 'verts';
      const strokes = !points && (key === 'lines' || style === 1);
      mesh.add(cornersOf(found[key], SHAPES[points || strokes ? (points ? 'path' : thin) : full]), points ? 'points' : strokes ? 'strokes' : 'surface', found);
      if (given.edgeColor && key !== 'lines' && key !== 'verts' && !strokes) mesh.add(cornersOf(found[key], SHAPES[thin]), 'strokes', {}, true);
    });
    if (!mesh.batches.length) {
      const every = Uint32Array.from({ length: mesh.places.length / 3 }, (_, i) => i);
      mesh.add({ ids: every, owners: every }, 'points', found);
    }
    mesh.own = found.colors;
    mesh.paint(mesh.own);
    return mesh;
  }

  add({ ids, owners }, kind, found, edge) {
    // Faces share points by their numbers, unless each has a colour of its own and so its own
    // corners.
    const apart = kind === 'surface' && !this.given.ofCells;
    const batch = new Batch(this.gl, kind, ids.length, apart ? ids : null);
    const from = apart || ids.every((x, i) => x === i) ? null : ids;
    batch.put('ownPlace', gathered(this.places, from, 3), 3);
    if (found.normals) batch.put('vizNormalMC', gathered(found.normals, from, 3), 3);
    if (found.tangents) batch.put('vizTangentMC', gathered(found.tangents, from, 3), 3);
    // All of the width where the points have none of their own.
    if (kind === 'strokes' && this.capsules && !edge) batch.put('ownShare', gathered(found.widths || new Uint8Array(this.places.length / 3).fill(255), from, 1), 1);
    // Strokes end where their surface turns away, and none behind its border stands out from it.
    if (kind === 'strokes' && found.leans) batch.put('ownLean', gathered(found.leans, from, 3), 3);
    if (kind === 'strokes') batch.put('ownGap', Uint8Array.from(owners, (cell, i) => Number(cell !== owners[i + 1])), 1);
    batch.points = from;
    batch.from = this.given.ofCells ? owners : from;
    if (edge) {
      batch.plain([...this.given.edgeColor, 1]);
      this.edges.push(batch);
    } else this.batches.push(batch);
  }

  // Colours of the points or cells; none for the colour of the material.
  paint(colors, data = Boolean(this.given.colored)) {
    this.data = Boolean(colors) && data;
    this.batches.forEach((batch) => {
      if (colors) {
        batch.color = null;
        batch.put('ownColor', gathered(colors, batch.from, 4), 4);
      } else batch.plain([...this.given.color, 1]);
    });
  }

  // Colours of an array, by a table of 256 colours from low to high.
  colorBy(name, range, [low, high], table) {
    const codes = this.values[name];
    const colors = new Uint8Array(codes.length * 4).fill(255);
    // Codes from 0 to 65534 span the range of the array; the last one stands for no value.
    const step = (range[1] - range[0]) / (NO_VALUE - 1);
    for (let i = 0; i < codes.length; i += 1) {
      const t = Math.floor((256 * (range[0] + codes[i] * step - low)) / (high - low || 1));
      const k = 3 * Math.max(0, Math.min(255, t));
      for (let c = 0; c < 3; c += 1) colors[4 * i + c] = codes[i] === NO_VALUE ? GREY : table[k + c];
    }
    this.paint(colors, true);
  }

  // Strokes that have moved for a share of their period; Python says the same of a movie.
  move(share) {
    const { phase, passing, grown } = this.moving;
    const { tail, neck, bare, head, base } = this.given.moving;
    const widths = Uint8Array.from(grown, (most, i) => {
      const at = (phase[i] / NO_VALUE - passing[i] * share) % 1;
      const here = at < 0 ? at + 1 : at;
      const place = (here - bare) / (1 - bare);
      // In the head from its base, 0, to its tip, 1.
      const ahead = (place - 1) / head + 1;
      const shaft = tail + ((neck - tail) * place) / (1 - head);
      const width = ahead > 0 ? 1 - ahead : shaft + (1 - shaft) * Math.max(0, 1 + ahead / base);
      return here < bare ? 0 : most * width;
    });
    this.batches.forEach((batch) => { if (batch.kind === 'strokes') batch.put('ownShare', gathered(widths, batch.points, 1), 1); });
  }

  program(key, strokes, capsules = strokes && this.capsules) {
    const name = `${key}${strokes}${capsules}`;
    const text = key === '' ? (this.given.ball && !strokes ? BALLS : UNLIT) : this.texts[this.given.texts[key]];
    if (!text) throw new Error(`no light for ${key}`);
    if (!this.programs.has(name)) this.programs.set(name, new Program(this.gl, text, strokes, capsules));
    return this.programs.get(name);
  }

  draw(numbers, key, view, sorted, ratio) {
    const { given } = this;
    const sizes = { vizNormalMCSize: [given.normals?.scale || 1], vizTangentMCSize: [given.tangents?.scale || 1] };
    const { gl } = this;
    // Faces are moved back by a little, or they would hide parts of the lines on them.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(2, 2);
    const sides = (side) => {
      (side ? gl.enable : gl.disable).call(gl, gl.CULL_FACE);
      gl.cullFace(side > 0 ? gl.FRONT : gl.BACK);
    };
    sides(given.culled);
    if (this.heights) gl.bindTexture(gl.TEXTURE_2D, this.heights);
    // Pixels at the border of a stroke or a ball are covered in part.
    ((this.capsules || given.ball) && given.opacity >= 1 ? gl.enable : gl.disable).call(gl, gl.SAMPLE_ALPHA_TO_COVERAGE);
    const all = { ...numbers, ...given.numbers, ...sizes, ownOpacity: [given.opacity] };
    this.batches.forEach((batch) => {
      const wide = (batch.kind === 'points' ? given.pointSize * (given.ball ? numbers.ownNearer : 1) : given.lineWidth) * ratio;
      this.program(given.live ? `${this.data ? 'data ' : ''}${key}` : '', batch.kind === 'strokes').use({ ...all, ownWide: [wide], ownHalo: [wide * (given.halo || 0)], ownDepth: [given.depth || 0], ownDarker: [this.data ? 0 : 0.6] });
      if (sorted && batch.order && batch.count < 3 * MOST_SORTED) batch.sort(view, this.places);
      if (batch.kind !== 'surface' || given.culled || given.opacity < 1) {
        batch.draw();
        return;
      }
      // Where a surface turns away both of its sides have one depth: the far one is moved back.
      sides(-1);
      batch.draw();
      sides(1);
      gl.polygonOffset(4, 16);
      batch.draw();
      gl.polygonOffset(2, 2);
      sides(0);
    });
    sides(0);
    if (!this.edges.length) return;
    this.program('', true, false).use({ ...all, ownWide: [ratio] });
    this.edges.forEach((batch) => batch.draw());
  }
}

// Half a ball seen along z, wound with lines about y; a disc of lines from its centre, across the view;
// half a ball of near ends of lines; a bar of lines from across the view to the eye. The surface of
// lines faces the eye as far as it can.
const FORMS = ['ball', 'disc', 'hemisphere', 'bar'];
const HOLE = 0.3; // inner radius of the disc
function keyOf(gl, form) {
  const [rows, columns] = [24, 64];
  const [places, normals, tangents, ids] = [[], [], [], []];
  const facing = (v) => (v[2] > 0.9999 ? [0, 1, 0] : unit(minus([0, 0, 1], scaled(v, v[2]))));
  for (let r = 0; r <= rows; r += 1) {
    for (let c = 0; c <= columns; c += 1) {
      const round = (c / columns) * 2 * Math.PI;
      const sine = form === 'disc' ? HOLE + (1 - HOLE) * (r / rows) : Math.sin((r / rows) * (Math.PI / 2));
      const v = [sine * Math.cos(round), sine * Math.sin(round), Math.sqrt(1 - sine ** 2)];
      const line = { ball: unit(cross([0, 1, 0], v)), disc: unit([v[0], v[1], 0]), hemisphere: v, bar: [Math.cos(round / 4), 0, Math.sin(round / 4)] }[form];
      places.push(...(form === 'bar' ? [(2 * c) / columns - 1, (2 * r) / rows - 1, 0] : v));
      // A normal of the length 2 is not turned to the eye.
      normals.push(...scaled(form === 'ball' ? v : facing(line), 2));
      tangents.push(...line);
      const here = r * (columns + 1) + c;
      if (r < rows && c < columns) ids.push(here, here + 1, here + columns + 2, here, here + columns + 2, here + columns + 1);
    }
  }
  const batch = new Batch(gl, 'surface', ids.length, Uint32Array.from(ids));
  batch.put('ownPlace', Float32Array.from(places), 3);
  batch.put('vizNormalMC', Float32Array.from(normals), 3);
  batch.put('vizTangentMC', Float32Array.from(tangents), 3);
  batch.plain([1, 1, 1, 1]);
  return batch;
}
