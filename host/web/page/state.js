// What the page shows, which its parts share, and how they say it.

import { Abandoned, Frame, Problem, Workers } from "./workers.js";
import { at, count, nameOf, settings, view } from "./controls.js";
import { errorText, secondsText } from "./table.js";

export const state = {
  /** What there is to choose from. */
  about: null,
  /** The scene that is shown: files, the name of the main one, what its blob says of itself. */
  scene: null,
  /** The camera that was moved; the scene's own without one. */
  camera: null,
  frame: new Frame(400, 300),
  /** The reference that was drawn last, and what it was drawn with. */
  reference: null,
  /** The picture that is drawn; null while the scene is compiled for it. */
  wanted: null,
  /** The picture that was finished last, with what was measured. */
  finished: null,
  /** Counts changes: work for an earlier one is given up. */
  change: 0,
  /** Settles when the files that are being opened are shown, or cannot be; null if none are. */
  opening: null,
  /** The settings that were chosen while files are opened, which the new scene keeps. */
  kept: new Set(),
  /** Takes whether a picture was finished, for what waits for one; null if nothing does. */
  onpicture: null,
};

const module = WebAssembly.compileStreaming(fetch("gridel.wasm")).catch(async () =>
  // A server may not know the type of such files.
  WebAssembly.compile(await (await fetch("gridel.wasm")).arrayBuffer()));
export const workers = new Workers(module, Math.max(1, Math.min(8, navigator.hardwareConcurrency || 2)));

/** What loads blobs goes one after the other. */
let queue = Promise.resolve();
export function inTurn(work) {
  const done = queue.then(work);
  queue = done.catch(() => {});
  return done;
}

export function setState(name) {
  document.documentElement.dataset.state = name;
}

/** All is done; an error that is still shown is one. */
export function setDone() {
  setState(at("error").hidden ? "done" : "error");
}

/** Notes when something was first seen, in milliseconds since the page was asked for. */
export function mark(what) {
  document.documentElement.dataset[what] ??= Math.round(performance.now());
}

// The status line. A screen reader reads each of its texts.

/** Work is first announced after this time, in milliseconds: most of it is done sooner. */
const FIRST_STATUS = 300;
/** Between two shares of the same work, in milliseconds. */
const STATUS_PAUSE = 5000;

let said = "Loading";
const notes = new Set();
let progress = null;
let timer = null;

function say(text = said) {
  said = text;
  at("status").textContent = [text, ...notes].join(". ");
}

/** Says what is shown, or what went wrong. */
export function status(text) {
  clearTimeout(timer);
  progress = timer = null;
  say(text);
}

/** Says what is being done, and every few seconds its share. */
export function statusDuring(what, share = () => 0) {
  const isSame = progress?.what === what;
  progress = { what, share };
  if (isSame) {
    // The share that is shown is another picture's.
    if (said.startsWith(`${what}: `)) say(what);
    return;
  }
  clearTimeout(timer);
  const tell = () => {
    const percent = Math.floor(100 * progress.share());
    say(percent > 0 ? `${what}: ${percent} %` : what);
    timer = setTimeout(tell, STATUS_PAUSE);
  };
  timer = setTimeout(tell, FIRST_STATUS);
}

/** Says what waits, until it is done. */
export async function statusWaiting(note, work) {
  notes.add(note);
  say();
  try {
    return await work;
  } finally {
    notes.delete(note);
    say();
  }
}

/** Answers what waits for a picture. */
export function settlePicture(isFinished) {
  state.onpicture?.(isFinished);
  state.onpicture = null;
}

/** Says what is drawn, or was. */
export function describe(chosen, name) {
  const { scene, finished } = state;
  const done = name === "done";
  const what = { picture: "", work: ", work of each pixel", error: ", error eight times enlarged" }[view()];
  const white = finished?.maximum && view() === "work" ? `: white is ${finished.maximum} tests` : "";
  const errors = done && finished?.errors ? `, RMS error ${errorText(finished.errors.rmse)}` : "";
  const time = done && finished && !finished.wanted.heatMap ? `, ${secondsText(finished.seconds)}` : "";
  const text = `${scene.name}: ${nameOf(chosen, scene)}${what}${white}${time}${errors}`;
  if (done) {
    status(text);
    at("progress").value = 1;
    setDone();
  } else {
    setState(name);
    statusDuring(`Drawing, ${count(chosen.samples, "sample")}`, () => shareOf(state.frame));
  }
  at("canvas").setAttribute("aria-label", `Picture of ${text}`);
}

/** The share of a frame's pixels that is drawn. */
export function shareOf({ drawn, width, height }) {
  return drawn / (width * height);
}

/** Shows an error of the program, or a fault of the page. */
export function showError(error) {
  // What was given up has something else in its place.
  if (error instanceof Abandoned) return;
  settlePicture(false);
  let problem = error;
  if (error instanceof RangeError || error?.name === "DataCloneError") {
    problem = Problem.of(`the browser has not enough memory for this: ${error.message}`,
      "choose a smaller picture or smaller files, or use the program");
  } else if (!(error instanceof Problem)) {
    problem = new Problem({ message: String(error), report: String(error.stack ?? error) });
  }
  at("error-text").textContent = problem.report;
  // Marks below an excerpt stay in their columns.
  at("error-text").classList.toggle("excerpt", problem.report.includes("╭"));
  at("error").hidden = false;
  status(problem.message);
  setState("error");
  at("error").scrollIntoView({ block: "nearest" });
}

workers.onfault = showError;

// Sizes.

/** Pixels of a picture that browsers have the memory for. */
const MOST_PIXELS = 2 ** 26;
/** A side that a request can state. */
const MOST_SIDE = 2 ** 16 - 1;

export function sizeOf({ width, height }, scale) {
  return [width, height].map((side) => Math.max(1, Math.round(side * scale)));
}

export function size() {
  return sizeOf(state.scene.info, Number(at("size").value));
}

/** Throws if the picture of a scene is larger than browsers can show. */
export function checkSize(scene, scale) {
  const { width, height } = scene.info;
  const fits = (by) => {
    const [columns, rows] = sizeOf(scene.info, by);
    return columns * rows <= MOST_PIXELS && Math.max(columns, rows) <= MOST_SIDE;
  };
  if (fits(scale)) return;
  const how = scale < 1 ? ", even at half its size" : scale > 1 ? " at double its size" : "";
  const again = scene === state.scene ? "" : " and open it again";
  throw Problem.of(`the picture of ${scene.name}, ${width} x ${height} pixels, is too large for browsers${how}: 2^26 pixels are the most`,
    `${fits(0.5) ? `choose half as its size${again}, or ` : ""}render it with the program: \`gridel render\``);
}

/** A frame of a size. */
export function frameOf([width, height]) {
  try {
    return new Frame(width, height);
  } catch {
    throw Problem.of(`this browser has no memory for a picture of ${width} x ${height} pixels`,
      "choose half as its size, or render it with the program: `gridel render`");
  }
}

/** A picture as requests state it. */
export function shot({ format, structure, samples, depth } = settings()) {
  const [width, height] = size();
  return { slot: 0, camera: state.camera, format, structure, width, height, samples, depth, heatMap: false };
}
