// Where there is room in the plane, and what is under the pointer. Pure geometry.
import type { Place } from "./world_text";

export interface Disc extends Place {
  radius: number;
}
/** The half plane normal . x >= offset, with a unit normal; thin: both sides are free. */
export interface HalfPlane {
  normal: Place;
  offset: number;
  thin: boolean;
}

export const distanceTo = ({ normal, offset }: HalfPlane, { x, y }: Place): number => normal.x * x + normal.y * y - offset;

/** The largest radius of a disc at a place that meets nothing; negative inside of something. */
export function room(at: Place, discs: readonly Disc[], walls: readonly HalfPlane[]): number {
  let least = Infinity;
  for (const disc of discs) least = Math.min(least, Math.hypot(at.x - disc.x, at.y - disc.y) - disc.radius);
  for (const wall of walls) least = Math.min(least, wall.thin ? Math.abs(distanceTo(wall, at)) : distanceTo(wall, at));
  return least;
}

/** How far a point is from the way between two others. */
export function fromSegment(at: Place, a: Place, b: Place): number {
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  const square = dx * dx + dy * dy;
  const part = square > 0 ? Math.min(1, Math.max(0, ((at.x - a.x) * dx + (at.y - a.y) * dy) / square)) : 0;
  return Math.hypot(at.x - a.x - part * dx, at.y - a.y - part * dy);
}

const clean = (value: number): number => Number(value.toFixed(4)) + 0;

/**
 * The wall through two points, its free side where the discs are, without discs above it or to its right. Nearly level
 * and nearly upright ones are made so. Discs on both sides need a thin wall; one that is cut allows none.
 */
export function wallThrough(a: Place, b: Place, discs: readonly Disc[], round: (value: number) => number): HalfPlane | "cuts" | null {
  const length = Math.hypot(b.x - a.x, b.y - a.y);
  if (!(length > 0)) return null;
  let normal = { x: -(b.y - a.y) / length, y: (b.x - a.x) / length };
  const steep = 0.06;
  if (Math.abs(normal.x) < steep) normal = { x: 0, y: Math.sign(normal.y) };
  if (Math.abs(normal.y) < steep) normal = { x: Math.sign(normal.x), y: 0 };
  if (normal.y < 0 || (normal.y === 0 && normal.x < 0)) normal = { x: -normal.x, y: -normal.y };
  // As the text will say it.
  normal = { x: clean(normal.x), y: clean(normal.y) };
  const size = Math.hypot(normal.x, normal.y);
  const offset = round((normal.x * (a.x + b.x) + normal.y * (a.y + b.y)) / 2);
  const sides = discs.map((disc) => {
    const distance = (normal.x * disc.x + normal.y * disc.y - offset) / size;
    return Math.abs(distance) < disc.radius ? 0 : Math.sign(distance);
  });
  if (sides.includes(0)) return "cuts";
  if (sides.length > 0 && sides.every((side) => side < 0)) return { normal: { x: 0 - normal.x, y: 0 - normal.y }, offset: 0 - offset, thin: false };
  return { normal, offset, thin: sides.includes(-1) };
}
