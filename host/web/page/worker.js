// A worker: an instance of the module, which answers requests one by one and draws in between.
"use strict";

const encoder = new TextEncoder();
const decoder = new TextDecoder();

/** How long it draws before it looks for messages, in milliseconds. */
const TURN = 12;

/** The module, and the instance that answers; none after a fault. */
let compiled;
let gridel = null;
/** The picture that is being drawn. */
let drawing = null;
/** How many blocks of pixels it draws in a turn. */
let blocks = 1;

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

/** A new instance, which holds nothing. */
function instance() {
  // Libraries for charts import functions of browsers, which nothing calls here.
  const imports = {};
  for (const { module, name } of WebAssembly.Module.imports(compiled)) {
    (imports[module] ??= {})[name] = () => { throw new Error(`${name} was called`); };
  }
  return new WebAssembly.Instance(compiled, imports).exports;
}

/** Gives up an instance that is broken, with all that it held, and says so. */
function lost(error) {
  gridel = drawing = null;
  const message = `the scene takes more memory than the browser gives, or this is a fault of the page (${error})`;
  const help = "use the program for a scene that is large; report one that is not, with its files";
  return { message, help, report: `  × ${message}\n  help: ${help}\n`, isLost: true };
}

onmessage = ({ data }) => {
  try {
    receive(data);
  } catch (error) {
    const answer = { error: lost(error) };
    if (data.draw) postMessage({ generation: data.generation, error: answer.error });
    else postMessage({ id: data.id, answer, bytes: new Uint8Array() });
  }
};

function receive(data) {
  if (data.module) {
    compiled = data.module;
    gridel = instance();
    postMessage({ id: data.id, answer: {}, bytes: new Uint8Array() });
  } else if (data.draw) {
    const begun = call(data.draw);
    drawing = begun.answer.error ? null : { generation: data.generation };
    blocks = 1;
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
    // Blocks take longer in another part of the picture, and much longer with more samples.
    const fitting = Math.floor(blocks * TURN / Math.max(time, 0.01));
    blocks = Math.max(1, Math.min(fitting, 2 * blocks, 1 << 16));
    const { error, done, seen } = answer;
    postMessage({ generation, error, done, seen, words: bytes.buffer }, [bytes.buffer]);
    if (error || done) drawing = null;
    else turn();
  } catch (fault) {
    postMessage({ generation, error: lost(fault) });
  }
}

/** One request: JSON, and bytes that belong to it. */
function call(request, bytes = new Uint8Array()) {
  gridel ??= instance();
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
