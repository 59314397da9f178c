// SPDX-License-Identifier: Apache-2.0
import { Box3, BufferAttribute, BufferGeometry, Color, DataTexture, DoubleSide, Group, Line, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, NearestFilter, PlaneGeometry, Quaternion, RGBAFormat, Vector3 } from "../vendor/three/three.module.js";

const PALETTE = {
  dark: { path: "#58a6ff", keyframes: "#8b98a5", submap: "#e3b341", loops: "#f778ba", camera: "#ffd33d", moving: "#ff8a3d", objects: "#ffffff" },
  light: { path: "#0b66c3", keyframes: "#5f6d7a", submap: "#8a5a00", loops: "#bf3989", camera: "#a96e00", moving: "#c2410c", objects: "#1b2733" },
};
const EDGES = [0, 1, 1, 3, 3, 2, 2, 0, 4, 5, 5, 7, 7, 6, 6, 4, 0, 4, 1, 5, 2, 6, 3, 7];
const FRUSTUM_EDGES = [0, 1, 0, 2, 0, 3, 0, 4, 1, 2, 2, 3, 3, 4, 4, 1, 5, 6];
const VELOCITY_S = 0.7; // an arrow ends where the object will be by then
const KEYFRAME_M = 0.1, CAMERA_M = 0.45; // depth of the frustums drawn
const BESIDE_M = 0.5; // between the map and a submap

const positionOf = (pose) => new Vector3(pose[0], pose[1], pose[2]);
const rotationOf = (pose) => new Quaternion(pose[3], pose[4], pose[5], pose[6]);
const toMap = (pose, point) => point.applyQuaternion(rotationOf(pose)).add(positionOf(pose));

/// Line segments whose points are set as a whole.
class Segments extends LineSegments {
  constructor(width = 1) {
    super(new BufferGeometry(), new LineBasicMaterial({ transparent: true, linewidth: width }));
    this.frustumCulled = false;
    this.set([]);
  }

  set(points) {
    this.geometry.dispose();
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
  }
}

/// The five corners of a camera's frustum and a mark above it, in the map.
function frustum(pose, camera, depth) {
  const { width, height, fx, fy, cx, cy } = camera ?? { width: 640, height: 480, fx: 525, fy: 525, cx: 320, cy: 240 };
  const at = (x, y) => new Vector3((x - cx) / fx, (y - cy) / fy, 1).multiplyScalar(depth);
  const corners = [new Vector3(), at(0, 0), at(width, 0), at(width, height), at(0, height), at(width * 0.42, -height * 0.06), at(width * 0.58, -height * 0.06)];
  return corners.map((corner) => toMap(pose, corner));
}

const segmentsOf = (points, edges) => edges.flatMap((i) => points[i].toArray());

function corners(low, high) {
  return Array.from({ length: 8 }, (_, i) => new Vector3(i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]));
}

/// The keyframes of a map that has no place in the map yet, and the camera in it. It stands beside the map; where it belongs nobody knows.
class Submap extends Group {
  constructor() {
    super();
    this.keyframes = new Segments();
    this.camera = new Segments();
    this.add(this.keyframes, this.camera);
    this.set(new Map());
  }

  /// @param keyframes  poses by id. @param camera  intrinsics.
  set(keyframes, camera) {
    const poses = [...keyframes.values()];
    this.size = poses.length;
    this.keyframes.set([
      ...poses.flatMap((pose) => segmentsOf(frustum(pose, camera, KEYFRAME_M), FRUSTUM_EDGES)),
      ...poses.slice(1).flatMap((pose, i) => [...poses[i].slice(0, 3), ...pose.slice(0, 3)]),
    ]);
    if (!poses.length) this.camera.set([]);
    this.around = new Box3().setFromPoints(poses.map(positionOf));
  }

  /// @param map  the box around its voxels.
  standBeside(map) {
    if (map.isEmpty() || !this.size) return;
    const middle = map.getCenter(new Vector3()).sub(this.around.getCenter(new Vector3()));
    this.position.set(map.max.x + BESIDE_M - this.around.min.x, middle.y, middle.z);
  }
}

/// All that is drawn beside the voxels, each in a group of its name.
export class Layers {
  constructor() {
    this.group = new Group();
    this.camera = null;
    this.pose = null;
    this.boxes = [];
    this.objects = [];
    this.points = new Float32Array(3 * 1024);
    this.pathLength = 0;
    this.path = new Line(new BufferGeometry(), new LineBasicMaterial());
    this.path.frustumCulled = false;
    for (const name of ["keyframes", "loops", "frustum", "moving", "objectBoxes"]) this[name] = new Segments();
    this.grid = new Mesh(new PlaneGeometry(1, 1), new MeshBasicMaterial({ side: DoubleSide, transparent: true, depthWrite: false, toneMapped: false }));
    this.grid.visible = false;
    this.submap = new Submap();
    this.group.add(this.submap, this.path, this.keyframes, this.loops, this.frustum, this.moving, this.objectBoxes, this.grid);
    this.setTheme("dark");
  }

  setTheme(theme) {
    const palette = PALETTE[theme];
    const paint = (object, color, opacity = 1) => {
      object.material.color = new Color(color);
      object.material.opacity = opacity;
    };
    paint(this.path, palette.path);
    paint(this.keyframes, palette.keyframes, 0.6);
    paint(this.loops, palette.loops);
    for (const lines of this.submap.children) paint(lines, palette.submap);
    paint(this.frustum, palette.camera);
    paint(this.moving, palette.moving);
    paint(this.objectBoxes, palette.objects, 0.75);
  }

  setPath({ first, points }) {
    const length = first + points.length / 3;
    if (3 * length > this.points.length) {
      const larger = new Float32Array(6 * length);
      larger.set(this.points);
      this.points = larger;
    }
    this.points.set(points, 3 * first);
    this.pathLength = length;
    this.path.geometry.dispose();
    this.path.geometry = new BufferGeometry();
    this.path.geometry.setAttribute("position", new BufferAttribute(this.points.slice(0, 3 * length), 3));
  }

  setKeyframes({ keyframes, loops }) {
    this.keyframes.set([...keyframes.values()].flatMap((pose) => segmentsOf(frustum(pose, this.camera, KEYFRAME_M), FRUSTUM_EDGES)));
    const known = loops.filter(([a, b]) => keyframes.has(a) && keyframes.has(b));
    this.loops.set(known.flatMap((ids) => ids.flatMap((id) => keyframes.get(id).slice(0, 3))));
  }

  setSubmap({ keyframes }, map) {
    this.submap.set(keyframes, this.camera);
    this.submap.standBeside(map);
  }

  /// The camera's pose in the submap; it has none in the map.
  setPoseInSubmap(pose) {
    this.frustum.set([]);
    this.submap.camera.set(segmentsOf(frustum(pose, this.camera, CAMERA_M), FRUSTUM_EDGES));
  }

  setPose(pose) {
    this.pose = pose;
    this.frustum.set(segmentsOf(frustum(pose, this.camera, CAMERA_M), FRUSTUM_EDGES));
  }

  setBoxes(boxes) {
    this.boxes = boxes;
    this.moving.set(boxes.flatMap(({ min, max, velocity }) => {
      const middle = min.map((v, i) => (v + max[i]) / 2);
      return [...segmentsOf(corners(min, max), EDGES), ...middle, ...middle.map((v, i) => v + VELOCITY_S * velocity[i])];
    }));
  }

  setObjects(objects) {
    this.objects = objects;
    this.objectBoxes.set(objects.flatMap(({ pose, size }) => {
      const half = size.map((s) => s / 2);
      return segmentsOf(corners(half.map((h) => -h), half).map((corner) => toMap(pose, corner)), EDGES);
    }));
  }

  setGrid({ width, height, resolution, pose, cells }) {
    if (!width || !height) return;
    const texels = new Uint8Array(4 * cells.length);
    cells.forEach((cell, i) => texels.set(cell < 0 ? [0, 0, 0, 0] : cell > 50 ? [214, 69, 65, 200] : [86, 156, 214, 70], 4 * i));
    this.grid.material.map?.dispose();
    const map = new DataTexture(texels, width, height, RGBAFormat);
    map.magFilter = map.minFilter = NearestFilter;
    map.needsUpdate = true;
    this.grid.material.map = map;
    this.grid.material.needsUpdate = true;
    this.grid.scale.set(width * resolution, height * resolution, 1);
    this.grid.quaternion.copy(rotationOf(pose));
    this.grid.position.copy(toMap(pose, new Vector3((width * resolution) / 2, (height * resolution) / 2, 0.01)));
  }

  /// Where names stand: over each object and each box.
  names() {
    const objects = this.objects.map(({ label, pose, color }) => ({ text: label, color, at: positionOf(pose), layer: "objects" }));
    const moving = this.boxes.map(({ id, label, min, max, velocity, color }) => ({
      text: `${label} ${id} · ${Math.hypot(...velocity).toFixed(1)} m/s`, color, at: new Vector3(...min.map((v, i) => (v + max[i]) / 2)), layer: "moving", moving: true,
    }));
    const { size, position } = this.submap;
    const submap = size ? [{ text: `not yet in the map: ${size} keyframe${size > 1 ? "s" : ""}`, color: [227, 179, 65], at: position, layer: "keyframes" }] : [];
    return [...submap, ...moving, ...objects];
  }
}
