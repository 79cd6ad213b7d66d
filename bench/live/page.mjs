// How fast the page draws ten thousand spheres: node page.mjs COMMAND [PAGE], PAGE served in place of the built-in one.
// It needs web/node_modules (npm ci in web/) and a Chromium. The spheres stand; all their places and turns are handed to the
// picture anew each time, as with every frame of a run, so that no physics is in the numbers.
import { spawn } from "node:child_process";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const { chromium } = createRequire(path.join(here, "../../web/package.json"))("playwright-core");
const [command, page] = process.argv.slice(2);
const executablePath = [process.env.CONTINUO_BROWSER, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((place) => place && existsSync(place));
const seconds = 5;

/** Milliseconds of processor time that the browser's processes of a kind have used. */
function used(kind) {
  let sum = 0;
  for (const pid of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      if (!readFileSync(`/proc/${pid}/cmdline`, "utf8").includes(`--type=${kind}`)) continue;
      const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
      sum += 10 * (Number(fields[11]) + Number(fields[12]));
    } catch {
      // it has ended meanwhile
    }
  }
  return sum;
}

const server = spawn(command, ["view", path.join(here, "spheres.sim"), "--no-open", "--paused", ...(page ? ["--page", page] : [])], { stdio: ["ignore", "pipe", "inherit"] });
const url = await new Promise((resolve) => server.stdout.on("data", (data) => /http:\S+/.test(data) && resolve(/http:\S+/.exec(data)[0])));
const browser = await chromium.launch({ executablePath, headless: true, args: ["--no-sandbox", "--disable-gpu"] });
const tab = await browser.newPage({ viewport: { width: 1280, height: 720 } });
await tab.goto(`${url}#view=60,-60,30,6,6,14`);
await tab.waitForFunction(() => globalThis.continuo?.session.frame && globalThis.continuo.app.scene.drawn > 1);
for (const what of ["nothing", "spheres"]) {
  const before = { gpu: used("gpu-process"), page: used("renderer") };
  const pictures = await tab.evaluate(([drawn, time]) => new Promise((resolve) => {
    const { session } = globalThis.continuo;
    const begin = performance.now();
    let count = 0;
    const next = () => {
      ++count;
      if (drawn === "spheres") session.tell("frame", session.frame);
      if (performance.now() - begin < 1000 * time) requestAnimationFrame(next);
      else resolve(count);
    };
    requestAnimationFrame(next);
  }), [what, seconds]);
  const size = await tab.evaluate(() => [...document.querySelectorAll(".surface canvas, .scene > canvas")].map(({ width, height }) => `${width}x${height}`).pop());
  const each = (kind, from) => ((used(kind) - from) / pictures).toFixed(1);
  console.log(`${what}: ${(pictures / seconds).toFixed(1)} pictures a second (canvas ${size}); processor for each: ${each("gpu-process", before.gpu)} ms drawing, ${each("renderer", before.page)} ms the page`);
}
await browser.close();
server.kill("SIGINT");
