// Worlds of bodies: a ghost beside them, one picked by hand, thousands drawn.
import assert from "node:assert/strict";
import { writeFileSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { button, later, model, open, picture, serve, still, stopped, until } from "./harness.mjs";

test("a ghost of bodies stands beside them, and a body that is picked says its state", async (t) => {
  const { url } = await serve(t, model("billiards"));
  const tab = await open(t, url);
  const bodies = await tab.evaluate(() => globalThis.continuo.session.model.bodies.count);
  await tab.keyboard.press("h");
  await tab.waitForFunction(() => globalThis.continuo.session.frame.ghostPositions !== null);
  const apart = () => tab.evaluate(() => {
    const { positions, ghostPositions } = globalThis.continuo.session.frame;
    return [positions.length, ghostPositions?.length, Math.max(...positions.map((at, i) => Math.abs(at - (ghostPositions?.[i] ?? at))))];
  });
  const [here, there] = await apart();
  assert.deepEqual([here, there], [2 * bodies, 2 * bodies]);
  await tab.waitForSelector('[data-plot="distance"]');
  await until(tab, ({ t: time }) => time > 2, "both play");
  await tab.keyboard.press("Space");
  await stopped(tab, "it pauses");
  await still(tab);
  const at = await tab.evaluate(() => globalThis.continuo.app.scene.onPage([...globalThis.continuo.session.frame.positions.slice(0, 2), 0]));
  await tab.mouse.click(at.x, at.y);
  const rows = tab.locator(".card tr");
  await rows.first().waitFor();
  assert.ok((await rows.count()) >= 4, "place and velocity are told");
  await tab.locator(".ring").waitFor();  // it is marked in the scene
  await picture(tab, "ghost_of_bodies");
  await tab.keyboard.press("v");
  await tab.keyboard.press("r");
  await stopped(tab, "back to the start", ({ t: time }) => time === 0);
  await tab.keyboard.press("n");
  await stopped(tab, "to the first impact", ({ t: time }) => time > 0);
  // The camera goes with it, as soon as the browser draws it.
  await tab.waitForFunction(() => {
    const { session, app } = globalThis.continuo;
    const { x, y } = app.scene.stage.target;
    return x > 0.7 && Math.hypot(x - session.frame.positions[0], y - session.frame.positions[1]) < 1e-3;
  });
  await tab.getByLabel("Method of the ghost").selectOption("");
  await until(tab, ({ state }) => !state.ghost, "it goes again");
  await tab.waitForFunction(() => globalThis.continuo.app.scene.ghostBodies === null);
});

test("thousands of spheres are drawn, each turned as it is", async (t) => {
  const folder = mkdtempSync(path.join(tmpdir(), "continuo-spheres-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const file = path.join(folder, "spheres.sim");
  writeFileSync(file, `# Spheres fall into a box.
world {
  dimension 3
  gravity (0, 0, -9.81)
  material restitution 0.3 friction 0.6
  container box (0, 0, 0) to (6, 6, 6)
  bodies grain random 2000 in (0, 0, 0) to (6, 6, 5) radius 0.12 seed 1
  mode fast step 1/60
}
run 0..60 output 0.1
`);
  const { url } = await serve(t, file);
  const tab = await open(t, url);
  await until(tab, ({ t: time, drawn }) => time > 0.8 && drawn > 5, "they fall and are drawn");
  await tab.keyboard.press("Space");
  await stopped(tab, "it pauses");
  const seen = await tab.evaluate(() => {
    const { session, app } = globalThis.continuo;
    const picture_ = app.scene.picture("#ffffff");
    const { data } = picture_.getContext("2d").getImageData(0, 0, picture_.width, picture_.height);
    let painted = 0;
    for (let at = 0; at < data.length; at += 4) if (Math.max(data[at], data[at + 1], data[at + 2]) - Math.min(data[at], data[at + 1], data[at + 2]) > 60) ++painted;
    const samples = app.scene.stage.surface.canvas.getContext("webgl2").getContextAttributes().antialias;
    return { painted: painted / (data.length / 4), samples, turned: session.frame.orientations?.length };
  });
  assert.equal(seen.turned, 4 * 2000);
  assert.equal(seen.samples, false, "many bodies do without several samples a pixel");
  assert.ok(seen.painted > 0.04, `their colours cover some of the picture: ${seen.painted}`);
  await picture(tab, "spheres");
});

test("boxes are drawn as they stand, joints can be hidden, and a hand pulls what a joint holds", async (t) => {
  const { url } = await serve(t, model("dominoes"));
  const tab = await open(t, url);
  assert.equal(await tab.evaluate(() => globalThis.continuo.session.model.bodies.form.filter((form) => form !== null).length), 12);
  await until(tab, ({ t: time }) => time > 0.5, "it plays");
  // The first domino has fallen a little: a corner of its face is not where that of an upright one would be.
  const corner = () => tab.evaluate(() => {
    const { scene } = globalThis.continuo.app;
    const { array } = scene.bodies.solids.faces.geometry.getAttribute("position");
    const { positions, orientations } = globalThis.continuo.session.frame;
    const [x, y] = [array[0] - positions[0], array[1] - positions[1]];
    const [c, s] = [Math.cos(orientations[0]), Math.sin(orientations[0])];
    return [c * x + s * y, c * y - s * x, orientations[0]];
  });
  const [x, y, angle] = await corner();
  assert.ok(Math.abs(Math.abs(x) - 0.075) < 1e-3 && Math.abs(Math.abs(y) - 0.5) < 1e-3, `the corner is at ${x}, ${y}`);
  assert.ok(angle < -0.05);
  const shown = () => tab.evaluate(() => globalThis.continuo.app.scene.bodies.joints.group.visible);
  assert.equal(await shown(), true);
  await tab.keyboard.press("j");
  assert.equal(await shown(), false);
  // The last one is taken while it stands, before the others reach it.
  await button(tab, "Pause").click();
  await button(tab, "Reset to the start").click();
  await stopped(tab, "back to the start", ({ t: time }) => time === 0);
  await still(tab);
  const at = await tab.evaluate(() => globalThis.continuo.app.scene.onPage([...globalThis.continuo.session.frame.positions.slice(22, 24), 0]));
  await tab.mouse.move(at.x, at.y);
  await tab.mouse.down();
  await tab.mouse.move(at.x, at.y - 60, { steps: 5 });
  await tab.evaluate(() => globalThis.continuo.session.send({ do: "play" }));
  await tab.waitForFunction(() => globalThis.continuo.session.frame.positions[23] > 0.6);
  await tab.mouse.up();
});

test("a walker walks faster while its key is held, and a car is driven back by its own", async (t) => {
  const { url } = await serve(t, model("walker"));
  const tab = await open(t, url);
  const place = (body) => tab.evaluate((i) => ({ x: globalThis.continuo.session.frame.positions[2 * i], t: globalThis.continuo.session.frame.t }), body);
  const pace = async (body, from) => {
    await until(tab, ({ t: time }) => time > from, "it begins");
    const first = await place(body);
    await until(tab, ({ t: time }) => time > first.t + 1.5, "it goes on");
    const last = await place(body);
    return (last.x - first.x) / (last.t - first.t);
  };
  // A turn of the crank is a step of 1.418 m.
  const alone = await pace(0, 1);
  assert.ok(Math.abs(alone - (2 / (2 * Math.PI)) * 1.418) < 0.1, `it walks: ${alone}`);
  await tab.keyboard.down("w");
  await until(tab, ({ state }) => state.inputs.pace > 2, "w makes it faster");
  const driven = await pace(0, (await place(0)).t + 1);
  await tab.keyboard.up("w");
  assert.ok(driven > 1.5 * alone, `the key makes it faster: ${driven}`);
  await picture(tab, "walker");

  // In pause, lest its file drive it before the key does.
  await button(tab, "Pause").click();
  await stopped(tab, "it pauses");
  await tab.evaluate(() => globalThis.continuo.session.send({ do: "open", model: "offroad" }));
  await tab.waitForFunction(() => globalThis.continuo.session.model.path === "offroad.sim" && globalThis.continuo.session.frame?.positions.length === 6);
  const car = await tab.evaluate(() => globalThis.continuo.session.model.bodies.names.indexOf("car"));
  await tab.keyboard.down("s");
  await button(tab, "Play").click();
  // By 3 m/s^2 of its motors.
  await tab.waitForFunction((i) => globalThis.continuo.session.frame.positions[2 * i] < -0.5, car);
  await tab.keyboard.up("s");
  await picture(tab, "offroad");
});

test("a character walks, jumps and stops as its keys say, and its wall stops it", async (t) => {
  const { url } = await serve(t, model("platforms"));
  const tab = await open(t, url);
  // With a wall before the gap behind the stairs, into which it would fall where the key is let go late.
  await tab.evaluate(() => {
    const { session } = globalThis.continuo;
    session.send({ do: "run", text: session.model.text.replace("(9, 1.25) (9, -3)", "(8, 1.25) (8, 5) (9, 5) (9, -3)") });
  });
  await tab.waitForFunction(() => globalThis.continuo.session.model.text.includes("(8, 5)") && globalThis.continuo.session.frame);
  const hero = await tab.evaluate(() => globalThis.continuo.session.model.bodies.names.indexOf("hero"));
  const place = () => tab.evaluate((i) => Array.from(globalThis.continuo.session.frame.positions.slice(2 * i, 2 * i + 2)), hero);
  const comes = (far) => tab.waitForFunction(([i, x]) => globalThis.continuo.session.frame.positions[2 * i] > x, [hero, far]);
  const jumps = () => tab.waitForFunction((i) => globalThis.continuo.session.frame.positions[2 * i + 1] > 1.5, hero);
  await until(tab, ({ t: time }) => time > 0.3, "it plays");
  assert.ok(Math.abs((await place())[0]) < 1e-6, "without keys it stands, whatever the file says");
  await tab.keyboard.down("w");
  await jumps();
  await tab.keyboard.up("w");
  await tab.keyboard.down("d");
  await comes(6.2);  // up the stairs
  await tab.keyboard.up("d");
  await until(tab, ({ state }) => state.inputs.right === 0, "d is let go");
  await later(tab, 0.3, "it comes to rest");
  const [stood, height] = await place();
  assert.ok(Math.abs(height - 2.155) < 0.01, `it stands on the stairs: ${height}`);
  await picture(tab, "platforms");
  await later(tab, 0.3, "time passes");
  assert.ok(Math.abs((await place())[0] - stood) < 1e-6, "it stands");
  await tab.keyboard.down("a");
  await tab.waitForFunction((i) => globalThis.continuo.session.frame.positions[2 * i] < -1.68, hero);
  await later(tab, 0.3, "it walks on against the wall");
  await tab.keyboard.up("a");
  assert.ok(Math.abs((await place())[0] + 1.695) < 0.01, "the wall stops it");
});

test("ground of triangles and of segments is drawn, and belongs into the picture", async (t) => {
  const folder = mkdtempSync(path.join(tmpdir(), "continuo-ground-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const rows = [0, 1, 2, 3, 4, 5, 6];
  const height = (x, y) => 0.6 * Math.cos(x - 3) * Math.cos(y - 3);
  const corners = rows.flatMap((y) => rows.map((x) => `v ${x - 3} ${y - 3} ${height(x, y)}`));
  const faces = rows.slice(1).flatMap((y) => rows.slice(1).map((x) => `f ${7 * (y - 1) + x} ${7 * (y - 1) + x + 1} ${7 * y + x + 1} ${7 * y + x}`));
  writeFileSync(path.join(folder, "hills.obj"), [...corners, ...faces, ""].join("\n"));
  const file = path.join(folder, "hills.sim");
  writeFileSync(file, `world {
  dimension 3
  gravity (0, 0, -9.81)
  mode fast step 1/120
  wall hills mesh "hills.obj"
  bodies ball grid 3 x 3 x 1 from (-1.5, -1.5, 1.5) spacing (1.5, 1.5, 1) radius 0.25
}
run 0..60
`);
  const { url } = await serve(t, file);
  const tab = await open(t, url);
  await until(tab, ({ t: time }) => time > 0.4, "it plays");
  const [hills] = await tab.evaluate(() => globalThis.continuo.session.model.bodies.meshes);
  assert.deepEqual([hills.name, hills.corners.length, hills.facets.length, hills.thin], ["hills", 49, 72, false]);
  await picture(tab, "hills");
  const road = await open(t, (await serve(t, model("offroad"))).url);
  await until(road, ({ t: time }) => time > 0.1, "the car stands on its road");
  await still(road);
  const at = await road.evaluate(() => {
    const { session, app } = globalThis.continuo;
    const [chain] = session.model.bodies.meshes;
    return [chain.facets.length, ...[chain.corners[0], chain.corners.at(-1)].map((corner) => app.scene.onPage([...corner, 0]).x)];
  });
  assert.equal(at[0], 40);
  assert.ok(at.slice(1).every((x) => x >= 0 && x <= 1280), `both ends of the road are in the picture: ${at}`);
  await picture(road, "road");
});
