// Sliders, keys, the mouse on the mass, methods and the ghost, the address.
import assert from "node:assert/strict";
import { test } from "node:test";
import { button, model, now, open, picture, serve, slide, still, stopped, until } from "./harness.mjs";

const place = (tab, point) => tab.evaluate(([x, y]) => globalThis.continuo.app.scene.onPage([x, y, 0]), point);

test("a slider changes the motion, undo and the file take it back", async (t) => {
  const { url } = await serve(t, model("bouncing_ball"), "--paused");
  const tab = await open(t, url);
  const fall = async () => {
    await button(tab, "Reset to the start").click();
    await stopped(tab, "reset", ({ t: time }) => time === 0);
    await button(tab, "Run until the next event").click();
    const { t: time } = await stopped(tab, "it falls to the floor", ({ t: at }) => at > 0);
    return 20 / time ** 2;  // from 10 m
  };
  const before = await fall();
  assert.ok(Math.abs(before - 9.8) < 1e-6, `g is 9.8, not ${before}`);
  await slide(tab, "g", 1);
  await until(tab, ({ state }) => state.parameters.g === 30, "the slider reaches its end");
  const after = await fall();
  assert.ok(Math.abs(after - 30) < 1e-6, `g is 30 now, not ${after}`);
  await until(tab, () => tab.url().includes("p.g=30"), "the address carries it");

  await tab.keyboard.press("u");
  await until(tab, ({ state }) => state.parameters.g !== 30, "undo takes it back");
  await slide(tab, "g", 0.1);
  await until(tab, ({ state }) => state.parameters.g < 5, "another value");
  await button(tab, "Parameters as in the file").click();
  await until(tab, ({ state }) => state.parameters.g === 9.8, "as in the file");
});

test("the address brings parameters, method and ghost back", async (t) => {
  const { url } = await serve(t, model("spring_pendulum"));
  const tab = await open(t, `${url}#p.k=55&method=rk4,step=0.02&ghost=explicit_euler,step=0.02&speed=0.5`);
  const { state } = await until(tab, ({ state: s }) => s.parameters.k === 55 && s.method === "rk4" && s.ghost && s.target === 0.5, "what the address says");
  assert.equal(state.step, 0.02);
  assert.equal(state.ghost.method, "explicit_euler");
});

test("a key drives the car", async (t) => {
  // In pause, lest its files drive it before the keys do.
  const { url } = await serve(t, model("car"), "--paused");
  const tab = await open(t, url);
  await tab.keyboard.down("w");
  await button(tab, "Play").click();
  const driving = await until(tab, ({ state, values }) => state.inputs.throttle === 1 && values.v > 3, "w is the throttle");
  await tab.keyboard.up("w");
  const rolling = await until(tab, ({ state }) => state.inputs.throttle === 0, "let go, the car rolls");
  await tab.keyboard.down("s");
  const braked = await until(tab, ({ state, values }) => state.inputs.brake === 1 && values.v < 0.5 * rolling.values.v, "s is the brake");
  await tab.keyboard.up("s");
  assert.ok(braked.values.x > driving.values.x, "it has moved on meanwhile");
  await picture(tab, "car");
});

test("dragging the mass moves it, and the energy shows the work done", async (t) => {
  const { url } = await serve(t, model("mass_spring"));
  const tab = await open(t, url);
  await until(tab, ({ t: time }) => time > 0.5, "it plays");
  await button(tab, "Pause").click();
  const paused = await stopped(tab, "it pauses");
  await still(tab);
  const item = await tab.evaluate(() => globalThis.continuo.session.model.drawing.findIndex(({ drag }) => drag));
  const at = await tab.evaluate((index) => {
    const { session } = globalThis.continuo;
    return session.model.drawing[index].numbers.at.map((number) => session.frame.scene[number]);
  }, item);
  const from = await place(tab, at);
  const to = await place(tab, [-7, at[1]]);
  await tab.mouse.move(from.x, from.y);
  await tab.mouse.down();
  await tab.mouse.move((from.x + to.x) / 2, from.y, { steps: 5 });
  await tab.mouse.move(to.x, to.y, { steps: 8 });
  const held = await until(tab, ({ values }) => Math.abs(values.x + 7) < 0.1, "the mass is where the mouse is");
  await tab.mouse.up();
  // At rest at x the energy is k*x^2/2 with k = 1; it was 12.5 J.
  assert.ok(Math.abs(held.values.energy - held.values.x ** 2 / 2) < 0.6, `the energy is that of the stretched spring: ${held.values.energy}`);
  assert.ok(held.values.energy > 1.5 * paused.values.energy, "work was done");
  await button(tab, "Play").click();
  const gone = await until(tab, ({ values }) => values.x > 3, "let go, it swings from there");
  assert.ok(Math.abs(gone.values.energy - held.values.energy) < 0.15 * held.values.energy, "and keeps what it was given");
  const shown = await tab.locator('[data-plot="energy"] canvas').evaluate((canvas) => canvas.width > 50);
  assert.ok(shown);
  await picture(tab, "dragged");
});

test("keys alone select the mass and drag it", async (t) => {
  const { url } = await serve(t, model("mass_spring"), "--paused");
  const tab = await open(t, url);
  const before = await now(tab);
  await tab.keyboard.press("d");
  for (let i = 0; i < 4; ++i) await tab.keyboard.press("ArrowRight");
  await until(tab, ({ values }) => values.x > before.values.x + 0.5, "the arrow keys drag it");
  assert.match(await tab.locator(".card").textContent(), /box at/);
});

test("another method, and a ghost beside the first with its distance", async (t) => {
  const { url } = await serve(t, model("mass_spring"));
  const tab = await open(t, url);
  await tab.getByLabel("Method", { exact: true }).selectOption("explicit_euler");
  await until(tab, ({ state }) => state.method === "explicit_euler", "the method is taken");
  await tab.locator("summary", { hasText: "Ghost" }).click();
  await tab.getByLabel("Method of the ghost").selectOption("rk4");
  const first = await until(tab, ({ state, ghost }) => state.ghost?.method === "rk4" && ghost, "the ghost is there");
  assert.equal(first.ghost.length, first.scene.length);
  await tab.waitForSelector('[data-plot="distance"]');
  await until(tab, ({ t: time, values }) => time > first.t + 3 && values.distance > 0.05, "Euler leaves the other");
  await picture(tab, "ghost");
  await tab.getByLabel("Method of the ghost").selectOption("");
  await until(tab, ({ state }) => !state.ghost, "it goes again");
  await tab.waitForSelector('[data-plot="distance"]', { state: "detached" });
});
