import { StringStream } from "@codemirror/language";
import { Text } from "@codemirror/state";
import { expect, test } from "vitest";
import { rangeOf } from "../../src/editor/editor";
import { piece } from "../../src/editor/language";

function pieces(line: string): [string, string | null][] {
  const stream = new StringStream(line, 2, 2);
  const state = { afterName: false, atStart: true };
  const found: [string, string | null][] = [];
  while (!stream.eol()) {
    stream.start = stream.pos;
    const kind = piece(stream, state);
    if (stream.current().trim() !== "") found.push([stream.current(), kind]);
  }
  return found;
}

test("a bracket after a number is a unit, after a name an index", () => {
  expect(pieces("param k = 4 [N/m]").at(-1)).toEqual(["[N/m]", "unit"]);
  expect(pieces("u[i]' = 3[m]").map(([, kind]) => kind)).not.toContain("keyword");
  expect(pieces("u[i]")[1]).toEqual(["[", null]);
});

test("words, numbers and ranges are told apart", () => {
  const kinds = Object.fromEntries(pieces('run 0..60 [s] method rk4 step 1e-3 # comment "no"'));
  expect(kinds).toMatchObject({ run: "keyword", "0": "number", "..": "operator", "60": "number", "[s]": "unit", method: "modifier", "1e-3": "number", '# comment "no"': "comment" });
  expect(Object.fromEntries(pieces("draw { ball (x, y) radius 0.1 }"))).toMatchObject({ draw: "keyword", ball: "typeName", x: "variableName" });
  expect(Object.fromEntries(pieces("world { ball arm to frame at (0, 1) }"))).toMatchObject({ ball: "keyword", arm: "variableName" });
  expect(pieces("x := sin(t)").map(([, kind]) => kind)).toEqual(["variableName", "operator", "function", null, "variableName", null]);
});

test("every line is read to its end", () => {
  for (const line of ["§ ünïcode \u0000", '"open', "[open", "x'''", "1..2..3", ".5.5"]) expect(() => pieces(line)).not.toThrow();
});

test("a message is underlined where it is, and never outside the text", () => {
  const text = Text.of(["abc", "defgh"]);
  expect(rangeOf(text, { line: 2, column: 2, length: 3 })).toEqual({ from: 5, to: 8 });
  expect(rangeOf(text, { line: 99, column: 99, length: 99 })).toEqual({ from: 8, to: 9 });
  expect(rangeOf(text, { line: null, column: null, length: null })).toEqual({ from: 0, to: 1 });
});
