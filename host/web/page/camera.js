// The camera.

import { at } from "./controls.js";
import { setState, showError, state } from "./state.js";
import { askLoaded, saying } from "./loading.js";
import { update } from "./picture.js";

let isMoving = false;
let waiting = null;
/** The page's state before a move, and the change that it belongs to: a move without effect returns to it. */
let before = null;
/** Counts returns to a first camera: moves from before them do not count. */
let returns = 0;

/** Moves the camera; what comes while it moves is added up. */
export async function move({ orbit = [0, 0], pan = [0, 0], zoom = 0 }) {
  if (!state.scene || state.opening) return;
  const { state: now } = document.documentElement.dataset;
  if (now !== "drawing") before = { state: now, change: state.change };
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
      await turn(by);
    }
    if (before?.change === state.change) setState(before.state);
  } catch (error) {
    waiting = null;
    showError(error);
  } finally {
    isMoving = false;
    before = null;
  }
}

/** Returns to the scene's own camera. */
export async function home({ keepsError = false } = {}) {
  if (!state.scene || state.opening) return;
  returns += 1;
  waiting = null;
  state.camera = null;
  update({ moved: true, keepsError });
  try {
    await turn({}, { isHome: true });
  } catch (error) {
    showError(error);
  }
}

async function turn(by, { isHome = false } = {}) {
  const mine = returns;
  const moved = askLoaded(() => ({ do: "move", slot: 0, camera: state.camera, ...by }));
  const made = await (isHome ? moved : saying("The camera moves when the scene is compiled", moved));
  if (!made || mine !== returns) return;
  const { answer } = made;
  if (isHome) at("camera").textContent = answer.toml;
  if (isHome || !answer.moved) return;
  at("camera").textContent = answer.toml;
  state.camera = answer.camera;
  update({ moved: true });
}
