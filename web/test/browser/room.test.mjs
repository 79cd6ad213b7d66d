// A class: the presenter's page and a viewer's, in two tabs, and what takes long.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { button, model, now, open, picture, serve, until } from "./harness.mjs";

test("a viewer sees what the presenter does, and changes nothing", async (t) => {
  const { url, viewers } = await serve(t, model("bouncing_ball"), "--listen", "127.0.0.2", "--paused");
  const presenter = await open(t, url), viewer = await open(t, viewers);
  assert.ok(viewer.url().includes("?token=") && !viewer.url().includes(new URL(url).searchParams.get("token")));
  assert.equal(await viewer.locator(".room .badge").textContent(), "you are watching");
  assert.equal(await button(viewer, "Play").isDisabled(), true);
  assert.equal(await viewer.locator(".controls input:not([disabled])").count(), 0);
  assert.equal(await viewer.locator(".room .own").count(), 0);
  await presenter.locator(".room .watchers", { hasText: "1 viewer" }).waitFor();
  await viewer.keyboard.press("Space");
  await viewer.keyboard.press("n");
  await viewer.evaluate(() => globalThis.continuo.session.send({ do: "set", parameter: "g", value: 1 }));
  await presenter.evaluate(() => globalThis.continuo.session.send({ do: "set", parameter: "g", value: 4 }));
  const seen = await until(viewer, ({ state }) => state.parameters.g === 4, "the presenter's change");
  assert.equal(seen.state.playing, false);
  await button(presenter, "Play").click();
  await until(viewer, ({ t: time }) => time > 0.2, "the motion");
  assert.equal(await presenter.locator(".message.error").count(), 0);
  await picture(presenter, "room_presenter");
  await picture(viewer, "room_viewer");
  await presenter.locator(".room .watchers").click();
  assert.equal(await presenter.locator(".viewers-address .address").textContent(), viewers);
  await picture(presenter, "room_address");
});

test("a viewer tries it, and comes back", async (t) => {
  const { url, viewers } = await serve(t, model("bouncing_ball"), "--listen", "127.0.0.2", "--viewers", "own", "--paused");
  const presenter = await open(t, url), viewer = await open(t, viewers);
  await viewer.locator(".room .own", { hasText: "Try it yourself" }).click();
  await viewer.waitForFunction(() => globalThis.continuo?.session.role?.role === "owner" && globalThis.continuo.session.frame);
  await viewer.evaluate(() => globalThis.continuo.session.send({ do: "set", parameter: "g", value: 2 }));
  await until(viewer, ({ state }) => state.parameters.g === 2, "their own change");
  assert.equal(await viewer.getByRole("button", { name: "Save the file" }).isVisible(), false);
  assert.notEqual((await now(presenter)).state.parameters.g, 2);
  await picture(viewer, "room_own");
  await viewer.locator(".room .own", { hasText: "Watch the presenter" }).click();
  await viewer.waitForFunction(() => globalThis.continuo?.session.role?.role === "viewer" && globalThis.continuo.session.frame);
  assert.notEqual((await now(viewer)).state.parameters.g, 2);
});

test("a step that takes long says so, and can be stopped", async (t) => {
  const folder = mkdtempSync(path.join(tmpdir(), "continuo-heavy-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const file = path.join(folder, "heavy.sim");
  writeFileSync(file, "param N = 1000, k = 1 in 0..2\nfor i in 1..N {\n  u[i]' = -k*u[i] + 0.5*sin(u[i])*sum(j in 1..N: u[j])/N\n  u[i](0) = 1 + i/N\n}\nrun 0..100 method radau tol 1e-9\n");
  const { url } = await serve(t, file);
  const tab = await open(t, url);
  await tab.locator(".room .busy", { hasText: "computing a step" }).waitFor();
  await picture(tab, "room_busy");
  await tab.locator(".room .busy button").click();
  await until(tab, ({ state }) => state.playing === false, "the stop");
  await tab.locator(".room .busy").waitFor({ state: "hidden" });
});
