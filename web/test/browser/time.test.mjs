// Play, pause, step, back, reset, until the next event, looking back; speed.
import assert from "node:assert/strict";
import { test } from "node:test";
import { button, model, now, open, picture, serve, until } from "./harness.mjs";

test("the transport does what its buttons say", async (t) => {
  // Slowly: on a busy machine the hand that pauses comes late, and the first impact is at 10/7 s.
  const { url } = await serve(t, model("bouncing_ball"), "--speed", "0.1");
  const tab = await open(t, url);
  const going = await until(tab, ({ t: time, state }) => state.playing && time > 0.05, "it plays by itself");
  await button(tab, "Pause").click();
  const paused = await until(tab, ({ state }) => !state.playing, "it pauses");
  assert.ok(paused.t >= going.t);
  await tab.waitForTimeout(300);
  assert.equal((await now(tab)).t, paused.t, "a pause stands still");

  await button(tab, "One step on").click();
  const stepped = await until(tab, ({ t: time }) => time > paused.t, "a step goes on");
  await button(tab, "One step back").click();
  await until(tab, ({ t: time }) => time < stepped.t, "and back");

  await button(tab, "Run until the next event").click();
  const event = await until(tab, ({ t: time, state }) => !state.playing && time > 1.4, "it runs to the impact");
  assert.ok(Math.abs(event.t - 10 / 7) < 1e-6, `the first impact is at 10/7 s, not at ${event.t}`);
  assert.ok(event.events >= 1, "and the event is marked");
  const worst = await tab.evaluate(() => {
    const { history } = globalThis.continuo.session;
    return Math.max(...[...history.t.subarray(0, history.length)].map((at, row) => Math.abs(history.columns[0][row] - (10 - 4.9 * at * at))));
  });
  assert.ok(worst < 1e-5, `each row on the way lies on the parabola; a float32 of 10 is right to 5e-7: ${worst}`);

  await button(tab, "Reset to the start").click();
  const reset = await until(tab, ({ t: time }) => time === 0, "a reset goes to the start");
  assert.equal(reset.scene[2], 10.5, "the middle of the ball is its radius above its height again");
  await tab.keyboard.press("Space");
  await until(tab, ({ state, t: time }) => state.playing && time > 0.05, "the space bar plays");
});

test("time holds, and the speed changes it", async (t) => {
  const { url } = await serve(t, model("spring_pendulum"));
  const tab = await open(t, url);
  const rate = async () => {
    // Both clocks are read where the frames arrive.
    const read = () => tab.evaluate(() => new Promise((resolve) => {
      const { session } = globalThis.continuo;
      let done = false;
      session.on("frame", (frame) => {
        if (!done) resolve([frame.t, performance.now() / 1000]);
        done = true;
      });
    }));
    const a = await read();
    await tab.waitForTimeout(1500);
    const b = await read();
    return (b[0] - a[0]) / (b[1] - a[1]);
  };
  await until(tab, ({ t: time }) => time > 0.5, "it plays");
  // Where the machine is too busy the motion slows down evenly: it keeps time when it can.
  const near = async (wanted, within) => {
    const seen = [];
    while (seen.length < 8) {
      seen.push(await rate());
      if (Math.abs(seen.at(-1) - wanted) < within) return;
    }
    assert.fail(`${wanted} times real time, not ${seen}`);
  };
  await near(1, 0.1);
  await tab.getByLabel("Speed, times real time").selectOption("0.25");
  await until(tab, ({ state }) => state.target === 0.25, "the speed is taken");
  await near(0.25, 0.06);
  assert.match(await tab.locator(".reached").textContent(), /reached 0\.2\d*×/);
});

test("a plot looks back, and every view shows that instant", async (t) => {
  const { url } = await serve(t, model("spring_pendulum"));
  const tab = await open(t, url);
  await until(tab, ({ t: time }) => time > 2, "it plays");
  await button(tab, "Pause").click();
  const paused = await until(tab, ({ state }) => !state.playing, "it pauses");
  const over = tab.locator('[data-plot="energy"] .u-over');
  const box = await over.boundingBox();
  const part = await tab.evaluate(() => {
    const { min, max } = globalThis.continuo.app.plots.shown.find(({ figure }) => figure.spec.id === "energy").figure.plot.scales.x;
    return (1 - min) / (max - min);
  });
  await tab.mouse.click(box.x + part * box.width, box.y + box.height / 2);
  const back = await until(tab, ({ lookingBack, t: time }) => lookingBack && Math.abs(time - 1) < 0.15, "a click looks back");
  assert.ok(back.last >= paused.t - 1e-6, "and the newer rows stay");
  const shown = Number((await tab.locator(".values td.number").first().textContent()).replace("−", "-"));
  assert.ok(Math.abs(shown - back.t) < 0.15, "the table of values shows that time");
  const exact = await tab.evaluate(() => {
    const { session } = globalThis.continuo;
    return [session.history.valueAt(0, session.frame.t), session.frame.scene[2]];
  });
  assert.ok(Math.abs(exact[0] - exact[1]) < 1e-3, "the scene and the rows agree there");
  await picture(tab, "looking_back");
});
