// The lines of springs and ropes, as points. Pure geometry.
export type Point = readonly [number, number, number];

/** Two unit vectors at right angles to the way from `from` to `to`, the first in the plane of the picture where that is 2-D. */
export function across(from: Point, to: Point, flat: boolean): [Point, Point] {
  const d: Point = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
  const length = Math.hypot(...d);
  if (!(length > 0)) return [[0, 1, 0], [0, 0, 1]];
  const u: Point = [d[0] / length, d[1] / length, d[2] / length];
  if (flat) return [[-u[1], u[0], 0], [0, 0, 1]];
  const other: Point = Math.abs(u[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
  const a: Point = [u[1] * other[2] - u[2] * other[1], u[2] * other[0] - u[0] * other[2], u[0] * other[1] - u[1] * other[0]];
  const size = Math.hypot(...a);
  const v: Point = [a[0] / size, a[1] / size, a[2] / size];
  return [v, [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]];
}

export const springPoints = (turns: number): number => 14 * Math.max(1, Math.round(turns)) + 3;

/** A coil from `from` to `to`: straight ends, between them turns of the given width. Written into `out`. */
export function spring(out: Float32Array, from: Point, to: Point, turns: number, width: number, flat: boolean): void {
  const count = springPoints(turns);
  const [v, w] = across(from, to, flat);
  const rounds = Math.max(1, Math.round(turns));
  for (let i = 0; i < count; ++i) {
    const part = i === 0 ? 0 : i === count - 1 ? 1 : (i - 1) / (count - 3);
    const end = i === 0 || i === count - 1;
    const angle = 2 * Math.PI * rounds * part;
    const along = end ? part : 0.08 + 0.84 * part;
    const side = end ? 0 : 0.5 * width * Math.sin(angle);
    const depth = end || flat ? 0 : 0.5 * width * (Math.cos(angle) - (part === 0 || part === 1 ? 1 : 0));
    for (let axis = 0; axis < 3; ++axis) {
      out[3 * i + axis] = from[axis]! + along * (to[axis]! - from[axis]!) + side * v[axis]! + depth * w[axis]!;
    }
  }
}

export const ropePoints = 25;

/** A rope of `length` from `from` to `to`: straight where it is taut, else hanging in a parabola of about that length along `down`. */
export function rope(out: Float32Array, from: Point, to: Point, length: number, down: Point): void {
  const chord = Math.hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
  const slack = Number.isFinite(length) && length > chord ? length - chord : 0;
  // A parabola of sag s over a chord c is c + 8*s^2/(3*c) long while s is small, and 2*s where c vanishes.
  const sag = slack > 0 ? Math.min(0.5 * length, Math.sqrt((3 / 8) * Math.max(chord, 0.05 * length) * slack)) : 0;
  for (let i = 0; i < ropePoints; ++i) {
    const part = i / (ropePoints - 1);
    const drop = 4 * sag * part * (1 - part);
    for (let axis = 0; axis < 3; ++axis) out[3 * i + axis] = from[axis]! + part * (to[axis]! - from[axis]!) + drop * down[axis]!;
  }
}

/** The points of a trail, oldest first, with their times; what a run takes back is forgotten. */
export class Trail {
  readonly points: number[] = [];
  readonly times: number[] = [];

  constructor(private readonly most = 6000) {}

  add(t: number, point: Point): void {
    if (!Number.isFinite(point[0] + point[1] + point[2])) return;
    const last = this.times.length - 1;
    if (last >= 0 && t <= this.times[last]!) return;
    if (last >= 1 && this.same(last, point) && this.same(last - 1, point)) {
      this.times[last] = t;  // at rest
      return;
    }
    this.times.push(t);
    this.points.push(...point);
    if (this.times.length > this.most) this.thin();
  }

  forgetFrom(t: number): void {
    let length = this.times.length;
    while (length > 0 && this.times[length - 1]! >= t) --length;
    this.times.length = length;
    this.points.length = 3 * length;
  }

  forgetBefore(t: number): void {
    let count = 0;
    while (count < this.times.length && this.times[count]! < t) ++count;
    if (count < 512) return;
    this.times.splice(0, count);
    this.points.splice(0, 3 * count);
  }

  /** The range of points from `t - length` to `t`. */
  range(t: number, length: number): [number, number] {
    let end = this.times.length;
    while (end > 0 && this.times[end - 1]! > t) --end;
    let begin = 0;
    if (Number.isFinite(length)) while (begin < end && this.times[begin]! < t - length) ++begin;
    return [begin, end];
  }

  private same(index: number, point: Point): boolean {
    return this.points[3 * index] === point[0] && this.points[3 * index + 1] === point[1] && this.points[3 * index + 2] === point[2];
  }

  private thin(): void {
    const half = this.times.length >> 1;
    let to = 0;
    for (let from = 0; from < this.times.length; from += from < half ? 2 : 1, ++to) {
      this.times[to] = this.times[from]!;
      for (let axis = 0; axis < 3; ++axis) this.points[3 * to + axis] = this.points[3 * from + axis]!;
    }
    this.times.length = to;
    this.points.length = 3 * to;
  }
}
