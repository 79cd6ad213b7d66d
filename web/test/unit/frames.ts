// Frames as the server writes them, for tests.
import type { ModelMessage } from "../../src/protocol";

export interface Parts {
  run?: number;
  flags?: number;
  t?: number;
  rowTimes?: number[];
  rows?: number[][];
  scene?: number[];
  ghostRows?: number[][];
  ghostScene?: number[];
  bodies?: { dimension: number; positions: number[]; orientations?: number[]; ghostPositions?: number[]; ghostOrientations?: number[] };
  paths?: number[];
  ghostPaths?: number[];
}

export function encodeFrame(parts: Parts): ArrayBuffer {
  const { run = 1, flags = 0, t = 0, rowTimes = [], rows = [], scene = [], ghostRows, ghostScene = [], bodies, paths, ghostPaths = [] } = parts;
  const floats = [...rows.flat(), ...scene, ...(ghostRows ? [...ghostRows.flat(), ...ghostScene] : [])];
  const { ghostPositions, ghostOrientations = [], orientations = [] } = bodies ?? {};
  const bodyFloats = [...(bodies?.positions ?? []), ...orientations, ...(ghostPositions ?? []), ...ghostOrientations, ...(paths ?? []), ...ghostPaths];
  const data = new ArrayBuffer(40 + 8 * rowTimes.length + 4 * floats.length + (bodies ? 4 : 0) + 4 * bodyFloats.length);
  const view = new DataView(data);
  view.setUint32(0, 1, true);
  view.setUint32(4, run, true);
  view.setUint32(8, flags | (ghostRows ? 2 : 0) | (bodies ? 4 : 0) | (bodies?.orientations ? 8 : 0) | (ghostPositions ? 32 : 0) | (paths ? 64 : 0), true);
  view.setUint32(12, rowTimes.length, true);
  view.setFloat64(16, t, true);
  view.setFloat64(24, 0.5, true);
  view.setFloat64(32, 1, true);
  let at = 40;
  for (const time of rowTimes) view.setFloat64((at += 8) - 8, time, true);
  for (const value of floats) view.setFloat32((at += 4) - 4, value, true);
  if (bodies) view.setUint32((at += 4) - 4, bodies.positions.length / bodies.dimension, true);
  for (const value of bodyFloats) view.setFloat32((at += 4) - 4, value, true);
  return data;
}

export function modelOf(parts: Partial<ModelMessage> = {}): ModelMessage {
  return {
    say: "model", run: 1, name: "M", heading: "", path: "models/m.sim", text: "", saveable: false, time_unit: "s", dimension: 2,
    columns: [{ name: "x", unit: "m", kind: "state" }, { name: "v", unit: "m/s", kind: "state" }],
    plots: [], drawing: [], scene_count: 0, bodies: null, parameters: [], inputs: [], methods: [{ name: "rk4", title: "RK4", fixed: true }],
    experiment: { from: 0, to: 10, method: "rk4", step: 0.1, rtol: null }, gallery: [], undo: 0,
    ...parts,
  };
}
