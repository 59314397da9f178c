// SPDX-License-Identifier: Apache-2.0
import { Color, GridHelper, Group, PerspectiveCamera, Quaternion, Scene, Vector3, WebGLRenderer } from "../vendor/three/three.module.js";
import { Labels } from "./labels.js";
import { Layers } from "./layers.js";
import { Orbit } from "./orbit.js";
import { Voxels } from "./voxels.js";

const MOST_PIXELS = 2; // per CSS pixel
const SLOW_MS = 90, FAST_MS = 22; // until a picture that was asked for is drawn
const COARSEST_PX = 5;
const FEW = 100000; // voxels: so many are drawn sharp however slowly
const FILLED = 0.88; // of the free part of the picture, when the whole map is shown

const cornersOf = ({ min, max }) => Array.from({ length: 8 }, (_, i) => new Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z));
const BACKGROUND = { dark: "#0f151d", light: "#eef1f4" };
const FLOOR = { dark: ["#33404e", "#212b36"], light: ["#c2ccd5", "#dce2e8"] };

/// The picture: draws when something has changed, from begin() on.
export class View {
  constructor(canvas, names) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: "high-performance" });
    this.setSharp(true);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(50, 1, 0.05, 200);
    this.camera.up.set(0, 0, 1);
    this.root = new Group(); // the map's frame, turned so that z is up where the grid says that it is not
    this.voxels = new Voxels();
    this.layers = new Layers();
    this.root.add(this.voxels.group, this.layers.group);
    this.scene.add(this.root);
    this.labels = new Labels(names);
    this.follows = false;
    this.begun = false;
    this.pictures = 0;
    this.detail = 1; // least side of a voxel that is drawn [px]: grows where drawing is slow
    this.lag = FAST_MS; // mean [ms]
    this.inset = 0;
    this.orbit = new Orbit(this.camera, canvas, () => this.changed());
    this.hidden = new Set();
    this.setTheme("dark");
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  setTheme(theme) {
    this.scene.background = new Color(BACKGROUND[theme]);
    this.layers.setTheme(theme);
    if (this.floor) this.scene.remove(this.floor);
    this.floor = new GridHelper(60, 60, ...FLOOR[theme]);
    this.floor.rotation.x = Math.PI / 2;
    this.floor.position.z = this.floorZ ?? -1.2;
    this.floor.visible = !this.hidden.has("floor");
    this.scene.add(this.floor);
    this.changed();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.setViewOffset(width, height, this.inset / 2, 0, width, height);
    this.fit(true);
    this.changed();
  }

  /// So much at the right is covered [px]: the middle of the picture is that of the rest.
  setInset(inset) {
    this.inset = inset;
    this.resize();
  }

  /// The grid lies level at the floor's height: from it follow up and the floor.
  setGrid(grid) {
    const q = new Quaternion(...grid.pose.slice(3));
    this.root.quaternion.copy(q.invert());
    this.floorZ = new Vector3(...grid.pose.slice(0, 3)).applyQuaternion(this.root.quaternion).z;
    this.floor.position.z = this.floorZ - 0.02;
    this.layers.setGrid(grid);
    this.changed();
  }

  setLayer(name, shown) {
    const objects = { voxels: [this.voxels.group], path: [this.layers.path], keyframes: [this.layers.keyframes, this.layers.loops, this.layers.submap], camera: [this.layers.frustum], moving: [this.layers.moving], objects: [this.layers.objectBoxes], grid: [this.layers.grid], floor: [this.floor], names: [] }[name];
    for (const object of objects) object.visible = shown;
    if (shown) this.hidden.delete(name);
    else this.hidden.add(name);
    this.changed();
  }

  world(pointInMap) {
    return new Vector3().copy(pointInMap).applyQuaternion(this.root.quaternion);
  }

  setPose(pose) {
    this.layers.setPose(pose);
    if (this.follows) this.orbit.lookAt(this.world(new Vector3(...pose.slice(0, 3))));
    this.changed();
  }

  setPoseInSubmap(pose) {
    this.layers.setPoseInSubmap(pose);
    this.changed();
  }

  setSubmap(told) {
    this.layers.setSubmap(told, this.voxels.box());
    this.fit(true);
    this.changed();
  }

  /// Shows the whole map. @param onlyIfUntouched  the user has not chosen a view.
  fit(onlyIfUntouched = false) {
    if (onlyIfUntouched && (this.orbit.touched || this.follows)) return;
    const box = this.voxels.box();
    if (box.isEmpty()) return;
    if (this.layers.pose) box.expandByPoint(new Vector3(...this.layers.pose.slice(0, 3)));
    const { submap } = this.layers;
    if (submap.size) box.union(submap.around.clone().translate(submap.position));
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const tangent = Math.tan((this.camera.fov * Math.PI) / 360);
    this.orbit.lookAtAll(cornersOf(box).map((corner) => this.world(corner)), [(tangent * (width - this.inset) * FILLED) / height, tangent * FILLED]);
  }

  heights() {
    const box = this.voxels.box();
    if (box.isEmpty()) return;
    const up = this.up();
    const along = cornersOf(box).map((corner) => up.dot(corner));
    this.voxels.setHeights(this.floorZ ?? Math.min(...along), Math.max(...along));
  }

  /// In the map.
  up() {
    return new Vector3(0, 0, 1).applyQuaternion(this.root.quaternion.clone().invert());
  }

  /// The first picture is the map's, where there is one: without it, it would be drawn twice.
  begin() {
    if (this.begun) return;
    this.begun = true;
    this.changed();
  }

  changed() {
    if (this.due || !this.begun) return;
    this.due = true;
    this.asked = performance.now();
    requestAnimationFrame((now) => this.draw(now));
  }

  draw(now) {
    this.due = false;
    const seconds = Math.min((now - (this.last ?? now)) / 1000, 0.1) || 0.016;
    this.last = now;
    const still = !this.orbit.advance(seconds, matchMedia("(prefers-reduced-motion: reduce)").matches);
    this.camera.updateMatrixWorld();
    this.root.updateMatrixWorld();
    this.adapt(now - this.asked);
    const pixels = (this.renderer.domElement.height / 2) * this.camera.projectionMatrix.elements[5];
    this.voxels.prepare(this.camera.position.clone().applyQuaternion(this.root.quaternion.clone().invert()), pixels, this.detail);
    this.renderer.render(this.scene, this.camera);
    this.drawNames();
    ++this.pictures;
    if (!still || (this.detail > 1 && this.lag < FAST_MS)) this.changed(); // finer, as long as it is fast
  }

  setSharp(sharp) {
    this.sharp = sharp;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, MOST_PIXELS) * (sharp ? 1 : 0.5));
  }

  /// Pictures that are slow to draw become coarser: fewer voxels, then fewer pixels. @param lag  of this one [ms].
  adapt(lag) {
    const few = this.voxels.stats.voxels < FEW;
    this.lag = few ? FAST_MS : this.lag + 0.2 * (lag - this.lag);
    if (few) {
      if (!this.sharp) this.setSharp(true);
      this.detail = 1;
    } else if (this.lag > SLOW_MS) {
      if (this.sharp && this.detail === COARSEST_PX) this.setSharp(false);
      this.detail = Math.min(this.detail * Math.min(Math.sqrt(this.lag / SLOW_MS), 2), COARSEST_PX);
    } else if (this.lag < FAST_MS) {
      if (!this.sharp && this.detail === 1) this.setSharp(true);
      this.detail = Math.max(this.detail / 1.05, 1);
    }
  }

  drawNames() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const names = this.hidden.has("names") ? [] : this.layers.names().filter(({ layer }) => !this.hidden.has(layer));
    this.labels.draw(names, (pointInMap) => {
      const p = this.world(pointInMap).project(this.camera);
      return p.z < 1 && Math.abs(p.x) < 1.05 && Math.abs(p.y) < 1.05 ? [((p.x + 1) / 2) * width, ((1 - p.y) / 2) * height] : null;
    });
  }
}
