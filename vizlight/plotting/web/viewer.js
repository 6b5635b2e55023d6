// The viewer of vizlight.live_html: vtk.js draws, and the light of each fragment follows the eye.
// The text of the shaders and the numbers they are given come from Python, with the page.
import '@kitware/vtk.js/Rendering/OpenGL/Actor';
import '@kitware/vtk.js/Rendering/OpenGL/Camera';
import '@kitware/vtk.js/Rendering/OpenGL/PolyDataMapper';
import '@kitware/vtk.js/Rendering/OpenGL/Renderer';
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor';
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkInteractorStyleTrackballCamera from '@kitware/vtk.js/Interaction/Style/InteractorStyleTrackballCamera';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import vtkOpenGLRenderWindow from '@kitware/vtk.js/Rendering/OpenGL/RenderWindow';
import vtkPolyData from '@kitware/vtk.js/Common/DataModel/PolyData';
import vtkRenderWindow from '@kitware/vtk.js/Rendering/Core/RenderWindow';
import vtkRenderWindowInteractor from '@kitware/vtk.js/Rendering/Core/RenderWindowInteractor';
import vtkRenderer from '@kitware/vtk.js/Rendering/Core/Renderer';
import { unzlibSync } from 'fflate';
import { buildPanel, buildScalarBars } from './panel.js';

// What stands for a coordinate that is not a number.
const NOT_FINITE = -(2 ** 31);
const KINDS = { i2: Int16Array, i4: Int32Array, u1: Uint8Array, u4: Uint32Array };

// Numbers of several bytes come as differences from row to row (order 1) or as those of the
// differences (order 2), with the sign in the last bit, bytes of equal rank together.
function rowsOf(bytes, size, columns, order) {
  const count = bytes.length / size;
  const rows = count / columns;
  const found = new (size === 4 ? Uint32Array : Uint16Array)(count);
  for (let c = 0; c < columns; c += 1) {
    let step = 0;
    let value = 0;
    for (let r = 0; r < rows; r += 1) {
      let folded = 0;
      for (let b = 0; b < size; b += 1) folded |= bytes[b * count + c * rows + r] << (8 * b);
      const change = (folded >>> 1) ^ -(folded & 1);
      step = order === 2 ? step + change : change;
      value = (value + step) | 0;
      found[r * columns + c] = value;
    }
  }
  return found.buffer;
}

function unpack({ data, kind, columns, order, scale }) {
  const text = atob(data);
  const packed = Uint8Array.from(text, (c) => c.charCodeAt(0));
  const bytes = unzlibSync(packed);
  const values = columns ? new KINDS[kind](rowsOf(bytes, KINDS[kind].BYTES_PER_ELEMENT, columns, order)) : bytes;
  return scale ? Float32Array.from(values, (x) => (x === NOT_FINITE ? NaN : x * scale)) : values;
}

function array(name, packed, numberOfComponents) {
  return vtkDataArray.newInstance({ name, values: unpack(packed), numberOfComponents });
}

// Directions and positions of the world in the coordinates of a camera, whose matrix has rows.
const turn = (m, v) => [0, 4, 8].map((r) => m[r] * v[0] + m[r + 1] * v[1] + m[r + 2] * v[2]);
const move = (m, v) => turn(m, v).map((x, i) => x + m[4 * i + 3]);
function unit(v) {
  const size = Math.hypot(...v) || 1;
  return v.map((x) => x / size);
}

function numbersOfLights(lights, matrix) {
  const found = {};
  lights.forEach((light, i) => {
    const { value, position, eye } = light;
    if (eye) found[`vizLight${i}`] = position ? value : unit(value);
    else found[`vizLight${i}`] = position ? move(matrix, value) : unit(turn(matrix, value));
    if (position) found[`vizFade${i}`] = light.attenuation;
    found[`vizColor${i}`] = light.color.map((c) => c * light.intensity);
  });
  return found;
}

// Nearest and farthest depth of the points, where the ends of a depth cue are not given.
function depthRange(points, matrix, alongAxis) {
  let near = Infinity;
  let far = -Infinity;
  for (let i = 0; i < points.length; i += 3) {
    const p = move(matrix, points.subarray(i, i + 3));
    const depth = alongAxis ? -p[2] : Math.hypot(...p);
    if (depth < near) near = depth;
    if (depth > far) far = depth;
  }
  return near <= far ? [near, far] : [0, 1];
}

function endsOfCue(cue, points, matrix) {
  let { front, back } = cue;
  if (front === null || back === null) {
    const [near, far] = depthRange(points, matrix, true);
    if (front === null) front = back === null || near < back ? near : back - 1;
    if (back === null) back = far > front ? far : front + 1;
  }
  return [front, back, cue.scales[0], cue.scales[1]];
}

class Mesh {
  constructor(given, lightSets) {
    this.given = given;
    this.name = given.name;
    this.lights = given.live ? lightSets[given.lights] : [];
    this.material = given.live ? given.material : null;
    this.points = unpack(given.points);
    const poly = vtkPolyData.newInstance();
    poly.getPoints().setData(this.points, 3);
    if (given.verts) poly.getVerts().setData(unpack(given.verts));
    if (given.lines) poly.getLines().setData(unpack(given.lines));
    if (given.polys) poly.getPolys().setData(unpack(given.polys));
    if (given.strips) poly.getStrips().setData(unpack(given.strips));
    const mapper = vtkMapper.newInstance();
    this.mapper = mapper;
    if (given.colors) {
      const data = given.ofCells ? poly.getCellData() : poly.getPointData();
      data.setScalars(array('colors', given.colors, 4));
      mapper.setColorModeToDirectScalars();
      if (given.ofCells) mapper.setScalarModeToUseCellData();
      else mapper.setScalarModeToUsePointData();
    } else mapper.setScalarVisibility(false);
    const attributes = [];
    ['normals', 'tangents'].forEach((key) => {
      if (!given[key]) return;
      const name = key === 'normals' ? 'vizNormal' : 'vizTangent';
      poly.getPointData().addArray(array(name, given[key], 3));
      attributes.push(name);
    });
    mapper.setCustomShaderAttributes(attributes);
    mapper.setInputData(poly);
    this.actor = vtkActor.newInstance();
    this.actor.setMapper(mapper);
    const look = this.actor.getProperty();
    look.setLighting(false);
    look.setAmbient(1);
    look.setDiffuse(0);
    look.setColor(...given.color);
    look.setOpacity(given.opacity);
    look.setLineWidth(given.lineWidth);
    look.setPointSize(given.pointSize);
    look.setRepresentation(given.representation);
    if (given.live) this.followEye();
  }

  followEye() {
    const specific = this.mapper.getViewSpecificProperties();
    specific.OpenGL = {
      ShaderReplacements: this.given.shader.map(([shaderType, originalValue, replacementValue]) => ({
        shaderType, originalValue, replacementValue, replaceFirst: true, replaceAll: false,
      })),
    };
    specific.ShadersCallbacks = [
      { callback: (_, cells, renderer) => this.setNumbers(cells.getProgram(), renderer.getActiveCamera()) },
    ];
  }

  setNumbers(program, camera) {
    const { given, material } = this;
    const matrix = camera.getViewMatrix();
    const numbers = {
      ...given.numbers,
      ...numbersOfLights(this.lights, matrix),
      vizEye: camera.getParallelProjection() ? [0, 0, 1, 0] : [0, 0, 0, 1],
      vizAmbientGain: given.ambientColor.map((c) => c * material.ambient),
      vizDiffuseGain: [material.diffuse],
      vizSpecularGain: given.specularColor.map((c) => c * material.specular),
      vizShininess: [material.shininess],
    };
    if (given.cue) {
      numbers.vizAxis = [0, 0, 1, 0];
      numbers.vizFrom = [0, 0, 0];
      numbers.vizCueEnds = endsOfCue(given.cue, this.points, matrix);
    }
    Object.entries(numbers).forEach(([name, value]) => {
      if (!program.isUniformUsed(name)) return;
      if (value.length === 1) program.setUniformf(name, value[0]);
      else if (value.length === 3) program.setUniform3f(name, ...value);
      else program.setUniform4f(name, ...value);
    });
  }
}

function setCamera(camera, { position, focal, up, angle, parallel, scale }) {
  camera.setPosition(...position);
  camera.setFocalPoint(...focal);
  camera.setViewUp(...up);
  camera.setViewAngle(angle);
  camera.setParallelProjection(parallel);
  camera.setParallelScale(scale);
}

function notice(text) {
  const line = document.createElement('p');
  line.setAttribute('role', 'alert');
  line.className = 'notice';
  line.textContent = text;
  document.getElementById('bottom').append(line);
}

// Arrow keys turn the camera, plus and minus move it; a canvas alone is closed to the keyboard.
function bindKeys(element, app) {
  const step = 5;
  const moves = {
    ArrowLeft: (camera) => camera.azimuth(step),
    ArrowRight: (camera) => camera.azimuth(-step),
    ArrowUp: (camera) => camera.elevation(-step),
    ArrowDown: (camera) => camera.elevation(step),
    '+': (camera) => camera.zoomOrDolly(1.1),
    '-': (camera) => camera.zoomOrDolly(1 / 1.1),
  };
  element.addEventListener('keydown', (event) => {
    const act = moves[event.key === '=' ? '+' : event.key];
    if (!act) return;
    event.preventDefault();
    const { camera } = app;
    const closer = {
      zoomOrDolly: (f) => (camera.getParallelProjection()
        ? camera.setParallelScale(camera.getParallelScale() / f) : camera.dolly(f)),
    };
    act({ azimuth: camera.azimuth, elevation: camera.elevation, ...closer });
    camera.orthogonalizeViewUp();
    app.render();
  });
}

function start() {
  const page = JSON.parse(document.getElementById('scene').textContent);
  const view = document.getElementById('view');
  if (!document.createElement('canvas').getContext('webgl2')) {
    document.querySelector('details').remove();
    notice('This page needs WebGL 2 to draw, which this browser does not have or has switched off.');
    return;
  }
  const renderer = vtkRenderer.newInstance({ background: page.background });
  const renderWindow = vtkRenderWindow.newInstance();
  renderWindow.addRenderer(renderer);
  const canvas = vtkOpenGLRenderWindow.newInstance();
  renderWindow.addView(canvas);
  canvas.setContainer(view);
  const interactor = vtkRenderWindowInteractor.newInstance();
  interactor.setInteractorStyle(vtkInteractorStyleTrackballCamera.newInstance());
  interactor.setView(canvas);
  interactor.initialize();
  interactor.bindEvents(view);
  const camera = renderer.getActiveCamera();
  const lightSets = structuredClone(page.lights);
  const meshes = page.meshes.map((given) => new Mesh(structuredClone(given), lightSets));
  meshes.forEach((mesh) => renderer.addActor(mesh.actor));
  const app = {
    page, meshes, lightSets, renderer, camera, canvas,
    render() {
      renderer.resetCameraClippingRange();
      renderWindow.render();
    },
    resetView() {
      setCamera(camera, page.camera);
      app.render();
    },
    resetLight() {
      lightSets.forEach((set, i) => set.forEach((light, j) => Object.assign(light, structuredClone(page.lights[i][j]))));
      meshes.forEach((mesh, i) => Object.assign(mesh.material || {}, page.meshes[i].material));
      app.render();
    },
  };
  function resize() {
    const { width, height } = view.getBoundingClientRect();
    const ratio = window.devicePixelRatio || 1;
    // In an upright window the angle of view is that from side to side.
    camera.setUseHorizontalViewAngle(height > width);
    canvas.setSize(Math.max(1, Math.floor(width * ratio)), Math.max(1, Math.floor(height * ratio)));
    app.render();
  }
  setCamera(camera, page.camera);
  buildPanel(app);
  buildScalarBars(page.bars);
  bindKeys(view, app);
  page.notices.forEach(notice);
  new ResizeObserver(resize).observe(view);
  resize();
  window.vizlight = app;
}

try {
  start();
} catch (error) {
  notice(`The scene cannot be shown: ${error.message}`);
  throw error;
}
