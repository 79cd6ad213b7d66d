// The world of a model's text, as far as it is written in plain numbers: what stands where, and the changes of the text
// that put down, move and take away its things. Everything else in the text stays as it is, to the byte. No drawing here.

export interface Place {
  x: number;
  y: number;
}

/** A piece of the text, from one offset to another. */
export interface Piece {
  from: number;
  to: number;
}

export interface BodyItem extends Piece {
  kind: "body";
  name: string;
  /** Null where it is no plain number: then the text alone can move it. */
  at: Place | null;
  /** The numbers of its place. */
  numbers: [Piece, Piece] | null;
}
export interface WallItem extends Piece {
  kind: "wall";
  name: string;
  normal: Place;
  offset: number;
  /** The number of its offset. */
  number: Piece;
}
export interface SpringItem extends Piece {
  kind: "spring";
  a: string;
  b: string | Place;
  /** The numbers of the point that it hangs on. */
  numbers: [Piece, Piece] | null;
}
export type Item = BodyItem | WallItem | SpringItem;

export interface WorldText {
  /** What stands between the braces. */
  inside: Piece;
  items: Item[];
}

export interface Change extends Piece {
  insert: string;
}

const numeral = "[+-]?(?:\\d+(?:\\.(?!\\.)\\d*)?|\\.\\d+)(?:[eE][+-]?\\d+)?";
const pair = `\\(\\s*(${numeral})\\s*,\\s*(${numeral})\\s*\\)`;
const nameText = "[\\p{L}_][\\p{L}\\p{N}\\p{M}_]*";

/** The text with its comments and strings blanked, as long as it was. */
export const codeOf = (text: string): string => text.replace(/"(?:[^"\\\n]|\\.)*"?|#[^\n]*/g, (found) => " ".repeat(found.length));

/** The end of a block whose brace opens at `open`; -1 where it is not closed. */
function closingBrace(code: string, open: number): number {
  let depth = 0;
  for (let i = open; i < code.length; ++i) {
    if (code[i] === "{") ++depth;
    else if (code[i] === "}" && --depth === 0) return i;
  }
  return -1;
}

/** The items of a block: a line or what stands between semicolons; lines go on inside of brackets and after a comma. */
function* piecesOf(code: string, { from, to }: Piece): Generator<Piece> {
  let begin = from;
  let depth = 0;
  for (let i = from; i <= to; ++i) {
    const sign = i < to ? code[i]! : "\n";
    if (sign === "(" || sign === "[" || sign === "{") ++depth;
    if (sign === ")" || sign === "]" || sign === "}") --depth;
    const ends = i === to || (depth === 0 && (sign === ";" || (sign === "\n" && !/,\s*$/.test(code.slice(begin, i)))));
    if (!ends) continue;
    const lead = /^\s*/.exec(code.slice(begin, i))![0].length;
    const body = code.slice(begin + lead, i).trimEnd();
    if (body !== "") yield { from: begin + lead, to: begin + lead + body.length };
    begin = i + 1;
  }
}

/** Where the groups of a match stand in the text. */
function groupAt(match: RegExpExecArray, group: number, base: number): Piece {
  const [from, to] = match.indices![group]!;
  return { from: base + from, to: base + to };
}

function itemOf(code: string, piece: Piece): Item | null {
  const text = code.slice(piece.from, piece.to);
  const find = (pattern: string): RegExpExecArray | null => new RegExp(pattern, "du").exec(text);
  const body = find(`^body\\s+(${nameText})(?![\\p{L}\\p{N}_\\[])`);
  if (body) {
    const at = find(`\\sat\\s*${pair}`);
    return { ...piece, kind: "body", name: body[1]!, at: at ? { x: Number(at[1]), y: Number(at[2]) } : null, numbers: at ? [groupAt(at, 1, piece.from), groupAt(at, 2, piece.from)] : null };
  }
  const wall = find(`^wall\\s+(?:(${nameText})\\s*)?${pair}\\s*at\\s+(${numeral})(?!\\s*[-+*/^(])`);
  if (wall) {
    return { ...piece, kind: "wall", name: wall[1] ?? "", normal: { x: Number(wall[2]), y: Number(wall[3]) }, offset: Number(wall[4]), number: groupAt(wall, 4, piece.from) };
  }
  const spring = find(`^spring\\s+(${nameText})\\s+to\\s+(?:(${nameText})|${pair})`);
  if (spring) {
    const b = spring[2] ?? { x: Number(spring[3]), y: Number(spring[4]) };
    return { ...piece, kind: "spring", a: spring[1]!, b, numbers: spring[2] ? null : [groupAt(spring, 3, piece.from), groupAt(spring, 4, piece.from)] };
  }
  return null;
}

/** The world of a text in the plane; null where it has none. */
export function worldOf(text: string): WorldText | null {
  const code = codeOf(text);
  const begin = /(?:^|[\n;])[ \t]*world\s*\{/.exec(code);
  if (!begin) return null;
  const open = begin.index + begin[0].length - 1;
  const close = closingBrace(code, open);
  if (close < 0) return null;
  const inside = { from: open + 1, to: close };
  const items: Item[] = [];
  for (const piece of piecesOf(code, inside)) {
    if (/^dimension\s+3/.test(code.slice(piece.from, piece.to))) return null;
    const item = itemOf(code, piece);
    if (item) items.push(item);
  }
  return { inside, items };
}

/** A number as somebody would write it, to so many digits after the point. */
export function numberText(value: number, digits: number): string {
  const text = value.toFixed(Math.min(12, Math.max(0, digits)));
  const short = text.includes(".") ? text.replace(/\.?0+$/, "") : text;
  return short === "-0" ? "0" : short;
}

const placeText = ({ x, y }: Place, digits: number): string => `(${numberText(x, digits)}, ${numberText(y, digits)})`;

/** `base` if the text has no such name, else base2, base3, ...; with `first` counted from 1. */
export function freshName(text: string, base: string, counted = false): string {
  const used = new Set(codeOf(text).match(new RegExp(nameText, "gu")));
  if (!counted && !used.has(base)) return base;
  for (let i = counted ? 1 : 2; ; ++i) if (!used.has(`${base}${i}`)) return `${base}${i}`;
}

/** What a wall is called by the direction that it faces. */
export function wallBase({ x, y }: Place): string {
  const length = Math.hypot(x, y);
  const [right, up] = [x / length, y / length];
  if (up > 0.999) return "floor";
  if (up < -0.999) return "ceiling";
  if (right > 0.999) return "left_wall";
  if (right < -0.999) return "right_wall";
  return up > 0 ? "slope" : "roof";
}

/** A new item below those of its kind, else at the end of the world, indented as its neighbours are. */
function put(text: string, world: WorldText, kind: Item["kind"], line: string): Change {
  const code = codeOf(text);
  const lineOf = (at: number): string => text.slice(text.lastIndexOf("\n", at - 1) + 1, at);
  const same = world.items.filter((item) => item.kind === kind && lineOf(item.from).trim() === "").at(-1);
  if (same) {
    // After the comment that may end its line; where another item shares the line, after that one too.
    let end = text.indexOf("\n", same.to);
    if (end < 0 || end > world.inside.to) end = world.inside.to;
    const shared = code.slice(same.to, end).trim() !== "";
    if (!shared && end < world.inside.to) return { from: end, to: end, insert: `\n${lineOf(same.from)}${line}` };
  }
  const { from, to } = world.inside;
  const before = text.slice(from, to);
  const outer = /^[ \t]*/.exec(lineOf(from))![0];
  const comment = /#[^\n]*$/.test(before);
  const blank = before.length - before.trimEnd().length;
  if (before.includes("\n") && !comment) return { from: to - blank, to, insert: `\n${outer}  ${line}\n${outer}` };
  if (comment) return { from: to, to, insert: `\n${outer}  ${line}\n${outer}` };
  return { from, to, insert: `\n${before.trim() === "" ? "" : `${outer}  ${before.trim()}\n`}${outer}  ${line}\n${outer}` };
}

export interface Written {
  changes: Change[];
  name: string;
}

export function addBody(text: string, world: WorldText, at: Place, radius: number, digits: number): Written {
  const name = freshName(text, "ball", true);
  return { name, changes: [put(text, world, "body", `body ${name} at ${placeText(at, digits)} radius ${numberText(radius, digits + 1)} mass 1`)] };
}

/** The wall of the half plane normal . x >= offset; a thin one has two free sides. */
export function addWall(text: string, world: WorldText, normal: Place, offset: number, thin: boolean, digits: number): Written {
  const name = freshName(text, wallBase(normal));
  return { name, changes: [put(text, world, "wall", `wall ${name} ${placeText(normal, 4)} at ${numberText(offset, digits + 1)}${thin ? " thin" : ""}`)] };
}

export function addSpring(text: string, world: WorldText, a: string, b: string | Place, digits: number): Written {
  const end = typeof b === "string" ? b : placeText(b, digits);
  return { name: "", changes: [put(text, world, "spring", `spring ${a} to ${end} stiffness 40 damping 0.2`)] };
}

/** Moves a body, or the point that a spring hangs on. */
export function moveTo(item: BodyItem | SpringItem, { x, y }: Place, digits: number): Change[] {
  if (!item.numbers) return [];
  return [x, y].map((value, axis) => ({ ...item.numbers![axis]!, insert: numberText(value, digits) }));
}

export const moveWall = (item: WallItem, offset: number, digits: number): Change[] => [{ ...item.number, insert: numberText(offset, digits + 1) }];

/** The whole of an item's line where nothing else stands in it, else the item and its semicolon. */
function withLine(text: string, { from, to }: Piece): Change {
  const lineBegin = text.lastIndexOf("\n", from - 1) + 1;
  const lineEnd = text.indexOf("\n", to);
  const before = text.slice(lineBegin, from);
  const after = text.slice(to, lineEnd < 0 ? text.length : lineEnd);
  if (before.trim() === "" && /^\s*(#.*)?$/.test(after) && lineEnd >= 0) return { from: lineBegin, to: lineEnd + 1, insert: "" };
  const semicolon = /^\s*;[ \t]*/.exec(after);
  if (semicolon) return { from, to: to + semicolon[0].length, insert: "" };
  const earlier = /;\s*$/.exec(before);
  return { from: earlier ? from - earlier[0].length : from, to, insert: "" };
}

/** Takes an item away, and the springs of a body with it; or says in which line something else reads the body or wall. */
export function remove(text: string, world: WorldText, item: Item): Change[] | { readIn: number; name: string } {
  const gone: Item[] = [item];
  if (item.kind === "body") gone.push(...world.items.filter((each) => each.kind === "spring" && (each.a === item.name || each.b === item.name)));
  const name = item.kind === "spring" ? "" : item.name;
  if (name !== "") {
    for (const found of codeOf(text).matchAll(new RegExp(`(?<![\\p{L}\\p{N}_.])${name}(?![\\p{L}\\p{N}_])`, "gu"))) {
      if (!gone.some(({ from, to }) => found.index >= from && found.index < to)) return { readIn: text.slice(0, found.index).split("\n").length, name };
    }
  }
  return gone.map((each) => withLine(text, each)).sort((a, b) => a.from - b.from);
}

/** The text after changes that do not overlap. */
export function changed(text: string, changes: readonly Change[]): string {
  return [...changes].sort((a, b) => b.from - a.from).reduce((now, { from, to, insert }) => now.slice(0, from) + insert + now.slice(to), text);
}
