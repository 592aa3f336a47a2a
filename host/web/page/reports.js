// A pixel explained, the memory of boards, and files to save.

import { USUAL, at, settings } from "./controls.js";
import { askCompiled, compileOf } from "./loading.js";
import { shot, showError, size, state, workers } from "./state.js";
import { bytesOf } from "./workers.js";
import { save } from "./files.js";

export async function explain(x, y) {
  if (!state.scene && !state.opening) return;
  try {
    const made = await askCompiled(() => {
      const [width, height] = size();
      const pixel = [Math.min(x, width - 1), Math.min(y, height - 1)];
      [at("pixel-x").value, at("pixel-y").value] = pixel;
      return { do: "explain", shot: shot(), pixel, compile: compileOf(state.scene, settings()) };
    });
    if (!made) return;
    at("summary").textContent = made.answer.summary;
    at("explanation").textContent = made.answer.text;
    at("explanation").hidden = false;
  } catch (error) {
    showError(error);
  }
}

/** Asks what the scene takes on a board, as the controls say, and shows it. Returns nothing if they say otherwise now. */
async function reported() {
  const board = at("board").value;
  const format = at("board-format").value || null;
  if (!board) return null;
  const made = await askCompiled(() => {
    const chosen = settings();
    const { structure } = chosen;
    const measured = state.about.boardStructures.includes(structure) ? structure : USUAL;
    const compile = compileOf(state.scene, { ...chosen, structure: measured });
    return { do: "memory", board, format, structure, compile };
  });
  if (!made || board !== at("board").value) return null;
  const { answer } = made;
  at("fits").textContent = answer.fits ? `The scene fits on ${board}, through ${answer.report.structure} in ${answer.report.format}.`
    : `${answer.why[0].toUpperCase()}${answer.why.slice(1)}.`;
  at("memory").textContent = answer.text;
  at("memory").hidden = false;
  return { board, text: answer.text };
}

/** Shows what the scene takes on a board. */
export async function memory() {
  try {
    await reported();
  } catch (error) {
    at("fits").textContent = error.help ? `${error.message}: ${error.help}.` : error.message;
    at("memory").hidden = true;
  }
}

const stem = () => state.scene.name.split("/").at(-1).replace(/\.gz$/, "").replace(/\.[^.]*$/, "");

export async function saveMemory() {
  const made = await reported();
  if (made) save(`${stem()}-${made.board}.txt`, made.text, "text/plain");
}

export async function saveBlob() {
  await askCompiled();
  if (state.scene) save(`${stem()}.gridel`, state.scene.bytes, "application/octet-stream");
}

/** Saves the picture that is finished. */
export async function savePicture() {
  const { finished } = state;
  if (!finished) return;
  const { width, height } = finished.wanted;
  const name = `${stem()}.png`;
  const made = await workers.ask({ do: "png", width, height }, bytesOf(finished.linear));
  save(name, made.bytes, "image/png");
}
