// Files that are chosen or dropped, folders too.

import { Problem } from "./workers.js";
import { bytesText } from "./table.js";

/** Formats in the order in which one of several files is the scene; others are companions. */
const SCENES = ["gridel", "toml", "gltf", "glb", "obj", "nff", "cif", "mmcif", "pdb", "ent", "ply", "stl", "off", "xyz"];

export function extension(name) {
  const parts = name.toLowerCase().split(".");
  if (parts.length > 2 && parts.at(-1) === "gz") parts.pop();
  return parts.length > 1 ? parts.at(-1) : "";
}

/** The files that can be the scene, the likeliest first. */
export function candidates(files) {
  const rank = ({ path }) => {
    const place = SCENES.indexOf(extension(path));
    return place < 0 ? SCENES.length : place;
  };
  const scenes = files.filter((file) => rank(file) < SCENES.length);
  const depth = ({ path }) => path.split("/").length;
  // Without any of them the program says what it reads.
  return (scenes.length ? scenes : files.slice(0, 1))
    .sort((a, b) => rank(a) - rank(b) || depth(a) - depth(b));
}

/** A file with its bytes, or with the reason why it cannot be read: a scene may not need it. */
async function whole(path, opened) {
  let file;
  try {
    file = await opened;
    return { path, bytes: new Uint8Array(await file.arrayBuffer()) };
  } catch ({ message }) {
    const large = file?.size >= 2 ** 30;
    return { path, problem: Problem.of(`${path} cannot be read: ${large ? `${bytesText(file.size)} are too many for this browser` : message.replace(/\.$/, "")}`,
      large ? "use the program for this file" : "open it again, if it still exists and you may read it") };
  }
}

export async function fromList(list) {
  return Promise.all(Array.from(list, (file) => whole(file.webkitRelativePath || file.name, file)));
}

/** The files of a drop. */
export async function fromDrop(transfer) {
  const entries = Array.from(transfer.items ?? [], (item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (!entries.some((entry) => entry.isDirectory)) return fromList(transfer.files);
  const files = [];
  const walk = async (entry, folder) => {
    const path = folder + entry.name;
    if (entry.isFile) {
      files.push(await whole(path, new Promise((resolve, reject) => entry.file(resolve, reject))));
      return;
    }
    const reader = entry.createReader();
    // A reader gives a hundred at a time.
    for (;;) {
      const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject)).catch(({ message }) => {
        throw Problem.of(`the folder ${path} cannot be read: ${message.replace(/\.$/, "")}`, "open it again, if it still exists and you may read it");
      });
      if (!some.length) return;
      for (const inner of some) await walk(inner, `${path}/`);
    }
  };
  for (const entry of entries) await walk(entry, "");
  // A folder gives them in no order.
  return files.sort((a, b) => a.path.localeCompare(b.path));
}

export function isBlob({ path, bytes }) {
  const magic = [..."GRIDEL"].every((letter, index) => bytes?.[index] === letter.charCodeAt(0));
  return magic || extension(path) === "gridel";
}

export function save(name, bytes, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
