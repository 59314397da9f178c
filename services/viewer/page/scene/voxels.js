// SPDX-License-Identifier: Apache-2.0
import { Box3, BufferAttribute, DataTexture, DoubleSide, Group, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, NearestFilter, RGBAFormat, ShaderMaterial, Sphere, UnsignedByteType, Vector3 } from "../vendor/three/three.module.js";

const SIDE = 32; // voxels of a chunk, as the frames have them
const MIDDLE = 32768; // key of the map's origin
const LABELS = 4096; // of a table at most
export const COLORS = ["picture", "label", "height", "certainty"];

// Three faces that meet in a corner: of a cube no more can be seen. The shader mirrors them towards the eye.
const CORNER = new Float32Array([1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, -1, 1, -1, -1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1]);
const INDEX = [0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7, 8, 9, 10, 8, 10, 11];

const VERTEX = `
  attribute vec4 voxel;  // place, red + 256 green, blue + 256 certainty, label
  uniform vec3 origin;   // of the chunk, in the map [m]
  uniform float side;    // of a voxel [m]
  uniform vec3 eye;      // in the map [m]
  uniform vec3 up;       // in the map
  uniform vec2 heights;  // lowest, highest [m]
  uniform int mode;
  uniform float dimmed;  // label that alone is bright, or -1
  uniform sampler2D labels;
  varying vec3 tone;
  varying vec2 face;
  vec3 ramp(float t) {  // viridis, by a polynomial
    const vec3 a = vec3(0.2777, 0.0054, 0.3341), b = vec3(0.1051, 1.4046, 1.3846), c = vec3(-0.3309, 0.2148, 0.0951), d = vec3(-4.6342, -5.7991, -19.3324), e = vec3(6.2283, 14.1799, 56.6906), f = vec3(4.7764, -13.7451, -65.3530), g = vec3(-5.4355, 4.6459, 26.3124);
    return clamp(a + t * (b + t * (c + t * (d + t * (e + t * (f + t * g))))), 0.0, 1.0);
  }
  void main() {
    vec3 cell = vec3(mod(voxel.x, 32.0), mod(floor(voxel.x / 32.0), 32.0), floor(voxel.x / 1024.0));
    vec3 center = origin + (cell + 0.5) * side;
    vec3 towards = sign(eye - center);
    vec3 normal = gl_VertexID < 4 ? vec3(towards.x, 0.0, 0.0) : gl_VertexID < 8 ? vec3(0.0, towards.y, 0.0) : vec3(0.0, 0.0, towards.z);
    face = gl_VertexID < 4 ? position.yz : gl_VertexID < 8 ? position.xz : position.xy;
    vec3 color = vec3(mod(voxel.y, 256.0), floor(voxel.y / 256.0), mod(voxel.z, 256.0)) / 255.0;
    float certainty = floor(voxel.z / 256.0) / 255.0;
    if (mode == 1) {
      vec3 of_label = texture2D(labels, vec2((mod(voxel.w, 64.0) + 0.5) / 64.0, (floor(voxel.w / 64.0) + 0.5) / 64.0)).rgb;
      color = voxel.w > 0.5 ? of_label : mix(vec3(0.62, 0.65, 0.69), vec3(dot(color, vec3(0.3, 0.59, 0.11))), 0.45);
    } else if (mode == 2) {
      color = ramp(clamp((dot(center, up) - heights.x) / max(heights.y - heights.x, 1e-3), 0.0, 1.0));
    } else if (mode == 3) {
      color = ramp(certainty);
    }
    if (dimmed >= 0.0 && abs(voxel.w - dimmed) > 0.5) color = mix(color, vec3(dot(color, vec3(0.33))), 0.85) * 0.5;
    float light = 0.80 + 0.20 * dot(normal, up) + 0.07 * dot(normal, normalize(vec3(0.8, 0.35, 0.5)));
    tone = color * light;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(center + position * towards * (0.5 * side), 1.0);
  }`;

const FRAGMENT = `
  varying vec3 tone;
  varying vec2 face;
  void main() {
    vec2 width = fwidth(face) * 1.1;
    vec2 edge = smoothstep(vec2(1.0) - width, vec2(1.0), abs(face));
    float near = 1.0 - smoothstep(0.08, 0.3, max(width.x, width.y));  // far voxels are smaller than a line
    gl_FragColor = vec4(tone * (1.0 - 0.22 * near * max(edge.x, edge.y)), 1.0);
  }`;

/// The map's voxels: a mesh for each chunk, whose instances are the frame's rows as they came.
export class Voxels {
  constructor() {
    this.group = new Group();
    this.chunks = new Map(); // by key
    this.labels = new DataTexture(new Uint8Array(LABELS * 4).fill(160), 64, 64, RGBAFormat, UnsignedByteType);
    this.labels.minFilter = this.labels.magFilter = NearestFilter;
    this.labels.needsUpdate = true;
    this.shared = { eye: { value: new Vector3() }, up: { value: new Vector3(0, -1, 0) }, heights: { value: [0, 1] }, side: { value: 0.05 }, mode: { value: 0 }, dimmed: { value: -1 }, labels: { value: this.labels } };
    this.corner = new BufferAttribute(CORNER, 3);
    this.generation = null;
    this.clear();
  }

  clear() {
    for (const { mesh } of this.chunks.values()) this.drop(mesh);
    this.chunks.clear();
    this.stats = { voxels: 0, keySum: 0, revision: 0, complete: false, labelled: 0 };
  }

  drop(mesh) {
    if (!mesh) return;
    this.group.remove(mesh);
    mesh.geometry.dispose();
    mesh.material.dispose();
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
    for (const figure of ["voxels", "keySum", "labelled"]) this.stats[figure] -= before?.[figure] ?? 0;
    if (!count) this.drop(before?.mesh);
    const chunk = { voxels: count, ...this.sums(key, voxels), mesh: count ? this.mesh(key, voxels, before?.mesh) : null };
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

  /// @param before  the mesh of this chunk until now, which is used again.
  mesh(key, voxels, before) {
    const size = SIDE * this.resolution;
    const origin = new Vector3(...key).multiplyScalar(SIDE).subScalar(MIDDLE).multiplyScalar(this.resolution);
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("position", this.corner);
    geometry.setIndex(INDEX);
    geometry.setAttribute("voxel", new InstancedBufferAttribute(voxels, 4));
    geometry.instanceCount = voxels.length / 4;
    geometry.boundingBox = new Box3(origin.clone(), origin.clone().addScalar(size));
    geometry.boundingSphere = geometry.boundingBox.getBoundingSphere(new Sphere());
    if (before) {
      before.geometry.dispose();
      before.geometry = geometry;
      return before;
    }
    const material = new ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT, side: DoubleSide, uniforms: { ...this.shared, origin: { value: origin } } });
    const mesh = new Mesh(geometry, material);
    mesh.matrixAutoUpdate = false;
    this.group.add(mesh);
    return mesh;
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
    for (const { mesh } of this.chunks.values()) if (mesh) box.union(mesh.geometry.boundingBox);
    return box;
  }

  /// Before each picture. @param eye, up  in the map.
  prepare(eye, up) {
    this.shared.eye.value.copy(eye);
    this.shared.up.value.copy(up);
  }

  setHeights(low, high) {
    this.shared.heights.value = [low, high];
  }
}
