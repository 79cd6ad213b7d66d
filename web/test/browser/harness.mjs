// Starts `continuo view` and a browser, and looks at both.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { after } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const here = path.dirname(fileURLToPath(import.meta.url));
export const root = path.resolve(process.env.CONTINUO_ROOT ?? path.join(here, "../../.."));
export const command = process.env.CONTINUO_COMMAND ?? path.join(root, "build/continuo");
const page = process.env.CONTINUO_PAGE;  // a page to serve in place of the built-in one
const pictures = process.env.CONTINUO_PICTURES ?? path.join(tmpdir(), "continuo-pictures");
const browserPath = [process.env.CONTINUO_BROWSER, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((place) => place && existsSync(place));
/** Milliseconds, for whatever is waited for: only a test that fails waits so long, on a machine however busy. */
const limit = 60000;

export const model = (name) => path.join(root, "models", `${name}.sim`);
export const pageOptions = page ? ["--page", page] : [];

/** `continuo view FILE`, without a file where that is null: its address, with --listen also that of viewers, and how to
 *  end it. */
export async function serve(t, file, ...options) {
  const child = spawn(command, ["view", ...(file === null ? [] : [file]), "--no-open", ...pageOptions, ...options], { stdio: ["ignore", "pipe", "pipe"], cwd: root });
  let said = "";
  child.stderr.on("data", (data) => (said += data));
  const [url, viewers] = await new Promise((resolve, reject) => {
    let out = "";
    child.stdout.on("data", (data) => {
      out += data;
      const found = out.match(/http:\S+(?=\n)/g) ?? [];
      if (found.length >= (options.includes("--listen") ? 2 : 1)) resolve(found);
    });
    child.on("exit", (code) => reject(new Error(`continuo view ended with ${code}: ${said}`)));
  });
  t.after(async () => {
    await closeTabs();
    child.removeAllListeners("exit");
    const ended = new Promise((resolve) => child.on("exit", resolve));
    child.kill("SIGINT");
    await ended;
  });
  return { url, viewers, child };
}

let shared;
const tabs = [];

/** One browser for a file of tests, with a folder of its own. */
export async function browser() {
  if (!shared) {
    const home = mkdtempSync(path.join(tmpdir(), "continuo-browser-"));
    const context = await chromium.launchPersistentContext(home, {
      executablePath: browserPath,
      headless: true,
      args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars"],
      viewport: { width: 1280, height: 720 },
    });
    context.setDefaultTimeout(limit);
    shared = { context, home };
  }
  return shared.context;
}

after(async () => {
  await shared?.context.close();
  if (shared) rmSync(shared.home, { recursive: true, force: true });
});

/** Opens the page; any error in its console fails the test. */
export async function open(t, url, { width = 1280, height = 720, scheme = "light" } = {}) {
  const tab = await (await browser()).newPage();
  const problems = [];
  tabs.push({ tab, problems });
  t.after(closeTabs);
  tab.on("pageerror", (error) => problems.push(error.stack ?? String(error)));
  tab.on("console", (message) => message.type() === "error" && problems.push(message.text()));
  await tab.setViewportSize({ width, height });
  await tab.emulateMedia({ colorScheme: scheme });
  await tab.goto(url);
  await tab.waitForFunction(() => globalThis.continuo?.session.frame);
  return Object.assign(tab, { problems });
}

/** Before the server goes: a page that loses it complains, and rightly. */
async function closeTabs() {
  for (const { tab, problems } of tabs.splice(0)) {
    await tab.close();
    assert.deepEqual(problems, [], "errors in the console");
  }
}

/** What the page knows now. */
export const now = (tab) =>
  tab.evaluate(() => {
    const { session, app } = globalThis.continuo;
    const { history, model, state, frame } = session;
    const at = history.length - 1;
    return {
      t: frame?.t, state, run: frame?.run, rows: history.length, first: history.first, last: history.last, drawn: app.scene.drawn, scene: frame ? [...frame.scene] : [],
      ghost: frame?.ghostScene ? [...frame.ghostScene] : null, lookingBack: frame?.lookingBack,
      values: Object.fromEntries((model?.columns ?? []).map(({ name }, column) => [name, history.columns[column]?.[at]])), name: model?.name, events: session.events.length,
    };
  });

/** Waits until `test`, which sees what `now` gives, holds. */
export async function until(tab, test, what) {
  const end = Date.now() + limit;
  let seen;
  do {
    seen = await now(tab);
    if (test(seen)) return seen;
    await tab.waitForTimeout(60);
  } while (Date.now() < end);
  assert.fail(`${what}: not within ${limit} ms; at ${tab.url()}, t = ${seen.t}, state ${JSON.stringify(seen.state)}, values ${JSON.stringify(seen.values)}`);
}

/** Waits until it stands where `test` holds. That it no longer plays may be told before its last picture comes. */
export const stopped = (tab, what, test = () => true) => until(tab, (seen) => !seen.state.playing && seen.t === seen.state.t && test(seen), what);

/** Waits until the motion has gone on for so long, in its own time, after all that is known now. */
export async function later(tab, time, what) {
  const { t, state } = await now(tab);
  await until(tab, (seen) => seen.t > Math.max(t, state.t) + time, what);
}

/** Waits until the camera rests, which follows what moves with a delay: until then no place of the page stays that of a
 *  thing. */
export const still = (tab) =>
  tab.evaluate(() => new Promise((resolve) => {
    const { stage } = globalThis.continuo.app.scene;
    let before = "", same = 0;
    const look = () => {
      const view = [...stage.view, stage.width, stage.height].join();
      same = view === before ? same + 1 : 0;
      before = view;
      // A picture comes with every second frame of the browser, as long as the camera moves.
      if (same < 6) requestAnimationFrame(look);
      else resolve();
    };
    look();
  }));

/** Waits until the plots show all rows that have come. */
export const plotted = (tab) => tab.waitForFunction(() => !globalThis.continuo.app.plots.dirty);

export const button = (tab, name) => tab.getByRole("button", { name, exact: true });

export async function picture(tab, name) {
  mkdirSync(pictures, { recursive: true });
  await tab.screenshot({ path: path.join(pictures, `${name}.png`) });
}

/** Sets a slider as a hand would, to a part of its range between 0 and 1. */
export async function slide(tab, quantity, part) {
  const slider = tab.locator(`[data-quantity="${quantity}"] input[type=range]`);
  await slider.scrollIntoViewIfNeeded();
  const box = await slider.boundingBox();
  await tab.mouse.move(box.x + 8, box.y + box.height / 2);
  await tab.mouse.down();
  // At an end the hand goes beyond it.
  const beyond = part >= 1 ? 12 : part <= 0 ? -12 : 0;
  await tab.mouse.move(box.x + 8 + part * (box.width - 16) + beyond, box.y + box.height / 2, { steps: 4 });
  await tab.mouse.up();
}
