// SPDX-License-Identifier: Apache-2.0
// Binary frames, as services/viewer/FRAMES.md says.

export const KIND = { hello: 1, map: 2, tracking: 3, path: 4, keyframes: 5, boxes: 6, objects: 7, grid: 8, picture: 9, services: 10, reply: 11, labels: 12, camera: 13, submap: 14 };
const NAMES = Object.fromEntries(Object.entries(KIND).map(([name, kind]) => [kind, name]));
const HEADER = 8;
const VERSION = 1;
const text = new TextDecoder();

function readMap(view, buffer) {
  const map = { generation: view.getBigUint64(8, true), resolution: view.getFloat64(16, true), revision: Number(view.getBigUint64(24, true)), complete: view.getUint32(36, true) !== 0, chunks: [] };
  let at = 40;
  for (let i = view.getUint32(32, true); i > 0; --i) {
    const key = [view.getUint16(at, true), view.getUint16(at + 2, true), view.getUint16(at + 4, true)];
    const count = view.getUint32(at + 8, true);
    at += 16;
    map.chunks.push({ key, count, voxels: new Uint16Array(buffer.slice(at, at + 8 * count)) });
    at += 8 * count;
  }
  return map;
}

function readPath(view, buffer) {
  return { first: view.getUint32(8, true), points: new Float32Array(buffer.slice(16, 16 + 12 * view.getUint32(12, true))) };
}

const readPose = (view, at) => Array.from({ length: 7 }, (_, i) => view.getFloat32(at + 4 * i, true));

function readKeyframes(view) {
  const keyframes = new Map();
  const loops = [];
  let at = 16;
  for (let i = view.getUint32(8, true); i > 0; --i, at += 40) keyframes.set(view.getBigUint64(at, true), readPose(view, at + 8));
  for (let i = view.getUint32(12, true); i > 0; --i, at += 16) loops.push([view.getBigUint64(at, true), view.getBigUint64(at + 8, true)]);
  return { keyframes, loops };
}

function readGrid(view, buffer) {
  const width = view.getUint32(8, true), height = view.getUint32(12, true);
  return { width, height, resolution: view.getFloat32(16, true), pose: readPose(view, 20), cells: new Int8Array(buffer.slice(48, 48 + width * height)) };
}

function readPicture(view, buffer) {
  const count = view.getUint32(28, true), size = view.getUint32(24, true);
  const picture = { width: view.getUint32(16, true), height: view.getUint32(20, true), features: [], jpeg: null };
  for (let i = 0, at = 32; i < count; ++i, at += 8) picture.features.push([view.getUint16(at, true), view.getUint16(at + 2, true), view.getUint32(at + 4, true)]);
  picture.jpeg = new Blob([new Uint8Array(buffer, 32 + 8 * count, size)], { type: "image/jpeg" });
  return picture;
}

const READERS = { [KIND.map]: readMap, [KIND.path]: readPath, [KIND.keyframes]: readKeyframes, [KIND.submap]: readKeyframes, [KIND.grid]: readGrid, [KIND.picture]: readPicture };

/// [name of the kind, what it tells]; null for another version or kind.
export function readFrame(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < HEADER || view.getUint8(0) !== 0x52 || view.getUint8(1) !== 0x56 || view.getUint8(2) !== VERSION) return null;
  const kind = view.getUint8(3);
  if (!(kind in NAMES)) return null;
  const reader = READERS[kind];
  return [NAMES[kind], reader ? reader(view, buffer) : JSON.parse(text.decode(new Uint8Array(buffer, HEADER)))];
}
