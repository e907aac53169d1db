// What test_browser.py has a page do, and what it is told: each function here is called by its name in a browser.

const byId = id => document.getElementById(id);
const all = selector => [...document.querySelectorAll(selector)];
const pause = time => new Promise(done => setTimeout(done, time));
const until = async ready => {
  while (!ready()) await pause(20);
};
const press = (key, more = {}) => document.dispatchEvent(new KeyboardEvent('keydown', {key, ...more}));
const placeOf = number => [...view.poses.subarray(8 * number, 8 * number + 3)];

// Where a point [m] is on the screen.
function onScreen(point) {
  const {x, y} = new THREE.Vector3(...point).project(view.camera),
    box = byId('canvas').getBoundingClientRect();
  return [box.left + ((x + 1) / 2) * box.width, box.top + ((1 - y) / 2) * box.height];
}

// Red, green and blue of the picture at a point [m].
function colourAt(point) {
  view.draw();
  const gl = view.renderer.getContext(),
    found = new Uint8Array(4);
  const {x, y} = new THREE.Vector3(...point).project(view.camera);
  const at = [((x + 1) / 2) * gl.drawingBufferWidth, ((y + 1) / 2) * gl.drawingBufferHeight].map(Math.floor);
  gl.readPixels(...at, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, found);
  return [...found.subarray(0, 3)];
}

const tests = {
  async controls() {
    await until(() => view.frames > 0);
    const told = {frames: view.frames, first: [...view.poses.subarray(8, 24)]};
    byId('time').value = 0.8;
    byId('time').oninput();
    view.draw();
    told.later = [view.time, ...view.poses.subarray(8, 24)];
    press('Home');
    press('ArrowRight');
    told.second = view.time;
    press('ArrowRight');
    press('ArrowLeft');
    told.again = view.time;
    press('End');
    told.end = view.time;
    press('.');
    told.fast = view.speed;
    press(' ');
    told.plays = [view.playing, byId('play').ariaLabel];
    for (let i = 0; i < 4; i++) press(',');
    told.slow = view.speed;
    await until(() => view.time > 0.01 && view.time < 1);
    press(' ');
    told.stops = [view.playing, byId('play').textContent];
    const before = view.camera.position.clone();
    press('ArrowLeft', {shiftKey: true});
    press('+');
    told.turned = view.camera.position.distanceTo(before);
    press('r');
    told.reset = [view.time, view.speed, view.camera.position.distanceTo(before)];
    view.draw();
    view.pickAt(...onScreen(placeOf(2)));
    view.draw();
    told.card = byId('card').textContent;
    told.picked = byId('block').value;
    press('Escape');
    told.hidden = byId('card').hidden;
    view.pickAt(1, 1);
    told.none = view.number;
    byId('block').value = 1;
    byId('block').onchange();
    view.draw();
    told.chosen = byId('card').querySelector('h2').textContent;
    view.poses[8 * 1] -= 2e-8; // less than a digit of the card
    view.poses[8 * 1 + 1] -= 2e-8;
    view.writeCard();
    told.zero = byId('card').textContent;
    press('Escape');
    told.switches = Object.keys(view.switches);
    view.switches.forces.click();
    view.draw();
    told.scales = [byId('force-scale').textContent, byId('length-scale').textContent];
    told.opened = byId('opened').textContent;
    told.canvas = byId('canvas').ariaLabel;
    // the squares of what the picture shows of three unit vectors at right angles sum to one in any direction of it
    const ends = all('#axes line').map(line => ['x2', 'y2'].map(name => line.getAttribute(name) / 26));
    const sums = [0, 1].map(k => ends.reduce((sum, end) => sum + end[k] ** 2, 0));
    told.axes = [...sums, 1 - ends.reduce((sum, [x, y]) => sum + x * y, 0)];
    const named = one => one.ariaLabel || one.textContent.trim() || one.labels?.length;
    told.unnamed = all('button, select, input, canvas').filter(one => !named(one)).length;
    return told;
  },

  colours() {
    const front = -0.5,
      told = {lower: colourAt([0, front, 0.5]), upper: colourAt([0, front, 1.5])};
    told.edge = colourAt([0, front, 1]);
    told.shaded = colourAt([0.7, 0.55, -0.002]); // the sun comes from the left and the front
    told.lit = colourAt([-1.5, -1.5, -0.002]);
    view.turn('forces', true);
    told.through = colourAt([0, front, 0.3]); // the ground lies behind
    view.turn('forces', false);
    view.turn('blocks', false);
    told.gone = colourAt([0, front, 1.5]);
    told.ground = colourAt([0, front, 0.3]);
    return told;
  },

  layout() {
    const points = [],
      {shapes} = JSON.parse(byId('run').textContent),
      turn = new THREE.Quaternion();
    for (const time of [0, 0.3]) {
      view.show(time);
      view.draw();
      for (const number of [1, 2]) {
        turn.set(...view.poses.subarray(8 * number + 4, 8 * number + 8));
        for (const corner of shapes[1].corners) {
          const off = new THREE.Vector3(...corner).applyQuaternion(turn);
          points.push(onScreen(off.add(new THREE.Vector3(...placeOf(number))).toArray()));
        }
      }
    }
    const box = byId('canvas').getBoundingClientRect();
    return {
      points,
      canvas: [box.left, box.top, box.right, box.bottom],
      footer: document.querySelector('footer').getBoundingClientRect().bottom,
      wide: document.documentElement.scrollWidth,
      heights: all('button, select')
        .filter(one => one.offsetParent)
        .map(one => one.offsetHeight),
      slider: byId('time').offsetWidth,
    };
  },

  async frames() {
    const took = [];
    for (let i = 0; i < 150; i++) {
      view.time = (view.last * i) / 150;
      const start = performance.now();
      view.draw();
      took.push(performance.now() - start);
      await pause(5);
    }
    took.sort((one, other) => one - other);
    return {quarter: took[37], half: took[75], most: took[149]};
  },

  trouble() {
    return {text: byId('trouble').textContent};
  },
};

const state = () => document.documentElement.dataset.state;
await until(state);
let told;
try {
  told = await tests[NAME]();
} catch (error) {
  told = {error: String(error.stack ?? error)};
}
const asked = performance.getEntriesByType('resource').map(entry => entry.name);
await fetch('/told', {method: 'POST', body: JSON.stringify({...told, asked, state: state()})});
