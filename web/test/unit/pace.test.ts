import { expect, test } from "vitest";
import { Pace } from "../../src/scene/pace";

/** Pictures that take `cost(share)` milliseconds each. */
const run = (pace: Pace, cost: (share: number) => number, pictures = 200): number => {
  let changes = 0;
  for (let i = 0; i < pictures; ++i) if (pace.took(cost(pace.share))) ++changes;
  return changes;
};

test("where the browser keeps up, every pixel is drawn", () => {
  const pace = new Pace(0.5);
  expect(run(pace, () => 16.7)).toBe(0);
  expect(pace.share).toBe(1);
});

test("where pixels cost, as many go as are needed and no more", () => {
  const pace = new Pace(0.5);
  run(pace, (share) => 40 * share ** 2);
  expect(pace.share).toBeLessThan(1);
  expect(40 * pace.share ** 2).toBeLessThan(25);
  expect(40 * (pace.share / 0.8) ** 2).toBeGreaterThan(25);
});

test("never fewer than the least", () => {
  const pace = new Pace(0.7);
  run(pace, (share) => 400 * share ** 2);
  expect(pace.share).toBe(0.7);
});

test("a tab that was hidden for a while says nothing about the pace", () => {
  const pace = new Pace(0.5);
  expect(run(pace, () => 60_000)).toBe(0);
});
