// npm run thumbnails: makes the small pictures of the gallery from the models, by the page itself. Needs Chromium and
// the command (CONTINUO_COMMAND, by default ../build/continuo); names of models after -- make those alone.
import { spawn } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const here = path.dirname(fileURLToPath(import.meta.url));
const models = path.join(here, "../models");
const file = path.join(here, "src/thumbnails.json");
const command = process.env.CONTINUO_COMMAND ?? path.join(here, "../build/continuo");
const executablePath = [process.env.CONTINUO_BROWSER, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((place) => place && existsSync(place));
const size = { width: 192, height: 120 };

const view = spawn(command, ["view", path.join(models, "mass_spring.sim"), "--no-open", "--page", path.join(here, "dist/index.html")], { stdio: ["ignore", "pipe", "ignore"] });
const url = await new Promise((resolve) => view.stdout.on("data", (data) => /http:\S+/.test(data) && resolve(/http:\S+/.exec(data)[0])));
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
const page = await browser.newPage({ viewport: { width: 1000, height: 700 }, deviceScaleFactor: 2, colorScheme: "light" });
await page.goto(url);
await page.waitForFunction(() => globalThis.continuo?.session.frame, null, { timeout: 60000 });
// No larger than the picture, so that small balls are seen in it; of the grid only floors.
await page.addStyleTag({ content: ".scene { position: fixed !important; inset: 0 auto auto 0; width: 192px !important; height: 120px !important; z-index: 99; --grid: transparent; --grid-axis: transparent; --muted: transparent; } .bare .scene { display: none !important; }" });

/** The scene as it stands, or the first plot where there is none. */
const draw = ({ width, height }) => {
  const { app, session } = globalThis.continuo;
  const whole = Object.assign(document.createElement("canvas"), { width, height });
  const context = whole.getContext("2d");
  if (!app.scene.empty) {
    context.drawImage(app.scene.picture("rgba(0, 0, 0, 0)"), 0, 0, width, height);
    return whole.toDataURL("image/webp", 0.82);
  }
  const { history, model } = session;
  const plot = model.plots[0];
  const rows = history.length;
  const finite = (values) => values.filter((value) => Number.isFinite(value));
  const along = plot.against === "t" ? history.t.subarray(0, rows) : history.columns[plot.against.column].subarray(0, rows);
  const ways = plot.curves.slice(0, 4).map(({ column }) => history.columns[column].subarray(0, rows));
  const range = (values) => values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
  const [left, right] = range(finite(along));
  const [low, high] = range(ways.flatMap((values) => [...finite(values)]));
  const colors = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"];
  context.strokeStyle = "#8996a3";
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(5.5, 6);
  context.lineTo(5.5, height - 6.5);
  context.lineTo(width - 6, height - 6.5);
  context.stroke();
  ways.forEach((values, index) => {
    context.beginPath();
    values.forEach((value, row) => context.lineTo(8 + ((width - 16) * (along[row] - left)) / (right - left || 1), height - 10 - ((height - 20) * (value - low)) / (high - low || 1)));
    context.strokeStyle = colors[index];
    context.lineWidth = 2;
    context.stroke();
  });
  return whole.toDataURL("image/webp", 0.82);
};

const wanted = process.argv.slice(2);
const gallery = await page.evaluate(() => globalThis.continuo.session.model.gallery.map(({ name }) => name));
const before = existsSync(file) ? JSON.parse(readFileSync(file, "utf8")) : {};
const pictures = Object.fromEntries(Object.entries(before).filter(([name]) => gallery.includes(name)));
for (const name of wanted.length > 0 ? wanted : gallery) {
  await page.evaluate((model) => globalThis.continuo.session.send({ do: "open", model }), name);
  await page.waitForFunction((model) => globalThis.continuo.session.model.path.split("/").at(-1) === `${model}.sim` && globalThis.continuo.session.state, name, { timeout: 60000 });
  // A third of the run in two seconds; what takes longer is taken as it is after six.
  await page.evaluate(() => {
    const { session } = globalThis.continuo;
    const { from, to } = session.model.experiment;
    session.send({ do: "speed", value: Math.max((to - from) / 6, 1e-30) });
    session.send({ do: "play" });
  });
  await page.waitForFunction(() => {
    const { session } = globalThis.continuo;
    const { from, to } = session.model.experiment;
    return (session.frame?.t ?? from) > from + (to - from) * 0.33;
  }, null, { timeout: 6000 }).catch(() => undefined);
  await page.evaluate(() => globalThis.continuo.session.send({ do: "pause" }));
  await page.waitForTimeout(300);
  pictures[name] = await page.evaluate(draw, size);
  console.log(`${name}: ${pictures[name].length} bytes`);
}
writeFileSync(file, `${JSON.stringify(pictures, Object.keys(pictures).sort(), 1)}\n`);
await browser.close();
view.kill("SIGINT");
