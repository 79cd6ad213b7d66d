// A recorded run, played in the page alone: it answers the commands of the transport as the server would.
import { decodeFrame } from "./protocol";
import type { Command, EventMessage, Frame, ModelMessage, SolverMessage, StateMessage } from "./protocol";
import type { Listener, Source } from "./source";

export interface Recording {
  model: ModelMessage;
  events?: EventMessage[];
  messages?: SolverMessage[];
  state?: Partial<StateMessage>;
  frames: string;
}

/** The recording in the page, where there is one. */
export function findRecording(page: Document): Recording | null {
  const text = page.getElementById("recording")?.textContent?.trim();
  return text ? (JSON.parse(text) as Recording) : null;
}

/** Undoes base64 and parts the frames: each is led by its length. What is cut off at the end is left out. */
export function framesOf(base64: string): ArrayBuffer[] {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  const lengths = new DataView(bytes.buffer);
  const frames: ArrayBuffer[] = [];
  for (let at = 0; at + 4 <= bytes.length; ) {
    const length = lengths.getUint32(at, true);
    if (at + 4 + length > bytes.length) break;
    frames.push(bytes.buffer.slice(at + 4, at + 4 + length));
    at += 4 + length;
  }
  return frames;
}

/** The last of `frames` at or before `t`, the first where there is none. */
export function frameAt(frames: readonly { t: number }[], t: number): number {
  let low = 0;
  let high = frames.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (frames[middle]!.t <= t) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
}

/** The picture at `t`: the newest frame, its drawing moved straight towards that of the next. */
export function pictureAt(frames: readonly Frame[], t: number): Frame {
  const index = frameAt(frames, t);
  const frame = frames[index]!;
  const next = frames[index + 1];
  const part = next && t > frame.t ? (t - frame.t) / (next.t - frame.t) : 0;
  const between = (a: Float32Array, b: Float32Array | undefined | null): Float32Array =>
    part > 0 && b && b.length === a.length ? a.map((value, i) => value + part * (b[i]! - value)) : a;
  return {
    ...frame,
    t,
    rewound: false,
    lookingBack: true,
    rowTimes: new Float64Array(0),
    rows: new Float32Array(0),
    ghostRows: frame.ghostRows ? new Float32Array(0) : null,
    scene: between(frame.scene, next?.scene),
    ghostScene: frame.ghostScene ? between(frame.ghostScene, next?.ghostScene) : null,
    positions: frame.positions ? between(frame.positions, next?.positions) : null,
    ghostPositions: frame.ghostPositions ? between(frame.ghostPositions, next?.ghostPositions) : null,
    paths: frame.paths ? new Float32Array(0) : null,
    ghostPaths: frame.ghostPaths ? new Float32Array(0) : null,
  };
}

export class Player implements Source {
  readonly live = false;
  private readonly frames: Frame[] = [];
  private listener: Listener | null = null;
  private t = 0;
  private playing = false;
  private speed = 1;
  private before = 0;
  private timer = 0;

  constructor(private readonly recording: Recording) {
    for (const data of framesOf(recording.frames)) {
      const frame = decodeFrame(data, recording.model);
      if (typeof frame !== "string") this.frames.push({ ...frame, run: recording.model.run });
    }
    this.t = this.first;
  }

  private get first(): number {
    return this.frames[0]?.t ?? 0;
  }
  private get last(): number {
    return this.frames.at(-1)?.t ?? 0;
  }

  start(listener: Listener): void {
    this.listener = listener;
    listener.linked("recording");
    listener.said(this.recording.model);
    for (const frame of this.frames) listener.arrived(frame);
    for (const event of this.recording.events ?? []) listener.said(event);
    for (const message of this.recording.messages ?? []) listener.said(message);
    // A thousand units in real time would be long: a minute is what people watch.
    const span = this.last - this.first;
    this.speed = span > 120 || span < 2 ? Number((span / 20).toPrecision(1)) : 1;
    this.show();
  }

  send(command: Command): void {
    switch (command.do) {
      case "play":
        if (this.t >= this.last) this.t = this.first;
        this.playing = true;
        this.before = performance.now();
        cancelAnimationFrame(this.timer);
        this.timer = requestAnimationFrame(this.tick);
        break;
      case "pause":
        this.playing = false;
        break;
      case "step":
        this.playing = false;
        this.t = this.frames[Math.min(this.frames.length - 1, frameAt(this.frames, this.t) + 1)]?.t ?? this.t;
        break;
      case "back": {
        this.playing = false;
        const index = frameAt(this.frames, this.t);
        const here = this.frames[index]?.t ?? this.t;
        this.t = here < this.t ? here : (this.frames[Math.max(0, index - 1)]?.t ?? this.t);
        break;
      }
      case "reset":
        this.playing = false;
        this.t = this.first;
        break;
      case "until_event":
        this.playing = false;
        this.t = (this.recording.events ?? []).find((event) => event.t > this.t + 1e-12)?.t ?? this.last;
        break;
      case "seek":
        this.t = Math.min(this.last, Math.max(this.first, command.t));
        break;
      case "speed":
        this.speed = command.value;
        break;
      default:
        return;  // there is no solver here to ask
    }
    this.show();
  }

  private readonly tick = (now: number): void => {
    if (!this.playing) return;
    const passed = Math.min(0.1, (now - this.before) / 1000);
    this.before = now;
    this.t += passed * (this.speed || 10);
    if (this.t >= this.last) {
      this.t = this.last;
      this.playing = false;
    } else {
      this.timer = requestAnimationFrame(this.tick);
    }
    this.show();
  };

  private show(): void {
    if (!this.listener || this.frames.length === 0) return;
    const { model, state } = this.recording;
    this.listener.arrived(pictureAt(this.frames, this.t));
    this.listener.said({
      say: "state",
      reached: this.playing ? this.speed : 0,
      slow: false,
      method: model.experiment.method,
      step: model.experiment.step,
      rtol: model.experiment.rtol,
      ghost: null,
      parameters: Object.fromEntries(model.parameters.map(({ name, value }) => [name, value])),
      inputs: Object.fromEntries(model.inputs.map(({ name, value }) => [name, value])),
      undo: 0,
      mode: null,
      steps: 0,
      rejected: 0,
      ended: null,
      ...state,
      playing: this.playing,
      t: this.t,
      target: this.speed,
      history: [this.first, this.last],
    });
  }
}
