// Play, pause, step, back, reset, until the next event, looking back; speed.
import assert from "node:assert/strict";
import { test } from "node:test";
import { button, model, now, open, picture, plotted, serve, stopped, until } from "./harness.mjs";

test("the transport does what its buttons say", async (t) => {
  // Slowly: on a busy machine the hand that pauses comes late, and the first impact, at 10/7 s, is to be ahead then. It
  // comes after 71 s, later than anything is waited for.
  const { url } = await serve(t, model("bouncing_ball"), "--speed", "0.02");
  const tab = await open(t, url);
  const going = await until(tab, ({ t: time, state }) => state.playing && time > 0.02, "it plays by itself");
  await button(tab, "Pause").click();
  const paused = await stopped(tab, "it pauses");
  assert.ok(paused.t >= going.t);
  await tab.waitForTimeout(300);
  assert.equal((await now(tab)).t, paused.t, "a pause stands still");

  await button(tab, "One step on").click();
  const stepped = await until(tab, ({ t: time }) => time > paused.t, "a step goes on");
  await button(tab, "One step back").click();
  await until(tab, ({ t: time }) => time < stepped.t, "and back");

  await button(tab, "Run until the next event").click();
  const event = await stopped(tab, "it runs to the impact", ({ t: time }) => time > stepped.t);
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
  await until(tab, ({ state, t: time }) => state.playing && time > 0.02, "the space bar plays");
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
    const seen = [], end = Date.now() + 60000;
    while (Date.now() < end) {
      seen.push(await rate());
      if (Math.abs(seen.at(-1) - wanted) < within) return;
    }
    assert.fail(`${wanted} times real time, not ${seen}`);
  };
  await near(1, 0.1);
  await tab.getByLabel("Speed, times real time").selectOption("0.25");
  await until(tab, ({ state }) => state.target === 0.25, "the speed is taken");
  await near(0.25, 0.06);
  await tab.locator(".reached", { hasText: /reached 0\.2\d*×/ }).waitFor();
});

test("a plot looks back, and every view shows that instant", async (t) => {
  const { url } = await serve(t, model("spring_pendulum"));
  const tab = await open(t, url);
  await until(tab, ({ t: time }) => time > 2, "it plays");
  await button(tab, "Pause").click();
  const paused = await stopped(tab, "it pauses");
  await plotted(tab);
  const over = tab.locator('[data-plot="energy"] .u-over');
  const box = await over.boundingBox();
  // The middle of what the plot shows, however late it was paused.
  const [part, middle] = await tab.evaluate(() => {
    const { app, session } = globalThis.continuo;
    const { min, max } = app.plots.shown.find(({ figure }) => figure.spec.id === "energy").figure.plot.scales.x;
    const time = (Math.max(min, session.history.first) + session.history.last) / 2;
    return [(time - min) / (max - min), time];
  });
  await tab.mouse.click(box.x + part * box.width, box.y + box.height / 2);
  const back = await until(tab, ({ lookingBack, t: time }) => lookingBack && Math.abs(time - middle) < 0.15, "a click looks back");
  assert.ok(back.last >= paused.t - 1e-6, "and the newer rows stay");
  // The table of values shows that time, as soon as the browser draws it.
  await tab.waitForFunction((time) => Math.abs(Number(document.querySelector(".values td.number").textContent) - time) < 0.15, back.t);
  const [row, drawn, apart] = await tab.evaluate(() => {
    const { history, frame } = globalThis.continuo.session;
    const after = history.indexAfter(frame.t);
    return [history.valueAt(0, frame.t), frame.scene[2], history.t[after] - history.t[after - 1]];
  });
  // Of rows that have waited for a page that opens late, or is busy, some are left out. What is straight between two is
  // wrong by an eighth of the acceleration, which is below 64 m/s^2, times the square of the time between them.
  assert.ok(Math.abs(row - drawn) < 1e-3 + 8 * apart ** 2, `the scene and the rows agree there: ${row}, ${drawn}`);
  await picture(tab, "looking_back");
});
