// How long it takes from the command to its first picture: first_picture.mjs COMMAND MODEL.sim [TIMES]
// From the start of `continuo view` until the page has drawn a frame of the motion and the browser has shown it. With a
// browser that is there already, as a lecturer has it; the browser's own start is measured apart.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import path from "node:path";

const [command, model, times = "9"] = process.argv.slice(2);
const modules = process.env.CONTINUO_NODE_MODULES ?? path.join(path.dirname(path.resolve(command)), "web/node_modules");
const { chromium } = createRequire(path.join(modules, "x.js"))("playwright-core");
const executablePath = [process.env.CONTINUO_BROWSER, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"]
  .find((place) => place && existsSync(place));

const now = () => performance.now();

async function view() {
  const begin = now();
  const child = spawn(command, ["view", model, "--no-open"], { stdio: ["ignore", "pipe", "ignore"] });
  const url = await new Promise((resolve, reject) => {
    child.stdout.once("data", (data) => resolve(String(data).trim()));
    child.once("exit", (code) => reject(new Error(`continuo view ended with ${code}`)));
  });
  return { begin, addressed: now(), url, end: () => child.kill("SIGINT") };
}

/** Resolves when a frame of the motion has been drawn and the picture after it begun: then it is on the screen. */
const firstPicture = () =>
  new Promise((resolve) => {
    const look = () => (globalThis.continuo?.session.frame ? requestAnimationFrame(() => resolve(true)) : requestAnimationFrame(look));
    look();
  });

const home = mkdtempSync(path.join(tmpdir(), "continuo-first-picture-"));
const started = now();
const context = await chromium.launchPersistentContext(home, {
  executablePath,
  headless: true,
  args: ["--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
});
await context.newPage();
const browserStart = now() - started;

const runs = [];
for (let k = 0; k < Number(times); ++k) {
  const tab = await context.newPage();
  const viewed = await view();
  await tab.goto(viewed.url, { waitUntil: "commit" });
  const committed = now();
  await tab.evaluate(firstPicture);
  runs.push({ address: viewed.addressed - viewed.begin, page: committed - viewed.begin, picture: now() - viewed.begin });
  await tab.close();
  viewed.end();
}
await context.close();
rmSync(home, { recursive: true, force: true });

const middle = (name) => runs.map((run) => run[name]).sort((a, b) => a - b)[Math.floor(runs.length / 2)];
const least = (name) => Math.min(...runs.map((run) => run[name]));
const say = (name) => `${least(name).toFixed(0)} ms at best, ${middle(name).toFixed(0)} ms in the middle`;
console.log(`${path.basename(model)}, ${runs.length} times: address ${say("address")}; page ${say("page")}; first picture ${say("picture")}; ` +
  `the browser's own start ${browserStart.toFixed(0)} ms`);
