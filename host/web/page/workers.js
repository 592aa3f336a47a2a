// Workers: requests with answers, and pictures from coarse to fine.

/** How long coarse blocks may keep the next picture waiting, in milliseconds. */
const PATIENCE = 250;

/** An error of the program. */
export class Problem extends Error {
  constructor({ message, help, report }) {
    super(message);
    this.help = help;
    this.report = report;
  }

  /** An error of the page, in the form of the program's. */
  static of(message, help) {
    return new Problem({ message, help, report: `  × ${message}\n  help: ${help}\n` });
  }
}

/** What was asked of a worker that was ended. */
export class Abandoned extends Error {}

/** Pixels so far. A finer block is never drawn over by a coarser one that comes late. */
export class Frame {
  constructor(width, height) {
    const pixels = width * height;
    Object.assign(this, { width, height });
    this.colors = new Uint32Array(pixels).fill(0xff000000);
    this.linear = new Uint16Array(3 * pixels);
    this.work = new Uint32Array(pixels);
    this.changed();
    this.drawn = 0;
  }

  /** Begins a picture, over what is there. */
  begin() {
    this.sides = new Uint8Array(this.width * this.height).fill(255);
    this.work.fill(0);
    this.drawn = 0;
  }

  /** The first of the rows that were put since the last call, and the end of them. */
  changed() {
    const rows = [this.first, this.end];
    [this.first, this.end] = [this.height, 0];
    return rows;
  }

  put(words) {
    const { width, sides, colors, linear, work } = this;
    for (let at = 0; at < words.length; at += 4) {
      const place = words[at], value = words[at + 1], redGreen = words[at + 2], blueSize = words[at + 3];
      const x = place & 0xffff, y = place >>> 16;
      const columns = (blueSize >>> 16) & 0xff, rows = blueSize >>> 24;
      const pixel = y * width + x;
      this.first = Math.min(this.first, y);
      this.end = Math.max(this.end, y + rows);
      linear[3 * pixel] = redGreen;
      linear[3 * pixel + 1] = redGreen >>> 16;
      linear[3 * pixel + 2] = blueSize;
      const side = Math.max(columns, rows);
      for (let row = pixel; row < pixel + rows * width; row += width) {
        for (let it = row; it < row + columns; it += 1) {
          if (sides[it] < side) continue;
          sides[it] = side;
          work[it] = value;
          colors[it] = value | 0xff000000;
        }
      }
    }
    this.drawn += words.length / 4;
  }
}

export class Workers {
  constructor(module, count) {
    this.answers = new Map();
    /** Workers that failed, which are started again when they are asked next. */
    this.failed = new Set();
    this.id = 0;
    this.generation = 0;
    /** The picture that is drawn, and the one that waits for it. */
    this.current = null;
    this.next = null;
    this.all = Array.from({ length: count }, (_, index) => this.started(index));
    this.ready = module.then((it) => {
      this.module = it;
      return Promise.all(this.all.map((_, index) => this.send(index, { module: it })));
    });
  }

  started(index) {
    const worker = new Worker("worker.js");
    worker.onmessage = ({ data }) => this.receive(index, data);
    worker.onerror = ({ message }) => {
      if (this.all[index] !== worker) return;
      // A script that cannot be loaded has no message.
      const problem = message ? Problem.of(`a worker failed: ${message}`, "try again, and reload the page if it fails again")
        : Problem.of("worker.js cannot be loaded", "start the server of the page again, and try again; reload the page if that fails");
      this.failed.add(index);
      this.end(index, problem);
      if (this.current) this.fail(problem, true);
      this.onfault?.(problem);
    };
    return worker;
  }

  /** Ends a worker. What it was asked is rejected. */
  end(index, error) {
    this.all[index].terminate();
    for (const [id, [, reject, asked]] of this.answers) {
      if (asked !== index) continue;
      this.answers.delete(id);
      reject(error);
    }
    this.onlost?.();
  }

  /** Starts a worker again, which holds nothing. */
  startAgain(index) {
    this.failed.delete(index);
    this.all[index] = this.started(index);
    // What it is asked next fails, too.
    this.send(index, { module: this.module }).catch(() => {});
  }

  /** Ends the first worker, and starts another. */
  restart() {
    this.stop();
    this.end(0, new Abandoned("given up"));
    this.startAgain(0);
  }

  send(index, message, transfer = []) {
    if (this.failed.has(index)) this.startAgain(index);
    const id = this.id += 1;
    return new Promise((resolve, reject) => {
      this.answers.set(id, [resolve, reject, index]);
      this.all[index].postMessage({ id, ...message }, transfer);
    });
  }

  /** Asks the first worker. */
  ask(request, bytes) {
    return this.send(0, { request, bytes });
  }

  /** Asks all workers, and returns the first one's answer. */
  async askAll(request, bytes) {
    const answers = await Promise.all(this.all.map((_, index) => this.send(index, { request, bytes })));
    return answers[0];
  }

  receive(index, data) {
    if (data.id !== undefined) {
      const [resolve, reject] = this.answers.get(data.id) ?? [];
      this.answers.delete(data.id);
      const { error } = data.answer;
      // What the worker held is gone.
      if (error?.isLost) this.onlost?.();
      if (error) reject?.(new Problem(error));
      else resolve?.({ answer: data.answer, bytes: data.bytes });
      return;
    }
    if (data.error?.isLost) this.onlost?.();
    const { current } = this;
    if (!current || data.generation !== current.generation) return;
    if (data.error) {
      this.fail(new Problem(data.error), data.error.isLost);
      return;
    }
    current.frame.put(new Uint32Array(data.words));
    if (data.seen) current.seen.add(index);
    if (data.done) current.done.add(index);
    current.onchange?.();
    if (current.done.size === this.all.length) {
      this.current = null;
      current.resolve((performance.now() - current.begun) / 1000);
      this.begin();
    } else if (this.next && this.isSeen()) {
      this.begin();
    }
  }

  /** Gives up the picture that is drawn, for an error, and goes on to the one that waits. */
  fail(problem, isLost) {
    this.current.reject(problem);
    this.current = null;
    this.all.forEach((worker) => worker.postMessage({ stop: true }));
    // A worker that holds nothing any more cannot draw that one either.
    if (isLost) {
      this.next?.reject(problem);
      this.next = null;
    }
    this.begin();
  }

  isSeen() {
    return !this.current || this.current.seen.size === this.all.length
      || performance.now() - this.current.begun > PATIENCE || this.current.isBackground;
  }

  /** Draws a picture in place of the one that is drawn. Returns the seconds; nothing for one that is given up. */
  draw(shot, frame, { onchange, isBackground = false } = {}) {
    return new Promise((resolve, reject) => {
      this.next?.resolve();
      this.next = { shot, frame, onchange, isBackground, resolve, reject };
      if (this.isSeen()) this.begin();
      else setTimeout(() => { if (this.next && this.isSeen()) this.begin(); }, PATIENCE);
    });
  }

  begin() {
    const { next } = this;
    if (!next) return;
    this.next = null;
    const generation = this.generation += 1;
    this.current?.resolve();
    next.frame.begin();
    this.current = { ...next, generation, begun: performance.now(), seen: new Set(), done: new Set() };
    this.all.forEach((worker, index) => {
      const draw = { do: "begin", shot: next.shot, share: [index, this.all.length] };
      worker.postMessage({ draw, generation });
    });
  }

  /** Gives up what is drawn. */
  stop() {
    this.current?.resolve();
    this.next?.resolve();
    this.current = this.next = null;
    this.all.forEach((worker) => worker.postMessage({ stop: true }));
  }
}

/** The bytes of arrays, one after the other. */
export function bytesOf(...arrays) {
  const all = new Uint8Array(arrays.reduce((sum, it) => sum + it.byteLength, 0));
  let place = 0;
  for (const it of arrays) {
    all.set(new Uint8Array(it.buffer, it.byteOffset, it.byteLength), place);
    place += it.byteLength;
  }
  return all;
}

/** Colors of three bytes as a canvas takes them. */
export function packed(bytes) {
  const colors = new Uint32Array(bytes.length / 3);
  for (let pixel = 0, byte = 0; pixel < colors.length; pixel += 1, byte += 3) {
    colors[pixel] = bytes[byte] | bytes[byte + 1] << 8 | bytes[byte + 2] << 16 | 0xff000000;
  }
  return colors;
}
