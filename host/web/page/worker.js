// A worker: an instance of the module, which answers requests one by one and draws in between.
"use strict";

const encoder = new TextEncoder();
const decoder = new TextDecoder();

/** How long it draws before it looks for messages, in milliseconds. */
const TURN = 12;

let gridel;
/** The picture that is being drawn. */
let drawing = null;
let blocks = 16;

/** Messages come between the turns of drawing. */
const turns = new MessageChannel();
let isTurning = false;
turns.port1.onmessage = () => {
  isTurning = false;
  draw();
};
function turn() {
  if (!isTurning) turns.port2.postMessage(null);
  isTurning = true;
}

onmessage = async ({ data }) => {
  try {
    await receive(data);
  } catch (error) {
    const fault = { message: String(error), help: "reload the page", report: String(error) };
    postMessage({ id: data.id, answer: { error: fault }, bytes: new Uint8Array() });
  }
};

async function receive(data) {
  if (data.module) {
    // Libraries for charts import functions of browsers, which nothing calls here.
    const imports = {};
    for (const { module, name } of WebAssembly.Module.imports(data.module)) {
      (imports[module] ??= {})[name] = () => { throw new Error(`${name} was called`); };
    }
    gridel = (await WebAssembly.instantiate(data.module, imports)).exports;
    postMessage({ id: data.id, answer: {}, bytes: new Uint8Array() });
  } else if (data.draw) {
    const begun = call(data.draw);
    drawing = begun.answer.error ? null : { generation: data.generation };
    if (begun.answer.error) postMessage({ generation: data.generation, error: begun.answer.error });
    else turn();
  } else if (data.stop) {
    drawing = null;
  } else {
    const { answer, bytes } = call(data.request, data.bytes);
    postMessage({ id: data.id, answer, bytes }, [bytes.buffer]);
  }
}

/** Draws for a turn. */
function draw() {
  if (!drawing) return;
  const { generation } = drawing;
  const begun = performance.now();
  try {
    const { answer, bytes } = call({ do: "step", blocks });
    const time = performance.now() - begun;
    if (time < TURN / 2) blocks = Math.min(2 * blocks, 1 << 16);
    else if (time > 2 * TURN) blocks = Math.max(1, blocks >> 1);
    const { error, done, seen } = answer;
    postMessage({ generation, error, done, seen, words: bytes.buffer }, [bytes.buffer]);
    if (error || done) drawing = null;
    else turn();
  } catch (fault) {
    drawing = null;
    const text = String(fault);
    postMessage({ generation, error: { message: text, help: "reload the page", report: text } });
  }
}

/** One request: JSON, and bytes that belong to it. */
function call(request, bytes = new Uint8Array()) {
  const json = encoder.encode(JSON.stringify(request));
  const address = gridel.input(4 + json.length + bytes.length);
  // The memory's buffer is another one when it has grown.
  const input = new Uint8Array(gridel.memory.buffer, address);
  new DataView(gridel.memory.buffer).setUint32(address, json.length, true);
  input.set(json, 4);
  input.set(bytes, 4 + json.length);
  const length = gridel.call();
  const start = gridel.output_address();
  const output = new Uint8Array(gridel.memory.buffer, start, length);
  const text = new DataView(gridel.memory.buffer).getUint32(start, true);
  return { answer: JSON.parse(decoder.decode(output.subarray(4, 4 + text))), bytes: output.slice(4 + text) };
}
