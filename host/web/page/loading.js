// What the workers hold: the files of a scene, its blob, and that of the reference.

import { at, settings, showWarnings } from "./controls.js";
import { inTurn, state, statusDuring, statusWaiting, workers } from "./state.js";
import { Abandoned } from "./workers.js";

/** Which scene's files the first worker holds, and what the blobs of all workers were compiled with. */
let held;
export function forget() {
  held = { files: null, picture: null, reference: null };
}
forget();
workers.onlost = forget;

/** How a scene is compiled; nothing for a blob. */
export function compileOf(scene, { bits, structure, without }) {
  return scene.blob ? undefined : { name: scene.name, structure, latticeBits: bits, without };
}

function keyOf(scene, chosen) {
  return JSON.stringify([scene.number, compileOf(scene, chosen)]);
}

/** What the first worker does that may take long: for which scene and settings, and since when. */
let job = null;

/** Asks the first worker for what may take long, and may be given up. Call it in turn. */
async function askLong(key, request) {
  job = { key, begun: performance.now() };
  try {
    return await workers.ask(request);
  } finally {
    job = null;
  }
}

/** Gives up what the first worker compiles. */
export function giveUp() {
  if (job) workers.restart();
}

/** Gives up what the first worker compiles for other settings, once that has taken as long as opening the scene did. */
export function giveUpFor(scene, chosen, isStale) {
  const other = job;
  if (!other || other.key === keyOf(scene, chosen)) return;
  // The new worker reads the scene again.
  const wait = other.begun + scene.time - performance.now();
  setTimeout(() => { if (job === other && !isStale()) giveUp(); }, Math.max(0, wait));
}

/** Says what waits, if it waits for the compiler. */
export function saying(note, work) {
  return job || state.opening ? statusWaiting(note, work) : work;
}

/** Hands the files of a scene to the first worker, which reads them when it compiles. */
async function give(scene) {
  if (held.files === scene.number) return;
  held.files = null;
  await workers.ask({ do: "clear-files" });
  if (!scene.blob) {
    for (const { path, bytes } of scene.files) if (bytes) await workers.ask({ do: "add-file", path }, bytes);
  }
  held.files = scene.number;
}

/** Compiles a scene for all workers, unless that was done. Call it in turn. */
export async function compile(scene, chosen) {
  const request = compileOf(scene, chosen);
  const key = keyOf(scene, chosen);
  if (held.picture === key && held.files === scene.number) return;
  workers.stop();
  await give(scene);
  if (scene.key !== key) {
    if (request) statusDuring(`Compiling ${scene.name}`);
    const made = request ? await askLong(key, { do: "compile", ...request }) : { bytes: scene.blob, answer: {} };
    Object.assign(scene, { warnings: [], hasOwnLight: true }, made.answer, { key, bytes: made.bytes });
  }
  held.picture = null;
  const { answer } = await workers.askAll({ do: "load", slot: 0, name: scene.blob ? scene.name : undefined }, scene.bytes);
  scene.info = answer;
  held.picture = key;
  if (scene === state.scene) showCompiled(scene);
}

/** Shows what the compiler says of a scene. */
export function showCompiled(scene) {
  const unread = scene.files.filter((it) => it.problem);
  showWarnings([...scene.warnings, ...unread.map((it) => `${it.problem.message}; it is left out`)]);
  at("camera-note").hidden = scene.hasOwnLight;
}

/** The place of the scene with all bits and effects; a blob is what it is. Call it in turn. */
export async function referenceSlot(scene) {
  if (scene.blob) return 0;
  if (held.reference !== scene.number) {
    held.reference = null;
    await workers.askAll({ do: "load", slot: 1 }, scene.reference);
    held.reference = scene.number;
  }
  return 1;
}

/** Does something with the scene in turn, and again if it was given up; null if another scene is opened meanwhile. */
async function withScene(work) {
  while (state.opening) await state.opening;
  const { scene } = state;
  while (scene && scene === state.scene) {
    try {
      return await inTurn(() => {
        if (state.opening) throw new Abandoned("another scene is opened");
        return work(scene);
      });
    } catch (error) {
      if (!(error instanceof Abandoned)) throw error;
    }
    while (state.opening) await state.opening;
  }
  return null;
}

/** Asks the first worker about the scene as the controls say, once it is compiled; without a request, returns the scene. */
export function askCompiled(request) {
  return withScene(async (scene) => {
    const chosen = settings();
    await compile(scene, chosen);
    return request ? askLong(keyOf(scene, chosen), request()) : scene;
  });
}

/** Asks the first worker about the blob that the workers hold. */
export function askLoaded(request, bytes) {
  return withScene(async (scene) => {
    if (!held.picture?.startsWith(`[${scene.number},`)) await compile(scene, settings());
    return workers.ask(request(), bytes);
  });
}
