import { expect, test } from "vitest";
import { decodeFrame } from "../../src/protocol";
import { frameAt, framesOf, pictureAt } from "../../src/recording";
import { Session } from "../../src/session";
import { encodeFrame, modelOf } from "./frames";

function base64(frames: ArrayBuffer[], cut = 0): string {
  const bytes = frames.flatMap((frame) => [...new Uint8Array(Uint32Array.of(frame.byteLength).buffer), ...new Uint8Array(frame)]);
  return btoa(String.fromCharCode(...bytes.slice(0, bytes.length - cut)));
}

test("a recording is parted into its frames, also where its end is missing", () => {
  const frames = [encodeFrame({ t: 1 }), encodeFrame({ t: 2, rowTimes: [2], rows: [[1, 2]] })];
  expect(framesOf(base64(frames)).map((frame) => frame.byteLength)).toEqual(frames.map((frame) => frame.byteLength));
  expect(framesOf(base64(frames, 3))).toHaveLength(1);
  expect(framesOf("")).toEqual([]);
});

test("between two frames the drawing is between the two", () => {
  const model = modelOf({ scene_count: 1 });
  const frames = [0, 1, 2].map((t) => decodeFrame(encodeFrame({ t, scene: [10 * t] }), model)).filter((frame) => typeof frame !== "string");
  expect(frameAt(frames, 1.5)).toBe(1);
  expect(frameAt(frames, -1)).toBe(0);
  const picture = pictureAt(frames, 1.25);
  expect([picture.t, picture.scene[0], picture.lookingBack]).toEqual([1.25, 12.5, true]);
  expect(pictureAt(frames, 2).scene[0]).toBe(20);
});

test("a new run of the same model forgets the old one and rebuilds nothing", () => {
  const session = new Session({ live: true, start: () => undefined, send: () => undefined });
  let built = 0;
  session.on("model", () => ++built);
  const arrive = (run: number, t: number) => session.arrived(decodeFrame(encodeFrame({ run, t, rowTimes: [t], rows: [[t, t]] }), modelOf()) as never);
  session.said(modelOf({ run: 1 }));
  arrive(1, 0);
  arrive(1, 1);
  session.said({ say: "event", t: 0.5, name: "e", mark: null });
  expect([session.history.length, session.events.length]).toEqual([2, 1]);
  arrive(2, 0);
  expect([session.history.length, session.events.length]).toEqual([1, 0]);
  session.said(modelOf({ run: 3 }));
  expect(built).toBe(1);
  session.said(modelOf({ run: 4, text: "another" }));
  expect(built).toBe(2);
});
