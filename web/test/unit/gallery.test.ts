// The order and the search of the gallery, the arrows, and the axes of a plot in the address.
import { expect, test } from "vitest";
import { bySubject, isFound } from "../../src/gallery";
import { specFromText, specText } from "../../src/plots/specs";
import { roundBelow, vectorOf } from "../../src/scene/vectors";

const ball = { name: "bouncing_ball", title: "A ball falls.", subject: "Start here" };

test("models stand under their subjects in their order; others are last", () => {
  const models = [{ name: "own", title: "" }, ball, { name: "gas", title: "", subject: "Bodies" }, { name: "car", title: "", subject: "Start here" }];
  expect(bySubject(models).map(({ subject, models: members }) => [subject, members.map(({ name }) => name)])).toEqual([["Start here", ["bouncing_ball", "car"]], ["Bodies", ["gas"]], ["More", ["own"]]]);
  expect(bySubject([{ name: "own", title: "" }])).toMatchObject([{ subject: "" }]);
});

test("all words are looked for, in any order", () => {
  expect(isFound(ball, "")).toBe(true);
  expect(isFound(ball, "FALLS bouncing_ball start")).toBe(true);
  expect(isFound(ball, "ball car")).toBe(false);
});

test("a vector is that of the mode", () => {
  const item = { shape: "ball" as const, drag: false, numbers: { at: [0, 1], velocity: [2, 3], "acceleration:flight": [4, 5] } };
  const scene = new Float32Array([0, 0, 1, 2, 3, 4]);
  expect(vectorOf(item, "velocity", null, scene)).toEqual([1, 2, 0]);
  expect(vectorOf(item, "acceleration", "flight", scene)).toEqual([3, 4, 0]);
  expect(vectorOf(item, "acceleration", "rest", scene)).toBeNull();
  expect([9.9, 5, 4.9, 0.019].map(roundBelow)).toEqual([5, 5, 2, 0.01]);
});

test("logarithmic axes are in the address", () => {
  const columns = [{ name: "x", unit: "m", kind: "state" as const }, { name: "v", unit: "m/s", kind: "state" as const }];
  for (const text of ["x:t", "v:x", "x,v:t:logy", "v:x:logxy"]) expect(specText(specFromText(text, columns, "a")!)).toBe(text);
});
