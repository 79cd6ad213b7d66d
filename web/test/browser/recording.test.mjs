// The exported page, with the network off; the page in a frame.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { browser, button, command, model, now, open, pageOptions, picture, serve, until } from "./harness.mjs";

test("an exported page replays with the network off", async (t) => {
  const folder = mkdtempSync(path.join(tmpdir(), "continuo-export-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const file = path.join(folder, "ball.html");
  // It plays for longer than anything here is waited for.
  execFileSync(command, ["view", model("bouncing_ball"), "--export", file, "--until", "90", ...pageOptions], { stdio: "pipe" });
  const context = await browser();
  await context.setOffline(true);
  t.after(() => context.setOffline(false));
  const asked = [];
  context.on("request", (request) => asked.push(request.url()));
  const tab = await open(t, pathToFileURL(file).href);
  let sockets = 0;
  tab.on("websocket", () => ++sockets);
  const begun = await now(tab);
  assert.ok(begun.last > 89.9, "all rows are there from the start");
  await button(tab, "Play").click();
  const playing = await until(tab, ({ t: time }) => time > 1.6, "it plays");
  const height = ({ scene }) => scene[2] - 0.5;  // of the underside: the ball's middle is drawn above h by its radius
  assert.ok(height(playing) < 9 && height(playing) >= 0, "the ball has fallen and bounced");
  await button(tab, "Pause").click();
  await until(tab, ({ state }) => !state.playing, "it pauses");
  await tab.getByLabel("Time in the history").fill("0.5");
  const sought = await until(tab, ({ t: time }) => Math.abs(time - 0.5) < 1e-6, "the time line seeks");
  assert.ok(Math.abs(height(sought) - (10 - 4.9 * 0.25)) < 0.02, `h(0.5) = 8.775, not ${height(sought)}`);
  await button(tab, "Run until the next event").click();
  const event = await until(tab, ({ t: time }) => time > 1, "it finds the impact");
  assert.ok(Math.abs(event.t - 10 / 7) < 1e-6);
  await tab.locator('[data-plot="energy"] .u-over').hover();
  await tab.waitForFunction(() => globalThis.continuo.session.cursor !== null);  // it follows the pointer
  assert.equal(sockets, 0);
  assert.deepEqual(asked.filter((url) => !/^(file|data|blob):/.test(url)), [], "nothing was asked of the network");
  await picture(tab, "exported");
});

test("in a frame there are the scene and its transport, no more", async (t) => {
  const { url } = await serve(t, model("kepler"));
  const tab = await open(t, `${url}&embed`, { width: 640, height: 400 });
  await until(tab, ({ t: time }) => time > 0.3, "it moves");
  assert.equal(await tab.locator(".controls, .plots, .editor").count(), 0);
  assert.equal(await button(tab, "Pause").count(), 1);
  await picture(tab, "embedded");
});
