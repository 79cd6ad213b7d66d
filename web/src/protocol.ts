// What goes over the wire (docs/protocol.md), and the reading of a binary frame.

export type ColumnKind = "state" | "let" | "output" | "energy" | "drift" | "curve" | "distance";
export interface Column {
  name: string;
  unit: string;
  kind: ColumnKind;
}
export interface Series {
  label: string;
  column: number;
  unit: string;
}
export interface Plot {
  curves: Series[];
  against: Series | "t";
}
export type Shape = "floor" | "ball" | "spring" | "rod" | "rope" | "arrow" | "trail" | "box" | "text";
export interface Item {
  shape: Shape;
  label?: string | null;
  color?: string | null;
  text?: string | null;
  /** Places in a frame's `scene`: `at`, `to` and `size` hold several, the other attributes one. */
  numbers: Record<string, number | number[]>;
  drag: boolean;
  /** Of a trail: where its point stands among the numbers that frames have for each row. */
  path?: number[] | null;
}
/** The surface of a body that is no ball, in its frame: faces by the numbers of their corners, counter-clockwise seen from outside. */
export interface Form {
  corners: number[][];
  faces: number[][];
}
/**
 * A surface that never moves. Its facets are triangles, counter-clockwise seen from the free side; in the plane segments,
 * with what is free on the right of the way from the first corner to the second.
 */
export interface StaticMesh {
  name: string;
  corners: number[][];
  facets: number[][];
  /** Both sides are free. */
  thin: boolean;
}
/** Where it holds its bodies in their frames; of the world, where `second` is null, in the world. */
export interface Joint {
  name: string;
  kind: string;
  first: number;
  second: number | null;
  on_first: number[];
  on_second: number[];
  axis: number[];
  /** The greatest distance of the two places, beyond which it is broken; null: none. */
  apart: number | null;
}
export interface Bodies {
  count: number;
  dimension: 2 | 3;
  radius: number | number[];
  color?: string | string[] | null;
  names?: string[];
  walls: { normal: number[]; offset: number; thin?: boolean }[];
  containers: { lower: number[]; upper: number[] }[];
  meshes?: StaticMesh[];
  /** Between bodies a and b, or from body a to a point. */
  springs?: { a: number; b: number | null; point: number[] | null }[];
  forms?: Form[];
  /** Of each body the number of its form, null of a ball; empty where all are balls. */
  form?: (number | null)[];
  joints?: Joint[];
}
export interface Parameter {
  name: string;
  value: number;
  /** The value in the text. */
  file: number;
  unit: string;
  min: number | null;
  max: number | null;
  comment: string;
  structural: boolean;
}
export interface Input {
  name: string;
  value: number;
  file: number;
  unit: string;
  min: number | null;
  max: number | null;
  key: string | null;
  comment: string;
  from_file: boolean;
}
export interface Method {
  name: string;
  title: string;
  fixed: boolean;
}
export interface GalleryEntry {
  name: string;
  title: string;
  subject?: string;
}
export interface ModelMessage {
  say: "model";
  run: number;
  name: string;
  heading: string;
  path: string;
  text: string;
  saveable: boolean;
  /** No model was named: the page begins with the gallery. */
  welcome?: boolean;
  /** Of a text that is wrong: nothing moves until it is mended. */
  mistakes?: Diagnostic[];
  time_unit: string;
  dimension: 2 | 3;
  columns: Column[];
  plots: Plot[];
  drawing: Item[];
  scene_count: number;
  path_count?: number;
  bodies: Bodies | null;
  parameters: Parameter[];
  inputs: Input[];
  methods: Method[];
  experiment: { from: number; to: number; method: string; step: number | null; rtol: number | null };
  gallery: GalleryEntry[];
  undo: number;
}
export interface Choice {
  method: string;
  step: number | null;
  rtol: number | null;
}
export interface StateMessage extends Choice {
  say: "state";
  playing: boolean;
  t: number;
  target: number;
  reached: number;
  slow: boolean;
  history: [number, number];
  ghost: Choice | null;
  parameters: Record<string, number>;
  inputs: Record<string, number>;
  undo: number;
  mode: string | null;
  steps: number;
  rejected: number;
  ended: string | null;
}
export interface EventMessage {
  say: "event";
  t: number;
  name: string;
  mark: string | null;
}
export type Severity = "error" | "warning" | "note";
export interface Diagnostic {
  severity: Severity;
  code: string | null;
  text: string;
  hint: string | null;
  line: number | null;
  column: number | null;
  length?: number | null;
}
export interface SolverMessage extends Diagnostic {
  say: "message";
}
export interface CheckedMessage {
  say: "checked";
  id: number;
  diagnostics: Diagnostic[];
}
/** Who this page is to the server, and the commands it may give: docs/protocol.md. */
export interface RoleMessage {
  say: "role";
  role: "presenter" | "viewer" | "owner";
  may: string[];
  own_sessions: boolean;
  viewers_address: string | null;
}
export interface BusyMessage {
  say: "busy";
  with: "motion" | "commands" | null;
  seconds: number;
}
export type Say =
  | RoleMessage
  | BusyMessage
  | { say: "room"; viewers: number }
  | ModelMessage
  | StateMessage
  | EventMessage
  | SolverMessage
  | CheckedMessage
  | { say: "saved"; path: string }
  | { say: "pong"; id: number }
  | { say: "values"; t: number; body: number; name: string; values: Record<string, number> };

export type Command =
  | { do: "play" | "pause" | "cancel" | "step" | "back" | "reset" | "until_event" | "restore" | "undo" }
  | { do: "release"; still?: boolean }
  | { do: "seek"; t: number }
  | { do: "speed"; value: number }
  | { do: "set"; parameter: string; value: number }
  | { do: "input"; name: string; value: number }
  | { do: "method"; name: string; step?: number; rtol?: number }
  | { do: "ghost"; name: string | null; step?: number; rtol?: number }
  | { do: "drag"; item: number; to: number[] }
  | { do: "drag"; body: number; to: number[] }
  | { do: "pick"; body: number }
  | { do: "open"; model: string }
  | { do: "check"; id: number; text: string }
  | { do: "run"; text: string }
  | { do: "save"; text: string }
  | { do: "ping"; id: number }
  | { do: "rate"; fps: number };

export interface Frame {
  run: number;
  rewound: boolean;
  lookingBack: boolean;
  t: number;
  reached: number;
  target: number;
  rowTimes: Float64Array;
  /** One row after the other, `columns` numbers each. */
  rows: Float32Array;
  scene: Float32Array;
  ghostRows: Float32Array | null;
  ghostScene: Float32Array | null;
  positions: Float32Array | null;
  orientations: Float32Array | null;
  ghostPositions: Float32Array | null;
  ghostOrientations: Float32Array | null;
  /** Where the points of trails were at the time of each row, `path_count` numbers each. */
  paths: Float32Array | null;
  ghostPaths: Float32Array | null;
  /** Of the bodies, where there are few. */
  velocities?: Float32Array | null;
}

const flag = { rewound: 1, ghost: 2, bodies: 4, orientation: 8, lookingBack: 16, ghostBodies: 32, paths: 64, velocities: 128 };

/** The run a frame belongs to, readable before its model is known. */
export const runOfFrame = (data: ArrayBuffer): number => (data.byteLength >= 8 ? new DataView(data).getUint32(4, true) : -1);

/** Reads a frame of `model`, or says what is wrong with it. Arrays are views into `data` (browsers are little endian). */
export function decodeFrame(data: ArrayBuffer, model: Pick<ModelMessage, "columns" | "scene_count" | "path_count" | "bodies">): Frame | string {
  if (data.byteLength < 40) return `a frame of ${data.byteLength} bytes`;
  const view = new DataView(data);
  if (view.getUint32(0, true) !== 1) return `a binary message of kind ${view.getUint32(0, true)}`;
  const flags = view.getUint32(8, true);
  const rows = view.getUint32(12, true);
  let at = 40;
  let short = false;
  const room = (bytes: number): boolean => {
    if (at + bytes <= data.byteLength) return true;
    short = true;
    return false;
  };
  const floats = (count: number): Float32Array => {
    if (!room(4 * count)) return new Float32Array(0);
    const values = new Float32Array(data, at, count);
    at += 4 * count;
    return values;
  };
  const rowTimes = room(8 * rows) ? new Float64Array(data, at, rows) : new Float64Array(0);
  at += 8 * rows;
  const width = model.columns.length;
  const rowValues = floats(rows * width);
  const scene = floats(model.scene_count);
  const ghost = (flags & flag.ghost) !== 0;
  const ghostRows = ghost ? floats(rows * width) : null;
  const ghostScene = ghost ? floats(model.scene_count) : null;
  let positions: Float32Array | null = null;
  let orientations: Float32Array | null = null;
  let ghostPositions: Float32Array | null = null;
  let ghostOrientations: Float32Array | null = null;
  if ((flags & flag.bodies) !== 0 && model.bodies && room(4)) {
    const count = view.getUint32(at, true);
    at += 4;
    const { dimension } = model.bodies;
    const turned = (flags & flag.orientation) !== 0;
    const turns = (): Float32Array | null => (turned ? floats(count * (dimension === 2 ? 1 : 4)) : null);
    positions = floats(count * dimension);
    orientations = turns();
    if ((flags & flag.ghostBodies) !== 0) {
      ghostPositions = floats(count * dimension);
      ghostOrientations = turns();
    }
  }
  const withPaths = (flags & flag.paths) !== 0;
  const paths = withPaths ? floats(rows * (model.path_count ?? 0)) : null;
  const ghostPaths = withPaths && ghost ? floats(rows * (model.path_count ?? 0)) : null;
  const velocities = (flags & flag.velocities) !== 0 && model.bodies && positions ? floats(positions.length) : null;
  if (short) return `a frame that ends early, after ${data.byteLength} bytes`;
  return {
    run: view.getUint32(4, true),
    rewound: (flags & flag.rewound) !== 0,
    lookingBack: (flags & flag.lookingBack) !== 0,
    t: view.getFloat64(16, true),
    reached: view.getFloat64(24, true),
    target: view.getFloat64(32, true),
    rowTimes,
    rows: rowValues,
    scene,
    ghostRows,
    ghostScene,
    positions,
    orientations,
    ghostPositions,
    ghostOrientations,
    paths,
    ghostPaths,
    velocities,
  };
}
