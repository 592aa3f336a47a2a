// The picture: drawn, compared, painted.

import { USUAL, at, choose, count, nameOf, settings, view } from "./controls.js";
import { Table, bytesText, errorText, secondsText, shareText } from "./table.js";
import { bytesOf, packed } from "./workers.js";
import { compile, giveUpFor, referenceSlot } from "./loading.js";
import {
  checkSize, describe, frameOf, inTurn, mark, setDone, setState, settlePicture, shareOf, shot, showError, sizeOf, state, statusDuring,
  workers,
} from "./state.js";
import { clearStale, memory } from "./reports.js";

const context = at("canvas").getContext("2d", { alpha: false, willReadFrequently: true });
const table = new Table(at("rows"), (chosen) => {
  choose(chosen);
  update();
});

/** Between paintings of work that is not finished, in milliseconds. */
const WORK_PAUSE = 400;
/** Between paintings, pixels of a picture per millisecond. */
const PIXELS_PER_PAUSE = 100_000;

let isPainting = false;
/** The colors that the canvas shows, but for rows that were drawn since. */
let painted = null;

/** Shows what the controls say. Errors of another scene can be left on the page. */
export async function update({ moved = false, keepsError = false } = {}) {
  // A scene that is opened will be shown with what the controls say then.
  if (!state.scene || state.opening) return;
  const { scene } = state;
  const mine = state.change += 1;
  const isStale = () => mine !== state.change;
  state.finished = null;
  if (!keepsError) at("error").hidden = true;
  setState("drawing");
  clearFigures();
  clearStale();
  state.wanted = null;
  try {
    const chosen = settings();
    giveUpFor(scene, chosen, isStale);
    await inTurn(() => isStale() || compile(scene, chosen));
    if (isStale()) return;
    const wanted = state.wanted = { ...shot(chosen), heatMap: view() === "work" };
    if (moved || table.key !== tableKey()) table.clear(tableKey());
    resize(scene);
    [at("pixel-x").max, at("pixel-y").max] = [wanted.width - 1, wanted.height - 1];
    describe(chosen, "drawing");
    const seconds = await workers.draw(wanted, state.frame, { onchange: paint });
    if (isStale() || seconds === undefined) return;
    mark("picture");
    state.finished = { chosen, wanted, seconds, linear: state.frame.linear };
    settlePicture(true);
    // Counting takes time.
    if (!wanted.heatMap) at("time").textContent = secondsText(seconds);
    at("bytes").textContent = bytesText(scene.info.bytes);
    await paintLast();
    memory();
    if (!wanted.heatMap) await compare(chosen, isStale);
    if (isStale()) return;
    describe(chosen, "done");
  } catch (error) {
    if (isStale()) return;
    // The error that came first says more.
    if (keepsError && !at("error").hidden) setDone();
    else showError(error);
  }
}

/** Makes room for the picture of a scene. Throws, and leaves all as it is, if there is none. */
export function resize(scene) {
  const { canvas } = context;
  const scale = Number(at("size").value);
  checkSize(scene, scale);
  const [width, height] = sizeOf(scene.info, scale);
  if (state.frame.width !== width || state.frame.height !== height) {
    state.frame = frameOf([width, height]);
    [canvas.width, canvas.height] = [width, height];
  }
  canvas.style.setProperty("--shape", width / height);
}

/** Forgets what was measured for another picture. */
function clearFigures() {
  for (const id of ["rmse", "largest", "different", "time", "bytes"]) at(id).textContent = "-";
  at("reference-text").textContent = "";
}

/** Draws the reference, unless it is there, and compares. */
async function compare(chosen, isStale) {
  const { scene, finished: picture } = state;
  const samples = at("reference").value === "same" ? chosen.samples : Number(at("reference").value);
  const depth = Math.max(chosen.depth, scene.first.depth);
  const slot = await inTurn(() => isStale() || referenceSlot(scene));
  if (isStale()) return;
  const wanted = { ...shot(chosen), slot, format: "f64", structure: scene.blob ? chosen.structure : USUAL, samples, depth };
  const key = JSON.stringify([scene.number, wanted]);
  if (state.reference?.key !== key) {
    state.reference = null;
    const drawn = frameOf([wanted.width, wanted.height]);
    statusDuring(`Drawing the reference, ${count(samples, "sample")}`, () => shareOf(drawn));
    const onchange = () => { at("progress").value = shareOf(drawn); };
    const seconds = await workers.draw(wanted, drawn, { onchange, isBackground: true });
    if (isStale() || seconds === undefined) return;
    state.reference = { key, linear: drawn.linear, seconds };
  }
  const { reference } = state;
  const both = bytesOf(reference.linear, picture.linear);
  const { answer } = await workers.ask({ do: "errors" }, both);
  if (isStale()) return;
  const bits = scene.blob ? scene.info.latticeBits : 24;
  const [blob, effects] = scene.blob ? ["the blob itself in ", ""] : ["", ", all effects"];
  at("reference-text").textContent = `Reference: ${blob}f64, ${bits} lattice bits${effects}, ${count(samples, "sample")} per pixel, ` +
    `depth ${depth}; it took ${secondsText(reference.seconds)}.`;
  at("rmse").textContent = errorText(answer.rmse);
  at("largest").textContent = errorText(answer.largest);
  at("different").textContent = shareText(answer.share);
  table.add({ chosen, name: nameOf(chosen, scene), ...answer, seconds: picture.seconds, bytes: scene.info.bytes });
  picture.errors = answer;
  await paintLast();
}

function tableKey() {
  return JSON.stringify([state.scene.number, state.camera, at("size").value, at("reference").value]);
}

/** Paints soon what was drawn so far. */
function paint() {
  at("progress").value = shareOf(state.frame);
  if (isPainting) return;
  isPainting = true;
  if (view() === "work") {
    paintWork().catch(showError);
    return;
  }
  requestAnimationFrame(() => {
    // Browsers copy the whole canvas for each painting.
    setTimeout(() => { isPainting = false; }, state.frame.colors.length / PIXELS_PER_PAUSE);
    // The last of an earlier picture.
    if (state.finished && view() !== "picture") return;
    show(state.frame.colors, state.frame.changed());
    mark("seen");
  });
}

/** Shows colors: all, or the rows that changed if it shows the others. */
function show(colors, rows) {
  const { width, height } = context.canvas;
  if (colors.length !== width * height) return;
  const [first, end] = painted === colors && rows ? rows : [0, height];
  painted = colors;
  if (first >= end) return;
  const pixels = new Uint8ClampedArray(colors.buffer, colors.byteOffset, 4 * colors.length);
  context.putImageData(new ImageData(pixels, width), 0, 0, 0, first, width, end - first);
}

/** Paints the work so far. */
async function paintWork() {
  const mine = state.change;
  try {
    const { bytes } = await workers.ask({ do: "heat-map" }, bytesOf(state.frame.work));
    if (mine !== state.change || state.finished) return;
    show(packed(bytes));
  } finally {
    // The first worker draws, too.
    setTimeout(() => { isPainting = false; }, WORK_PAUSE);
  }
}

/** Paints a finished picture as it is looked at, and returns true; false if what that needs is not there. */
async function paintLast() {
  const { finished: mine, frame, reference } = state;
  if (!mine) return false;
  const isWork = mine.wanted.heatMap;
  if (!isWork && view() === "picture") {
    show(frame.colors, frame.changed());
    return true;
  }
  if (!isWork && (!mine.errors || !reference)) return false;
  const made = isWork
    ? await workers.ask({ do: "heat-map" }, bytesOf(frame.work))
    : await workers.ask({ do: "difference" }, bytesOf(reference.linear, mine.linear));
  if (state.finished !== mine) return false;
  mine.maximum = made.answer.maximum;
  show(packed(made.bytes));
  describe(mine.chosen, "done");
  return true;
}

/** Returns true while a picture is drawn, or a scene compiled for it, that shows the view as well. */
function isDrawn() {
  const isWork = view() === "work";
  return !state.finished && document.documentElement.dataset.state === "drawing"
    && (state.wanted?.heatMap ?? isWork) === isWork;
}

/** Shows the picture in another view. */
export async function look() {
  // Picture and error have the same pixels.
  if (isDrawn()) return;
  const { finished } = state;
  if (!finished || finished.wanted.heatMap !== (view() === "work")) {
    await update();
    return;
  }
  const isPainted = await paintLast();
  // While the reference is drawn there are no errors yet, and the status line says so.
  const isWhole = finished.errors || finished.wanted.heatMap;
  if (isPainted && isWhole && state.finished === finished) describe(finished.chosen, "done");
}
