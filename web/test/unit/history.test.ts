import { expect, test } from "vitest";
import { History } from "../../src/history";

const rows = (times: number[], value: (t: number) => number, rewound = false, ghost = false) => ({
  rewound,
  t: times.at(-1) ?? 0,
  rowTimes: Float64Array.from(times),
  rows: Float32Array.from(times.map(value)),
  ghostRows: ghost ? Float32Array.from(times.map((t) => -value(t))) : null,
});

test("values between rows lie on the line between them, and there are none outside", () => {
  const history = new History(1);
  history.append(rows([0, 1, 2], (t) => 10 * t));
  expect(history.valueAt(0, 0.5)).toBe(5);
  expect(history.valueAt(0, 2)).toBe(20);
  expect(history.valueAt(0, -0.1)).toBeNaN();
  expect(history.valueAt(0, 99)).toBeNaN();
});

test("a rewound frame forgets what it replaces", () => {
  const history = new History(1);
  history.append(rows([0, 1, 2, 3], (t) => t));
  history.append(rows([2, 2.5], (t) => 100 * t, true));
  expect([...history.t.subarray(0, history.length)]).toEqual([0, 1, 2, 2.5]);
  expect(history.valueAt(0, 2)).toBe(200);
  history.append({ ...rows([], (t) => t, true), t: 1 });
  expect([...history.t.subarray(0, history.length)]).toEqual([0, 1]);
});

test("a ghost that comes later has no values before", () => {
  const history = new History(1);
  history.append(rows([0, 1], (t) => t));
  history.append(rows([2, 3], (t) => t, false, true));
  expect(history.valueAt(0, 1, true)).toBeNaN();
  expect(history.valueAt(0, 3, true)).toBe(-3);
  history.append(rows([4], (t) => t));
  expect(history.valueAt(0, 4, true)).toBeNaN();
});

test("a long run is thinned in its older half, keeps its order, its beginning and its newest rows", () => {
  const history = new History(1, 16);
  const count = 3 * history.most;
  for (let i = 0; i < count; i += 100) history.append(rows(Array.from({ length: 100 }, (_, k) => i + k), (t) => t % 1000));
  expect(history.length).toBeLessThanOrEqual(history.most);
  expect(history.length).toBeGreaterThan(history.most / 2);
  expect(history.first).toBe(0);
  expect(history.last).toBe(count - 1);
  for (let i = 1; i < history.length; ++i) {
    expect(history.t[i]! > history.t[i - 1]!).toBe(true);
    expect(history.columns[0]![i]).toBe(history.t[i]! % 1000);
  }
  const newest = history.t.subarray(history.length - 100, history.length);
  expect(newest[99]! - newest[0]!).toBe(99);
});
