// What the workers hold: the files of a scene, its blob, and that of the reference.

import { USUAL, at, settings, showWarnings } from "./controls.js";
import { inTurn, state, status, workers } from "./state.js";

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

/** Hands the files of a scene to the first worker, which reads them when it compiles. */
async function give(scene) {
  if (held.files === scene.number) return;
  held.files = null;
  await workers.ask({ do: "clear-files" });
  if (!scene.blob) {
    for (const { path, bytes } of scene.files) await workers.ask({ do: "add-file", path }, bytes);
  }
  held.files = scene.number;
}

/** Compiles a scene for all workers, unless that was done. Call it in turn. */
export async function compile(scene, chosen) {
  const request = compileOf(scene, chosen);
  const key = JSON.stringify([scene.number, request]);
  if (held.picture === key && held.files === scene.number) return;
  workers.stop();
  await give(scene);
  if (scene.key !== key) {
    if (request) status(`Compiling ${scene.name}`);
    const made = request ? await workers.ask({ do: "compile", ...request }) : { bytes: scene.blob, answer: {} };
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
  showWarnings(scene.warnings);
  at("camera-note").hidden = scene.hasOwnLight;
}

/** The place of the scene with all bits and effects; a blob is what it is. Call it in turn. */
export async function referenceSlot(scene) {
  if (scene.blob) return 0;
  if (held.reference !== scene.number) {
    await give(scene);
    const made = await workers.ask({ do: "compile", name: scene.name, structure: USUAL, latticeBits: 24, without: [] });
    held.reference = null;
    await workers.askAll({ do: "load", slot: 1 }, made.bytes);
    held.reference = scene.number;
  }
  return 1;
}

/** Asks the first worker about the scene as the controls say, once it is open and compiled. */
export async function askCompiled(request) {
  while (state.opening) await state.opening;
  return inTurn(async () => {
    if (!state.scene) return null;
    await compile(state.scene, settings());
    return request ? workers.ask(request()) : null;
  });
}

/** Asks the first worker about the blob that the workers hold. */
export function askLoaded(request) {
  return inTurn(async () => {
    if (!held.picture?.startsWith(`[${state.scene.number},`)) await compile(state.scene, settings());
    return workers.ask(request());
  });
}
