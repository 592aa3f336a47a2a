// A pixel explained, the memory of boards, and files to save.

import { USUAL, at, settings } from "./controls.js";
import { Problem, bytesOf } from "./workers.js";
import { askCompiled, askLoaded, compileOf, saying } from "./loading.js";
import { shot, showError, state, status, statusWaiting } from "./state.js";
import { save } from "./files.js";

/** The settings that the explanation and the memory report on the page are for. */
const shown = { explanation: null, memory: null };

/** The settings that an explanation depends on. */
function explanationKey() {
  const { scene } = state;
  return scene && JSON.stringify([scene.number, shot(), compileOf(scene, settings())]);
}

/** The settings that a memory report depends on. */
function memoryKey() {
  const { scene } = state;
  const { structure, bits, without } = settings();
  return scene && JSON.stringify([scene.number, structure, bits, without, at("board").value, at("board-format").value]);
}

/** Clears the explanation and the memory report if they are for other settings. */
export function clearStale() {
  if (shown.explanation !== explanationKey()) noExplanation("Click into the picture, or give a column and a row.");
  if (shown.memory !== memoryKey()) noMemory("");
}

export async function explain(x, y) {
  if (!state.scene && !state.opening) return;
  try {
    let key;
    const asked = askCompiled(() => {
      key = explanationKey();
      return { do: "explain", shot: shot(), pixel: [x, y], compile: compileOf(state.scene, settings()) };
    });
    const made = await saying("The pixel will be explained when the scene is compiled", asked);
    // The picture is another one by now.
    if (!made || key !== explanationKey()) return;
    shown.explanation = key;
    [at("pixel-x").value, at("pixel-y").value] = [x, y];
    at("summary").textContent = made.answer.summary;
    at("explanation").textContent = made.answer.text;
    at("explanation").hidden = false;
  } catch (error) {
    if (error instanceof Problem) noExplanation(error.help ? `${error.message}: ${error.help}` : error.message);
    else showError(error);
  }
}

function noExplanation(why) {
  shown.explanation = explanationKey();
  at("summary").textContent = why;
  at("explanation").hidden = true;
}

/** Explains the pixel of the fields. */
export function explainFields() {
  const fields = [at("pixel-x"), at("pixel-y")];
  const wrong = fields.find((field) => !field.checkValidity());
  if (wrong) {
    const name = wrong === fields[0] ? "Column" : "Row";
    const what = wrong.value ? `${wrong.value} is not in the picture` : "has no number";
    noExplanation(`${name} ${what}: write a whole number from 0 to ${wrong.max || 0}.`);
    wrong.focus();
    return;
  }
  explain(...fields.map(({ valueAsNumber }) => valueAsNumber));
}

/** Asks what the scene takes on a board, as the controls say, and shows it. Returns nothing if they say otherwise now. */
async function reported() {
  const board = at("board").value;
  const format = at("board-format").value || null;
  if (!board) return null;
  let structure, isOther, key;
  const made = await askCompiled(() => {
    key = memoryKey();
    const chosen = settings();
    ({ structure } = chosen);
    // The report is of the blob that is saved, if boards can use that.
    isOther = !state.scene.blob && !state.about.boardStructures.includes(structure);
    const compile = isOther ? compileOf(state.scene, { ...chosen, structure: USUAL }) : undefined;
    return { do: "memory", board, format, structure, compile };
  });
  if (!made || board !== at("board").value) return null;
  const { answer } = made;
  const sentences = [answer.fits ? `The scene fits on ${board}, through ${answer.report.structure} in ${answer.report.format}.`
    : `${answer.why[0].toUpperCase()}${answer.why.slice(1)}.`];
  if (isOther) sentences.push(`This is for a blob with ${USUAL}: ${structure} was not measured on boards.`);
  if (!answer.fits && !state.scene.blob) sentences.push(`\`gridel build --target ${board}\` leaves out names.`);
  if (key === memoryKey()) {
    shown.memory = key;
    at("fits").textContent = sentences.join(" ");
    at("memory").textContent = answer.text;
    at("memory").hidden = false;
  }
  return { board, text: answer.text };
}

function noMemory(why) {
  shown.memory = memoryKey();
  at("fits").textContent = why;
  at("memory").hidden = true;
}

/** Shows what the scene takes on a board. */
export async function memory() {
  clearStale();
  try {
    await reported();
  } catch (error) {
    noMemory(error.help ? `${error.message}: ${error.help}.` : error.message);
  }
}

const stem = () => state.scene.name.split("/").at(-1).replace(/\.gz$/, "").replace(/\.[^.]*$/, "");

export async function saveMemory() {
  const made = await saying("The memory report will be saved when the scene is compiled", reported());
  if (made) save(`${stem()}-${made.board}.txt`, made.text, "text/plain");
}

export async function saveBlob() {
  const scene = await saying("The blob will be saved when it is compiled", askCompiled());
  if (scene) save(`${stem()}.gridel`, scene.bytes, "application/octet-stream");
}

/** Saves the picture, once it is finished. */
export async function savePicture() {
  if (!state.finished) {
    if (state.onpicture) return;
    if (!["opening", "drawing"].includes(document.documentElement.dataset.state)) {
      status("There is no picture to save");
      return;
    }
    const finished = new Promise((resolve) => { state.onpicture = resolve; });
    if (!await statusWaiting("The picture will be saved when it is finished", finished)) return;
  }
  const { linear, wanted: { width, height } } = state.finished;
  const name = `${stem()}.png`;
  const made = await askLoaded(() => ({ do: "png", width, height }), bytesOf(linear));
  if (made) save(name, made.bytes, "image/png");
}
