// SPDX-License-Identifier: Apache-2.0
const POINTS = 240; // eight seconds at 30 Hz

/// A small plot of the newest values, with the newest as text.
class Plot {
  constructor(parent, name, unit, format) {
    const row = document.createElement("div");
    row.className = "plot";
    row.innerHTML = "<span></span><canvas role=\"img\"></canvas><output></output>";
    [this.label, this.canvas, this.output] = row.children;
    this.label.textContent = name;
    this.canvas.setAttribute("aria-label", `${name} over the last seconds`);
    this.unit = unit;
    this.format = format;
    this.values = [];
    parent.append(row);
  }

  add(value) {
    this.values.push(value);
    if (this.values.length > POINTS) this.values.shift();
    this.output.textContent = `${this.format(value)} ${this.unit}`;
  }

  draw() {
    const scale = devicePixelRatio, { clientWidth, clientHeight } = this.canvas;
    if (!clientWidth || !this.values.length) return;
    const width = (this.canvas.width = clientWidth * scale), height = (this.canvas.height = clientHeight * scale);
    const context = this.canvas.getContext("2d");
    const most = Math.max(...this.values, 1e-9) * 1.15;
    const x = (i) => ((i + POINTS - this.values.length) / (POINTS - 1)) * width, y = (v) => height - 1 - (v / most) * (height - 3);
    const color = getComputedStyle(document.documentElement).getPropertyValue("--accent");
    context.beginPath();
    this.values.forEach((v, i) => (i ? context.lineTo(x(i), y(v)) : context.moveTo(x(i), y(v))));
    context.strokeStyle = color;
    context.lineWidth = 1.5 * scale;
    context.stroke();
    context.lineTo(x(this.values.length - 1), height);
    context.lineTo(x(0), height);
    context.globalAlpha = 0.14;
    context.fillStyle = color;
    context.fill();
  }
}

/// Of the tracker, frame by frame.
export class Plots {
  constructor(element) {
    const whole = (v) => v.toFixed(0);
    this.total = new Plot(element, "frame time", "ms", (v) => v.toFixed(v < 100 ? 1 : 0));
    this.inliers = new Plot(element, "inliers", "", whole);
    this.dynamic = new Plot(element, "dynamic", "", whole);
    this.dropped = new Plot(element, "dropped", "", whole);
    this.plots = [this.total, this.inliers, this.dynamic, this.dropped];
    new ResizeObserver(() => this.draw()).observe(element);
  }

  add(tracking) {
    this.total.add(tracking.total_ms);
    this.inliers.add(tracking.inliers);
    this.dynamic.add(tracking.dynamic);
    this.dropped.add(tracking.dropped);
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => {
      this.due = false;
      this.draw();
    });
  }

  draw() {
    for (const plot of this.plots) plot.draw();
  }
}
