// Opens scenes. One that cannot be opened leaves the scene before as it was.

import { USUAL, at, offer } from "./controls.js";
import { candidates, isBlob } from "./files.js";
import { Abandoned, Problem } from "./workers.js";
import { checkSize, inTurn, setState, settlePicture, showError, sizeOf, state, statusDuring, workers } from "./state.js";
import { compile, forget, giveUp, showCompiled } from "./loading.js";
import { bytesText } from "./table.js";
import { clearStale } from "./reports.js";
import { home } from "./camera.js";
import { update } from "./picture.js";

/** Counts files that are opened, of which the last one is shown. */
let openings = 0;
/** What was opened while this one is, and is opened after all if this one cannot be. */
let current = null;
let before = null;

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
    const opened = isStale() ? null : await inTurn(() => isStale() ? null : load(files, main, sample, mine));
    if (isStale()) return;
    [current, before] = [null, null];
    Object.assign(state, { scene: opened, opening: null, finished: null });
    offer(opened, state.about);
    showCompiled(opened);
    showChosen();
    clearStale();
    document.title = `${opened.name}: what accuracy costs`;
    home({ keepsError });
  } catch (error) {
    if (before === what && !(error instanceof Abandoned)) before = null;
    if (isStale()) return;
    current = null;
    showError(error);
    setState("opening");
    await restore();
  } finally {
    if (state.opening === own) state.opening = null;
    settle();
  }
}

/** Shows again what was shown, or was being opened, before what cannot be opened. */
async function restore() {
  state.opening = null;
  if (before) {
    const { read, main, sample } = before;
    before = null;
    open(read, { main, sample, keepsError: true });
    return;
  }
  showChosen();
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
  rejectSame(files);
  const begun = performance.now();
  const opened = { files, main, sample, name: main.path, number, blob: isBlob(main) ? main.bytes : null };
  await compile(opened, { bits: 24, structure: USUAL, without: [] });
  opened.first = opened.info;
  // It was compiled as the reference is.
  opened.reference = opened.bytes;
  opened.time = performance.now() - begun;
  checkSize(sizeOf(opened.info, 0.5), false);
  return opened;
}

/** Throws if two files have the same path: scenes name files by it. */
function rejectSame(files) {
  const sizes = new Map();
  for (const { path, bytes } of files) {
    if (sizes.has(path)) {
      const both = [sizes.get(path), bytes.length].map((it) => `${path} (${bytesText(it)})`).join(" and ");
      throw Problem.of(`two files have the same name: ${both}`, "open one of them, or rename one");
    }
    sizes.set(path, bytes.length);
  }
}

/** Shows which sample and which file was chosen. */
function showChosen() {
  const { files = [], main, sample } = state.scene ?? {};
  // Without one, each sample can be chosen.
  at("sample").value = sample ?? "";
  const all = candidates(files);
  at("scene-name").hidden = !main || Boolean(sample) || all.length > 1;
  at("scene-name").textContent = `File: ${main?.path}`;
  at("main-label").hidden = all.length < 2;
  at("main").replaceChildren(...all.map((it) => new Option(it.path, it.path, false, it === main)));
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
