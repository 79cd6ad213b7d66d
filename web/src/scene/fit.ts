// What part of the plane or of space the scene needs: pure geometry, no camera.
import type { Item } from "../protocol";

export interface Bounds {
  lower: [number, number, number];
  upper: [number, number, number];
}

export const emptyBounds = (): Bounds => ({ lower: [Infinity, Infinity, Infinity], upper: [-Infinity, -Infinity, -Infinity] });
export const isEmpty = (bounds: Bounds): boolean => !(bounds.lower[0] <= bounds.upper[0]);

/** Takes a ball of `radius` into the bounds; what is not finite is left out. */
export function include(bounds: Bounds, x: number, y: number, z: number, radius = 0): void {
  if (!Number.isFinite(x + y + z + radius)) return;
  const { lower, upper } = bounds;
  lower[0] = Math.min(lower[0], x - radius);
  lower[1] = Math.min(lower[1], y - radius);
  lower[2] = Math.min(lower[2], z - radius);
  upper[0] = Math.max(upper[0], x + radius);
  upper[1] = Math.max(upper[1], y + radius);
  upper[2] = Math.max(upper[2], z + radius);
}

export function union(bounds: Bounds, other: Bounds): void {
  if (isEmpty(other)) return;
  for (let axis = 0; axis < 3; ++axis) {
    bounds.lower[axis] = Math.min(bounds.lower[axis]!, other.lower[axis]!);
    bounds.upper[axis] = Math.max(bounds.upper[axis]!, other.upper[axis]!);
  }
}

export const extent = (bounds: Bounds, axis: number): number => (isEmpty(bounds) ? 0 : bounds.upper[axis]! - bounds.lower[axis]!);
export const centre = (bounds: Bounds, axis: number): number => (isEmpty(bounds) ? 0 : (bounds.upper[axis]! + bounds.lower[axis]!) / 2);

/** The first place of an argument, -1 where it is absent. */
export const placeOf = (item: Item, name: string, index = 0): number => {
  const places = item.numbers[name];
  return places === undefined || places === null ? -1 : typeof places === "number" ? (index === 0 ? places : -1) : (places[index] ?? -1);
};

export function numberOf(item: Item, scene: Float32Array, name: string, otherwise: number, index = 0): number {
  const place = placeOf(item, name, index);
  return place < 0 ? otherwise : scene[place]!;
}

/** A point of the drawing; the third number is 0 in the plane. */
export const pointOf = (item: Item, scene: Float32Array, name: "at" | "to"): [number, number, number] => [
  numberOf(item, scene, name, 0, 0),
  numberOf(item, scene, name, 0, 1),
  numberOf(item, scene, name, 0, 2),
];

/** What the drawing occupies at one instant. Trails follow points that other items show, so they count as points. */
export function boundsOfItems(items: readonly Item[], scene: Float32Array, up: 1 | 2 = 1): Bounds {
  const bounds = emptyBounds();
  for (const item of items) {
    if (item.shape === "floor") continue;
    const [x, y, z] = pointOf(item, scene, "at");
    if (item.shape === "box") {
      const [width, height, angle] = [numberOf(item, scene, "size", 1, 0), numberOf(item, scene, "size", 1, 1), numberOf(item, scene, "angle", 0)];
      const [c, s] = [Math.abs(Math.cos(angle)), Math.abs(Math.sin(angle))];
      const right = (c * width + s * height) / 2;
      const above = (s * width + c * height) / 2;
      include(bounds, x - right, y - above, z);
      include(bounds, x + right, y + above, z);
    } else {
      include(bounds, x, y, z, item.shape === "ball" ? Math.abs(numberOf(item, scene, "radius", 0)) : 0);
    }
    if (item.numbers["to"] === undefined) continue;
    const part = item.shape === "arrow" ? numberOf(item, scene, "scale", 1) : 1;
    const to = pointOf(item, scene, "to");
    include(bounds, x + part * (to[0] - x), y + part * (to[1] - y), z + part * (to[2] - z));
  }
  // A floor is as wide as the picture; its height belongs into it, if anything stands there.
  for (const item of items) {
    if (item.shape !== "floor" || isEmpty(bounds)) continue;
    const height = numberOf(item, scene, "height", 0);
    bounds.lower[up] = Math.min(bounds.lower[up], height);
    bounds.upper[up] = Math.max(bounds.upper[up], height);
  }
  return bounds;
}

export function boundsOfBodies(positions: Float32Array, dimension: number, radius: (index: number) => number): Bounds {
  const bounds = emptyBounds();
  for (let i = 0, at = 0; at < positions.length; ++i, at += dimension) {
    include(bounds, positions[at]!, positions[at + 1]!, dimension === 3 ? positions[at + 2]! : 0, radius(i));
  }
  return bounds;
}

/**
 * Remembers what the motion has needed so far. A scene that travels (a car on its road) is followed; one that swings,
 * orbits or leaves a trail is shown whole.
 */
export class Interest {
  private readonly whole = emptyBounds();
  private largest: [number, number, number] = [0, 0, 0];
  private now = emptyBounds();
  /** The scene has travelled so far that the picture goes with it. */
  following = false;

  constructor(private readonly mayFollow: boolean) {}

  see(bounds: Bounds): void {
    if (isEmpty(bounds)) return;
    this.now = bounds;
    union(this.whole, bounds);
    for (let axis = 0; axis < 3; ++axis) this.largest[axis] = Math.max(this.largest[axis]!, extent(bounds, axis));
  }

  /** What the picture should hold. */
  wanted(): Bounds {
    if (isEmpty(this.whole)) return { lower: [-1, -1, -1], upper: [1, 1, 1] };
    const wanted: Bounds = { lower: [...this.whole.lower], upper: [...this.whole.upper] };
    const size = Math.max(...this.largest);
    for (let axis = 0; axis < 3 && this.mayFollow; ++axis) {
      if (extent(this.whole, axis) <= 6 * size) continue;
      this.following = true;
      const reach = 2 * size;
      wanted.lower[axis] = centre(this.now, axis) - reach;
      wanted.upper[axis] = centre(this.now, axis) + reach;
    }
    return wanted;
  }
}

/** The height of a picture of the given aspect that holds the bounds with a margin; 1 where they are a point. */
export function heightFor(bounds: Bounds, aspect: number, margin = 1.16): number {
  const height = Math.max(extent(bounds, 1), extent(bounds, 0) / aspect) * margin;
  return height > 0 && Number.isFinite(height) ? height : 1;
}

type Vector = readonly [number, number, number];
const product = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/**
 * How far from the middle of the bounds the eye has to be for a picture that holds their corners with a margin. `back`,
 * `right` and `above` are the directions of the picture, of length 1, `back` towards the eye; `tangent` is that of half
 * the angle that it shows upwards.
 */
export function distanceFor(bounds: Bounds, back: Vector, right: Vector, above: Vector, tangent: number, aspect: number, margin = 1.04): number {
  let distance = 0;
  for (let corner = 0; corner < 8; ++corner) {
    const from = [0, 1, 2].map((axis) => ((corner >> axis) & 1 ? 0.5 : -0.5) * extent(bounds, axis)) as unknown as Vector;
    const aside = Math.max(Math.abs(product(from, right)) / aspect, Math.abs(product(from, above)));
    distance = Math.max(distance, product(from, back) + (margin * aside) / tangent);
  }
  return distance > 0 && Number.isFinite(distance) ? distance : 1;
}

/**
 * The height at the picture's centre. Where the picture is higher than the scene, as over a long road, what is left over
 * goes above a floor rather than below it.
 */
export function centreHeight(bounds: Bounds, height: number, floor: number | null): number {
  const middle = centre(bounds, 1);
  if (floor === null || bounds.lower[1] < floor - 0.02 * height) return middle;
  return Math.max(middle, floor + height * (0.5 - 0.14));
}

/** Distances between grid lines: 1, 2 or 5 times a power of ten, about `count` of them in `span`. */
export function gridStep(span: number, count: number): number {
  const raw = span / Math.max(1, count);
  if (!(raw > 0) || !Number.isFinite(raw)) return 1;
  const power = 10 ** Math.floor(Math.log10(raw));
  const part = raw / power;
  return (part < 1.5 ? 1 : part < 3.5 ? 2 : part < 7.5 ? 5 : 10) * power;
}
