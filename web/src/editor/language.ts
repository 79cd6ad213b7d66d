// The highlighting of models: which piece of a line is a word of the language, a number, a unit, a text, a comment.
import { StreamLanguage, type StringStream } from "@codemirror/language";

const statements = new Set([
  "model", "param", "let", "output", "energy", "input", "table", "unknown", "guess", "for", "mode", "start", "when", "at", "every",
  "initially", "run", "plot", "draw", "check",
]);
const words = new Set([
  "in", "if", "then", "else", "and", "or", "not", "from", "sum", "where", "go", "mark", "stop", "after", "before", "falls", "rises", "crosses", "through",
  "method", "step", "tol", "abs", "max", "realtime", "steps", "log", "per", "decade", "against", "within", "always", "drift", "count", "of", "events", "event", "time", "end", "key", "to", "seed", "sobol", "latin_hypercube", "monte_carlo", "indices", "morris",
  "drag", "color", "label", "radius", "size", "angle", "turns", "width", "length", "scale",
]);
// These begin something only where a name, a number or a bracket follows: `body ball`, `wall (0, 1)`. Elsewhere they are names.
const ofBlocks = new Set([
  "world", "force", "torque", "dimension", "gravity", "material", "combine", "attraction", "drag", "body", "bodies", "character", "part", "wall", "container", "spring", "springs", "hinge",
  "slider", "weld", "ball", "distance", "rope", "wheel", "universal", "gear", "pull", "fix", "ignore", "sweep", "runs", "keep",
]);
const shapes = new Set(["floor", "ball", "spring", "rod", "rope", "arrow", "trail", "box", "text"]);
const functions = new Set([
  "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp", "log", "log2", "log10", "sqrt", "cbrt",
  "pow", "hypot", "abs", "min", "max", "sign", "floor", "ceil", "round", "mod", "smooth", "interp", "distance", "within", "ray", "uniform", "normal", "lognormal",
  "triangular",
]);

interface State {
  /** The last piece was a name: a bracket opens an index, not a unit. */
  afterName: boolean;
  atStart: boolean;
}

export type Piece = "comment" | "string" | "number" | "unit" | "keyword" | "modifier" | "typeName" | "function" | "operator" | "variableName" | null;

export function piece(stream: StringStream, state: State): Piece {
  if (stream.sol()) {
    state.atStart = true;
    state.afterName = false;
  }
  if (stream.eatSpace()) {
    state.afterName = false;
    return null;
  }
  const atStart = state.atStart;
  const afterName = state.afterName;
  state.atStart = false;
  state.afterName = false;
  if (stream.match(/^#.*/)) return "comment";
  if (stream.match(/^"(?:[^"\\]|\\.)*"?/)) return "string";
  if (stream.match(/^(?:\d+(?:\.(?!\.)\d*)?|\.\d+)(?:[eE][+-]?\d+)?/)) return "number";
  if (!afterName && stream.match(/^\[[^\]]*\]?/)) return "unit";
  const name = stream.match(/^[\p{L}_][\p{L}\p{N}\p{M}_]*/u) as RegExpMatchArray | null;
  if (name) {
    const word = name[0];
    if (atStart && statements.has(word)) return "keyword";
    // `ball (x, y)` draws a ball, `ball arm to frame` joins two bodies.
    if (atStart && shapes.has(word) && /^\s*\(/.test(stream.string.slice(stream.pos))) return "typeName";
    if (atStart && ofBlocks.has(word) && /^\s+[\p{L}\d({-]/u.test(stream.string.slice(stream.pos))) return "keyword";
    if (functions.has(word) && stream.peek() === "(") return "function";
    if (shapes.has(word) && /^\s*(\(|-?\d|\w)/.test(stream.string.slice(stream.pos))) return "typeName";
    if (words.has(word)) return "modifier";
    state.afterName = true;
    return "variableName";
  }
  if (stream.match(/^[{};]/)) {
    state.atStart = true;
    return null;
  }
  if (stream.match(/^'+/)) {
    state.afterName = true;
    return "variableName";
  }
  if (stream.match(/^(?::=|\.\.|[-+*/^=<>!]+)/)) return "operator";
  stream.next();
  return null;
}

export const sim = StreamLanguage.define<State>({
  name: "sim",
  startState: () => ({ afterName: false, atStart: true }),
  token: (stream, state) => {
    const kind = piece(stream, state);
    return kind === "unit" ? "labelName" : kind === "function" ? "macroName" : kind;
  },
  languageData: { commentTokens: { line: "#" } },
});
