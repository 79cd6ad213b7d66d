import { expect, test } from "vitest";
import { decodeFrame, runOfFrame } from "../../src/protocol";
import { encodeFrame, modelOf } from "./frames";

test("a frame gives back what was written into it", () => {
  const model = modelOf({ scene_count: 3 });
  const frame = decodeFrame(
    encodeFrame({ run: 7, flags: 1 | 16, t: 2.5, rowTimes: [2, 2.5], rows: [[1, 2], [3, 4]], scene: [5, 6, 7], ghostRows: [[8, 9], [10, 11]], ghostScene: [12, 13, 14] }),
    model,
  );
  if (typeof frame === "string") throw new Error(frame);
  expect([frame.run, frame.t, frame.reached, frame.target, frame.rewound, frame.lookingBack]).toEqual([7, 2.5, 0.5, 1, true, true]);
  expect([...frame.rowTimes]).toEqual([2, 2.5]);
  expect([...frame.rows]).toEqual([1, 2, 3, 4]);
  expect([...frame.scene]).toEqual([5, 6, 7]);
  expect([...frame.ghostRows!]).toEqual([8, 9, 10, 11]);
  expect([...frame.ghostScene!]).toEqual([12, 13, 14]);
});

test("bodies come with positions and orientations", () => {
  const model = modelOf({ columns: [], bodies: { count: 2, dimension: 2, radius: 1, walls: [], containers: [] } });
  const frame = decodeFrame(encodeFrame({ bodies: { dimension: 2, positions: [1, 2, 3, 4], orientations: [0.5, 1.5] } }), model);
  if (typeof frame === "string") throw new Error(frame);
  expect([...frame.positions!]).toEqual([1, 2, 3, 4]);
  expect([...frame.orientations!]).toEqual([0.5, 1.5]);
});

test("a ghost of bodies, and the paths of trails, come after what they belong to", () => {
  const model = modelOf({ columns: [], path_count: 2, bodies: { count: 1, dimension: 3, radius: 1, walls: [], containers: [] } });
  const bodies = { dimension: 1, positions: [1, 2, 3], orientations: [0, 0, 0, 1], ghostPositions: [4, 5, 6], ghostOrientations: [1, 0, 0, 0] };
  const data = encodeFrame({ rowTimes: [1, 2], rows: [], ghostRows: [], bodies, paths: [7, 8, 9, 10], ghostPaths: [11, 12, 13, 14] });
  new DataView(data).setUint32(40 + 16, 1, true);  // one body of three numbers
  const frame = decodeFrame(data, model);
  if (typeof frame === "string") throw new Error(frame);
  expect([...frame.ghostPositions!, ...frame.ghostOrientations!]).toEqual([4, 5, 6, 1, 0, 0, 0]);
  expect([...frame.paths!, ...frame.ghostPaths!]).toEqual([7, 8, 9, 10, 11, 12, 13, 14]);
});

test("a frame that was cut off, or is none, is refused and not half read", () => {
  const model = modelOf({ scene_count: 3 });
  const whole = encodeFrame({ rowTimes: [1], rows: [[1, 2]], scene: [1, 2, 3] });
  for (let length = 0; length < whole.byteLength; ++length) expect(typeof decodeFrame(whole.slice(0, length), model)).toBe("string");
  new DataView(whole).setUint32(0, 9, true);
  expect(typeof decodeFrame(whole, model)).toBe("string");
  new DataView(whole).setUint32(0, 1, true);
  new DataView(whole).setUint32(12, 0xffffffff, true);  // a count of rows that no memory has
  expect(typeof decodeFrame(whole, model)).toBe("string");
});

test("the run of a frame is read without its model", () => {
  expect(runOfFrame(encodeFrame({ run: 42 }))).toBe(42);
  expect(runOfFrame(new ArrayBuffer(4))).toBe(-1);
});
