// The first five minutes: from the command to a moving ball, the tour, a text with mistakes, a presentation, axes.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { spawnSync } from "node:child_process";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { button, command, model, open, picture, plotted, serve, until } from "./harness.mjs";

const sizes = [["notebook", 1280, 720], ["screen", 1920, 1080], ["telephone", 390, 844]];
const schemes = ["light", "dark"];

/** What is wrong with the page as it stands: things that stick out, controls without a name, faint letters. */
const faults = (tab) =>
  tab.evaluate(() => {
    const found = [];
    if (document.documentElement.scrollWidth > innerWidth + 1) found.push("the page is wider than the window");
    const shown = (element) => element.getClientRects().length > 0 && getComputedStyle(element).visibility === "visible";
    const top = document.querySelector("dialog[open]") ?? document.body;
    for (const each of top.querySelectorAll("button, input, select")) {
      if (!shown(each)) continue;
      if (!(each.getAttribute("aria-label") || each.textContent.trim() || each.labels?.length || each.title)) found.push(`no name: ${each.outerHTML.slice(0, 80)}`);
    }
    const channel = (value) => (value <= 0.03928 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
    const parse = (color) => {
      const numbers = color.match(/[\d.]+/g)?.map(Number) ?? [0, 0, 0, 0];
      return color.startsWith("color(srgb") ? [...numbers.slice(0, 3).map((value) => 255 * value), numbers[3] ?? 1] : [...numbers.slice(0, 3), numbers[3] ?? 1];
    };
    const light = ([r, g, b]) => 0.2126 * channel(r / 255) + 0.7152 * channel(g / 255) + 0.0722 * channel(b / 255);
    const ground = (element) => {
      const layers = [];
      for (let at = element; at; at = at.parentElement) layers.push(parse(getComputedStyle(at).backgroundColor));
      return layers.reverse().reduce((under, [r, g, b, alpha]) => [r, g, b].map((value, i) => alpha * value + (1 - alpha) * under[i]), [255, 255, 255]);
    };
    for (const each of top.querySelectorAll("b, span, p, h1, h2, h3, small, label, button, output, summary, td, th, legend")) {
      const own = [...each.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.textContent.trim() !== "");
      if (!own || !shown(each) || each.closest(":disabled") || each.closest(".cm-editor")) continue;
      const [a, b] = [light(parse(getComputedStyle(each).color)), light(ground(each))];
      const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
      if (contrast < 4.5) found.push(`contrast ${contrast.toFixed(2)}: ${each.className} ${each.textContent.trim().slice(0, 40)}`);
    }
    return [...new Set(found)];
  });

/** The step in all sizes, light and dark; each is also a picture to look at. */
async function everywhere(t, url, name, step) {
  for (const [size, width, height] of sizes) {
    for (const scheme of schemes) {
      const tab = await open(t, url, { width, height, scheme });
      await step(tab, width);
      await tab.waitForTimeout(400);
      await picture(tab, `welcome_${name}_${size}_${scheme}`);
      assert.deepEqual(await faults(tab), [], `${name}, ${size}, ${scheme}`);
      await tab.close();
    }
  }
}

test("from the command to a moving ball in one click", async (t) => {
  const { url } = await serve(t, null);
  const tab = await open(t, url);
  await tab.locator("dialog[open] .gallery").waitFor();
  assert.equal(await tab.locator(".gallery h3").first().textContent(), "Start here");
  await tab.locator('[data-model="bouncing_ball"]').click();
  await until(tab, ({ name, t: time }) => name === "BouncingBall" && time > 0.3, "the ball moves");
  assert.equal(await tab.locator("dialog[open]").count(), 0);
});

test("the gallery in all sizes, and its search", async (t) => {
  const { url } = await serve(t, null);
  await everywhere(t, url, "gallery", (tab) => tab.locator("dialog[open] .gallery").waitFor());
  const tab = await open(t, url);
  await tab.getByLabel("Find a model").fill("ball bounces");
  assert.deepEqual(await tab.locator(".gallery-card:visible").evaluateAll((cards) => cards.map((each) => each.dataset.model)), ["bouncing_ball"]);
  await tab.getByLabel("Find a model").fill("zzz");
  assert.ok(await tab.getByText("No model has all of these words.").isVisible());
  const all = await tab.evaluate(() => globalThis.continuo.session.model.gallery);
  assert.deepEqual(all.filter(({ subject }) => !subject).map(({ name }) => name), [], "each model has a subject");
  assert.equal(await tab.locator(".thumbnail img").count(), all.length, "each model has a picture");
});

test("the tour is offered once, and again when asked for", async (t) => {
  const { url } = await serve(t, null);
  const tab = await open(t, url);
  await tab.context().clearCookies();
  await tab.evaluate(() => localStorage.clear());
  // Whoever reloads before choosing is welcomed again: longer than the page takes to write its address.
  await tab.waitForTimeout(1000);
  assert.equal(await tab.evaluate(() => location.hash), "");
  await tab.reload();
  await tab.getByRole("button", { name: "Show me" }).click();
  for (let stop = 0; stop < 4; ++stop) await tab.locator(".tour").getByRole("button", { name: "Next" }).click();
  await tab.locator(".tour").getByRole("button", { name: "Done" }).click();
  assert.equal(await tab.locator(".tour").count(), 0);
  // Once the address names the model, the page does not begin with its gallery.
  await tab.waitForFunction(() => location.hash.includes("model="));
  await tab.reload();
  await tab.getByRole("button", { name: "Gallery", exact: true }).click();
  await tab.locator("dialog[open] .gallery").waitFor();
  assert.equal(await tab.locator(".tour-offer").count(), 0);
  await tab.getByRole("button", { name: "Tour" }).click();
  await tab.keyboard.press("Escape");
  assert.equal(await tab.locator(".tour").count(), 0);
});

test("a text with an error opens at the error, and runs as soon as it is mended", async (t) => {
  const file = path.join(mkdtempSync(path.join(tmpdir(), "continuo-")), "broken.sim");
  const good = readFileSync(model("bouncing_ball"), "utf8");
  writeFileSync(file, good.replace("h'' = -g }", "h'' = -gg }"));
  const { url } = await serve(t, file);
  await everywhere(t, url, "broken", (tab) => tab.locator(".beside.error").first().waitFor());
  const tab = await open(t, url);
  assert.match(await tab.locator(".mistakes").textContent(), /line 14, column 22/);
  assert.match(await tab.locator(".beside.error").first().textContent(), /column 22: /);
  // The cursor is at the error: what is typed mends it.
  await tab.keyboard.press("Delete");
  await until(tab, ({ name, values }) => name === "BouncingBall" && values.h !== undefined, "it runs");
  assert.equal(await tab.locator(".mistakes").isVisible(), false);
  await tab.keyboard.press("Control+s");
  await tab.getByText("saved to").waitFor();
  assert.equal(readFileSync(file, "utf8"), good);
});

test("a model that is not there", () => {
  const { status, stderr } = spawnSync(command, ["view", "models/bouncing_bal.sim", "--no-open"], { cwd: path.dirname(path.dirname(model("car"))), encoding: "utf8" });
  assert.notEqual(status, 0);
  assert.match(stderr, /bouncing_ball/);
});

test("presenting: the scene is the screen, Escape ends it", async (t) => {
  const { url } = await serve(t, model("spring_pendulum"));
  await everywhere(t, url, "scene", (tab) => until(tab, ({ t: time }) => time > 0.5, "it moves"));
  await everywhere(t, url, "present", async (tab) => {
    await tab.evaluate(() => (document.documentElement.requestFullscreen = undefined));
    await tab.keyboard.press("s");
  });
  const tab = await open(t, url);
  await tab.evaluate(() => (document.documentElement.requestFullscreen = undefined));
  await tab.keyboard.press("s");
  const box = await tab.locator(".scene").boundingBox();
  assert.ok(box.width >= 1279 && box.height > 580, `${box.width} x ${box.height}`);
  await tab.keyboard.press("o");
  assert.ok(await tab.locator(".plots").isVisible());
  await tab.keyboard.press("Escape");
  assert.ok(await tab.locator(".controls").isVisible());
});

test("axes of a plot are chosen from menus", async (t) => {
  const { url } = await serve(t, model("bouncing_ball"));
  const tab = await open(t, url);
  await until(tab, ({ t: time }) => time > 0.5, "it moves");
  await tab.locator(".plot-card").first().hover();
  await tab.getByRole("button", { name: /^Axes of/ }).first().click();
  const dialog = tab.locator("dialog[open]");
  await dialog.getByLabel("Horizontal axis").selectOption({ label: "h" });
  for (const box of await dialog.locator(".choices input:checked").all()) await box.uncheck();
  await dialog.getByLabel(/^h′/).check();
  await dialog.getByLabel(/^logarithmic, of/).check();
  await dialog.getByRole("button", { name: "Plot" }).click();
  await tab.locator(".plot-card").first().locator("b", { hasText: /against h/ }).waitFor();
  await plotted(tab);
  await picture(tab, "welcome_axes");
});
