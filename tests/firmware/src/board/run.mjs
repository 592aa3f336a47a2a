// Runs a WebAssembly program of the firmware in Node: node run.mjs PROGRAM.wasm
// Its files go into the current folder, what it prints to standard output.
import { closeSync, openSync, readFileSync, writeSync } from "node:fs";

class End extends Error {
  constructor(code) {
    super(`ended with ${code}`);
    this.code = code;
  }
}

let memory;
let file;
const bytes = (start, length) => new Uint8Array(memory.buffer, start, length);
const gridel = {
  print_bytes: (start, length) => writeSync(1, bytes(start, length)),
  create_file: (start, length) => {
    file = openSync(Buffer.from(bytes(start, length)).toString(), "w");
  },
  write_file: (start, length) => writeSync(file, bytes(start, length)),
  end: (code) => {
    throw new End(code);
  },
};

const module = await WebAssembly.instantiate(readFileSync(process.argv[2]), { gridel });
memory = module.instance.exports.memory;
try {
  module.instance.exports.start();
} catch (error) {
  if (!(error instanceof End)) throw error;
  process.exitCode = error.code;
} finally {
  if (file !== undefined) closeSync(file);
}
