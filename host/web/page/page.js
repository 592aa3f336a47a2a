// The page: what its controls do.
//
// | file | what is in it |
// |---|---|
// | `page.js` | what happens on events |
// | `opening.js` | scenes, opened |
// | `camera.js` | the camera, moved |
// | `picture.js` | the picture, drawn, compared and painted |
// | `reports.js` | explanations, memory reports, files to save |
// | `loading.js` | what the workers hold |
// | `state.js` | what all these share |
// | `controls.js`, `table.js` | what is chosen, and what was measured |
// | `files.js`, `keys.js`, `pointer.js` | files, keys, mouse and touch |
// | `workers.js`, `worker.js` | workers, and what runs in each |

import { at, choose, correct, cycle, offerAll, offerFormats, settings, step, sweep, view } from "./controls.js";
import { explain, explainFields, memory, saveBlob, saveMemory, savePicture } from "./reports.js";
import { fromDrop, fromList } from "./files.js";
import { home, move } from "./camera.js";
import { look, update } from "./picture.js";
import { open, openMain, openSample, start } from "./opening.js";
import { showError, state, status, workers } from "./state.js";
import { listen } from "./pointer.js";
import { press } from "./keys.js";

/** Shows a setting that was chosen; a scene that is opened keeps it. */
function set(setting) {
  if (state.opening) state.kept.add(setting);
  update();
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
    set("structure");
  },
  m: () => step(at("samples"), 1) && set("samples"),
  l: () => step(at("samples"), -1) && set("samples"),
  c: () => {
    const other = view() === "work" ? "picture" : "work";
    document.querySelector(`[name=view][value=${other}]`).checked = true;
    update();
  },
};

/** Ends the measurement of all values; null if none runs. */
let stop = null;

/** Draws all values of one setting, one after the other; stops if it does that. */
async function measure() {
  if (stop) {
    stop();
    return;
  }
  if (!state.scene || state.opening) return;
  const { scene } = state;
  const first = settings();
  const setting = at("sweep").value;
  if (scene.blob && ["bits", "effects"].includes(setting)) {
    status("A blob has its lattice bits and effects: open its scene file to change them.");
    return;
  }
  const key = setting === "effects" ? "without" : setting;
  let last = first;
  const end = () => {
    if (stop !== end) return null;
    stop = null;
    at("measure").textContent = "Measure all";
    if (state.scene !== scene) return null;
    // What was changed meanwhile stays.
    const now = settings();
    if (String(now[key]) === String(last[key])) choose({ ...now, [key]: first[key] });
    return update();
  };
  stop = end;
  at("measure").textContent = "Stop";
  document.querySelector("[name=view][value=picture]").checked = true;
  for (last of sweep(setting, first, scene, state.about)) {
    choose(last);
    const before = state.change + 1;
    await update();
    // Somebody changed something: that comes first.
    if (stop !== end || state.change !== before) break;
  }
  await end();
}

function connect() {
  const guarded = (action) => () => Promise.resolve(action()).catch(showError);
  at("sample").onchange = openSample;
  at("files").onchange = ({ target }) => {
    if (!target.files.length) return;
    open(fromList(target.files));
    // The same file can be chosen again after a change.
    target.value = "";
  };
  at("main").onchange = openMain;
  at("settings").onsubmit = (event) => event.preventDefault();
  at("settings").onchange = ({ target }) => {
    correct(at("depth"));
    set(at("effects").contains(target) ? "without" : target.id);
  };
  at("bits").oninput = () => { at("bits-shown").textContent = at("bits").value; };
  for (const radio of document.querySelectorAll("[name=view]")) radio.onchange = guarded(look);
  at("home").onclick = () => home();
  at("measure").onclick = guarded(measure);
  at("explain").onclick = explainFields;
  at("board").onchange = () => {
    offerFormats(state.about);
    memory();
  };
  at("board-format").onchange = memory;
  at("save-blob").onclick = guarded(saveBlob);
  at("save-picture").onclick = guarded(savePicture);
  at("save-memory").onclick = guarded(saveMemory);
  const error = at("error");
  let from = null;
  error.addEventListener("focusin", ({ relatedTarget }) => { if (!error.contains(relatedTarget)) from = relatedTarget; });
  at("error-close").onclick = () => {
    error.hidden = true;
    from?.focus({ preventScroll: true });
    if (document.activeElement !== from) at("canvas").focus({ preventScroll: true });
  };
  // The text itself can be hidden, and would not be read then.
  at("canvas").setAttribute("aria-description", at("keys").textContent.replace(/\s+/g, " ").trim());
  listen(at("canvas"), { move, click: explain, key: (event) => press(event, move, actions) });
  const drop = at("drop");
  addEventListener("dragover", (event) => {
    event.preventDefault();
    drop.hidden = false;
  });
  addEventListener("dragleave", (event) => { if (!event.relatedTarget) drop.hidden = true; });
  addEventListener("drop", (event) => {
    event.preventDefault();
    drop.hidden = true;
    // Words and pictures of pages can be dropped, too.
    if (event.dataTransfer.types.includes("Files")) open(fromDrop(event.dataTransfer));
  });
}

async function begin() {
  connect();
  openSample();
  await workers.ready;
  state.about = (await workers.ask({ do: "about" })).answer;
  offerAll(state.about);
  start();
}

begin().catch(showError);
