import { expect, test } from "vitest";
import { csv } from "../../src/plots/export";
import { atLeast, calm, decades, equalScales, finiteRange, leastDrift, padded, powersBetween, timeWindow } from "../../src/plots/range";
import { defaultSpecs, distanceSpec, energiesOf, specFromText, specText } from "../../src/plots/specs";
import { History } from "../../src/history";
import type { Column } from "../../src/protocol";
import { modelOf } from "./frames";

const columns: Column[] = [
  { name: "x", unit: "m", kind: "state" },
  { name: "x'", unit: "m/s", kind: "state" },
  { name: "kinetic", unit: "J", kind: "energy" },
  { name: "elastic", unit: "J", kind: "energy" },
  { name: "energy", unit: "J", kind: "energy" },
  { name: "drift", unit: "1", kind: "drift" },
  { name: "distance", unit: "m", kind: "distance" },
];

test("energies and their drift are plotted without being asked for", () => {
  const ids = defaultSpecs(modelOf({ columns, plots: [{ curves: [{ label: "x", column: 0, unit: "m" }], against: "t" }], drawing: [{ shape: "ball", numbers: { at: [0, 1] }, drag: false }] })).map(({ id }) => id);
  expect(ids).toEqual(["model0", "energy", "drift"]);
  expect(distanceSpec(columns)?.curves[0]?.column).toBe(6);
});

test("a model without drawing gets its phase plane, of a state against its own rate", () => {
  const phase = defaultSpecs(modelOf({ columns })).find(({ id }) => id === "phase");
  expect(phase?.against?.label).toBe("x");
  expect(phase?.curves.map(({ label }) => label)).toEqual(["x'"]);
});

test("a logarithmic axis has whole powers of ten, and not more than say something", () => {
  const powers = (low: number, high: number) => decades([low, high]).map((end) => Math.round(Math.log10(end)));
  expect(powers(2e-5, 0.3)).toEqual([-5, 0]);
  expect(powers(1e-3, 1)).toEqual([-3, 0]);
  expect(powers(5, 5)).toEqual([0, 1]);
  expect(powers(1e-300, 1)).toEqual([-20, 0]);
  expect(powersBetween(1e-5, 1, 6)).toEqual([1e-5, 1e-4, 1e-3, 0.01, 0.1, 1]);
  expect(powersBetween(1e-20, 1, 6).length).toBeLessThanOrEqual(7);
});

test("a world that says nothing is plotted by its energies", () => {
  const names = ["world.kinetic", "world.potential", "world.momentum.x", "world.collisions"];
  const curves = names.map((label, column) => ({ label, column, unit: "" }));
  const world = modelOf({ columns: names.map((name) => ({ name, unit: "", kind: "state" as const })), plots: [{ curves, against: "t" }], bodies: { count: 1, dimension: 2, radius: 1, walls: [], containers: [] } });
  expect(defaultSpecs(world).map(({ title }) => title)).toEqual(["world.kinetic, world.potential"]);
});

test("one energy alone is not shown twice", () => {
  expect(energiesOf([columns[2]!, columns[4]!]).map(({ label }) => label)).toEqual(["kinetic"]);
});

test("a plot survives the address, and unknown names are refused", () => {
  const spec = specFromText("x,x':t", columns, "a")!;
  expect(specText(spec)).toBe("x,x':t");
  expect(specFromText("x':x", columns, "a")?.against?.column).toBe(0);
  for (const wrong of ["", "x", "nothing:t", "x:nothing", ":"]) expect(specFromText(wrong, columns, "a")).toBeNull();
});

test("what is not finite does not spoil a range", () => {
  expect(finiteRange([1, NaN, Infinity, -2, -Infinity], 0, 5)).toEqual([-2, 1]);
  expect(finiteRange([NaN], 0, 1)).toBeNull();
  const [low, high] = padded([3, 3]);
  expect(low).toBeLessThan(3);
  expect(high).toBeGreaterThan(3);
});

test("a range grows at once and shrinks only when most of it is empty", () => {
  const wide = calm(null, [0, 10]);
  expect(calm(wide, [1, 9])).toBe(wide);
  expect(calm(wide, [0, 20])[1]).toBeGreaterThan(20);
  expect(calm(wide, [4, 5])[1]).toBeLessThan(6);
});

test("the window waits for the run to fill it, then follows", () => {
  expect(timeWindow(0, 0, 10)).toEqual([0, 1.25]);
  expect(timeWindow(0, 3, 10)).toEqual([0, 5]);
  expect(timeWindow(0, 9, 10)).toEqual([0, 10]);
  expect(timeWindow(0, 25, 10)).toEqual([15, 25]);
  expect(timeWindow(0, 25, Infinity)).toEqual([0, 25]);
  expect(timeWindow(NaN, NaN, 10)).toEqual([0, 10]);
});

test("equal scales show a circle round", () => {
  const [x, y] = equalScales([-1, 1], [-1, 1], 400, 200);
  expect((x[1] - x[0]) / 400).toBeCloseTo((y[1] - y[0]) / 200, 12);
  expect(y).toEqual([-1, 1]);
});

test("a table has units in its heading and quotes what needs it", () => {
  const history = new History(2);
  history.append({ rewound: false, t: 0, rowTimes: Float64Array.of(0, 0.5), rows: Float32Array.of(1, 2, 3, 0.1), ghostRows: null });
  const table = csv(history, [{ name: "a,b", unit: "m", kind: "state" }, { name: "c", unit: "1", kind: "state" }], [0, 1], "s");
  expect(table).toBe('t [s],"a,b [m]",c\n0,1,2\n0.5,3,0.100000001\n');
});

test("the drift of a conserved energy is a level line, and that of one that grows fills its axis", () => {
  const least = leastDrift(1e-10);
  const [low, high] = atLeast([-2e-12, 3e-12], least);
  expect(high - low).toBeCloseTo(1e-7, 12);
  expect((low + high) / 2).toBeCloseTo(5e-13, 18);
  expect(atLeast([0, 0.3], least)).toEqual([0, 0.3]);
  expect(leastDrift(null)).toBeCloseTo(1e-9, 15);
  // Of a constant in single precision, a unit in the last place up and down.
  const [bottom, top] = padded([6545, Math.fround(6545 * (1 + 2 ** -22))]);
  expect(top - bottom).toBeGreaterThan(100);
});
