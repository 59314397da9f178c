// SPDX-License-Identifier: Apache-2.0
import { Box3, BufferAttribute, BufferGeometry, DataTexture, DoubleSide, Group, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, NearestFilter, Points, RGBAFormat, ShaderMaterial, Sphere, UnsignedByteType, Vector3 } from "../vendor/three/three.module.js";
import { CORNER, CUBE, INDEX, SQUARE } from "./voxel_shaders.js";

const SIDE = 32; // voxels of a chunk, as the frames have them
const MIDDLE = 32768; // key of the map's origin
const LABELS = 4096; // of a table at most
const ABOVE = 1 << 15; // of a place: there is a voxel above
const LAYER = SIDE * SIDE;
const CUBE_PX = 3; // voxels of less are squares
export const COLORS = ["picture", "label", "height", "certainty"];

const occupied = new Uint8Array(SIDE * LAYER); // of the chunk that is looked at
const RANKS = 256;

/// Of each place a rank: the places below any rank are spread evenly over the chunk, and over each plane in it. Source: the sequence R3 of
/// Roberts, "The unreasonable effectiveness of quasirandom sequences" (2018).
const RANK = Uint8Array.from({ length: SIDE * LAYER }, (_, place) => (((place & 31) * 0.8191725134 + ((place >> 5) & 31) * 0.6710436067 + (place >> 10) * 0.5497004779) % 1) * RANKS);

/// The rows by rank, so that each beginning of them stands for all. Each is told whether there is a voxel above; in the highest layer,
/// where that is in another chunk, as for the voxel below.
function arranged(voxels) {
  const starts = new Uint32Array(RANKS + 1);
  for (let i = 0; i < voxels.length; i += 4) {
    occupied[voxels[i]] = 1;
    ++starts[RANK[voxels[i]] + 1];
  }
  for (let rank = 0; rank < RANKS; ++rank) starts[rank + 1] += starts[rank];
  const rows = new Uint32Array(voxels.buffer), out = new Uint32Array(rows.length);
  for (let i = 0; i < rows.length; i += 2) {
    const place = voxels[2 * i], to = 2 * starts[RANK[place]]++;
    const above = place + LAYER < occupied.length ? occupied[place + LAYER] : occupied[place - LAYER];
    out[to] = rows[i] | (above ? ABOVE : 0);
    out[to + 1] = rows[i + 1];
  }
  for (let i = 0; i < voxels.length; i += 4) occupied[voxels[i]] = 0;
  return new Uint16Array(out.buffer);
}

/// Around a chunk's voxels, from its corner [m].
function boundsOf(voxels, side) {
  let low = SIDE * LAYER - 1, high = 0; // z is in a place's highest bits
  let [lowX, lowY, highX, highY] = [SIDE, SIDE, 0, 0];
  for (let i = 0; i < voxels.length; i += 4) {
    const place = voxels[i], x = place & 31, y = (place >> 5) & 31;
    if (place < low) low = place;
    if (place > high) high = place;
    if (x < lowX) lowX = x;
    if (x > highX) highX = x;
    if (y < lowY) lowY = y;
    if (y > highY) highY = y;
  }
  return new Box3(new Vector3(lowX, lowY, low >> 10).multiplyScalar(side), new Vector3(highX + 1, highY + 1, (high >> 10) + 1).multiplyScalar(side));
}

/// The map's voxels: two meshes for each chunk, of which the nearer ones show cubes, the others squares.
export class Voxels {
  constructor() {
    this.group = new Group();
    this.chunks = new Map(); // by key
    this.labels = new DataTexture(new Uint8Array(LABELS * 4).fill(160), 64, 64, RGBAFormat, UnsignedByteType);
    this.labels.minFilter = this.labels.magFilter = NearestFilter;
    this.labels.needsUpdate = true;
    const values = { heights: [0, 1], side: 0.05, mode: 0, dimmed: -1, labels: this.labels, pixels: 1, least: 1 };
    this.shared = Object.fromEntries(Object.entries(values).map(([name, value]) => [name, { value }]));
    this.cube = new ShaderMaterial({ ...CUBE, side: DoubleSide, uniforms: this.shared });
    this.square = new ShaderMaterial({ ...SQUARE, uniforms: this.shared });
    this.corner = new BufferAttribute(CORNER, 3);
    this.generation = null;
    this.clear();
  }

  clear() {
    for (const chunk of this.chunks.values()) this.drop(chunk);
    this.chunks.clear();
    this.stats = { voxels: 0, keySum: 0, revision: 0, complete: false, labelled: 0 };
  }

  drop({ meshes }) {
    for (const mesh of meshes) {
      this.group.remove(mesh);
      mesh.geometry.dispose();
    }
  }

  /// Takes a frame of the map.
  apply(map) {
    if (map.generation !== this.generation) this.clear();
    this.generation = map.generation;
    this.shared.side.value = this.resolution = map.resolution;
    for (const chunk of map.chunks) this.put(chunk);
    this.stats.revision = map.revision;
    this.stats.complete = map.complete;
  }

  put({ key, count, voxels }) {
    const name = key.join();
    const before = this.chunks.get(name);
    if (before) this.drop(before);
    for (const figure of ["voxels", "keySum", "labelled"]) this.stats[figure] -= before?.[figure] ?? 0;
    const chunk = { voxels: count, ...this.sums(key, voxels), ...this.draw(key, voxels) };
    for (const figure of ["voxels", "keySum", "labelled"]) this.stats[figure] += chunk[figure];
    this.chunks.set(name, chunk);
  }

  sums(key, voxels) {
    const base = SIDE * (key[0] + key[1] + key[2]);
    let keySum = 0, labelled = 0;
    for (let i = 0; i < voxels.length; i += 4) {
      keySum += base + (voxels[i] & 31) + ((voxels[i] >> 5) & 31) + (voxels[i] >> 10);
      if (voxels[i + 3]) ++labelled;
    }
    return { keySum, labelled };
  }

  /// @returns the chunk's two meshes, and its place in the map.
  draw(key, voxels) {
    if (!voxels.length) return { meshes: [], box: new Box3() };
    const corner = new Vector3(...key).multiplyScalar(SIDE).subScalar(MIDDLE).multiplyScalar(this.resolution);
    const rows = arranged(voxels);
    const cubes = new InstancedBufferGeometry();
    cubes.setAttribute("position", this.corner);
    cubes.setIndex(INDEX);
    cubes.setAttribute("voxel", new InstancedBufferAttribute(rows, 4));
    cubes.instanceCount = rows.length / 4;
    const squares = new BufferGeometry();
    squares.setAttribute("voxel", new BufferAttribute(rows, 4));
    const inside = boundsOf(voxels, this.resolution);
    const meshes = [new Mesh(cubes, this.cube), new Points(squares, this.square)];
    for (const mesh of meshes) {
      mesh.geometry.boundingSphere = inside.getBoundingSphere(new Sphere());
      mesh.position.copy(corner);
      mesh.updateMatrix();
      mesh.matrixAutoUpdate = false;
      this.group.add(mesh);
    }
    return { meshes, box: inside.translate(corner) };
  }

  setLabels(labels) {
    const { data } = this.labels.image;
    labels.slice(0, LABELS).forEach(({ color }, i) => data.set([...color, 255], 4 * i));
    this.labels.needsUpdate = true;
  }

  setColors(mode) {
    this.shared.mode.value = COLORS.indexOf(mode);
  }

  /// Dims all labels but one; -1: none.
  highlight(label) {
    this.shared.dimmed.value = label;
  }

  /// Around all voxels, in the map.
  box() {
    const box = new Box3();
    for (const chunk of this.chunks.values()) box.union(chunk.box);
    return box;
  }

  /// Before each picture. @param eye  in the map. @param pixels  of 1 m at a distance of 1 m. @param detail  least side of what is drawn
  /// [px]: of smaller voxels only some are, as many as are needed to fill their place.
  prepare(eye, pixels, detail) {
    this.shared.pixels.value = pixels;
    this.shared.least.value = detail;
    for (const { meshes, box } of this.chunks.values()) {
      if (!meshes.length) continue;
      const [cubes, squares] = meshes;
      const size = (pixels * this.resolution) / Math.max(box.distanceToPoint(eye), 1e-3); // [px]
      cubes.visible = size >= CUBE_PX * detail;
      squares.visible = !cubes.visible;
      const count = squares.geometry.attributes.voxel.count;
      squares.geometry.setDrawRange(0, Math.ceil(count * Math.min(1, (size / detail) ** 2)));
    }
  }

  setHeights(low, high) {
    this.shared.heights.value = [low, high];
  }
}
