// SPDX-License-Identifier: Apache-2.0
import { Box3, Spherical, Vector3 } from "../vendor/three/three.module.js";

const TURN_PER_PIXEL = 0.006; // rad
const ZOOM_PER_NOTCH = 1.12;
const SETTLE_S = 0.09; // time constant of the movement towards what was asked for
const KEY_TURN = 0.09; // rad
const KEY_MOVE = 0.08; // of the distance
const LOWEST = 0.02, HIGHEST = Math.PI - 0.1; // polar angle

/// A camera that turns about a point; z is up. Mouse, touch (one finger turns, two move and zoom) and keys.
export class Orbit {
  constructor(camera, element, changed) {
    this.camera = camera;
    this.changed = changed;
    this.wanted = { target: new Vector3(), angle: new Spherical(9, 0.98, -2.05) }; // radius, polar, azimuth
    this.shown = { target: new Vector3(), angle: this.wanted.angle.clone() };
    this.touched = false; // by the user: the view no longer follows the map's size
    this.pointers = new Map();
    element.addEventListener("pointerdown", (e) => this.down(e, element));
    element.addEventListener("pointermove", (e) => this.move(e));
    for (const end of ["pointerup", "pointercancel"]) element.addEventListener(end, (e) => this.pointers.delete(e.pointerId));
    element.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    element.addEventListener("contextmenu", (e) => e.preventDefault());
    element.addEventListener("keydown", (e) => this.key(e));
  }

  down(event, element) {
    element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const dx = event.clientX - before.x, dy = event.clientY - before.y;
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
    if (others.length === 1) {
      const was = Math.hypot(before.x - others[0].x, before.y - others[0].y), is = Math.hypot(event.clientX - others[0].x, event.clientY - others[0].y);
      this.zoom(was / Math.max(is, 1));
      this.pan(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons & 6) {
      this.pan(dx, dy);
    } else {
      this.turn(-dx * TURN_PER_PIXEL, -dy * TURN_PER_PIXEL);
    }
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  }

  wheel(event) {
    event.preventDefault();
    this.zoom(event.deltaY > 0 ? ZOOM_PER_NOTCH : 1 / ZOOM_PER_NOTCH);
  }

  key(event) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (step && event.shiftKey) this.pan(-step[0] * KEY_MOVE * innerHeight, -step[1] * KEY_MOVE * innerHeight);
    else if (step) this.turn(step[0] * KEY_TURN, step[1] * KEY_TURN);
    else if (event.key === "+" || event.key === "=") this.zoom(1 / ZOOM_PER_NOTCH);
    else if (event.key === "-") this.zoom(ZOOM_PER_NOTCH);
    else return;
    event.preventDefault();
  }

  turn(azimuth, polar) {
    const { angle } = this.wanted;
    angle.theta += azimuth;
    angle.phi = Math.min(Math.max(angle.phi + polar, LOWEST), HIGHEST);
    this.touch();
  }

  zoom(factor) {
    this.wanted.angle.radius = Math.min(Math.max(this.wanted.angle.radius * factor, 0.2), 2000);
    this.touch();
  }

  pan(dx, dy) {
    const metres = (2 * this.shown.angle.radius * Math.tan((this.camera.fov * Math.PI) / 360)) / innerHeight;
    const right = new Vector3().setFromMatrixColumn(this.camera.matrix, 0), up = new Vector3().setFromMatrixColumn(this.camera.matrix, 1);
    this.wanted.target.addScaledVector(right, -dx * metres).addScaledVector(up, dy * metres);
    this.touch();
  }

  touch() {
    this.touched = true;
    this.changed();
  }

  /// Looks at a point from this far. @param radius  nullish: as far as now.
  lookAt(target, radius) {
    this.wanted.target.copy(target);
    if (radius) this.wanted.angle.radius = radius;
    this.changed();
  }

  /// Looks so that all points are seen, from the direction in which it looks. @param tangents  of half the angle of view, across and up.
  lookAtAll(points, tangents) {
    const { phi, theta } = this.wanted.angle;
    const back = new Vector3(Math.sin(phi) * Math.cos(theta), Math.sin(phi) * Math.sin(theta), Math.cos(phi));
    const right = new Vector3(-Math.sin(theta), Math.cos(theta), 0), up = new Vector3().crossVectors(back, right);
    const middle = new Box3().setFromPoints(points).getCenter(new Vector3());
    const away = points.map((point) => {
      const p = point.clone().sub(middle);
      return p.dot(back) + Math.max(Math.abs(p.dot(right)) / tangents[0], Math.abs(p.dot(up)) / tangents[1]);
    });
    this.lookAt(middle, Math.max(...away, 1));
  }

  /// Towards what is wanted. @returns whether it still moves.
  advance(seconds, at_once) {
    const share = at_once ? 1 : 1 - Math.exp(-seconds / SETTLE_S);
    const { target, angle } = this.shown;
    target.lerp(this.wanted.target, share);
    for (const part of ["radius", "phi", "theta"]) angle[part] += (this.wanted.angle[part] - angle[part]) * share;
    const { radius, phi, theta } = angle;
    this.camera.position.set(radius * Math.sin(phi) * Math.cos(theta), radius * Math.sin(phi) * Math.sin(theta), radius * Math.cos(phi)).add(target);
    this.camera.lookAt(target);
    this.camera.near = Math.max(radius / 200, 0.02);
    this.camera.far = radius * 20 + 100;
    this.camera.updateProjectionMatrix();
    return target.distanceTo(this.wanted.target) > 1e-3 || ["radius", "phi", "theta"].some((part) => Math.abs(this.wanted.angle[part] - angle[part]) > 1e-3);
  }

  /// For the address: six numbers; and back.
  toText() {
    const { target, angle } = this.wanted;
    return [...target.toArray(), angle.radius, angle.phi, angle.theta].map((v) => +v.toFixed(3)).join(",");
  }

  fromText(text) {
    const v = text.split(",").map(Number);
    if (v.length !== 6 || !v.every(Number.isFinite) || v[3] <= 0) return;
    this.wanted.target.fromArray(v);
    this.wanted.angle.set(v[3], v[4], v[5]);
    this.touched = true;
    this.advance(0, true);
  }
}
