// SPDX-License-Identifier: Apache-2.0
const LAYERS = { voxels: "Voxels", path: "Path", keyframes: "Keyframes, loops", camera: "Camera", moving: "Passing", objects: "Objects", names: "Names", grid: "2-D grid", floor: "Floor lines", picture: "Picture" };
export const LAYER_NAMES = Object.keys(LAYERS);
export const LAYERS_AT_FIRST = LAYER_NAMES.filter((name) => name !== "grid");

/// A list of buttons or lines, made anew only where its content has changed.
export class List {
  constructor(element, count, none) {
    Object.assign(this, { element, count, none, shown: null });
  }

  /// @param items  {text, note, color, title, act}
  show(items) {
    this.count.textContent = items.length;
    const content = JSON.stringify(items);
    if (content === this.shown) return;
    this.shown = content;
    const lines = items.map((item) => {
      const line = document.createElement("li");
      const inner = document.createElement(item.act ? "button" : "div");
      inner.className = "item";
      inner.innerHTML = "<i></i><span></span><small></small>";
      inner.children[0].style.setProperty("--of", `rgb(${item.color})`);
      inner.children[1].textContent = item.text;
      inner.children[2].textContent = item.note;
      if (item.act) inner.onclick = item.act;
      line.append(inner);
      return line;
    });
    if (!lines.length) lines.push(Object.assign(document.createElement("li"), { className: "none", textContent: this.none }));
    this.element.replaceChildren(...lines);
  }
}

/// The boxes to tick, one a layer.
export function makeLayerBoxes(fieldset, toggled) {
  for (const [name, title] of Object.entries(LAYERS)) {
    const label = document.createElement("label");
    const box = Object.assign(document.createElement("input"), { type: "checkbox", name: "layer", value: name });
    box.onchange = () => toggled(name, box.checked);
    label.append(box, title);
    fieldset.append(label);
  }
}

/// What the colours of the voxels mean.
export function showLegend(element, mode, labels) {
  if (mode === "label") {
    element.replaceChildren(...labels.filter(({ name }) => name).map(({ name, color }) => {
      const entry = document.createElement("span");
      const patch = document.createElement("i");
      patch.style.setProperty("--of", `rgb(${color})`);
      entry.append(patch, name);
      return entry;
    }));
  } else if (mode === "height" || mode === "certainty") {
    const ends = mode === "height" ? ["floor", "top"] : ["likely", "certain"];
    const ramp = document.createElement("span");
    ramp.className = "ramp";
    ramp.style.background = "linear-gradient(90deg, #440154, #3b528b, #21918c, #5ec962, #fde725)";
    element.replaceChildren(ends[0], ramp, ends[1]);
  } else {
    element.replaceChildren();
  }
}
