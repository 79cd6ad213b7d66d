// The rows a run has shown so far, by column, as the plots need them.
import type { Frame } from "./protocol";

const mostNumbers = 6e6;

export class History {
  length = 0;
  t: Float64Array;
  columns: Float32Array[];
  ghosts: Float32Array[];
  private capacity: number;

  constructor(
    readonly width: number,
    start = 1024,
  ) {
    this.capacity = start;
    this.t = new Float64Array(start);
    this.columns = Array.from({ length: width }, () => new Float32Array(start));
    this.ghosts = [];
  }

  /** The most rows that are kept; beyond, the older half is thinned. */
  get most(): number {
    return Math.max(2000, Math.min(40_000, Math.floor(mostNumbers / Math.max(1, this.width))));
  }

  append(frame: Pick<Frame, "rewound" | "t" | "rowTimes" | "rows" | "ghostRows">): void {
    const { rowTimes, rows, ghostRows } = frame;
    if (frame.rewound) this.forgetFrom(rowTimes[0] ?? frame.t, rowTimes.length === 0);
    if (ghostRows && this.ghosts.length === 0) {
      this.ghosts = Array.from({ length: this.width }, () => new Float32Array(this.capacity).fill(NaN, 0, this.length));
    }
    for (let row = 0; row < rowTimes.length; ++row) {
      if (this.length === this.capacity) this.makeRoom();
      const to = this.length++;
      this.t[to] = rowTimes[row]!;
      const from = row * this.width;
      for (let column = 0; column < this.width; ++column) this.columns[column]![to] = rows[from + column]!;
      if (this.ghosts.length > 0) {
        for (let column = 0; column < this.width; ++column) this.ghosts[column]![to] = ghostRows ? ghostRows[from + column]! : NaN;
      }
    }
  }

  /** Forgets the rows at and after `t`, or with `after` only those after it. */
  forgetFrom(t: number, after = false): void {
    let length = this.indexAfter(t);
    if (!after) while (length > 0 && this.t[length - 1]! >= t) --length;
    this.length = length;
  }

  forgetGhost(): void {
    this.ghosts = [];
  }

  /** The number of rows at or before `t`. */
  indexAfter(t: number): number {
    let low = 0;
    let high = this.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.t[middle]! <= t) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** A column's value at `t`, straight between its rows, NaN before the first and after the last. */
  valueAt(column: number, t: number, ghost = false): number {
    const values = (ghost ? this.ghosts : this.columns)[column];
    if (!values || this.length === 0) return NaN;
    const after = this.indexAfter(t);
    if (after === 0) return NaN;
    const before = after - 1;
    const t0 = this.t[before]!;
    if (after === this.length || t === t0) return t - t0 <= this.spacing() ? values[before]! : NaN;
    const t1 = this.t[after]!;
    return values[before]! + ((values[after]! - values[before]!) * (t - t0)) / (t1 - t0);
  }

  get first(): number {
    return this.length > 0 ? this.t[0]! : NaN;
  }
  get last(): number {
    return this.length > 0 ? this.t[this.length - 1]! : NaN;
  }

  private spacing(): number {
    return this.length < 2 ? Infinity : 2 * (this.t[this.length - 1]! - this.t[this.length - 2]!) + 1e-9;
  }

  private makeRoom(): void {
    if (this.capacity < this.most) {
      this.capacity = Math.min(this.most, 2 * this.capacity);
      const grown = <T extends Float64Array | Float32Array>(old: T): T => {
        const larger = new (old.constructor as new (length: number) => T)(this.capacity);
        larger.set(old);
        return larger;
      };
      this.t = grown(this.t);
      this.columns = this.columns.map(grown);
      this.ghosts = this.ghosts.map(grown);
      return;
    }
    const half = this.length >> 1;
    const kept = half >> 1;
    for (const values of [this.t, ...this.columns, ...this.ghosts]) {
      for (let row = 0; row < kept; ++row) values[row] = values[2 * row]!;
      values.copyWithin(kept, 2 * kept, this.length);
    }
    this.length -= kept;
  }
}
