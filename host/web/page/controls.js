// The controls: what is offered, and what is chosen.

export const at = (id) => document.getElementById(id);

/** The fastest structure without SIMD, and what boards hold. */
export const USUAL = "dual-split";

const SAMPLES = [1, 2, 4, 8, 16, 32, 64, 128, 256];

/** What is chosen. */
export function settings() {
  return {
    format: document.querySelector("[name=format]:checked")?.value ?? "f32",
    bits: Number(at("bits").value),
    structure: at("structure").value,
    samples: Number(at("samples").value),
    depth: whole(at("depth")),
    without: Array.from(document.querySelectorAll("#effects input:not(:checked)"), (it) => it.value),
  };
}

export function choose({ format, bits, structure, samples, depth, without }) {
  const radio = document.querySelector(`[name=format][value="${format}"]`);
  if (radio) radio.checked = true;
  at("bits").value = bits;
  at("bits-shown").textContent = bits;
  at("structure").value = structure;
  at("samples").value = samples;
  at("depth").value = depth;
  for (const box of document.querySelectorAll("#effects input")) box.checked = !without.includes(box.value);
}

/** The whole number of a field that is nearest to what was given; without one its default. */
function whole({ value, defaultValue, min, max }) {
  const number = Math.round(value === "" ? NaN : Number(value));
  return Math.min(Math.max(Number.isNaN(number) ? Number(defaultValue) : number, Number(min)), max === "" ? Infinity : Number(max));
}

/** Shows and returns the number of a field that counts. */
export function correct(field) {
  const number = whole(field);
  field.value = number;
  return number;
}

/** What the canvas shows: picture, work or error. */
export const view = () => document.querySelector("[name=view]:checked").value;

/** Offers number formats and boards, once. */
export function offerAll(about) {
  at("formats").append(...about.formats.map((name) => {
    const label = document.createElement("label");
    label.append(Object.assign(document.createElement("input"), { type: "radio", name: "format", value: name, checked: name === "f32" }), name);
    return label;
  }));
  at("board").replaceChildren(...about.boards.map(({ name, core }) => new Option(`${name} (${core})`, name)));
  offerFormats(about);
  at("depth").max = about.maxDepth;
  at("files").accept = [...about.extensions, ...about.images, "gridel", "gz", "mtl", "bin"].map((it) => `.${it}`).join(",");
}

/** Offers what the scene can be shown with, and chooses what its file says. Settings to keep stay where that is possible. */
export function offer(scene, about, kept) {
  const { first, blob } = scene;
  const now = settings();
  const structures = blob ? first.structures : about.structures;
  at("structure").replaceChildren(...structures.map((name) => new Option(name, name)));
  at("bits").disabled = Boolean(blob);
  const boxes = about.effects.filter(({ name }) => first.effects.includes(name)).map(({ name, without }) => {
    const label = document.createElement("label");
    const box = Object.assign(document.createElement("input"), { type: "checkbox", value: name, checked: true, disabled: Boolean(blob) });
    label.title = `without it, ${without}`;
    label.append(box, name);
    return label;
  });
  const none = Object.assign(document.createElement("span"), { className: "quiet", textContent: "none" });
  at("effects").replaceChildren(at("effects").querySelector("legend"), ...(boxes.length ? boxes : [none]));
  const samples = [...new Set([...SAMPLES, first.samples])].sort((a, b) => a - b);
  at("samples").replaceChildren(...samples.map((number) => new Option(number, number)));
  at("depth").defaultValue = first.depth;
  const chosen = { format: now.format, bits: first.latticeBits, structure: first.structures.includes(USUAL) ? USUAL : first.structures[0],
    samples: first.samples, depth: first.depth, without: [] };
  const can = { bits: !blob, structure: structures.includes(now.structure), samples: samples.includes(now.samples), depth: true, without: !blob };
  for (const key of kept) if (can[key]) chosen[key] = now[key];
  choose(chosen);
}

/** Lists the warnings of the importer and the compiler. */
export function showWarnings(warnings) {
  at("warnings-details").hidden = warnings.length === 0;
  at("warnings").replaceChildren(...warnings.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
}

/** Offers the number formats of a board. */
export function offerFormats(about) {
  const board = about.boards.find(({ name }) => name === at("board").value);
  at("board-format").replaceChildren(...board.formats.map((name) => new Option(name, name)));
}

/** Goes on to the next value, and around. */
export function cycle(select) {
  if (select.options.length) select.selectedIndex = (select.selectedIndex + 1) % select.options.length;
}

/** Goes up or down by a value; false at the end. */
export function step(select, by) {
  const index = Math.min(Math.max(select.selectedIndex + by, 0), select.options.length - 1);
  const isOther = index !== select.selectedIndex;
  select.selectedIndex = index;
  return isOther;
}

/** All values of one setting, beside what is chosen. */
export function sweep(setting, first, scene, about) {
  const each = (values, key) => values.map((value) => ({ ...first, [key]: value }));
  switch (setting) {
    case "format": return each(about.formats, "format");
    case "bits": return each([24, 20, 16, 12, 10], "bits");
    case "samples": return each([1, 2, 4, 8, 16], "samples");
    case "structure": return each(Array.from(at("structure").options, ({ value }) => value), "structure");
    default: return each([[], ...scene.first.effects.map((effect) => [effect])], "without");
  }
}

// Words.

export const count = (number, thing) => `${number} ${thing}${number === 1 ? "" : "s"}`;

export function nameOf({ format, bits, structure, samples, depth, without }, scene) {
  const left = without.length ? `, without ${without.join(", ")}` : "";
  const shownBits = scene.blob ? scene.info.latticeBits : bits;
  return `${format}, ${shownBits} bits, ${structure}, ${count(samples, "sample")}, depth ${depth}${left}`;
}
