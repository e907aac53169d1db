// The page of plotting.view. It draws a run with three.js: `run` is what mjrock/plotting/browser.py has written.
//
// All blocks are one mesh, and all lines of a kind are instances of one quadrilateral. A vertex knows the number of its
// body, and its shader reads the pose of that body from a small texture. A frame therefore costs the script one
// interpolation of the poses and one upload of the texture, however many blocks there are.

const run = JSON.parse(document.getElementById('run').textContent);
const byId = id => document.getElementById(id);
const all = selector => [...document.querySelectorAll(selector)];
const canvas = byId('canvas');
const NARROW = (24 * Math.PI) / 180; // vertical angle of the camera
const WIDE = 1024; // texels in a row of the texture of poses
const NIGHT = matchMedia('(prefers-color-scheme: dark)'),
  dark = NIGHT.matches;
const INK = '#2b1a14',
  FAINT = dark ? '#6d6058' : '#a08f86',
  GREY = dark ? '#77716a' : '#c9c5bd',
  FLOOR = dark ? '#4a4641' : '#e4e0d7',
  PICKED = '#ffd24a';
const EDGE = 1.3; // width of edges in pixels
const KINDS = {ties: [dark ? '#7db8f0' : '#1f5f9e', 3], cracks: ['#d1261a', 3.5], forces: ['#b5462f', 3.5]}; // colour and width in pixels
const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2];
const LENGTHS = [1, 2, 5, 10, 20]; // of the bars of forces
const LINES_OF_TRACK = dark ? ['#8fbfee', '#f0a070', '#86cf9d'] : ['#12406b', '#b04a10', '#2f7d4b'];

// ---------------------------------------------------------------------------------------------- numbers of the run

// Numbers that Python has packed: second differences of whole multiples of a step, row by row, folded so that small ones
// of either sign have three bytes of zero; the lowest bytes of all stand first. Returns them sample by sample.
async function unpacked({rows, step, data}) {
  const bytes = Uint8Array.from(atob(data), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const count = planes.length / 4,
    samples = count / rows,
    values = new Float32Array(count);
  for (let row = 0, i = 0; row < rows; row++) {
    for (let sample = 0, rate = 0, value = 0; sample < samples; sample++, i++) {
      const folded =
        planes[i] | (planes[i + count] << 8) | (planes[i + 2 * count] << 16) | (planes[i + 3 * count] << 24);
      rate = (rate + ((folded >>> 1) ^ -(folded & 1))) | 0;
      value = (value + rate) | 0;
      values[sample * rows + row] = value * step;
    }
  }
  return values;
}

// The sample before a time, and how far the time lies between it and the next one, 0 to 1.
function sampleAt(time) {
  let low = 0,
    high = run.t.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (run.t[middle] <= time) low = middle;
    else high = middle;
  }
  const share = high > low ? (time - run.t[low]) / (run.t[high] - run.t[low]) : 0;
  return [low, high, Math.min(1, Math.max(0, share))];
}

// Write the poses of all bodies at a time: x, y, z and 1 where the body is shown, then the quaternion with w last.
function setPoses(poses, motion, time) {
  const [low, high, share] = sampleAt(time),
    {places, turns} = motion,
    count = run.moving.length;
  for (let k = 0; k < count; k++) {
    const at = 8 * run.moving[k],
      rest = run.bodies[run.moving[k]].rest;
    const p = 3 * (low * count + k),
      q = 3 * (high * count + k),
      a = 4 * (low * count + k),
      b = 4 * (high * count + k);
    for (let i = 0; i < 3; i++) poses[at + i] = rest[i] + places[p + i] + share * (places[q + i] - places[p + i]);
    let size = 0;
    for (let i = 0; i < 4; i++) {
      const part = turns[a + i] + share * (turns[b + i] - turns[a + i]);
      poses[at + 4 + ((i + 3) % 4)] = part; // Python has w first
      size += part * part;
    }
    size = 1 / Math.sqrt(size);
    for (let i = 4; i < 8; i++) poses[at + i] *= size;
  }
}

// ------------------------------------------------------------------------------------------------- what is drawn

const POSED = `
  uniform highp sampler2D poses;
  vec3 turned(vec3 v, vec4 q) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
  vec4 texel(float body, int part) { int i = 2 * int(body) + part; return texelFetch(poses, ivec2(i % ${WIDE}, i / ${WIDE}), 0); }
  vec3 placed(vec3 local, float body) {
    if (body < 0.0) return local;
    vec4 at = texel(body, 0);
    return at.xyz + at.w * turned(local, texel(body, 1));
  }`;

// Let the vertices of a material of three.js stand where their body is.
function follow(material, uniforms) {
  material.onBeforeCompile = shader => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace(
        '#include <common>',
        `#include <common>\nattribute float body; uniform float picked; uniform vec3 mark;${POSED}`,
      )
      .replace(
        '#include <color_vertex>',
        '#include <color_vertex>\nif (body == picked) vColor.rgb = mix(vColor.rgb, mark, 0.75);',
      )
      .replace('#include <beginnormal_vertex>', 'vec3 objectNormal = turned(normal, texel(body, 1));')
      .replace('#include <begin_vertex>', 'vec3 transformed = placed(position, body);');
  };
  return material;
}

// The mesh of the bodies that are fixed, or of those that are not.
function meshOfBodies(fixed, uniforms) {
  const at = [],
    normals = [],
    colours = [],
    numbers = [];
  const [a, b, c] = [0, 1, 2].map(() => new THREE.Vector3()),
    colour = new THREE.Color();
  run.bodies.forEach((body, number) => {
    if ((body.colour === null) !== fixed) return;
    const {corners, faces} = run.shapes[body.shape];
    if (fixed) colour.set(run.ground && body.kind === 'ground' ? FLOOR : GREY);
    else colour.setRGB(...body.colour, THREE.SRGBColorSpace);
    for (const face of faces) {
      for (let i = 1; i + 1 < face.length; i++) {
        const triangle = [face[0], face[i], face[i + 1]].map(corner => corners[corner]);
        a.fromArray(triangle[0]);
        const normal = b.fromArray(triangle[1]).sub(a).cross(c.fromArray(triangle[2]).sub(a)).normalize();
        for (const corner of triangle) {
          at.push(...corner);
          normals.push(normal.x, normal.y, normal.z);
          colours.push(colour.r, colour.g, colour.b);
          numbers.push(number);
        }
      }
    }
  });
  const geometry = new THREE.BufferGeometry();
  const add = (name, values, size) =>
    geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(values), size));
  add('position', at, 3);
  add('normal', normals, 3);
  add('color', colours, 3);
  add('body', numbers, 1);
  const mesh = new THREE.Mesh(geometry, follow(new THREE.MeshLambertMaterial({vertexColors: true}), uniforms));
  // blocks lie on what is fixed, face on face: of the two the block is in front
  Object.assign(mesh.material, {polygonOffset: fixed, polygonOffsetFactor: 1, polygonOffsetUnits: 1});
  mesh.customDepthMaterial = follow(new THREE.MeshDepthMaterial({depthPacking: THREE.RGBADepthPacking}), uniforms);
  mesh.castShadow = mesh.receiveShadow = true;
  mesh.frustumCulled = false;
  return mesh;
}

const LINE = {
  vertexShader: `
    attribute vec2 corner, bodies, life;
    attribute vec3 start, end;
    uniform vec2 size;
    uniform float time, width;
    ${POSED}
    void main() {
      vec4 a = viewMatrix * vec4(placed(start, bodies.x), 1.0), b = viewMatrix * vec4(placed(end, bodies.y), 1.0);
      a.xyz *= 0.9995; b.xyz *= 0.9995; // towards the eye, in front of the faces that meet at the line
      vec4 from = projectionMatrix * a, to = projectionMatrix * b;
      vec2 along = (to.xy / to.w - from.xy / from.w) * size;
      float far = length(along);
      bool gone = time < life.x || time >= life.y || far < 1e-4 || from.w <= 0.0 || to.w <= 0.0;
      gl_Position = corner.x < 0.5 ? from : to;
      gl_Position.xy += corner.y * width * vec2(-along.y, along.x) / max(far, 1e-4) / size * gl_Position.w;
      if (gone) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }`,
  fragmentShader: `
    uniform vec3 colour;
    #include <common>
    void main() {
      gl_FragColor = vec4(colour, 1.0);
      #include <colorspace_fragment>
    }`,
};

// Lines of one colour and width. Each has two ends, {start, end, bodies: [number, number], life: [from, until]}.
function meshOfLines(lines, [colour, width], uniforms) {
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(12), 3));
  geometry.setAttribute('corner', new THREE.BufferAttribute(new Float32Array([0, -1, 1, -1, 1, 1, 0, 1]), 2));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  for (const [name, size] of [
    ['start', 3],
    ['end', 3],
    ['bodies', 2],
    ['life', 2],
  ]) {
    const values = new Float32Array(lines.flatMap(line => line[name]));
    geometry.setAttribute(name, new THREE.InstancedBufferAttribute(values, size));
  }
  geometry.instanceCount = lines.length;
  const own = {...uniforms, colour: {value: new THREE.Color(colour)}, width: {value: width}};
  const mesh = new THREE.Mesh(geometry, new THREE.ShaderMaterial({...LINE, uniforms: own, side: THREE.DoubleSide}));
  mesh.frustumCulled = false;
  return mesh;
}

// The ground: a disc that fades out beyond all that lies on it.
function meshOfGround({level, middle, radius}) {
  const at = [],
    colours = [],
    index = [],
    parts = 96,
    tone = new THREE.Color(FLOOR);
  for (const [share, alpha] of [
    [0, 1],
    [1, 1],
    [1.6, 0],
  ]) {
    for (let i = 0; i < parts; i++) {
      const angle = (2 * Math.PI * i) / parts;
      at.push(middle[0] + share * radius * Math.cos(angle), middle[1] + share * radius * Math.sin(angle), level);
      colours.push(tone.r, tone.g, tone.b, alpha);
    }
  }
  for (let ring = 0; ring < 2; ring++) {
    for (let i = 0; i < parts; i++) {
      const [a, b] = [ring * parts + i, ring * parts + ((i + 1) % parts)];
      index.push(a, a + parts, b + parts, a, b + parts, b);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(at), 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(colours), 4));
  geometry.setIndex(index);
  geometry.computeVertexNormals();
  const mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({vertexColors: true, transparent: true}));
  mesh.receiveShadow = true;
  mesh.renderOrder = -1; // before blocks that are seen through
  return mesh;
}

// Light from all sides, and a sun whose shadows cover the box of what is looked at.
function addLight(scene) {
  scene.add(new THREE.HemisphereLight('#ffffff', '#b9b0a4', 1.9));
  const sun = new THREE.DirectionalLight('#fff4e2', 2.3),
    middle = middleOfBox();
  const reach = 1.1 * new THREE.Vector3().fromArray(run.box[1]).distanceTo(new THREE.Vector3().fromArray(run.box[0]));
  sun.position.copy(middle).addScaledVector(new THREE.Vector3(-0.55, -0.75, 1.15).normalize(), 2 * reach);
  sun.target.position.copy(middle);
  sun.castShadow = true;
  Object.assign(sun.shadow.camera, {
    left: -reach,
    right: reach,
    bottom: -reach,
    top: reach,
    near: 0.5 * reach,
    far: 4 * reach,
  });
  sun.shadow.mapSize.set(2048, 2048);
  sun.shadow.normalBias = reach / 1024;
  sun.shadow.bias = -1e-4;
  scene.add(sun, sun.target);
}

// The bars of forces at a time: each lies along the force of a joint, and is as long as the force is large.
function setBars(mesh, {places, shares}, time, longest) {
  const [low, high, share] = sampleAt(time),
    count = 3 * run.forces.joints.length,
    {most} = run.forces;
  const {start, end} = mesh.geometry.attributes,
    between = (values, i) => {
      const before = values[low * count + i];
      return before + share * (values[high * count + i] - before);
    };
  for (let i = 0; i < count; i += 3) {
    const x = between(shares, i),
      y = between(shares, i + 1),
      z = between(shares, i + 2);
    const half = 0.5 * longest * Math.min(1, most / Math.max(Math.sqrt(x * x + y * y + z * z), 1e-9));
    for (let k = 0; k < 3; k++) {
      const at = between(places, i + k),
        off = half * (k === 0 ? x : k === 1 ? y : z);
      start.array[i + k] = at - off;
      end.array[i + k] = at + off;
    }
  }
  start.needsUpdate = end.needsUpdate = true;
}

// ------------------------------------------------------------------------------------------------------- the camera

const middleOfBox = () =>
  new THREE.Vector3().fromArray(run.box[0]).add(new THREE.Vector3().fromArray(run.box[1])).multiplyScalar(0.5);

// Put the camera where it sees the whole box, whatever the shape of the window.
function fitCamera(camera, controls) {
  const [low, high] = run.box,
    middle = middleOfBox(),
    eye = new THREE.Vector3(...run.camera).normalize();
  const right = new THREE.Vector3(0, 0, 1).cross(eye).normalize(),
    up = eye.clone().cross(right);
  const tall = Math.tan(NARROW / 2) * 0.86,
    wide = tall * camera.aspect,
    corner = new THREE.Vector3();
  let distance = 0;
  for (let i = 0; i < 8; i++) {
    corner.set(...[0, 1, 2].map(k => ((i >> k) & 1 ? high : low)[k])).sub(middle);
    const across = Math.max(Math.abs(corner.dot(right)) / wide, Math.abs(corner.dot(up)) / tall);
    distance = Math.max(distance, across + corner.dot(eye));
  }
  camera.position.copy(middle).addScaledVector(eye, distance);
  controls.target.copy(middle);
  controls.update();
}

// The longest of 1, 2 and 5 times a power of ten that is not longer than a length.
function roundBelow(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return power * [5, 2, 1].find(factor => factor * power <= most * (1 + 1e-9));
}

const PREFIXES = [
  [1e6, 'M'],
  [1e3, 'k'],
  [1, ''],
];
// A value with its unit, to so many digits.
function shown(value, unit, digits = 3) {
  const [factor, prefix] = unit === 'N' ? (PREFIXES.find(([least]) => Math.abs(value) >= least) ?? [1, '']) : [1, ''];
  return `${+(value / factor).toPrecision(digits)} ${prefix}${unit}`;
}

// A number with so many decimals, and no minus before a zero.
const plain = (value, places) => value.toFixed(places).replace(/^-(0(\.0*)?)$/, '$1');

// A length in mm, or in m from one metre on, to three digits, as text.
function lengthOf(metres) {
  const size = Math.abs(metres);
  return size < 1 ? `${plain(1e3 * metres, size < 1e-2 ? 3 : size < 1e-1 ? 2 : 1)} mm` : `${plain(metres, 2)} m`;
}

// ----------------------------------------------------------------------------------------------------------- picking

// The number of the nearest body that a ray meets, or -1.
function bodyOnRay(ray, poses) {
  const turn = new THREE.Quaternion(),
    local = new THREE.Ray(),
    point = new THREE.Vector3(),
    [a, b, c] = [0, 1, 2].map(() => new THREE.Vector3());
  let nearest = Infinity,
    found = -1;
  run.bodies.forEach((body, number) => {
    const pose = poses.subarray(8 * number, 8 * number + 8),
      {corners, faces} = run.shapes[body.shape];
    if (!pose[3]) return;
    turn.set(pose[4], pose[5], pose[6], pose[7]).invert();
    local.origin
      .copy(ray.origin)
      .sub(point.set(pose[0], pose[1], pose[2]))
      .applyQuaternion(turn);
    local.direction.copy(ray.direction).applyQuaternion(turn);
    for (const face of faces) {
      for (let i = 1; i + 1 < face.length; i++) {
        [a, b, c].forEach((v, k) => v.fromArray(corners[[face[0], face[i], face[i + 1]][k]]));
        if (!local.intersectTriangle(a, b, c, true, point)) continue;
        const far = point.distanceTo(local.origin);
        if (far < nearest) [nearest, found] = [far, number];
      }
    }
  });
  return found;
}

const MOST_ROWS = 6; // of forces on the card of a body

// The forces of the joints of a body at the sample nearest to a time, the largest first: [name of the other body, N].
function forcesOn(number, {shares}, time) {
  const [low, high, share] = sampleAt(time);
  const start = 3 * run.forces.joints.length * (share < 0.5 ? low : high);
  const found = [];
  run.forces.joints.forEach(([, below, above], joint) => {
    if (below !== number && above !== number) return;
    const at = start + 3 * joint;
    const size = Math.hypot(...shares.subarray(at, at + 3));
    if (size > 1e-3) found.push([run.bodies[below === number ? above : below].name, size * run.forces.scale]);
  });
  return found.sort((one, other) => other[1] - one[1]);
}

// Rows of the card of a body: what is known of it at a time.
function rowsOf(number, poses, forces, time) {
  const body = run.bodies[number];
  const pose = poses.subarray(8 * number, 8 * number + 8);
  const rows = [];
  if (body.mass !== null) rows.push(['mass', shown(body.mass, 'kg', 4)]);
  if (body.colour === null) rows.push(['fixed', run.moving.includes(number) ? 'moved as a support' : 'yes']);
  if (run.moving.includes(number)) {
    const off = [0, 1, 2].map(i => pose[i] - body.rest[i]);
    rows.push(['displacement', lengthOf(Math.hypot(...off))]);
    rows.push(['along x, y, z', off.map(lengthOf).join(', ')]);
    const angle = (2 * Math.atan2(Math.hypot(pose[4], pose[5], pose[6]), Math.abs(pose[7])) * 180) / Math.PI;
    rows.push(['turned by', `${angle < 5e-5 ? 0 : angle.toPrecision(3)} degrees`]);
  }
  if (forces) {
    const found = forcesOn(number, forces, time);
    for (const [name, force] of found.slice(0, MOST_ROWS)) rows.push([`force with ${name}`, shown(force, 'N')]);
    if (found.length > MOST_ROWS) rows.push(['', `and at ${found.length - MOST_ROWS} joints more`]);
  }
  return rows;
}

// ----------------------------------------------------------------------------------------------------------- the page

const make = (tag, properties = {}, ...children) => {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
};

// Draw what the ground does below the slider.
function drawTrack() {
  const svg = byId('ground-motion'),
    space = 'http://www.w3.org/2000/svg';
  const add = (tag, attributes) => {
    const element = svg.appendChild(document.createElementNS(space, tag));
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return element;
  };
  run.track.forEach(({values}, number) => {
    const points = values.map((value, i) => `${((1000 * i) / (values.length - 1)).toFixed(1)},${-value}`).join(' ');
    add('polyline', {points, stroke: LINES_OF_TRACK[number % LINES_OF_TRACK.length]});
  });
  run.track.forEach(({name, peak, unit}, number) => {
    const text = make('span', {textContent: `${name}, up to ${shown(peak, unit)}`});
    text.style.color = LINES_OF_TRACK[number % LINES_OF_TRACK.length];
    byId('caption').append(number ? '; ' : '', text);
  });
  for (const element of [svg, byId('caption')]) element.toggleAttribute('hidden', !run.track.length);
  return run.track.length ? add('line', {x1: 0, x2: 0, y1: -1.05, y2: 1.05}) : null;
}

// All that the page does, about the time that it shows.
class View {
  constructor(motion, forces) {
    Object.assign(this, {
      motion,
      forces,
      first: run.t[0],
      last: run.t.at(-1),
      speed: 1,
      playing: false,
      moved: false,
      number: -1,
    });
    this.time = this.first;
    this.frames = 0; // drawn
    this.cost = []; // time of script of the last frames [ms]
    const rows = Math.ceil((2 * run.bodies.length) / WIDE);
    this.poses = new Float32Array(4 * WIDE * rows);
    run.bodies.forEach((body, i) => this.poses.set([...body.rest, 1, 0, 0, 0, 1], 8 * i));
    this.texture = new THREE.DataTexture(this.poses, WIDE, rows, THREE.RGBAFormat, THREE.FloatType);
    this.uniforms = {
      poses: {value: this.texture},
      picked: {value: -1},
      mark: {value: new THREE.Color(PICKED)},
      time: {value: 0},
      size: {value: new THREE.Vector2(1, 1)},
    };
    this.build();
    this.connect();
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  // Make the scene.
  build() {
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: true});
    this.renderer.shadowMap.enabled = true;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(
      getComputedStyle(document.documentElement).getPropertyValue('--paper').trim(),
    );
    addLight(this.scene);
    this.blocks = meshOfBodies(false, this.uniforms);
    this.shapes = {};
    const always = [-1e30, 1e30];
    const outlined = body => !(run.ground && body.kind === 'ground'); // the ground goes on beyond its edge
    const edges = run.bodies.flatMap((body, i) =>
      run.shapes[body.shape].edges
        .filter(() => outlined(body))
        .map(([start, end]) => ({start, end, bodies: [i, i], life: always})),
    );
    this.edges = meshOfLines(edges, [INK, EDGE], this.uniforms);
    this.scene.add(this.blocks, meshOfBodies(true, this.uniforms), this.edges);
    for (const kind of ['ties', 'cracks']) {
      if (run[kind].length) this.shapes[kind] = meshOfLines(run[kind], KINDS[kind], this.uniforms);
    }
    if (this.forces) {
      const bars = run.forces.joints.map(() => ({start: [0, 0, 0], end: [0, 0, 0], bodies: [-1, -1], life: always}));
      this.shapes.forces = meshOfLines(bars, KINDS.forces, this.uniforms);
      this.shapes.forces.visible = false;
      this.shapes.forces.material.depthTest = false;
      this.shapes.forces.renderOrder = 3;
      this.longest = run.forces.longest;
    }
    if (run.ground) this.shapes.ground = meshOfGround(run.ground);
    this.scene.add(...Object.values(this.shapes));
    this.camera = new THREE.PerspectiveCamera((NARROW * 180) / Math.PI, 1, 1, 10);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    if (run.ground) this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.controls.enableZoom = window.self === window.top; // within another page the wheel scrolls that one, see connect
    this.controls.addEventListener('start', () => {
      this.moved = true;
    });
    this.controls.addEventListener('change', () => this.ask());
  }

  // Connect buttons, keys and pointers.
  connect() {
    this.cursor = drawTrack();
    const slider = byId('time');
    Object.assign(slider, {min: this.first, max: this.last, value: this.first});
    slider.oninput = () => {
      this.stop();
      this.show(+slider.value);
    };
    byId('play').onclick = () => (this.playing ? this.stop() : this.play());
    byId('back').onclick = () => this.step(-1);
    byId('forth').onclick = () => this.step(1);
    byId('reset').onclick = () => this.reset();
    byId('speed').append(
      ...SPEEDS.map(speed => make('option', {value: speed, textContent: `${speed} \u00d7`, selected: speed === 1})),
    );
    byId('speed').onchange = () => {
      this.speed = +byId('speed').value;
    };
    byId('longer').append(...LENGTHS.map(times => make('option', {value: times, textContent: `${times} \u00d7`})));
    byId('longer').onchange = () => {
      this.longest = run.forces.longest * byId('longer').value;
      this.ask();
    };
    byId('full').hidden = !document.fullscreenEnabled;
    byId('full').onclick = () =>
      document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen();
    byId('block').append(...run.bodies.map((body, value) => make('option', {value, textContent: body.name})));
    byId('block').onchange = () => this.pick(+byId('block').value);
    const groups = [...new Set(run.bodies.map(body => body.kind))];
    this.switches = Object.fromEntries(
      [...new Set([...groups, ...Object.keys(this.shapes)])].map(name => {
        const box = make('input', {type: 'checkbox', name, checked: this.shapes[name]?.visible ?? true});
        box.onchange = () => this.turn(name, box.checked);
        byId('switches').append(make('label', {}, box, name));
        return [name, box];
      }),
    );
    let pressed = null;
    canvas.addEventListener('pointerdown', event => {
      pressed = [event.clientX, event.clientY];
      this.controls.enableZoom = true;
    });
    canvas.addEventListener('pointerup', event => {
      if (pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 5)
        this.pickAt(event.clientX, event.clientY);
    });
    canvas.addEventListener('pointerleave', () => {
      this.controls.enableZoom = window.self === window.top;
    });
    document.addEventListener('keydown', event => this.key(event));
    const count = run.bodies.filter(body => body.kind === 'blocks').length,
      [first, last] = [this.first, this.last].map(time => +time.toFixed(2));
    canvas.setAttribute(
      'aria-label',
      `${count} block${count === 1 ? '' : 's'}, ${first} to ${last} s: drag to turn, wheel or pinch to zoom, click a block`,
    );
    NIGHT.addEventListener('change', () => location.reload()); // in the other colours
  }

  // What a key does. Keys that a control of the page takes are left to it.
  key(event) {
    const within = event.target.tagName;
    if (event.ctrlKey || event.metaKey || event.altKey || within === 'SELECT') return;
    if (within === 'BUTTON' && event.key === ' ') return;
    const turn = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    const action =
      event.shiftKey && turn
        ? () => this.orbit(...turn)
        : {
            ' ': () => byId('play').click(),
            ArrowLeft: () => this.step(-1),
            ArrowRight: () => this.step(1),
            Home: () => this.go(this.first),
            End: () => this.go(this.last),
            r: () => this.reset(),
            f: () => byId('full').click(),
            Escape: () => this.pick(-1),
            ',': () => this.change(-1),
            '.': () => this.change(1),
            '+': () => this.zoom(0.9),
            '=': () => this.zoom(0.9),
            '-': () => this.zoom(1 / 0.9),
          }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  go(time) {
    this.stop();
    this.show(time);
  }

  // Go to the next sample, or to the one before.
  step(by) {
    const at = by > 0 ? run.t.findIndex(t => t > this.time + 1e-9) : run.t.findLastIndex(t => t < this.time - 1e-9);
    if (at >= 0) this.go(run.t[at]);
  }

  change(by) {
    const at = Math.min(SPEEDS.length - 1, Math.max(0, SPEEDS.indexOf(this.speed) + by));
    this.speed = byId('speed').value = SPEEDS[at];
  }

  // Turn the camera about what it looks at, by steps of five degrees.
  orbit(across, down) {
    const off = this.camera.position.clone().sub(this.controls.target);
    off.applyAxisAngle(new THREE.Vector3(0, 0, 1), (across * Math.PI) / 36);
    const right = new THREE.Vector3(0, 0, 1).cross(off).normalize();
    const tilted = off.clone().applyAxisAngle(right, (down * Math.PI) / 36);
    if (Math.hypot(tilted.x, tilted.y) > 0.1 * tilted.length()) off.copy(tilted);
    this.camera.position.copy(this.controls.target).add(off);
    this.moved = true;
    this.controls.update();
  }

  zoom(by) {
    this.camera.position.sub(this.controls.target).multiplyScalar(by).add(this.controls.target);
    this.moved = true;
    this.controls.update();
  }

  reset() {
    this.moved = false;
    this.speed = +(byId('speed').value = '1');
    this.pick(-1);
    this.go(this.first);
    this.resize();
  }

  play() {
    if (this.time >= this.last) this.time = this.first;
    this.playing = true;
    this.since = null;
    this.label('Stop');
    this.ask();
  }

  stop() {
    this.playing = false;
    this.label('Play');
  }

  label(text) {
    byId('play').textContent = text;
    byId('play').setAttribute('aria-label', text.toLowerCase());
  }

  // Show a time.
  show(time) {
    this.time = Math.min(this.last, Math.max(this.first, time));
    this.ask();
  }

  // Show or hide a kind of thing. Forces lie within the blocks, which are therefore seen through.
  turn(name, on) {
    this.switches[name].checked = on;
    if (this.shapes[name]) this.shapes[name].visible = on;
    run.bodies.forEach((body, i) => {
      if (body.kind === name) this.poses[8 * i + 3] = +on;
    });
    if (name === 'forces') {
      Object.assign(this.blocks.material, {transparent: on, opacity: on ? 0.3 : 1, depthWrite: !on});
      this.blocks.material.needsUpdate = true;
      this.edges.material.uniforms.colour.value.set(on ? FAINT : INK);
      this.edges.material.uniforms.width.value = on ? 0.5 * EDGE : EDGE;
      byId('longer').parentElement.hidden = !on;
    }
    this.ask();
  }

  pickAt(x, y) {
    const box = canvas.getBoundingClientRect(),
      caster = new THREE.Raycaster();
    caster.setFromCamera(
      new THREE.Vector2((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height),
      this.camera,
    );
    this.pick(bodyOnRay(caster.ray, this.poses));
  }

  // Pick a body by its number, -1 for none.
  pick(number) {
    this.number = this.uniforms.picked.value = number;
    byId('block').value = number;
    byId('card').hidden = number < 0;
    this.ask();
  }

  // Write the card of the body that is picked.
  writeCard() {
    const rows = rowsOf(this.number, this.poses, this.forces, this.time).map(([name, value]) =>
      make('tr', {}, make('th', {scope: 'row', textContent: name}), make('td', {textContent: value})),
    );
    const close = make('button', {textContent: '\u00d7', title: 'let go (Escape)', onclick: () => this.pick(-1)});
    close.setAttribute('aria-label', 'let go of the block');
    byId('card').replaceChildren(
      make('h2', {textContent: run.bodies[this.number].name}),
      close,
      make('table', {}, make('tbody', {}, ...rows)),
    );
  }

  resize() {
    const {clientWidth: wide, clientHeight: tall} = canvas;
    if (!wide || !tall) return;
    this.tall = tall;
    this.renderer.setSize(wide, tall, false);
    this.uniforms.size.value.set(wide, tall);
    this.camera.aspect = wide / tall;
    if (!this.moved) fitCamera(this.camera, this.controls);
    this.ask();
  }

  // Ask for a frame. One is drawn when something has changed, and not otherwise.
  ask() {
    if (!this.asked)
      this.asked = requestAnimationFrame(now => {
        this.asked = 0;
        this.frame(now);
      });
  }

  // Draw a frame, and ask for the next one while the motion plays.
  frame(now) {
    const start = performance.now();
    if (this.playing) {
      if (this.since !== null) this.time = Math.min(this.last, this.time + (this.speed * (now - this.since)) / 1000);
      this.since = now;
      if (this.time >= this.last) this.stop();
    }
    this.draw();
    this.cost[this.frames++ % 120] = performance.now() - start;
    if (this.playing) this.ask();
  }

  draw() {
    setPoses(this.poses, this.motion, this.time);
    this.texture.needsUpdate = true;
    this.uniforms.time.value = this.time;
    if (this.shapes.forces?.visible) setBars(this.shapes.forces, this.forces, this.time, this.longest);
    const distance = this.camera.position.distanceTo(this.controls.target),
      reach = run.reach + distance;
    Object.assign(this.camera, {near: 0.02 * distance, far: 3 * reach});
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    byId('time').value = this.time;
    byId('time').setAttribute('aria-valuetext', `${this.time.toFixed(2)} seconds`);
    byId('clock').textContent = `${this.time.toFixed(2)} / ${this.last.toFixed(2)} s`;
    if (this.cursor)
      for (const end of ['x1', 'x2'])
        this.cursor.setAttribute(end, (1000 * (this.time - this.first)) / (this.last - this.first));
    this.drawScales(this.tall / (2 * distance * Math.tan(NARROW / 2)));
    this.drawAxes();
    if (run.opened) byId('opened').textContent = `largest opening so far ${lengthOf(run.opened[sampleAt(this.time)[0]])}`;
    if (this.number >= 0) this.writeCard();
  }

  // Draw the directions of x, y and z as the camera sees them.
  drawAxes() {
    const turn = this.camera.quaternion.clone().invert();
    all('#axes g').forEach((group, i) => {
      const {x, y} = new THREE.Vector3(+(i === 0), +(i === 1), +(i === 2)).applyQuaternion(turn);
      const [line, text] = group.children;
      line.setAttribute('x2', 26 * x);
      line.setAttribute('y2', -26 * y);
      text.setAttribute('x', 35 * x);
      text.setAttribute('y', -35 * y);
    });
  }

  // Draw the scale bars, of so many pixels a metre at what the camera looks at.
  drawScales(pixels) {
    const put = (id, per, unit) => {
      const value = roundBelow(110 / per),
        [bar, text] = byId(id).children;
      bar.style.width = `${per * value}px`;
      text.textContent = shown(value, unit);
    };
    put('length-scale', pixels, 'm');
    const forces = this.shapes.forces?.visible ?? false;
    byId('force-scale').hidden = !forces;
    if (forces) put('force-scale', (pixels * this.longest) / run.forces.scale, 'N');
  }
}

// What the address asks for after #: a time t, the names of things to show, and play.
function obey(view) {
  const asked = new URLSearchParams(location.hash.slice(1));
  for (const name of Object.keys(view.switches)) if (asked.has(name)) view.turn(name, asked.get(name) !== '0');
  if (asked.has('t')) view.show(+asked.get('t'));
  if (asked.has('block')) view.pick(run.bodies.findIndex(body => body.name === asked.get('block')));
  if (asked.has('play')) view.play();
}

function fail(error) {
  byId('trouble').hidden = false;
  byId('trouble').textContent =
    `This page cannot be shown: ${error.message ?? error}. It needs a browser with WebGL 2, of 2023 or later.`;
  document.documentElement.dataset.state = 'failed';
}

window.addEventListener('error', event => fail(event.error ?? event));
window.addEventListener('unhandledrejection', event => fail(event.reason));
const motion = {places: await unpacked(run.places), turns: await unpacked(run.turns)};
const forces = run.forces && {places: await unpacked(run.forces.places), shares: await unpacked(run.forces.shares)};
const view = (window.view = new View(motion, forces));
obey(view);
view.draw();
document.documentElement.dataset.state = 'drawn';
