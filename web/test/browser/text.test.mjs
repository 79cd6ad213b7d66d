// The editor, the gallery, messages, help.
import assert from "node:assert/strict";
import { test } from "node:test";
import { model, open, picture, serve, until } from "./harness.mjs";

test("an error is underlined where it is, and the mended text runs", async (t) => {
  const { url } = await serve(t, model("mass_spring"));
  const tab = await open(t, url);
  await tab.keyboard.press("e");
  const code = tab.locator(".cm-content");
  await code.click();
  await tab.keyboard.press("Control+End");
  await tab.keyboard.insertText("\nlet wrong = 2*nonsense\n");
  const underlined = tab.locator(".cm-lintRange-error");
  await underlined.waitFor();
  assert.equal(await underlined.textContent(), "nonsense");
  assert.match(await tab.locator(".cm-line", { has: underlined }).textContent(), /^let wrong = 2\*nonsense$/);
  assert.match(await tab.locator(".editor-status").textContent(), /1 error/);
  await picture(tab, "error");
  for (let i = 0; i < "nonsense\n".length; ++i) await tab.keyboard.press("Backspace");
  await tab.keyboard.insertText("x\n");
  await underlined.waitFor({ state: "detached" });
  await tab.keyboard.press("Control+Enter");
  await tab.waitForFunction(() => globalThis.continuo.session.model.columns.some(({ name }) => name === "wrong"));
  await until(tab, ({ values }) => Math.abs(values.wrong - 2 * values.x) < 1e-3, "the new quantity is there");
});

test("an error of the run pauses, says why and offers a way out", async (t) => {
  const { url } = await serve(t, model("bouncing_ball"));
  const tab = await open(t, url);
  await tab.evaluate(() => globalThis.continuo.session.send({ do: "run", text: "h'' = -9.81\nh(0) = 0.01;  h'(0) = 0\nwhen h falls through 0 { h := 0; h' := -0.7*h' }\nrun 0..10\ndraw { floor 0; ball (0, h) radius 0.001 }\n" }));
  await tab.locator(".message.error").waitFor();
  await tab.evaluate(() => globalThis.continuo.session.send({ do: "play" }));
  const message = await tab.locator(".message.error").first().textContent();
  assert.match(message, /E310/);
  const { state } = await until(tab, ({ state: s }) => !s.playing, "it has stopped");
  assert.equal(state.playing, false);
  await picture(tab, "message");
});

test("a plot has a logarithmic axis where it is asked for, and an audience sees the scene alone", async (t) => {
  const { url } = await serve(t, model("euler_energy"), "--speed", "4");
  const tab = await open(t, url);
  await until(tab, ({ t: time }) => time > 4, "it plays");
  await tab.keyboard.press("Space");
  await tab.locator('[data-plot="drift"]').hover();
  await tab.getByRole("button", { name: "Logarithmic axis of “Drift of the energy”" }).click();
  // Whenever it was paused, the axis ends at the power of ten above the greatest drift, which its last step made.
  await tab.waitForFunction(() => {
    const { app, session } = globalThis.continuo;
    const drift = app.plots.shown.find(({ figure }) => figure.spec.id === "drift").figure;
    const { min, max } = drift.plot.scales.y0;
    const greatest = 1.01 ** (10 * session.frame.t) - 1;
    return drift.logarithmic && min > 0 && Number.isInteger(Math.log10(max)) && max > 0.98 * greatest && max < 10.2 * greatest;
  });
  await picture(tab, "logarithmic");
  await tab.keyboard.press("s");
  await tab.locator(".controls").waitFor({ state: "hidden" });
  assert.ok(await tab.locator(".scene").isVisible());
  assert.ok(await tab.locator(".plots").isHidden());
  await picture(tab, "presented");
  await tab.keyboard.press("s");
  await tab.locator(".controls").waitFor();
});

test("the gallery is one click away, help one key, and the theme changes", async (t) => {
  const { url } = await serve(t, model("mass_spring"));
  const tab = await open(t, url);
  await tab.getByRole("button", { name: "Gallery" }).click();
  await picture(tab, "gallery");
  await tab.locator('[data-model="kepler"]').click();
  await until(tab, ({ name, t: time }) => name === "Kepler" && time > 0, "Kepler's planet moves");
  await tab.keyboard.press("?");
  await tab.locator("dialog .help").waitFor();
  await picture(tab, "help");
  await tab.keyboard.press("Escape");
  await tab.locator("dialog").waitFor({ state: "detached" });
  const colour = () => tab.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await colour();
  await tab.keyboard.press("t");
  assert.notEqual(await colour(), light);
});
