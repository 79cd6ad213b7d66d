// How fast the page draws ten thousand spheres: node page.mjs COMMAND PAGE [falling|pile|real|ball]
// It needs web/node_modules (npm ci) and a Chromium; PAGE is served in place of the built-in one.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const { chromium } = createRequire(path.join(here, "../../web/package.json"))("playwright-core");
const [command, page] = process.argv.slice(2);
const browserPath = [process.env.CONTINUO_BROWSER, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((place) => place && existsSync(place));
const seconds = 6;

/** Seconds of processor time that each process below `root` has used, by what it is. */
function used(root) {
  const all = readdirSync("/proc").filter((name) => /^\d+$/.test(name)).flatMap((pid) => {
    try {
      const [, rest] = readFileSync(`/proc/${pid}/stat`, "utf8").split(/\) /);
      const fields = rest.split(" ");
      const line = readFileSync(`/proc/${pid}/cmdline`, "utf8");
      return [{ pid: Number(pid), parent: Number(fields[1]), time: (Number(fields[11]) + Number(fields[12])) / 100, kind: /--type=([a-z-]+)/.exec(line)?.[1] ?? "browser" }];
    } catch {
      return [];
    }
  });
  const below = new Set([root]);
  for (let grown = true; grown; ) {
    grown = false;
    for (const { pid, parent } of all) if (below.has(parent) && !below.has(pid)) grown = !!below.add(pid);
  }
  const sums = {};
  for (const { pid, time, kind } of all) if (below.has(pid)) sums[pid === root ? "server" : kind] = (sums[pid === root ? "server" : kind] ?? 0) + time;
  return sums;
}

const add = (...parts) => parts.reduce((sum, part) => {
  for (const [name, value] of Object.entries(part)) sum[name] = (sum[name] ?? 0) + value;
  return sum;
}, {});

async function measure(what, { file, start, view, speed, size = { width: 1280, height: 720 } }) {
  const home = mkdtempSync(path.join(tmpdir(), "continuo-bench-"));
  const server = spawn(command, ["view", file, "--no-open", "--paused", ...(page ? ["--page", page] : [])], { stdio: ["ignore", "pipe", "inherit"] });
  const url = await new Promise((resolve) => server.stdout.on("data", (data) => /http:\S+/.test(data) && resolve(/http:\S+/.exec(data)[0])));
  const context = await chromium.launchPersistentContext(home, {
    executablePath: browserPath, headless: true, viewport: size,
    args: ["--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars"],
  });
  const tab = await context.newPage();
  await tab.goto(`${url}${view ? `#view=${view}` : ""}`);
  await tab.waitForFunction(() => globalThis.continuo?.session.frame);
  await tab.evaluate(() => (globalThis.continuo.session.send({ do: "speed", value: 0 }), globalThis.continuo.session.send({ do: "play" })));
  await tab.waitForFunction((t) => globalThis.continuo.session.frame.t >= t, start, { timeout: 300000 });
  await tab.evaluate((value) => globalThis.continuo.session.send({ do: "speed", value }), speed);
  await tab.waitForTimeout(2000);
  const [browser] = readFileSync(`/proc/${process.pid}/task/${process.pid}/children`, "utf8").trim().split(" ").map(Number).filter((pid) => pid !== server.pid);
  const before = add(used(browser), { server: used(server.pid).server });
  const seen = await tab.evaluate((time) => new Promise((resolve) => {
    const { session, app } = globalThis.continuo;
    const begin = performance.now();
    const drawn = app.scene.drawn;
    let frames = 0;
    session.on("frame", () => ++frames);
    setTimeout(() => {
      const passed = (performance.now() - begin) / 1000;
      resolve({ drawn: (app.scene.drawn - drawn) / passed, frames: frames / passed, t: session.frame.t, reached: session.frame.reached, canvas: app.scene.stage.canvas.width + "x" + app.scene.stage.canvas.height });
    }, 1000 * time);
  }), seconds);
  const after = add(used(browser), { server: used(server.pid).server });
  if (process.env.CONTINUO_PICTURES) await tab.screenshot({ path: path.join(process.env.CONTINUO_PICTURES, `bench_${what.replaceAll(" ", "_")}.png`) });
  const busy = Object.keys(after).map((name) => `${name} ${((100 * (after[name] - (before[name] ?? 0))) / seconds).toFixed(0)} %`);
  console.log(`${what}: ${seen.drawn.toFixed(1)} pictures a second of ${seen.canvas} (${seen.frames.toFixed(1)} frames came), t = ${seen.t.toFixed(2)}, ${seen.reached.toFixed(3)} of real time; processor: ${busy.join(", ")}`);
  await context.close();
  server.kill("SIGINT");
  rmSync(home, { recursive: true, force: true });
}

const spheres = path.join(here, "spheres.sim");
const pile = "22,-20,12,6,6,0.5";
const block = "60,-60,30,6,6,14";
const wanted = process.argv[4] ?? "all";
const programs = {
  falling: { file: spheres, start: 0.1, speed: 0.02, view: block },
  pile: { file: spheres, start: 3, speed: 0.02, view: pile },
  real: { file: spheres, start: 3, speed: 1, view: pile },
  ball: { file: path.join(here, "../../models/bouncing_ball.sim"), start: 1, speed: 1 },
};
for (const [name, program] of Object.entries(programs)) if (wanted === "all" || wanted === name) await measure(name, program);
process.exit(0);
