// SPDX-License-Identifier: Apache-2.0
// How the page comes up: in which order, what it asks for, and how long each part takes [ms from the navigation on].
// As a program, opening.mjs URL TIMES: a line of JSON for each time.
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

/// Draws by the processor, as machines without a graphics card do.
export const launch = () => chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--disable-dev-shm-usage"],
});

/// Runs in the page before its own scripts.
function watch() {
  const told = (window.opening = { kinds: [], waits: {}, times: {} });
  const mark = (name) => (told.times[name] ??= Math.round(performance.now()));
  const MAP = 2;
  window.WebSocket = class extends WebSocket {
    constructor(...rest) {
      super(...rest);
      mark("asked");
      this.addEventListener("open", () => mark("connected"));
      this.addEventListener("message", ({ data }) => {
        const kind = new Uint8Array(data)[3];
        told.kinds.push(kind);
        if (kind === MAP) mark("map");
      });
    }
  };
  let gl = null;
  const getContext = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
    if (!kind.startsWith("webgl")) return getContext.call(this, kind, ...rest);
    mark("files"); // all are there and have run, as far as the view
    const begun = performance.now();
    gl = getContext.call(this, kind, ...rest);
    told.waits.context ??= Math.round(performance.now() - begun);
    return gl;
  };
  const next = requestAnimationFrame;
  window.requestAnimationFrame = (draw) => next((now) => {
    const pictures = window.rds?.view.pictures;
    const begun = performance.now();
    draw(now);
    if (told.times.shown || window.rds?.view.pictures === pictures) return;
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits until it is drawn
    told.waits.draw ??= Math.round(performance.now() - begun);
    told.voxels ??= window.rds.stats.voxels; // in the first picture
    if (window.rds.stats.voxels > 0) mark("shown");
  });
}

/// Opens the page in a browser that has nothing of it.
export async function open(browser, url) {
  const context = await browser.newContext({ viewport: { width: 640, height: 400 } });
  const page = await context.newPage();
  await page.addInitScript(watch);
  await page.goto(url, { waitUntil: "commit" });
  await page.waitForFunction(() => window.opening.times.shown, null, { polling: 50 });
  const told = await page.evaluate(() => ({
    ...window.opening,
    asked: performance.getEntriesByType("resource").map(({ name }) => new URL(name).pathname).filter((path) => path.endsWith("js")),
    named: [...document.querySelectorAll("script, link[rel=modulepreload]")].map(({ src, href }) => new URL(src || href).pathname),
  }));
  await context.close();
  return told;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [url, times] = process.argv.slice(2);
  const browser = await launch();
  for (let i = 0; i < +times; ++i) console.log(JSON.stringify(await open(browser, url)));
  await browser.close();
}
