// SPDX-License-Identifier: Apache-2.0
const MOST = 80; // names at once

/// Names over the scene: HTML, so that they are sharp and of one size.
export class Labels {
  constructor(element) {
    this.element = element;
    this.shown = [];
  }

  /// @param names  {text, color, at (a vector in the world), moving}. @param project  of a point to [x, y] px, or null.
  draw(names, project) {
    const taken = [];
    let used = 0;
    for (const name of names) {
      if (used >= MOST) break;
      const place = project(name.at);
      if (!place || taken.some(([x, y]) => Math.abs(x - place[0]) < 56 && Math.abs(y - place[1]) < 17)) continue;
      taken.push(place);
      const label = this.shown[used] ?? this.add();
      label.textContent = name.text;
      label.className = name.moving ? "name moving" : "name";
      label.style.setProperty("--of", `rgb(${name.color})`);
      label.style.transform = `translate(-50%, -50%) translate(${place[0].toFixed(1)}px, ${place[1].toFixed(1)}px)`;
      label.hidden = false;
      ++used;
    }
    for (const label of this.shown.slice(used)) label.hidden = true;
  }

  add() {
    const label = document.createElement("span");
    this.element.append(label);
    this.shown.push(label);
    return label;
  }
}
