// The form of `mjrock app`. Python makes the plan of the form from the schema of the file (mjrock/app/form.py), and this
// script draws it. The input is one nested object of texts, of the shape of the file. It stays in this window, goes with
// each request, and comes back from no other one.
//
// A plan has tables by their ids, each a list of fields. A field has a control: number, text, choice, truth, file, row
// (values in brackets), table (one of some variants), list (of such) or named (such by name).

const byId = id => document.getElementById(id);
const KEPT = 'mjrock'; // the input in the storage of this window
const PAUSE = 250; // after the last key before a check [ms]
const LARGEST = 30 * 2 ** 20; // of a request, as the server has it, with room for the rest [byte]

const TABLES = new Set(['table', 'list', 'named', 'pairs']); // controls of several fields

const NAMES = ['kind', 'make', 'solver']; // keys that name what a table stands for
const TABLE = '+'; // choice of a field that makes it a table

let plan = null; // of the form, in a language
let state = {}; // what is in the fields
const files = {}; // content of uploaded files by name, base64
let responses = null; // name under which the server keeps the last run
let checking = null; // the request of the current check
let running = null;

// ------------------------------------------------------------------------------------------------- the server

// The parts of the answer to a task, as they come.
async function* parts(task, request, signal) {
  const body = JSON.stringify(request);
  if (body.length > LARGEST) throw new Error(plan.texts.too_large);
  const headers = {'Content-Type': 'application/json'};
  const response = await fetch(`do/${task}`, {method: 'POST', headers, body, signal});
  if (!response.ok) throw new Error(await response.text());
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let text = '',
    whole = false;
  for (;;) {
    const {done, value} = await reader.read();
    if (done) break;
    text += value;
    const lines = text.split('\n');
    text = lines.pop();
    for (const part of lines.map(JSON.parse)) {
      if (part.error) throw new Error(part.error);
      if (part.done) whole = true;
      else yield part;
    }
  }
  if (!whole) throw new Error(plan?.texts.broken_off ?? 'the connection broke off');
}

// All parts of an answer as one object.
async function answer(task, request, signal) {
  const found = {};
  for await (const part of parts(task, request, signal)) Object.assign(found, part);
  return found;
}

const request = more => ({state, files, ...more});

// ------------------------------------------------------------------------------------------------- elements

function element(tag, attributes = {}, ...inside) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else if (typeof value === 'boolean') made.toggleAttribute(name, value);
    else if (value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...inside);
  return made;
}

function options(select, choices, chosen) {
  select.replaceChildren(...choices.map(([value, text]) => element('option', {value}, text)));
  select.value = chosen;
}

const place = path => `at/${path.map(encodeURIComponent).join('/')}`;

// ------------------------------------------------------------------------------------------------- the form

// The variant of a table that its `kind` and `make` name; the nearest where none fits.
function variantOf(field, values) {
  const fits = (one, key) => (key in values ? values[key] === one.names[key] : !(key in one.names) || one.usual);
  const find = keys => field.variants.find(one => keys.every(key => fits(one, key)));
  const used = NAMES.filter(key => field.variants.some(one => key in one.names));
  return find(used) ?? find(NAMES.slice(0, 1)) ?? field.variants[0];
}

// Draw the fields of a table: those that are needed or have a value, the others in a fold.
function drawTable(id, values, path) {
  const shown = [],
    tables = [],
    more = [];
  for (const field of plan.tables[id]) {
    const place = TABLES.has(field.control) ? tables : field.key in values || field.needed ? shown : more;
    place.push(drawField(field, values, path));
  }
  if (tables.length) shown.push(element('div', {class: 'tables'}, ...tables));
  if (more.length) {
    const fold = element('details', {}, element('summary', {}, `${plan.texts.more} (${more.length})`), ...more);
    shown.push(fold);
  }
  return shown;
}

function drawField(field, values, path) {
  const own = [...path, field.key];
  const table = typeof values[field.key] === 'object' && field.variants.length && !Array.isArray(values[field.key]);
  if (field.control === 'table' || (table && !TABLES.has(field.control))) return drawOptional(field, values, own);
  if (field.control === 'list') return drawList(field, values, own);
  if (field.control === 'named') return drawNamed(field, values, own);
  if (field.control === 'pairs') return drawPairs(field, values, own);
  return drawValue(field, values, own);
}

// A field of one value, with its label, unit, range and meaning. Where it may be a table too, `add` makes it one; `then`
// is called after a change.
function drawValue(field, values, path, add, then) {
  const id = place(path),
    notes = `${id}/help`;
  const common = {id, 'aria-describedby': notes, 'data-control': field.control};
  const change = event => {
    if (event.target.value === TABLE) return add();
    set(values, field.key, event.target.value);
    then?.();
    changed();
  };
  const described = field.english ? {lang: 'en', title: field.english} : {};
  let control;
  if (field.control === 'choice' || field.control === 'truth') {
    control = element('select', {...common, onchange: change});
    const choices = field.choices ?? [];
    const usual = choices.find(([value]) => value === field.default); // where the key is left out
    options(control, usual ? choices : [['', '–'], ...choices], values[field.key] ?? usual?.[0] ?? '');
  } else if (field.control === 'file' || field.control === 'folder') {
    const taken = event => upload(event.target, values, field);
    control = element('input', {...common, type: 'file', onchange: taken});
    control.multiple = (field.several ?? false) || field.control === 'folder';
  } else {
    const typed = field.control === 'number' ? {inputmode: 'decimal'} : {};
    control = element('input', {...common, ...typed, type: 'text', placeholder: field.default ?? '', oninput: change});
    control.value = values[field.key] ?? '';
  }
  const parts = [[field.range, field.help].filter(Boolean).join('; ')];
  const unit = field.unit ? [element('span', {class: 'unit'}, field.unit)] : [];
  if (control.type === 'file') {
    const names = field.control === 'folder' ? Object.keys(files) : [values[field.key] ?? []].flat();
    parts.unshift(element('b', {}, names.join(', ')), ' ');
  }
  return element(
    'div',
    {class: 'field'},
    element('label', {for: id}, field.label, element('code', described, field.key)),
    element('div', {class: 'control'}, control, ...unit),
    element('p', {class: 'help', id: notes}, ...parts),
  );
}

function set(values, key, value) {
  if (value === '') delete values[key];
  else values[key] = value;
}

// A table of a variant, with a choice where there are several.
function drawVariant(field, values, path, legend, remove) {
  const box = element('fieldset', {id: place(path), tabindex: '-1'}, element('legend', {}, legend));
  const draw = () => {
    const variant = variantOf(field, values);
    const head = element('div', {class: 'row'});
    if (field.variants.length > 1) {
      const select = element('select', {
        'aria-label': `${legend}: ${plan.texts.kind}`,
        onchange: event => {
          for (const key of NAMES) delete values[key];
          Object.assign(values, field.variants[event.target.value].names);
          draw();
          changed();
        },
      });
      const choices = field.variants.map((one, i) => [i, one.label]);
      options(select, choices, field.variants.indexOf(variant));
      head.append(select);
    }
    if (remove) {
      const button = {type: 'button', 'aria-label': `${plan.texts.remove} ${legend}`, onclick: remove};
      head.append(element('button', button, plan.texts.remove));
    }
    box.replaceChildren(box.firstChild, ...(head.children.length ? [head] : []), ...drawTable(variant.id, values, path));
  };
  draw();
  return box;
}

// A table that may be left out.
function drawOptional(field, values, path) {
  const frame = element('div', {class: 'optional'});
  const draw = () => {
    if (field.needed && !('mechanisms' in values)) values[field.key] ??= {};
    if (field.key in values && typeof values[field.key] === 'object') {
      const remove = () => {
        delete values[field.key];
        draw();
        changed();
      };
      frame.replaceChildren(drawVariant(field, values[field.key], path, field.label, field.needed ? null : remove));
    } else {
      const add = () => {
        values[field.key] = {...variantOf(field, {}).names};
        draw();
        changed();
      };
      if (!field.choices) return frame.replaceChildren(addButton(field.label, place(path), add));
      const tables = field.variants.map(one => [TABLE, one.label]);
      const choices = [...field.choices, ...tables];
      frame.replaceChildren(drawValue({...field, control: 'choice', choices}, values, path, add));
    }
  };
  draw();
  return frame;
}

function addButton(label, id, onclick) {
  return element('p', {class: 'row'}, element('button', {type: 'button', id, onclick}, `+ ${label}`));
}

// Tables in a row, each of which can be taken away.
function drawList(field, values, path) {
  const frame = element('div', {class: 'list'});
  const draw = () => {
    if (values[field.key] && !Array.isArray(values[field.key])) values[field.key] = [values[field.key]];
    const rows = values[field.key] ?? [];
    const boxes = rows.map((one, i) => {
      const remove = () => {
        rows.splice(i, 1);
        if (!rows.length) delete values[field.key];
        draw();
        changed();
      };
      const label = field.variants.length > 1 ? variantOf(field, one).label : field.label;
      return drawVariant(field, one, [...path, i], `${label} ${i + 1}`, remove);
    });
    const add = () => {
      (values[field.key] ??= []).push({...variantOf(field, {}).names});
      draw();
      changed();
    };
    frame.replaceChildren(...boxes, addButton(field.label, place(path), add));
  };
  draw();
  return frame;
}

// Tables by name.
function drawNamed(field, values, path) {
  return drawByName(field, path, {
    entries: () => Object.entries(values[field.key] ?? {}),
    add: name => ((values[field.key] ??= {})[name] ??= {}),
    draw: (name, one, remove) => drawVariant(field, one, [...path, name], name, remove),
    remove: name => {
      delete values[field.key][name];
      if (!Object.keys(values[field.key]).length) delete values[field.key];
    },
  });
}

// Texts by name: those that have a label, or any.
function drawPairs(field, values, path) {
  if (field.choices) {
    const texts = values[field.key] ?? {};
    const given = {...texts}; // kept in the input when there is any
    const parts = Object.entries({...Object.fromEntries(field.choices), ...texts}).map(([name]) => {
      const label = field.choices.find(([known]) => known === name)?.[1] ?? name;
      const change = () => {
        if (Object.keys(given).length) values[field.key] = given;
        else delete values[field.key];
      };
      return drawValue({key: name, label, help: '', control: 'text'}, given, [...path, name], null, change);
    });
    return element('fieldset', {id: place(path), tabindex: '-1'}, element('legend', {}, field.label), ...parts);
  }
  const text = name => ({key: name, label: name, help: '', control: 'text'});
  return drawByName(field, path, {
    entries: () => Object.entries(values[field.key] ?? {}),
    add: name => ((values[field.key] ??= {})[name] ??= ''),
    draw: name => drawValue(text(name), values[field.key], [...path, name]),
  });
}

// What has names that a person gives: a part for each, and a field for a further name.
function drawByName(field, path, {entries, add, draw, remove}) {
  const frame = element('div', {class: 'list'});
  const again = () => {
    const parts = entries().map(([name, one]) =>
      draw(name, one, () => {
        remove(name);
        again();
        changed();
      }),
    );
    const name = element('input', {'aria-label': `${field.label}: ${plan.texts.name}`, placeholder: plan.texts.name});
    const further = () => {
      if (!name.value.trim()) return name.focus();
      add(name.value.trim());
      again();
      changed();
    };
    const row = addButton(field.label, place(path), further);
    row.append(name);
    frame.replaceChildren(...parts, row);
  };
  again();
  return frame;
}

function drawForm() {
  document.documentElement.lang = plan.language;
  for (const one of document.querySelectorAll('[data-text]')) one.textContent = plan.texts[one.dataset.text];
  for (const id of ['open', 'save', 'run', 'stop', 'report']) byId(id).textContent = plan.texts[id];
  byId('film').title = plan.texts.film;
  document.title = `mjrock: ${plan.texts.title}`;
  options(byId('language'), plan.languages, plan.language);
  options(byId('report-language'), plan.languages, byId('report-language').value || plan.language);
  options(byId('template'), [['', plan.texts.choose], ...plan.templates], byId('template').value);
  byId('form').replaceChildren(drawVariant(plan.root, state, [], plan.texts.mechanism, null));
}

// Read files that a person picks; their names stand in the field, and their content goes with a run.
async function upload(input, values, field) {
  const names = [];
  const help = byId(input.getAttribute('aria-describedby')).querySelector('b');
  const size = [...input.files].reduce((sum, file) => sum + file.size, 0);
  if ((4 / 3) * size > LARGEST) {
    input.value = '';
    help.textContent = plan.texts.too_large;
    return;
  }
  if (field.control === 'folder') for (const name in files) delete files[name];
  for (const file of input.files) {
    const text = await new Promise((done, failed) => {
      const reader = new FileReader();
      reader.onload = () => done(reader.result);
      reader.onerror = () => failed(reader.error);
      reader.readAsDataURL(file);
    });
    files[file.name] = text.slice(text.indexOf(',') + 1);
    names.push(file.name);
  }
  const several = field.control === 'folder' ? '.' : names; // all files are in one folder
  if (names.length) values[field.key] = input.multiple ? several : names[0];
  else delete values[field.key];
  help.textContent = names.join(', ');
  changed();
}

// ------------------------------------------------------------------------------------------------- the verdict

function keep() {
  try {
    sessionStorage.setItem(KEPT, JSON.stringify({state, language: plan.language}));
  } catch {
    // a window without storage forgets its input when it is loaded again
  }
}

let waiting = 0, // timer of the next check
  changes = 0;
function changed() {
  keep();
  responses = null;
  changes += 1;
  clearTimeout(waiting);
  waiting = setTimeout(check, PAUSE);
  byId('verdict').classList.add('busy');
}

function clearFaults() {
  for (const one of document.querySelectorAll('.fault')) one.remove();
  for (const one of document.querySelectorAll('[aria-invalid]')) one.removeAttribute('aria-invalid');
}

// Show that something has not been done, and why.
function showError(error) {
  clearFaults();
  byId('verdict').replaceChildren(element('p', {class: 'fault', role: 'alert'}, error.message));
}

// Show what is wrong at its field, or at the nearest table around it, and all of it beside the form.
function showFaults(faults) {
  clearFaults();
  const list = faults.map(({place: path, message}) => {
    let at = null;
    for (let end = path.length; end && !at; end--) at = byId(place(path.slice(0, end)));
    if (!at) return element('li', {}, message);
    at.setAttribute('aria-invalid', 'true');
    const fault = element('p', {class: 'fault', role: 'alert'}, message);
    const frame = at.closest('.field') ?? at;
    if (frame.tagName === 'FIELDSET') frame.firstChild.after(fault);
    else if (frame.tagName === 'BUTTON') frame.after(fault);
    else frame.append(fault);
    const show = event => {
      event.preventDefault();
      for (let fold = at.closest('details'); fold; fold = fold.parentElement.closest('details')) fold.open = true;
      at.scrollIntoView({block: 'center'});
      at.focus();
    };
    return element('li', {}, element('a', {href: `#${at.id}`, onclick: show}, message));
  });
  const count = `${plan.texts.to_mend}: ${faults.length}`;
  byId('verdict').replaceChildren(element('p', {class: 'part'}, count), element('ul', {}, ...list));
  byId('sketches').classList.add('busy');
  show({ratio: count, steps: ''});
}

async function check() {
  checking?.abort();
  const own = (checking = new AbortController()),
    of = changes;
  try {
    for await (const part of parts('check', request(), own.signal)) {
      if (own.signal.aborted) return;
      if (part.faults) showFaults(part.faults);
      show(part);
    }
  } catch (error) {
    if (own.signal.aborted) return;
    showError(error);
  }
  byId('verdict').classList.toggle('busy', of !== changes);
}

// Show a part of an answer. Tables come as markup from the parts of the report, which escape every text.
function show({verdict, ratio, steps, sketch, ...drawn}) {
  if (verdict !== undefined) {
    clearFaults();
    byId('verdict').innerHTML = verdict;
  }
  if (ratio !== undefined) {
    byId('to-results').textContent = ratio;
    byId('to-results').hidden = !ratio;
  }
  if (steps !== undefined) byId('steps').innerHTML = steps;
  if (sketch !== undefined) showSketch(sketch, drawn);
}

// Show the drawing of a mechanism in its place among all of them.
function showSketch(src, {alt, name, number, count}) {
  const box = byId('sketches');
  box.classList.remove('busy');
  while (box.children.length > count) box.lastChild.remove();
  while (box.children.length < count) box.append(element('figure', {}, element('img'), element('figcaption')));
  const [image, caption] = box.children[number].children;
  Object.assign(image, {src, alt});
  caption.textContent = name;
}

// ------------------------------------------------------------------------------------------------- runs and reports

function busy(runs) {
  byId('run').disabled = runs;
  for (const id of ['stop', 'progress']) byId(id).hidden = !runs;
}

async function run() {
  running = new AbortController();
  busy(true);
  byId('progress').removeAttribute('value');
  byId('how-far').textContent = '';
  try {
    for await (const part of parts('run', request(), running.signal)) {
      if (part.faults) showFaults(part.faults);
      if (part.share !== undefined) byId('progress').value = part.share;
      if (part.what !== undefined) byId('how-far').textContent = part.what;
      if (part.answers !== undefined) byId('answers').innerHTML = part.answers;
      if (part.responses) responses = part.responses;
      if (part.film) {
        byId('film').src = `film/${part.film}`;
        byId('film').hidden = false;
      }
    }
    byId('how-far').textContent = '';
  } catch (error) {
    byId('how-far').textContent = running.signal.aborted ? plan.texts.stopped : error.message;
  }
  running = null;
  busy(false);
}

function download(name, type, bytes) {
  const link = element('a', {href: URL.createObjectURL(new Blob([bytes], {type})), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

async function report() {
  const state = byId('report-state');
  byId('report').disabled = true;
  state.textContent = plan.texts.report_is_made;
  try {
    const made = await answer('report', request({responses, language: byId('report-language').value}));
    if (made.faults) showFaults(made.faults);
    state.textContent = made.faults ? plan.texts.to_mend : made.note;
    for (const {name, type, data} of made.documents ?? []) {
      download(name, type, Uint8Array.from(atob(data), letter => letter.charCodeAt(0)));
    }
  } catch (error) {
    state.textContent = error.message;
  }
  byId('report').disabled = false;
}

async function save() {
  const made = await answer('save', request());
  if (made.faults) showFaults(made.faults);
  else download(made.name, 'application/toml', made.text);
}

async function open(file) {
  if (file.size > LARGEST) throw new Error(plan.texts.too_large);
  const found = await answer('open', {text: await file.text(), language: plan.language});
  if (found.faults) return showFaults(found.faults.map(one => ({...one, place: []})));
  state = found.state;
  await load(state.language ?? plan.language);
}

// Draw the form in a language, and check what is in it.
async function load(language) {
  plan = await answer('form', {language});
  const whole = field => ({help: '', variants: [], ...field});
  for (const id in plan.tables) plan.tables[id] = plan.tables[id].map(whole);
  drawForm();
  changed();
}

function begin() {
  let kept = {};
  try {
    kept = JSON.parse(sessionStorage.getItem(KEPT)) ?? {};
  } catch {
    kept = {};
  }
  state = kept.state ?? {};
  byId('form').addEventListener('submit', event => event.preventDefault());
  byId('language').addEventListener('change', event => {
    state.language = event.target.value;
    byId('report-language').value = event.target.value;
    load(event.target.value);
  });
  byId('template').addEventListener('change', event => {
    const picked = plan.states[event.target.value];
    if (!picked) return;
    state = {...structuredClone(picked), language: plan.language};
    drawForm();
    changed();
  });
  byId('open').addEventListener('click', () => byId('file').click());
  byId('file').addEventListener('change', async event => {
    const [file] = event.target.files;
    event.target.value = '';
    if (file) await open(file).catch(showError);
  });
  byId('save').addEventListener('click', () => save().catch(showError));
  byId('run').addEventListener('click', run);
  byId('stop').addEventListener('click', () => running?.abort());
  byId('report').addEventListener('click', report);
  return load(kept.language ?? (navigator.language.startsWith('it') ? 'it' : 'en'));
}

begin().catch(showError);
