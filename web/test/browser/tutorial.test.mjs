// docs/tutorial_live.md, done by hand: what it promises happens, and its pictures (build/pictures/live_*.png) are taken.
import assert from "node:assert/strict";
import { test } from "node:test";
import { button, model, now, open, picture, serve, slide, still, stopped, until } from "./harness.mjs";

const size = { width: 1120, height: 660 };
/** To wait less: the pictures are taken at the speed of the clock. */
const hurry = (tab, value) => tab.evaluate((speed) => globalThis.continuo.session.send({ do: "speed", value: speed }), value);
const settle = (tab) => tab.waitForTimeout(600);

test("ten minutes with the bouncing ball", async (t) => {
  const { url } = await serve(t, model("bouncing_ball"));
  const tab = await open(t, url, size);
  await hurry(tab, 4);
  await until(tab, ({ t: time }) => time > 6, "minute 1: it falls and bounces");
  await hurry(tab, 1);
  await until(tab, ({ state }) => state.target === 1, "at the speed of the clock again");
  await picture(tab, "live_ball");

  // In pause, lest the first impact be over when the next key comes.
  await button(tab, "Pause").click();
  await button(tab, "Reset to the start").click();
  await stopped(tab, "minute 2: at the start", ({ t: time }) => time === 0);
  await tab.keyboard.press("n");
  const impact = await stopped(tab, "to the first impact", ({ t: time }) => time > 0);
  assert.ok(Math.abs(impact.t - 10 / 7) < 1e-6);
  await tab.keyboard.press("n");
  await stopped(tab, "to the second", ({ t: time }) => time > impact.t);
  await settle(tab);
  await picture(tab, "live_impacts");

  await slide(tab, "e", 1);
  await until(tab, ({ state }) => state.parameters.e === 1, "minute 3: no loss");
  await tab.keyboard.press("Space");
  await hurry(tab, 4);
  const level = await until(tab, ({ t: time }) => time > 8, "it goes on");
  await hurry(tab, 1);
  assert.ok(level.values["energy"] > 0);

  // From the floor: at the height to which the hand lifts it, it might be already.
  await tab.keyboard.press("n");
  await stopped(tab, "at the next impact", ({ t: time }) => time > level.t);
  await still(tab);
  const grip = await tab.evaluate(() => globalThis.continuo.app.scene.onPage([0, globalThis.continuo.session.frame.scene[2], 0]));
  const top = await tab.evaluate(() => globalThis.continuo.app.scene.onPage([0, 9.5, 0]));  // of the ball's middle
  await tab.mouse.move(grip.x, grip.y);
  await tab.mouse.down();
  await tab.mouse.move(top.x, top.y, { steps: 6 });
  await until(tab, ({ values }) => Math.abs(values.h - 9) < 0.3, "minute 4: the hand lifts it");
  await tab.mouse.up();
  const lifted = await now(tab);
  assert.ok(Math.abs(lifted.values.energy - 9.8 * lifted.values.h) < 1, "its energy is that of the height");
});

test("as everybody programs it first, and the cure", async (t) => {
  const { url } = await serve(t, model("bouncing_ball"), "--paused");
  const tab = await open(t, url, size);
  await tab.keyboard.press("g");
  await tab.getByPlaceholder("find a model…").fill("through floor");
  await tab.keyboard.press("Enter");
  await until(tab, ({ name }) => name === "BallThroughFloor", "minute 5: the gallery opens it");
  await tab.evaluate(() => globalThis.continuo.session.state?.playing || globalThis.continuo.session.send({ do: "play" }));
  await hurry(tab, 4);
  await until(tab, ({ t: time }) => time > 7, "it plays");
  await hurry(tab, 1);
  await until(tab, ({ state }) => state.target === 1, "at the speed of the clock again");
  const { values, lowest } = await tab.evaluate(() => {
    const { history, model: now_ } = globalThis.continuo.session;
    const rows = history.columns[0].subarray(0, history.length);
    return { values: now_.name, lowest: Math.min(...rows) };
  });
  assert.ok(values && lowest < -0.2, "it sinks into the floor");
  await picture(tab, "live_floor");

  await tab.keyboard.press("g");
  await tab.locator('[data-model="ball_located"]').click();
  await until(tab, ({ name }) => name === "BallLocated", "minute 7: the cure");
  await tab.keyboard.press("h");
  await tab.getByLabel("Method of the ghost").selectOption("explicit_euler");
  await until(tab, ({ state }) => state.ghost?.method === "explicit_euler", "minute 8: a ghost");
  await tab.evaluate(() => globalThis.continuo.session.state?.playing || globalThis.continuo.session.send({ do: "play" }));
  const { t: from } = await now(tab);
  const seen = await until(tab, ({ t: time, ghost }) => ghost && time > from + 5, "both play");
  assert.ok(Math.abs(seen.values.energy - 98.1) < 1e-3, "the energy of the first stays");
  await picture(tab, "live_ghost");
});

test("the text, and an error in it", async (t) => {
  const { url } = await serve(t, model("bouncing_ball"));
  const tab = await open(t, url, size);
  await tab.keyboard.press("e");
  const line = tab.locator(".cm-line", { hasText: "mode flight" });
  await line.click();
  await tab.keyboard.press("End");
  await tab.keyboard.press("ArrowLeft");
  await tab.keyboard.press("ArrowLeft");
  await tab.keyboard.insertText(" - c*h'");
  const underlined = tab.locator(".cm-lintRange-error");
  await underlined.first().waitFor();
  assert.equal(await underlined.first().textContent(), "c");
  await settle(tab);
  await picture(tab, "live_text");
});
