import { expect, test } from "vitest";
import { spring, springPoints, rope, ropePoints, Trail } from "../../src/scene/curves";
import { boundsOfItems, distanceFor, gridStep, heightFor, Interest, type Bounds } from "../../src/scene/fit";
import { boxOfWalls } from "../../src/scene/bodies";
import { endsOf, isBroken, linesOf } from "../../src/scene/joints";
import { bandOf, bandWidth, chainLines, trianglesOf } from "../../src/scene/ground";
import { edgesOf, entry, normalOf, placed, rotationOf } from "../../src/scene/solids";
import { pickSphere } from "../../src/scene/spheres";
import { itemColors } from "../../src/scene/drawing";
import { curveColors } from "../../src/palette";
import type { Bodies, Form, Item, Joint, StaticMesh } from "../../src/protocol";

const item = (shape: Item["shape"], numbers: Item["numbers"]): Item => ({ shape, numbers, drag: false });

test("the bounds hold balls with their radius, boxes, both ends of springs, and the floor", () => {
  const items = [item("floor", { height: 0 }), item("ball", { at: [1, 2], radius: 3 }), item("spring", { at: [4, 0], to: [1, 2] })];
  const bounds = boundsOfItems(items, Float32Array.of(0, 5, 10, 1, -7));
  expect(bounds.lower.slice(0, 2)).toEqual([-7, 0]);
  expect(bounds.upper.slice(0, 2)).toEqual([6, 11]);
});

test("the bounds hold an arrow to its tip, which its scale moves", () => {
  const bounds = boundsOfItems([item("arrow", { at: [0, 1], to: [2, 3], scale: 4 })], Float32Array.of(1, 1, 3, 5, 0.5));
  expect(bounds.lower.slice(0, 2)).toEqual([1, 1]);
  expect(bounds.upper.slice(0, 2)).toEqual([2, 3]);
});

// Each corner of random boxes, seen by the formulas of a perspective picture, is in it, and one is near its frame.
test("in space the picture holds the corners of the bounds, closely", () => {
  let seed = 7;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  for (let trial = 0; trial < 200; ++trial) {
    const size = [random(), random(), random()];
    const bounds: Bounds = { lower: [1, 2, 3], upper: [1 + size[0]!, 2 + size[1]!, 3 + size[2]!] };
    const [turn, rise, aspect, tangent] = [6.28 * random(), 1.5 * (2 * random() - 1), 0.4 + 2 * random(), 0.1 + random()];
    const back = [Math.cos(rise) * Math.cos(turn), Math.cos(rise) * Math.sin(turn), Math.sin(rise)] as const;
    const right = [-Math.sin(turn), Math.cos(turn), 0] as const;
    const above = [-Math.sin(rise) * Math.cos(turn), -Math.sin(rise) * Math.sin(turn), Math.cos(rise)] as const;
    const distance = distanceFor(bounds, back, right, above, tangent, aspect, 1);
    let nearest = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const from = size.map((extent, axis) => ((corner >> axis) & 1 ? 0.5 : -0.5) * extent);
      const along = (axis: readonly number[]) => from.reduce((sum, value, i) => sum + value * axis[i]!, 0);
      const depth = distance - along(back);
      expect(depth).toBeGreaterThan(0);
      nearest = Math.max(nearest, Math.abs(along(right)) / (depth * tangent * aspect), Math.abs(along(above)) / (depth * tangent));
    }
    expect(nearest).toBeCloseTo(1, 9);
  }
});

test("what is not finite is left out of the picture", () => {
  const bounds = boundsOfItems([item("ball", { at: [0, 1] }), item("ball", { at: [2, 3] })], Float32Array.of(1, 2, Infinity, NaN));
  expect(bounds.lower.slice(0, 2)).toEqual([1, 2]);
  expect(heightFor(bounds, 1)).toBe(1);
});

test("a car on its road is followed, a planet on its orbit is shown whole", () => {
  const at = (x: number) => boundsOfItems([item("box", { at: [0, 1] })], Float32Array.of(x, 0));
  const car = new Interest(true);
  const planet = new Interest(false);
  for (let x = 0; x <= 100; ++x) for (const interest of [car, planet]) interest.see(at(x));
  expect(car.wanted().lower[0]).toBeGreaterThan(90);
  expect(planet.wanted().lower[0]).toBeLessThan(0);
});

test("springs and ropes begin and end where they are fixed", () => {
  for (const flat of [true, false]) {
    const coil = new Float32Array(3 * springPoints(9));
    spring(coil, [1, 2, 0], [4, 6, 0], 9, 0.5, flat);
    expect([...coil.slice(0, 3)]).toEqual([1, 2, 0]);
    expect([...coil.slice(-3)]).toEqual([4, 6, 0]);
    expect(coil.every(Number.isFinite)).toBe(true);
  }
  const line = new Float32Array(3 * ropePoints);
  rope(line, [0, 0, 0], [2, 0, 0], 1, [0, -1, 0]);
  expect(line.filter((_, i) => i % 3 === 1).every((y) => y === 0)).toBe(true);  // taut
  rope(line, [0, 0, 0], [2, 0, 0], 2.2, [0, -1, 0]);
  let length = 0;
  for (let i = 3; i < line.length; i += 3) length += Math.hypot(line[i]! - line[i - 3]!, line[i + 1]! - line[i - 2]!);
  expect(Math.abs(length - 2.2)).toBeLessThan(0.03);  // the next term of the parabola's length is -32/5*s^4/c^3 = -0.018
});

test("a trail shows the time asked for, forgets what is taken back, and stays bounded", () => {
  const trail = new Trail(100);
  for (let i = 0; i <= 1000; ++i) trail.add(i, [i, 0, 0]);
  expect(trail.times.length).toBeLessThanOrEqual(100);
  expect(trail.times.at(-1)).toBe(1000);
  trail.forgetFrom(990);
  expect(trail.times.at(-1)!).toBeLessThan(990);
  const [begin, end] = trail.range(980, 10);
  for (let i = begin; i < end; ++i) expect(trail.times[i]! >= 970 && trail.times[i]! <= 980).toBe(true);
});

test("the front sphere is picked, a near miss counts only where nothing is hit", () => {
  const places = [0, 0, 0, 0, 0, 5, 3, 0, 0];
  const pick = (x: number, reach: number) => pickSphere(places, () => 1, [x, 0, 20], [0, 0, -1], () => reach);
  expect(pick(0, 0)).toBe(1);
  expect(pick(3.5, 0)).toBe(2);
  expect(pick(4.5, 0)).toBe(-1);
  expect(pick(4.5, 2)).toBe(2);
});

test("grid lines stand at 1, 2 or 5 times a power of ten", () => {
  expect(gridStep(10, 5)).toBe(2);
  expect(gridStep(0.7, 7)).toBeCloseTo(0.1, 12);
  expect(gridStep(4.9e6, 10)).toBe(5e5);
  expect(gridStep(0, 5)).toBe(1);
});

test("a few balls have colours of their own, many have one, a trail has its ball's", () => {
  const balls = (count: number) => Array.from({ length: count }, (_, i) => item("ball", { at: [2 * i, 2 * i + 1] }));
  expect(new Set(itemColors(balls(3), "light")).size).toBe(3);
  expect(new Set(itemColors(balls(40), "light")).size).toBe(1);
  const [, second, trail] = itemColors([...balls(2), item("trail", { at: [2, 3] })], "dark");
  expect(trail).toBe(second);
  expect(curveColors.dark).toContain(second);
});

test("six walls along the axes are a box, others are not", () => {
  const walls = [0, 1, 2].flatMap((axis) => [1, -1].map((sign) => ({ normal: [0, 1, 2].map((each) => (each === axis ? sign : 0)), offset: -2 })));
  expect(boxOfWalls(walls, 3)).toEqual({ lower: [-2, -2, -2], upper: [2, 2, 2] });
  expect(boxOfWalls(walls.slice(1), 3)).toBeNull();
  expect(boxOfWalls([...walls, { normal: [1, 1, 0], offset: 0 }], 3)).toBeNull();
});

const cube: Form = {
  corners: [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]],
  faces: [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
};

test("a cube has twelve edges, and normals that point outwards", () => {
  expect(edgesOf(cube, false)).toHaveLength(12);
  for (const face of cube.faces) {
    const normal = normalOf(cube, face);
    const corner = cube.corners[face[0]!]!;
    expect(normal[0] * corner[0]! + normal[1] * corner[1]! + normal[2] * corner[2]!).toBeCloseTo(1, 12);
  }
});

test("a body is placed by its angle in the plane, by its quaternion in space", () => {
  const right = placed(rotationOf(Float32Array.of(0, Math.PI / 2), 1, true), [0, 0, 0, 5, 6, 0], 3, [1, 0]);
  expect(right[0]).toBeCloseTo(5, 6);
  expect(right[1]).toBeCloseTo(7, 6);
  const half = Math.SQRT1_2; // a right angle about x takes y to z
  const up = placed(rotationOf(Float32Array.of(half, 0, 0, half), 0, false), [0, 0, 0], 0, [0, 1, 0]);
  expect(up[2]).toBeCloseTo(1, 6);
});

test("joints hold their bodies where they are, and guides lie along their axes", () => {
  const joint: Joint = { name: "", kind: "slider", first: 0, second: null, on_first: [1, 0], on_second: [4, 2], axis: [0, 1], apart: null };
  const bodies: Bodies = { count: 1, dimension: 2, radius: 2, walls: [], containers: [], joints: [joint] };
  const ends = endsOf(joint, bodies, [3, 2, 0], Float32Array.of(0));
  expect(ends.first).toEqual([4, 2, 0]);
  expect(ends.second).toEqual([4, 2, 0]);
  expect(linesOf(joint, ends, 2)).toEqual([[4, -1, 0], [4, 5, 0]]);
  expect(linesOf({ ...joint, kind: "rope" }, ends, 2)).toEqual([[4, 2, 0], [4, 2, 0]]);
  expect(linesOf({ ...joint, kind: "hinge" }, ends, 2)).toEqual([]);
  expect(isBroken(joint, { ...ends, second: [9, 9, 0] }, 2)).toBe(false);
  expect(isBroken({ ...joint, kind: "rope", apart: 3 }, { ...ends, second: [7, 2, 0] }, 2)).toBe(false);
  expect(isBroken({ ...joint, kind: "rope", apart: 3 }, { ...ends, second: [8, 2, 0] }, 2)).toBe(true);
});

test("a ray enters a cube at its surface, and a point of the plane is in a polygon or not", () => {
  expect(entry(cube, [-5, 0.5, 0.5], [1, 0, 0], false)).toBeCloseTo(4, 12);
  expect(entry(cube, [-5, 1.5, 0.5], [1, 0, 0], false)).toBeNull();
  expect(entry(cube, [0, 0, 0], [0, 0, 1], false)).toBe(0);
  const triangle: Form = { corners: [[0, 0], [1, 0], [0, 1]], faces: [[0, 1, 2]] };
  expect(entry(triangle, [0.2, 0.2, 0], [0, 0, -1], true)).toBe(0);
  expect(entry(triangle, [0.6, 0.6, 0], [0, 0, -1], true)).toBeNull();
});

// A road to the right, as the language has it: its points are turned round, so that what is free is on the right.
const road: StaticMesh = { name: "road", corners: [[6, 1], [4, 0], [0, 0]], facets: [[0, 1], [1, 2]], thin: false };

test("a chain is one line, with a band on the side that is not free", () => {
  expect(chainLines(road)).toEqual([[6, 1, 0, 4, 0, 0, 0, 0, 0]]);
  expect(chainLines({ ...road, facets: [[1, 2], [0, 1]] })).toHaveLength(2);
  expect(bandWidth(road)).toBeCloseTo(6 / 50, 12);
  const band = bandOf(road, 0.5);
  expect(band).toHaveLength(36);
  // Below the level part, and at a right angle behind the slope.
  for (let corner = 6; corner < 12; ++corner) expect(band[3 * corner + 1]).toBeLessThanOrEqual(0);
  expect(Math.min(...band.filter((_, k) => k >= 18 && k % 3 === 1))).toBeCloseTo(-0.5, 6);
  const [x, y] = [band[6]! - band[3]!, band[7]! - band[4]!];
  expect(Math.hypot(x, y)).toBeCloseTo(0.5, 6);
  expect(2 * x + y).toBeCloseTo(0, 6);
  expect(y).toBeLessThan(0);
});

test("a mesh is drawn as its triangles", () => {
  const mesh: StaticMesh = { name: "hill", corners: [[0, 0, 0], [1, 0, 0], [1, 1, 2], [0, 1, 0]], facets: [[0, 1, 2], [0, 2, 3]], thin: false };
  expect([...trianglesOf(mesh)]).toEqual([0, 0, 0, 1, 0, 0, 1, 1, 2, 0, 0, 0, 1, 1, 2, 0, 1, 0]);
});
