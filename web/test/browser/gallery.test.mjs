// Every model of the gallery opens in the page without an error in its console and moves. And the pictures that people
// look at: the lecture's scenes, dark, on a telephone, on a projector.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { model, open, picture, root, serve, stopped, until } from "./harness.mjs";

// Their conditions stand at both ends: there is nothing to see before all is known.
const boundary = ["blasius", "boundary_layer", "bratu", "cantilever", "swinging_period"];

test("each model of the gallery", async (t) => {
  const { url } = await serve(t, model("mass_spring"));
  const tab = await open(t, url);
  const names = await tab.evaluate(() => globalThis.continuo.session.model.gallery.map(({ name }) => name));
  const files = readdirSync(path.join(root, "models")).filter((file) => file.endsWith(".sim")).map((file) => file.slice(0, -4));
  assert.deepEqual([...names, ...boundary].sort(), files.sort(), "the gallery is the folder");
  for (const name of names) {
    await tab.evaluate((wanted) => globalThis.continuo.session.send({ do: "open", model: wanted }), name);
    await tab.waitForFunction((wanted) => globalThis.continuo.session.model.path === `${wanted}.sim`, name);
    await tab.waitForFunction(() => globalThis.continuo.session.history.length > 0 || document.querySelector(".message"));
    await tab.evaluate(() => globalThis.continuo.session.state?.playing || globalThis.continuo.session.send({ do: "play" }));
    await tab.waitForFunction(() => globalThis.continuo.session.history.length > 3 || document.querySelector(".message"));
    const heading = await tab.locator(".heading h1").textContent();
    assert.ok(heading.length > 5, `${name} says what it is`);
    await tab.waitForTimeout(250);
    await picture(tab, `gallery_${name}`);
    assert.deepEqual(tab.problems, [], `errors in the console with ${name}`);
    await tab.evaluate(() => document.querySelectorAll(".message .icon").forEach((cross) => cross.click()));
  }
});

/** The lecture's points, each in a scene of its own with a sentence that says what to see. What is to be seen is there at
 *  every time after the one that is named; what explodes is looked at where it stops by itself. */
const lecture = [
  ["euler_energy", 8, (seen) => assert.ok(seen.values.energy > 1.9 * 12.5, `Euler's energy grows: ${seen.values.energy}`)],
  ["ball_through_floor", 5, (seen) => assert.ok(seen.lowest < -0.2, `the ball pierces the floor: ${seen.lowest}`)],
  ["ball_located", 5, (seen) => assert.ok(seen.lowest > -1e-6 && Math.abs(seen.values.energy - 98.1) < 1e-3, `located impacts cure it: ${seen.lowest}, ${seen.values.energy}`)],
  ["stiff_spring_explicit", null, (seen) => assert.ok(Math.abs(seen.values.x) > 99, `the numbers explode: ${seen.values.x}`)],
  ["stiff_spring_implicit", 1.95, (seen) => assert.ok(seen.values.x > 0 && seen.values.x < 0.2, `calm: ${seen.values.x}`)],
];
for (const [name, end, check] of lecture) {
  test(`the lecture's point: ${name}`, async (t) => {
    const { url } = await serve(t, model(name), "--speed", "4");
    const tab = await open(t, url);
    if (end !== null) {
      await until(tab, ({ t: time }) => time > end, "it moves");
      await tab.keyboard.press("Space");
    }
    const seen = await stopped(tab, "it stops", ({ state }) => end !== null || state.ended);
    const lowest = await tab.evaluate(() => Math.min(...globalThis.continuo.session.history.columns[0].subarray(0, globalThis.continuo.session.history.length)));
    check({ ...seen, lowest });
    assert.match(await tab.locator(".heading .watch").textContent(), /Watch /);
    await tab.waitForTimeout(500);
    await picture(tab, `lecture_${name}`);
  });
}

test("light and dark, a telephone and a projector", async (t) => {
  const { url } = await serve(t, model("spring_pendulum"));
  for (const [name, options] of [
    ["light", { width: 1440, height: 900 }],
    ["dark", { width: 1440, height: 900, scheme: "dark" }],
    ["projector", { width: 1280, height: 720 }],
    ["telephone", { width: 390, height: 844 }],
    ["telephone_dark", { width: 390, height: 844, scheme: "dark" }],
  ]) {
    const tab = await open(t, url, options);
    await until(tab, ({ t: time }) => time > 1, "it moves");
    await tab.waitForTimeout(700);
    await picture(tab, `look_${name}`);
    const wide = await tab.evaluate(() => document.documentElement.scrollWidth > innerWidth + 1);
    assert.equal(wide, false, `nothing sticks out on a ${name} page`);
    assert.equal(await tab.evaluate(() => [...document.querySelectorAll("button, input, select")].filter((each) => !(each.getAttribute("aria-label") || each.textContent.trim() || each.labels?.length)).length), 0, "every control has a name");
    await until(tab, ({ drawn }) => drawn > 3, "the scene is drawn");
    await tab.close();
  }
});
