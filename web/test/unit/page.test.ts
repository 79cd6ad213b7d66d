import { expect, test } from "vitest";
import { fromHash, galleryName, toHash } from "../../src/address";
import { keyName, restOf, valueOfKey } from "../../src/controls/keys";
import { places, sliderScale } from "../../src/controls/scale";
import { formatNumber, formatReached, formatSteady, formatUnit, parseNumber } from "../../src/format";
import { parseHeading } from "../../src/heading";
import { pressed } from "../../src/keyboard";
import { channels } from "../../src/palette";
import { socketAddress } from "../../src/source";
import type { StateMessage } from "../../src/protocol";
import { modelOf } from "./frames";

test("numbers are short and say what they are", () => {
  expect([0.5, 12345.678, 1.2e-7, -3, 0, NaN, Infinity].map((value) => formatNumber(value))).toEqual(["0.5", "12346", "1.2e−7", "−3", "0", "–", "∞"]);
  expect([1, 10, 9.87654321].map((value) => formatSteady(value))).toEqual(["1.0000", "10.000", "9.8765"]);
  expect(parseNumber(" −1,5 ")).toBe(-1.5);
  expect(parseNumber("")).toBeNaN();
  expect([formatUnit("m/s^2"), formatUnit("kg*m^2"), formatUnit("1"), formatUnit("kg m2 s-2")]).toEqual(["m/s²", "kg·m²", "", "kg m² s⁻²"]);
});

test("the reached speed is told without noise", () => {
  expect(formatReached(0.99, 1)).toBe("1×");
  expect(formatReached(0.1234, 1)).toBe("0.12×");
  expect(formatReached(NaN, 1)).toBe("–");
});

test("a slider reaches both ends and gives back its values", () => {
  for (const [min, max, usual] of [[0, 10, 4], [-5, 5, 0], [1e-3, 1e3, 1], [0, 1e6, 1000]] as const) {
    const scale = sliderScale(min, max, usual);
    expect(scale.toValue(0)).toBe(min);
    expect(scale.toValue(places)).toBe(max);
    for (let place = 0; place <= places; place += 50) expect(Math.abs(scale.toPlace(scale.toValue(place)) - place)).toBeLessThanOrEqual(5);
  }
  const far = sliderScale(0, 1e6, 1000);
  expect(far.toPlace(1000)).toBeGreaterThan(50);  // linear, it would stand at 1
});

test("a key moves an input to its end and lets it back", () => {
  const throttle = { file: 0, min: 0, max: 1 };
  expect([valueOfKey(throttle, false), restOf(throttle)]).toEqual([1, 0]);
  expect(valueOfKey({ file: 0, min: -5, max: 5 }, true)).toBe(-5);
  expect(restOf({ file: 1, min: 0, max: 1 })).toBe(0);
  expect([keyName("left"), keyName("W"), keyName("space")]).toEqual(["arrowleft", "w", " "]);
});

test("keys have one name, and none while Ctrl, Alt or Meta is held", () => {
  const event = { key: "R", shiftKey: true, ctrlKey: false, metaKey: false, altKey: false };
  expect(pressed(event)).toBe("r");
  expect(pressed({ ...event, ctrlKey: true })).toBe("");
  expect(pressed({ ...event, key: "ArrowLeft" })).toBe("Shift+ArrowLeft");
  expect(pressed({ ...event, key: " ", shiftKey: false })).toBe("Space");
});

test("the address carries what differs, and comes back the same", () => {
  const model = modelOf({
    parameters: [{ name: "k", value: 5.5, file: 4, unit: "", min: 0, max: 10, comment: "", structural: false }, { name: "m", value: 1, file: 1, unit: "", min: 0, max: 10, comment: "", structural: false }],
    gallery: [{ name: "m", title: "" }],
  });
  const state = { method: "rk4", step: 0.05, rtol: null, ghost: { method: "rk4", step: 1, rtol: null }, target: 0.5, parameters: { k: 5.5, m: 1 }, inputs: {} } as unknown as StateMessage;
  const text = toHash(model, state, [1, 2, 3.00001234], ["x:t"]);
  expect(text).not.toContain("p.m");
  expect(fromHash(`#${text}`)).toEqual({
    model: "m", parameters: { k: 5.5 }, inputs: {}, method: { name: "rk4", step: 0.05 }, ghost: { name: "rk4", step: 1 }, speed: 0.5, view: [1, 2, 3], plots: ["x:t"],
  });
});

test("an address that somebody spoilt does no harm", () => {
  expect(fromHash("#p.k=abc&p.m=&view=1,x&method=,&speed=-1&=&%")).toEqual({ parameters: {}, inputs: {}, plots: [] });
  expect(galleryName({ path: "/a/b/bouncing_ball.sim" })).toBe("bouncing_ball");
});

test("the sentence that says what to see is found", () => {
  const heading = parseHeading("A ball falls.\n\nBetween impacts it flies.\nIt is free. Watch the energy\nfall in steps.\n\nTry:  continuo run a --set e=1\n      continuo run b\n");
  expect(heading.title).toBe("A ball falls.");
  expect(heading.watch).toBe("Watch the energy fall in steps.");
  expect(heading.paragraphs.map(({ code }) => code)).toEqual([false, true]);
});

test("colours and addresses are read as a browser would", () => {
  expect(channels("#ff8000")).toEqual([1, 128 / 255, 0]);
  expect(socketAddress({ protocol: "http:", host: "127.0.0.1:8080", search: "?token=a%2Bb&embed" })).toBe("ws://127.0.0.1:8080/live?token=a%2Bb");
});
