// The page: controls, picture, figures.

import { USUAL, at, choose, count, cycle, nameOf, offer, offerAll, offerFormats, settings, step, sweep, view } from "./controls.js";
import { Frame, Problem, Workers, bytesOf, packed } from "./workers.js";
import { candidates, fromDrop, fromList, isBlob, save } from "./files.js";
import { Table, bytesText, errorText, secondsText } from "./table.js";
import { press } from "./keys.js";
import { listen } from "./pointer.js";

const context = at("canvas").getContext("2d", { alpha: false, willReadFrequently: true });


/** Between paintings of work that is not finished, in milliseconds. */
const WORK_PAUSE = 400;

/** What there is to choose from. */
let about;
/** The scene that is shown: files, the name of the main one, what its blob says of itself. */
let scene = null;
/** The camera that was moved; the scene's own without one. */
let camera = null;
let frame = new Frame(400, 300);
/** The reference that was drawn last, and what it was drawn with. */
let reference = null;
/** What the blobs in the workers were compiled with. */
let compiled = { picture: null, reference: null };
/** The picture that was finished last, with what was measured. */
let finished = null;
/** Counts changes: work for an earlier one is given up. */
let change = 0;
/** Counts files that are opened, of which the last one is shown. */
let openings = 0;
let isOpening = false;
let isPainting = false;

const module = WebAssembly.compileStreaming(fetch("gridel.wasm")).catch(async () =>
  // A server may not know the type of such files.
  WebAssembly.compile(await (await fetch("gridel.wasm")).arrayBuffer()));
const workers = new Workers(module, Math.max(1, Math.min(8, navigator.hardwareConcurrency || 2)));
workers.onfault = showError;
const table = new Table(at("rows"), use);

function size() {
  const scale = Number(at("size").value);
  return [scene.info.width, scene.info.height].map((side) => Math.max(1, Math.round(side * scale)));
}

function shot(chosen) {
  const [width, height] = size();
  const { format, structure, samples, depth } = chosen;
  return { slot: 0, camera, format, structure, width, height, samples, depth, heatMap: false };
}

// Pictures.

/** What loads blobs goes one after the other. */
let queue = Promise.resolve();
function inTurn(work) {
  const done = queue.then(work);
  queue = done.catch(() => {});
  return done;
}

function setState(state) {
  document.documentElement.dataset.state = state;
}

/** Shows what the controls say. */
async function update({ moved = false } = {}) {
  // A scene that is opened will be shown with what the controls say then.
  if (!scene || isOpening) return;
  const mine = change += 1;
  const isStale = () => mine !== change;
  finished = null;
  at("error").hidden = true;
  setState("drawing");
  try {
    const chosen = settings();
    await inTurn(() => isStale() || compile(chosen));
    if (isStale()) return;
    const wanted = { ...shot(chosen), heatMap: view() === "work" };
    if (frame.width !== wanted.width || frame.height !== wanted.height) {
      frame = new Frame(wanted.width, wanted.height);
      at("canvas").width = wanted.width;
      at("canvas").height = wanted.height;
    }
    if (moved || table.key !== tableKey()) table.clear(tableKey());
    describe(chosen, "drawing");
    const seconds = await workers.draw(wanted, frame, { onchange: paint });
    if (isStale() || seconds === undefined) return;
    mark("picture");
    finished = { chosen, wanted, seconds, linear: frame.linear };
    // Counting takes time.
    if (!wanted.heatMap) at("time").textContent = secondsText(seconds);
    at("bytes").textContent = bytesText(scene.info.bytes);
    await paintLast();
    memory();
    if (!wanted.heatMap) await compare(chosen, isStale);
    if (isStale()) return;
    describe(chosen, "done");
  } catch (error) {
    if (!isStale()) showError(error);
  }
}

/** Compiles the scene for all workers, unless that was done. */
async function compile({ bits, structure, without }) {
  const wanted = scene.blob ? "blob" : JSON.stringify([bits, structure, without]);
  if (compiled.picture === wanted) return;
  workers.stop();
  compiled.picture = null;
  let { blob } = scene;
  if (!blob) {
    status(`Compiling ${scene.name}`);
    const compile = { do: "compile", name: scene.name, structure, latticeBits: bits, without };
    const made = await workers.ask(compile);
    blob = made.bytes;
    scene.warnings = made.answer.warnings;
    scene.displacement = made.answer.displacement;
  }
  const { answer } = await workers.askAll({ do: "load", slot: 0 }, blob);
  scene.info = answer;
  scene.bytes = blob;
  compiled.picture = wanted;
}

/** Draws the reference, unless it is there, and compares. */
async function compare(chosen, isStale) {
  const picture = finished;
  const samples = at("reference").value === "same" ? chosen.samples : Number(at("reference").value);
  const depth = Math.max(chosen.depth, scene.first.depth);
  const slot = await inTurn(() => isStale() || referenceSlot());
  if (isStale()) return;
  const wanted = { ...shot(chosen), slot, format: "f64", structure: scene.blob ? chosen.structure : USUAL, samples, depth };
  const key = JSON.stringify([scene.number, wanted]);
  if (reference?.key !== key) {
    status("Drawing the reference");
    const drawn = new Frame(wanted.width, wanted.height);
    const onchange = () => { at("progress").value = drawn.drawn / (drawn.width * drawn.height); };
    const seconds = await workers.draw(wanted, drawn, { onchange, isBackground: true });
    if (isStale() || seconds === undefined) return;
    reference = { key, linear: drawn.linear, seconds };
  }
  const bits = scene.blob ? scene.info.latticeBits : 24;
  at("reference-text").textContent = `Reference: f64, ${bits} lattice bits, all effects, ${count(samples, "sample")} per pixel, ` +
    `depth ${depth}; it took ${secondsText(reference.seconds)}.`;
  const both = bytesOf(reference.linear, picture.linear);
  const { answer } = await workers.ask({ do: "errors" }, both);
  if (isStale()) return;
  at("rmse").textContent = errorText(answer.rmse);
  at("largest").textContent = errorText(answer.largest);
  at("different").textContent = `${(100 * answer.share).toFixed(2)} %`;
  table.add({ chosen, name: nameOf(chosen, scene), ...answer, seconds: picture.seconds, bytes: scene.info.bytes });
  picture.errors = answer;
  await paintLast();
}

/** The scene with all bits and effects; a blob is what it is. */
async function referenceSlot() {
  if (scene.blob) return 0;
  if (compiled.reference !== scene.number) {
    const made = await workers.ask({ do: "compile", name: scene.name, structure: USUAL, latticeBits: 24, without: [] });
    await workers.askAll({ do: "load", slot: 1 }, made.bytes);
    compiled.reference = scene.number;
  }
  return 1;
}

/** Paints soon what was drawn so far. */
function paint() {
  at("progress").value = frame.drawn / (frame.width * frame.height);
  if (isPainting) return;
  isPainting = true;
  if (view() === "work") {
    paintWork().catch(showError);
    return;
  }
  requestAnimationFrame(() => {
    isPainting = false;
    // The last of an earlier picture.
    if (finished && view() !== "picture") return;
    show(frame.colors);
    mark("seen");
  });
}

function show(colors) {
  if (colors.length !== at("canvas").width * at("canvas").height) return;
  const pixels = new Uint8ClampedArray(colors.buffer, colors.byteOffset, 4 * colors.length);
  context.putImageData(new ImageData(pixels, at("canvas").width), 0, 0);
}

/** Paints the work so far. */
async function paintWork() {
  const mine = change;
  try {
    const { bytes } = await workers.ask({ do: "heat-map" }, bytesOf(frame.work));
    if (mine !== change || finished) return;
    show(packed(bytes));
  } finally {
    // The first worker draws, too.
    setTimeout(() => { isPainting = false; }, WORK_PAUSE);
  }
}

/** Paints a finished picture as it is looked at. */
async function paintLast() {
  if (!finished) return;
  const mine = finished;
  const isWork = mine.wanted.heatMap;
  if (!isWork && view() === "picture") {
    show(frame.colors);
    return;
  }
  if (!isWork && (!mine.errors || !reference)) return;
  const made = isWork
    ? await workers.ask({ do: "heat-map" }, bytesOf(frame.work))
    : await workers.ask({ do: "difference" }, bytesOf(reference.linear, mine.linear));
  if (finished !== mine) return;
  mine.maximum = made.answer.maximum;
  show(packed(made.bytes));
  describe(mine.chosen, "done");
}

/** Notes when something was first seen, in milliseconds since the page was asked for. */
function mark(what) {
  document.documentElement.dataset[what] ??= Math.round(performance.now());
}

// Words.

function tableKey() {
  return JSON.stringify([scene.number, camera, at("size").value, at("reference").value]);
}

function status(text) {
  at("status").textContent = text;
}

function describe(chosen, state) {
  const done = state === "done";
  const what = { picture: "", work: ", work of each pixel", error: ", error eight times enlarged" }[view()];
  const white = finished?.maximum && view() === "work" ? `: white is ${finished.maximum} tests` : "";
  const errors = done && finished?.errors ? `, RMS error ${errorText(finished.errors.rmse)}` : "";
  const time = done && finished && !finished.wanted.heatMap ? `, ${secondsText(finished.seconds)}` : "";
  const text = `${scene.name}: ${nameOf(chosen, scene)}${what}${white}${time}${errors}`;
  setState(state);
  if (done) {
    status(text);
    at("progress").value = 1;
  }
  at("canvas").setAttribute("aria-label", `Picture of ${text}`);
}

function showError(error) {
  const problem = error instanceof Problem ? error : new Problem({ message: String(error), report: String(error.stack ?? error) });
  at("error-text").textContent = problem.report;
  at("error").hidden = false;
  status(problem.message);
  setState("error");
  at("error").scrollIntoView({ block: "nearest" });
}

// Scenes.

/** Opens files, of which one is the scene. */
async function open(files, main = candidates(files)[0]) {
  if (!main) {
    setState("done");
    return;
  }
  const mine = openings += 1;
  const isStale = () => mine !== openings;
  isOpening = true;
  change += 1;
  workers.stop();
  at("error").hidden = true;
  setState("opening");
  try {
    await workers.ready;
    const opened = await inTurn(() => isStale() || load(files, main, mine));
    if (isStale()) return;
    scene = opened;
    camera = null;
    offer(scene, about);
    at("summary").textContent = "Click into the picture, or give a column and a row.";
    at("explanation").hidden = true;
    document.title = `${scene.name}: what accuracy costs`;
    await cameraText();
    if (isStale()) return;
    isOpening = false;
    update({ moved: true });
  } catch (error) {
    if (isStale()) return;
    isOpening = false;
    // The scene before stays, and so do its files.
    if (scene) await inTurn(() => give(scene.files, scene.files.find(({ path }) => path === scene.name)));
    compiled = { picture: null, reference: null };
    showError(error);
  }
}

/** Hands files to the first worker. */
async function give(files, main) {
  const all = candidates(files);
  at("main-label").hidden = all.length < 2;
  at("main").replaceChildren(...all.map((it) => new Option(it.path, it.path, false, it === main)));
  await workers.ask({ do: "clear-files" });
  for (const { path, bytes } of files) await workers.ask({ do: "add-file", path }, bytes);
}

/** Loads a scene into all workers. */
async function load(files, main, number) {
  await give(files, main);
  const blob = isBlob(main) ? main.bytes : null;
  const opened = { files, name: main.path, blob, bytes: blob, number, warnings: [] };
  const first = blob
    ? (await workers.askAll({ do: "load", slot: 0 }, blob)).answer
    : await firstInfo(opened);
  compiled = { picture: blob ? "blob" : opened.compiled, reference: null };
  return Object.assign(opened, { info: first, first });
}

/** Compiles a scene for the first time. */
async function firstInfo(opened) {
  status(`Reading ${opened.name}`);
  const made = await workers.ask({ do: "compile", name: opened.name, structure: USUAL, latticeBits: 24, without: [] });
  opened.warnings = made.answer.warnings;
  opened.bytes = made.bytes;
  opened.compiled = JSON.stringify([24, USUAL, []]);
  return (await workers.askAll({ do: "load", slot: 0 }, made.bytes)).answer;
}

// The camera.

let isMoving = false;
let waiting = null;

/** Moves the camera; what comes while it moves is added up. */
async function move({ orbit = [0, 0], pan = [0, 0], zoom = 0 }) {
  if (!scene || isOpening) return;
  setState("drawing");
  waiting ??= { orbit: [0, 0], pan: [0, 0], zoom: 0 };
  for (const axis of [0, 1]) {
    waiting.orbit[axis] += orbit[axis];
    waiting.pan[axis] += pan[axis];
  }
  waiting.zoom += zoom;
  if (isMoving) return;
  isMoving = true;
  try {
    while (waiting) {
      const by = waiting;
      waiting = null;
      const { answer } = await workers.ask({ do: "move", slot: 0, camera, ...by });
      ({ camera } = answer);
      at("camera").textContent = answer.toml;
      update({ moved: true });
    }
  } catch (error) {
    showError(error);
  } finally {
    isMoving = false;
  }
}

async function home() {
  camera = null;
  await cameraText();
  update({ moved: true });
}

async function cameraText() {
  at("camera").textContent = (await workers.ask({ do: "move", slot: 0, camera: null })).answer.toml;
}

/** What letters do. */
const actions = {
  r: home,
  f: () => {
    const formats = [...document.querySelectorAll("[name=format]")];
    formats[(formats.findIndex((it) => it.checked) + 1) % formats.length].checked = true;
    update();
  },
  a: () => {
    cycle(at("structure"));
    update();
  },
  m: () => step(at("samples"), 1) && update(),
  l: () => step(at("samples"), -1) && update(),
  c: () => {
    const other = view() === "work" ? "picture" : "work";
    document.querySelector(`[name=view][value=${other}]`).checked = true;
    update();
  },
};

// Explanations, boards, files.

async function explain(x, y) {
  if (!scene) return;
  const [width, height] = size();
  const pixel = [Math.min(x, width - 1), Math.min(y, height - 1)];
  [at("pixel-x").value, at("pixel-y").value] = pixel;
  try {
    const { answer } = await workers.ask({ do: "explain", shot: shot(settings()), pixel });
    at("summary").textContent = answer.summary;
    at("explanation").textContent = answer.text;
    at("explanation").hidden = false;
  } catch (error) {
    showError(error);
  }
}

/** Shows what the scene takes on a board. */
async function memory() {
  const name = at("board").value;
  if (!scene || !name) return;
  try {
    const request = { do: "memory", board: name, format: at("board-format").value || null };
    if (!scene.blob) {
      const { bits, structure, without } = settings();
      const measured = about.boardStructures.includes(structure) ? structure : USUAL;
      request.compile = { name: scene.name, structure: measured, latticeBits: bits, without };
    }
    const { answer } = await workers.ask(request);
    const { structure, format } = answer.report;
    at("fits").textContent = answer.fits ? `The scene fits on ${name}, through ${structure} in ${format}.`
      : `${answer.why[0].toUpperCase()}${answer.why.slice(1)}.`;
    at("memory").textContent = answer.text;
    at("memory").hidden = false;
  } catch (error) {
    at("fits").textContent = error.help ? `${error.message}: ${error.help}.` : error.message;
    at("memory").hidden = true;
  }
}

const stem = () => scene.name.split("/").at(-1).replace(/\.gz$/, "").replace(/\.[^.]*$/, "");

async function savePicture() {
  if (!finished) return;
  const { width, height } = finished.wanted;
  const made = await workers.ask({ do: "png", width, height }, bytesOf(finished.linear));
  save(`${stem()}.png`, made.bytes, "image/png");
}

// Measuring.

async function measure() {
  const first = settings();
  const isBlobs = scene.blob && ["bits", "effects"].includes(at("sweep").value);
  if (isBlobs) {
    status("A blob has its lattice bits and effects: open its scene file to change them.");
    return;
  }
  at("measure").disabled = true;
  document.querySelector("[name=view][value=picture]").checked = true;
  try {
    for (const chosen of sweep(at("sweep").value, first, scene, about)) {
      choose(chosen);
      const before = change + 1;
      await update();
      // Somebody changed something: that comes first.
      if (change !== before) return;
    }
    choose(first);
    await update();
  } finally {
    at("measure").disabled = false;
  }
}

function use(chosen) {
  choose(chosen);
  update();
}

// The start.

async function openSample() {
  setState("opening");
  const name = at("sample").value;
  const answer = await fetch(`scenes/${name}`);
  if (!answer.ok) throw new Error(`scenes/${name}: ${answer.status}`);
  await open([{ path: name, bytes: new Uint8Array(await answer.arrayBuffer()) }]);
}

async function start() {
  const sample = fetch(`scenes/${at("sample").value}`).then((it) => it.arrayBuffer());
  await workers.ready;
  about = (await workers.ask({ do: "about" })).answer;
  offerAll(about);
  connect();
  await open([{ path: at("sample").value, bytes: new Uint8Array(await sample) }]);
}

function connect() {
  const guarded = (action) => (...given) => Promise.resolve(action(...given)).catch(showError);
  at("sample").onchange = guarded(openSample);
  at("files").onchange = guarded(async ({ target }) => {
    setState("opening");
    const files = await fromList(target.files);
    // The same file can be chosen again after a change.
    target.value = "";
    await open(files);
  });
  at("main").onchange = () => open(scene.files, scene.files.find(({ path }) => path === at("main").value));
  at("settings").onsubmit = (event) => event.preventDefault();
  at("settings").onchange = () => update();
  at("bits").oninput = () => { at("bits-shown").textContent = at("bits").value; };
  for (const radio of document.querySelectorAll("[name=view]")) {
    radio.onchange = () => {
      const isDrawn = finished && finished.wanted.heatMap === (view() === "work");
      if (isDrawn) paintLast().then(() => describe(finished.chosen, "done"));
      else update();
    };
  }
  at("home").onclick = guarded(home);
  at("measure").onclick = guarded(measure);
  at("explain").onclick = () => explain(Number(at("pixel-x").value), Number(at("pixel-y").value));
  at("board").onchange = () => {
    offerFormats(about);
    memory();
  };
  at("board-format").onchange = () => memory();
  at("save-blob").onclick = () => scene && save(`${stem()}.gridel`, scene.bytes, "application/octet-stream");
  at("save-picture").onclick = guarded(savePicture);
  at("save-memory").onclick = () => save(`${stem()}-${at("board").value}.txt`, at("memory").textContent, "text/plain");
  at("error-close").onclick = () => { at("error").hidden = true; };
  listen(at("canvas"), { move, click: explain, key: (event) => press(event, move, actions) });
  const drop = at("drop");
  addEventListener("dragover", (event) => {
    event.preventDefault();
    drop.hidden = false;
  });
  addEventListener("dragleave", (event) => { if (!event.relatedTarget) drop.hidden = true; });
  addEventListener("drop", guarded(async (event) => {
    event.preventDefault();
    drop.hidden = true;
    setState("opening");
    await open(await fromDrop(event.dataTransfer));
  }));
}

start().catch(showError);
