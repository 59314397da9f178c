// SPDX-License-Identifier: Apache-2.0
const USED = 1, DYNAMIC = 2; // verdicts, as in FrameFeatures
const COLORS = ["rgba(200, 210, 220, .55)", "#3ddc84", "#ff5c50"];

/// The camera's picture with what became of its features, and the predicted boxes.
export class Picture {
  constructor(figure) {
    this.figure = figure;
    this.canvas = figure.querySelector("canvas");
    this.used = figure.querySelector("#picture-used");
    this.dynamic = figure.querySelector("#picture-dynamic");
    this.boxes = [];
  }

  async show(picture) {
    const image = await createImageBitmap(picture.jpeg).catch(() => null);
    if (!image) return;
    const context = this.canvas.getContext("2d");
    Object.assign(this.canvas, { width: picture.width, height: picture.height });
    context.drawImage(image, 0, 0);
    image.close();
    const size = picture.width / 160;
    for (const [x, y, verdict] of picture.features) {
      context.fillStyle = COLORS[verdict] ?? COLORS[0];
      context.fillRect(x - size / 2, y - size / 2, size, size);
    }
    this.drawBoxes(context, picture.width / 320);
    const count = (wanted) => picture.features.filter(([, , verdict]) => verdict === wanted).length;
    this.used.textContent = count(USED);
    this.dynamic.textContent = count(DYNAMIC);
    this.shown = true;
  }

  drawBoxes(context, width) {
    context.lineWidth = width;
    context.font = `600 ${7 * width}px system-ui, sans-serif`;
    for (const { image, label, id, movable } of this.boxes) {
      context.strokeStyle = context.fillStyle = movable ? "#ff8a3d" : "rgba(225, 232, 240, .7)";
      context.strokeRect(image[0], image[1], image[2] - image[0], image[3] - image[1]);
      context.fillText(`${label} ${id}`, image[0] + 2 * width, Math.max(image[1], 8 * width) - 2 * width);
    }
  }
}
