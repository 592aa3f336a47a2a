// Opens scenes. One that cannot be opened leaves the scene before as it was.

import { USUAL, at, offer } from "./controls.js";
import { candidates, isBlob } from "./files.js";
import { Abandoned, Problem } from "./workers.js";
import { inTurn, setState, settlePicture, showError, state, statusDuring, workers } from "./state.js";
import { compile, forget, giveUp, showCompiled } from "./loading.js";
import { bytesText } from "./table.js";
import { clearStale } from "./reports.js";
import { home } from "./camera.js";
import { resize, update } from "./picture.js";

/** Counts files that are opened, of which the last one is shown. */
let openings = 0;
/** What was opened while this one is, and is opened after all if this one cannot be. */
let current = null;
let before = null;
/** The files of which one can be chosen: those that were opened last, also if their first scene is broken. */
let offered = [];

/** Settles when there is a list of what can be chosen. */
let start;
export const started = new Promise((resolve) => { start = resolve; });
export { start };

/** Opens files, of which one is the scene; `read` may be a promise of them. Errors of another can be left on the page. */
export async function open(read, { main, sample, keepsError = false } = {}) {
  const mine = openings += 1;
  const isStale = () => mine !== openings;
  if (current) before = current;
  const what = current = { read, main, sample };
  let settle;
  state.opening = new Promise((resolve) => { settle = resolve; });
  const own = state.opening;
  state.change += 1;
  workers.stop();
  giveUp();
  settlePicture(false);
  statusDuring("Reading files");
  if (!keepsError) at("error").hidden = true;
  setState("opening");
  try {
    const files = await read;
    await started;
    if (!isStale()) rejectSame(files);
    what.files = files;
    const opened = isStale() ? null : await inTurn(() => isStale() ? null : load(files, main, sample, mine));
    if (isStale()) return;
    // Before it takes the place of the scene before.
    resize(opened);
    [current, before] = [null, null];
    Object.assign(state, { scene: opened, opening: null, finished: null });
    offer(opened, state.about, state.kept);
    state.kept.clear();
    showCompiled(opened);
    showChosen(files);
    clearStale();
    document.title = `${opened.name}: what accuracy costs`;
    home({ keepsError });
  } catch (error) {
    if (before === what && !(error instanceof Abandoned)) before = null;
    if (isStale()) return;
    current = null;
    showError(error);
    setState("opening");
    await restore(what.files);
  } finally {
    if (state.opening === own) state.opening = null;
    settle();
  }
}

/** Shows again what was shown, or was being opened, before what cannot be opened. */
async function restore(files) {
  state.opening = null;
  if (before) {
    const { read, main, sample } = before;
    before = null;
    open(read, { main, sample, keepsError: true });
    return;
  }
  state.kept.clear();
  showChosen(files);
  await inTurn(forget);
  // Without a scene nothing is drawn.
  if (state.scene) update({ keepsError: true });
  else setState("error");
}

/** Loads a scene into all workers. */
async function load(files, main = candidates(files)[0], sample, number) {
  if (!main) {
    throw Problem.of("there are no files to open: the folder is empty", "open a scene file and the files that it names, or a blob");
  }
  if (main.problem) throw main.problem;
  const begun = performance.now();
  const opened = { files, main, sample, name: main.path, number, blob: isBlob(main) ? main.bytes : null };
  try {
    await compile(opened, { bits: 24, structure: USUAL, without: [] });
  } catch (error) {
    // Why a file that it names is not there.
    const lacks = ({ path, problem }) => problem && error.report?.includes(path.split("/").at(-1));
    for (const { problem } of files.filter(lacks)) error.report += `\n${problem.report}`;
    throw error;
  }
  opened.first = opened.info;
  // It was compiled as the reference is.
  opened.reference = opened.bytes;
  opened.time = performance.now() - begun;
  return opened;
}

/** Throws if two files have the same path: scenes name files by it. */
function rejectSame(files) {
  const sizes = new Map();
  for (const { path, bytes } of files) {
    const size = bytes ? bytesText(bytes.length) : "unreadable";
    if (sizes.has(path)) {
      const both = [sizes.get(path), size].map((it) => `${path} (${it})`).join(" and ");
      throw Problem.of(`two files have the same name: ${both}`, "open one of them, or rename one");
    }
    sizes.set(path, size);
  }
}

/** Shows which sample and which file was chosen, and offers the scenes of files that were opened. */
function showChosen(opened = []) {
  const { files = [], main, sample } = state.scene ?? {};
  // Without one, each sample can be chosen.
  at("sample").value = sample ?? "";
  offered = candidates(opened).length > 1 ? opened : files;
  const all = candidates(offered);
  const isListed = all.length > 1 && all.includes(main);
  at("scene-name").hidden = !main || Boolean(sample) || isListed;
  at("scene-name").textContent = `File: ${main?.path}`;
  at("main-label").hidden = all.length < 2;
  const none = Object.assign(new Option("choose a scene", ""), { hidden: true });
  at("main").replaceChildren(...all.map((it) => new Option(it.path, it.path)), none);
  at("main").value = isListed ? main.path : "";
}

/** Opens the file that is chosen among several. */
export function openMain() {
  return open(offered, { main: offered.find(({ path }) => path === at("main").value) });
}

/** Opens the sample that is chosen. */
export function openSample() {
  const sample = at("sample").value;
  return open(fetched(sample), { sample });
}

async function fetched(name) {
  const remedy = "build the page again with `just web`, and serve its whole folder";
  const answer = await fetch(`scenes/${name}`).catch((error) => {
    throw Problem.of(`scenes/${name} cannot be loaded: ${error.message}`, "start the server of the page again");
  });
  if (!answer.ok) throw Problem.of(`scenes/${name} cannot be loaded: ${answer.status} ${answer.statusText}`, remedy);
  return [{ path: name, bytes: new Uint8Array(await answer.arrayBuffer()) }];
}
