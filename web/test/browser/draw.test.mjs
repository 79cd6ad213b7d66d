// Drawing a world by hand: the text grows, checks, and says what was drawn; what was written stays.
import assert from "node:assert/strict";
import { test } from "node:test";
import { button, model, now, open, picture, serve, stopped, until } from "./harness.mjs";

const textOf = (tab) => tab.evaluate(() => globalThis.continuo.session.model.text);
const names = (tab) => tab.evaluate(() => globalThis.continuo.session.model.bodies?.names ?? []);

async function begin(t, options) {
  const { url } = await serve(t, model("drawing_board"));
  const tab = await open(t, url, options);
  await until(tab, ({ t: time }) => time > 0.1, "it moves");
  await button(tab, "Draw balls, walls and springs").click();
  await stopped(tab, "it is at the start", ({ t: time }) => time === 0);
  // From then on the picture stands, and a place on the page remains one of the world.
  await tab.waitForFunction(() => !globalThis.continuo.app.scene.stage.automatic);
  return tab;
}

/** What was written runs and is shown, or is wrong; a gesture that writes nothing leaves what was there. */
const runs = (tab) =>
  tab.waitForFunction(() => {
    const { app, session } = globalThis.continuo;
    return (session.model.text === app.editor.text && session.frame?.positions) || document.querySelector(".message.error");
  });

/** A gesture over the scene, in parts of its size. */
async function drag(tab, [x0, y0], [x1, y1] = [x0, y0]) {
  const box = await tab.locator(".draw-layer").boundingBox();
  await tab.mouse.move(box.x + x0 * box.width, box.y + y0 * box.height);
  await tab.mouse.down();
  await tab.mouse.move(box.x + x1 * box.width, box.y + y1 * box.height, { steps: 3 });
  await tab.mouse.up();
  await runs(tab);
}

test("balls, walls and springs become lines of the text", async (t) => {
  const tab = await begin(t);
  const before = await textOf(tab);
  await drag(tab, [0.2, 0.4]);
  assert.deepEqual(await names(tab), ["ball1", "ball2"]);
  await button(tab, "Wall").click();
  await drag(tab, [0.08, 0.8], [0.08, 0.2]);
  assert.match(await textOf(tab), /\n  wall left_wall \(1, 0\) at -[\d.]+\n/);
  await button(tab, "Spring").click();
  await drag(tab, [0.2, 0.4], [0.35, 0.25]);
  assert.match(await textOf(tab), /\n  spring ball2 to \(-?[\d.]+, [\d.]+\) stiffness 40 damping 0.2\n/);
  await picture(tab, "draw_spring");
  await button(tab, "Move").click();
  await drag(tab, [0.2, 0.4], [0.22, 0.5]);
  assert.deepEqual(await names(tab), ["ball1", "ball2"]);
  await button(tab, "Delete").click();
  await drag(tab, [0.22, 0.5]);
  assert.deepEqual(await names(tab), ["ball1"]);
  assert.doesNotMatch(await textOf(tab), /\n  spring /, "its spring went with it");
  for (let i = 0; i < 20 && (await textOf(tab)) !== before; ++i) {
    await tab.keyboard.press("Control+z");
    await runs(tab);
  }
  assert.equal(await textOf(tab), before, "all of it is undone");
  await tab.keyboard.press("Control+y");
  await tab.waitForFunction(() => globalThis.continuo.session.model.bodies.count === 2);
  await tab.getByRole("button", { name: "Play", exact: true }).last().click();
  await until(tab, ({ t: time }) => time > 0.3, "what was drawn moves");
});

test("what is undone and done again before it runs is as it was", async (t) => {
  const tab = await begin(t);
  await drag(tab, [0.2, 0.4]);
  await drag(tab, [0.8, 0.4]);
  const drawn = await textOf(tab);
  // At once: no model comes between them.
  const twice = (what) => tab.evaluate((name) => [1, 2].forEach(() => globalThis.continuo.app.board.paper[name]()), what);
  await twice("undo");
  await tab.waitForFunction(() => globalThis.continuo.session.model.bodies.count === 1);
  await runs(tab);
  await twice("redo");
  await tab.waitForFunction(() => globalThis.continuo.session.model.bodies.count === 3);
  await runs(tab);
  assert.equal(await textOf(tab), drawn);
});

test("with the keys alone, and on a telephone", async (t) => {
  const tab = await begin(t, { width: 390, height: 844 });
  await tab.locator(".draw-layer").focus();
  for (let i = 0; i < 6; ++i) await tab.keyboard.press("ArrowLeft");
  for (let i = 0; i < 6; ++i) await tab.keyboard.press("ArrowUp");
  await tab.keyboard.press("Enter");
  await tab.keyboard.press("Enter");
  await tab.waitForFunction(() => globalThis.continuo.session.model.bodies.count === 2);
  await picture(tab, "draw_telephone");
  assert.equal(await tab.evaluate(() => document.documentElement.scrollWidth > innerWidth + 1), false);
});

test("a change of the text by hand changes the drawing", async (t) => {
  const tab = await begin(t);
  await tab.evaluate(() => {
    const { session } = globalThis.continuo;
    session.send({ do: "run", text: session.model.text.replace("at (0, 3)", "at (1, 4)") });
  });
  await tab.waitForFunction(() => Math.abs(globalThis.continuo.session.frame?.positions?.[0] - 1) < 1e-6);
});

test("after any gestures the text is in order and its world is what was drawn", async (t) => {
  const tab = await begin(t);
  let state = 7;
  const random = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
  for (let step = 0; step < 25; ++step) {
    const tool = ["Ball", "Ball", "Wall", "Spring", "Move", "Delete"][Math.floor(6 * random())];
    await button(tab, tool).click();
    const point = () => [0.05 + 0.9 * random(), 0.15 + 0.7 * random()];
    const from = point();
    await drag(tab, from, tool === "Ball" || tool === "Delete" ? from : point());
    const bodies = [...(await textOf(tab)).matchAll(/^ {2}body (\w+) at/gm)].map(([, name]) => name);
    assert.deepEqual((await names(tab)).sort(), bodies.sort());
    assert.equal(await tab.locator(".message.error").count(), 0, await textOf(tab));
  }
  await picture(tab, "draw_random");
  const seen = await now(tab);
  assert.ok(seen.name === "DrawingBoard");
});
