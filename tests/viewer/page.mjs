// SPDX-License-Identifier: Apache-2.0
// page.mjs URL FOLDER: opens the viewer's page in Chromium, prints its figures as JSON for each line on standard input
// ("stats"), takes a screenshot ("shot NAME WIDTH HEIGHT HASH"), turns the view ("turn SECONDS"), opens the page once more beside it ("open") and ends with
// standard input. Errors of the page go into the figures.
import { createInterface } from "node:readline";
import { launch, open } from "./opening.mjs";

const [url, folder] = process.argv.slice(2);
const browser = await launch();
const page = await browser.newPage({ viewport: { width: 640, height: 400 }, colorScheme: "dark" });
const errors = [];
page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
page.on("pageerror", (error) => errors.push(String(error)));
page.on("requestfailed", (request) => errors.push(`${request.url()}: ${request.failure()?.errorText}`));
page.on("request", (request) => new URL(request.url()).host !== new URL(url).host && !/^(blob|data):/.test(request.url()) && errors.push(`asks for ${request.url()}`));
const started = Date.now();
await page.goto(url, { waitUntil: "load" });
await page.waitForFunction(() => window.rds?.view.pictures > 0);
const firstPictureMs = Date.now() - started;

const commands = {
  stats: async () => ({ ...(await page.evaluate(() => window.rds.stats)), firstPictureMs, errors, state: await page.textContent("#state"), services: await page.locator("#services tbody tr").count() }),
  shot: async (name, width, height, hash) => {
    await page.setViewportSize({ width: +width, height: +height });
    if (hash) {
      await page.goto("about:blank");
      await page.goto(`${url}#${hash}`);
      await page.waitForFunction(() => window.rds?.stats.complete, null, { timeout: 60000 });
    }
    await page.waitForTimeout(1500);
    await page.screenshot({ path: `${folder}/${name}.png` });
    return { shot: name };
  },
  turn: async (seconds) => page.evaluate(async (ms) => { // pictures a second while the view turns
    const { view } = window.rds;
    const end = performance.now() + ms, before = view.pictures;
    const step = (shown) => (view.orbit.turn(0.01, 0), performance.now() < end ? requestAnimationFrame(() => step(shown)) : shown());
    await new Promise(step);
    return +((1000 * (view.pictures - before)) / ms).toFixed(1);
  }, 1000 * seconds),
  open: async () => open(browser, url),
  key: async (name) => ({ key: await page.keyboard.press(name) }),
  eval: async (...code) => ({ value: await page.evaluate(code.join(" ")) }),
};
console.log(JSON.stringify({ ready: true, firstPictureMs }));
for await (const line of createInterface({ input: process.stdin })) {
  const [command, ...rest] = line.split(" ");
  try {
    console.log(JSON.stringify(await commands[command](...rest)));
  } catch (error) {
    console.log(JSON.stringify({ failed: String(error) }));
  }
}
await browser.close();
