// SPDX-License-Identifier: Apache-2.0
import { Vector3 } from "./vendor/three/three.module.js";
import { connection } from "./connection.js";
import { Commands } from "./panels/commands.js";
import { LAYERS_AT_FIRST, LAYER_NAMES, List, makeLayerBoxes, showLegend } from "./panels/panels.js";
import { Picture } from "./panels/picture.js";
import { Plots } from "./panels/plots.js";
import { Services } from "./panels/services.js";
import { COLORS } from "./scene/voxels.js";
import { View } from "./scene/view.js";

const STATES = [["starting", "none"], ["tracking", "good"], ["weak", "warn"], ["lost", "bad"], ["relocalised", "good"], ["beside the map", "warn"]]; // as in TrackingState
const IN_MAP = [1, 2, 4], IN_SUBMAP = 5;
const SILENT_MS = 3000; // without a frame of the camera: no longer live
const ADDRESS_MS = 400;
const BEFORE_MAP = ["connected", "hello"]; // what is next is the map, or there is none
const NARROW = matchMedia("(max-width: 720px)");
const byId = (id) => document.getElementById(id);

const view = new View(byId("view"), byId("names"));
const picture = new Picture(byId("picture"));
const plots = new Plots(byId("plots"));
const services = new Services(byId("services"));
const moving = new List(byId("moving"), byId("moving-count"), "nobody");
const objects = new List(byId("objects"), byId("objects-count"), "none yet");
const settings = { color: "picture", layers: new Set(LAYERS_AT_FIRST), theme: null };
let labels = [];
let silence = 0;

function setState(text, kind) {
  const pill = byId("state");
  if (pill.textContent !== text) pill.textContent = text;
  pill.dataset.state = kind;
}

// ---- what the services tell

const seen = {};
const listener = {
  connected(is) {
    seen.connected = is;
    if (is) setState("waiting", "none");
    else setState("not connected", "bad");
  },
  hello({ version, commands, domain }) {
    byId("version").textContent = `version ${version}, domain ${domain}`;
    commandsPanel.allow(commands);
  },
  map(map) {
    view.voxels.apply(map);
    const { stats } = view.voxels;
    byId("empty").hidden = stats.voxels > 0;
    byId("stat-voxels").textContent = stats.voxels.toLocaleString("en");
    byId("view").setAttribute("aria-label", `3-D view of the map: ${stats.voxels} voxels, ${view.layers.objects.length} objects`);
    view.heights();
    view.fit(true);
    view.changed();
  },
  labels(told) {
    labels = told;
    view.voxels.setLabels(told);
    showLegend(byId("legend"), settings.color, labels);
    view.changed();
  },
  tracking(tracking) {
    const [text, kind] = STATES[tracking.state] ?? ["?", "none"];
    setState(text, kind);
    clearTimeout(silence);
    silence = setTimeout(() => setState("no camera", "none"), SILENT_MS);
    byId("stat-frame").textContent = `${tracking.total_ms.toFixed(1)} ms`;
    byId("stat-inliers").textContent = tracking.inliers.toFixed(0);
    if (IN_MAP.includes(tracking.state)) view.setPose(tracking.pose);
    else if (tracking.state === IN_SUBMAP && view.layers.submap.size) view.setPoseInSubmap(tracking.pose);
    plots.add(tracking);
  },
  camera(camera) {
    view.layers.camera = camera;
  },
  path(path) {
    view.layers.setPath(path);
    view.changed();
  },
  keyframes(told) {
    view.layers.setKeyframes(told);
    byId("stat-keyframes").textContent = told.keyframes.size;
    byId("stat-loops").textContent = told.loops.length;
    view.changed();
  },
  submap(told) {
    view.setSubmap(told);
  },
  boxes(boxes) {
    picture.boxes = boxes;
    const passing = boxes.filter(({ movable }) => movable);
    view.layers.setBoxes(passing);
    moving.show(passing.map(({ id, label, velocity, color }) => ({ text: `${label} ${id}`, note: `${Math.hypot(...velocity).toFixed(1)} m/s`, color })));
    view.changed();
  },
  objects(told) {
    view.layers.setObjects(told);
    objects.show(told.map((object) => ({ text: object.label, note: object.size.map((s) => s.toFixed(1)).join(" × ") + " m", color: object.color, act: () => goTo(object) })));
    view.changed();
  },
  grid(grid) {
    view.setGrid(grid);
    view.heights();
    view.fit(true);
  },
  async picture(told) {
    await picture.show(told);
    byId("picture").hidden = !settings.layers.has("picture");
  },
  services: (told) => services.show(told),
  reply: (told) => commandsPanel.reply(told),
};

function goTo({ pose, size }) {
  setFollow(false);
  view.orbit.touched = true;
  view.orbit.lookAt(view.world(new Vector3(...pose.slice(0, 3))), Math.max(2.2 * Math.hypot(...size), 1));
  keepAddress();
}

// ---- what the user chooses; the address holds it

function setColor(color) {
  settings.color = color;
  document.querySelector(`input[name=color][value=${color}]`).checked = true;
  view.voxels.setColors(color);
  showLegend(byId("legend"), color, labels);
  view.changed();
  keepAddress();
}

function setLayer(name, shown) {
  if (shown) settings.layers.add(name);
  else settings.layers.delete(name);
  document.querySelector(`input[name=layer][value=${name}]`).checked = shown;
  if (name === "picture") {
    byId("picture").hidden = !shown || !picture.shown;
    connection.wantPicture(shown);
  } else {
    view.setLayer(name, shown);
  }
  keepAddress();
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme ?? (matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark");
  settings.theme = theme;
  view.setTheme(document.documentElement.dataset.theme);
  keepAddress();
}

function setFollow(follows) {
  view.follows = follows;
  byId("follow").setAttribute("aria-pressed", follows);
  if (follows && view.layers.pose) {
    view.orbit.lookAt(view.world(new Vector3(...view.layers.pose.slice(0, 3))), Math.min(view.orbit.wanted.angle.radius, 5));
  }
  keepAddress();
}

function setPanel(shown) {
  byId("panel").hidden = !shown;
  byId("menu").setAttribute("aria-expanded", shown);
  view.setInset(shown && !NARROW.matches ? byId("panel").offsetWidth + 12 : 0);
}

let addressDue = 0;
function keepAddress() {
  clearTimeout(addressDue);
  addressDue = setTimeout(() => {
    const told = new URLSearchParams({ color: settings.color, layers: [...settings.layers].join(",") });
    if (view.follows) told.set("follow", "1");
    if (settings.theme) told.set("theme", settings.theme);
    if (view.orbit.touched) told.set("view", view.orbit.toText());
    history.replaceState(null, "", `#${told.toString().replaceAll("%2C", ",")}`);
  }, ADDRESS_MS);
}

function readAddress() {
  const told = new URLSearchParams(location.hash.slice(1));
  const layers = told.has("layers") ? told.get("layers").split(",") : LAYERS_AT_FIRST;
  setTheme(["light", "dark"].includes(told.get("theme")) ? told.get("theme") : null);
  for (const name of LAYER_NAMES) setLayer(name, layers.includes(name));
  setColor(COLORS.includes(told.get("color")) ? told.get("color") : "picture");
  setFollow(told.get("follow") === "1");
  if (told.has("view")) view.orbit.fromText(told.get("view"));
}

const KEYS = {
  f: () => fit(),
  c: () => setFollow(!view.follows),
  t: () => byId("theme").click(),
  m: () => byId("menu").click(),
  p: () => setLayer("picture", !settings.layers.has("picture")),
  ...Object.fromEntries(COLORS.map((color, i) => [String(i + 1), () => setColor(color)])),
};

function fit() {
  setFollow(false);
  view.orbit.touched = false;
  view.fit();
  keepAddress();
}

const commandsPanel = new Commands(byId("commands"), (message) => connection.say(message));
makeLayerBoxes(byId("layers"), setLayer);
for (const input of document.querySelectorAll("input[name=color]")) input.onchange = () => setColor(input.value);
byId("fit").onclick = fit;
byId("follow").onclick = () => setFollow(!view.follows);
byId("theme").onclick = () => setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");
byId("menu").onclick = () => setPanel(byId("panel").hidden);
NARROW.addEventListener("change", () => setPanel(!NARROW.matches));
matchMedia("(prefers-color-scheme: light)").addEventListener("change", () => settings.theme ?? setTheme(null));
addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input:not([type=radio]):not([type=checkbox])")) return;
  KEYS[event.key.toLowerCase()]?.();
});
for (const moved of ["pointerup", "wheel", "keyup"]) byId("view").addEventListener(moved, keepAddress, { passive: true });
readAddress();
setPanel(!NARROW.matches);
moving.show([]);
objects.show([]);
connection.listen((kind, told) => {
  listener[kind]?.(told);
  if (!BEFORE_MAP.includes(kind)) view.begin();
});

/// For tests and for who is curious: what is shown now.
window.rds = { view, picture, get stats() { return { ...view.voxels.stats, connected: seen.connected, pictures: view.pictures, path: view.layers.pathLength, boxes: view.layers.boxes.length, objects: view.layers.objects.length, labels: labels.length, keyframes: byId("stat-keyframes").textContent, picture: picture.shown ?? false, submap: view.layers.submap.size }; } };
