// The joints of a world: pins as points, ropes and distances as lines between their ends, guides as lines along their axes.
import * as three from "three";
import type { Bodies, Joint } from "../protocol";
import { placed, rotationOf, type Triple } from "./solids";

/** Where a joint holds its two bodies, and the direction of its axis; 0 where it has none. */
export function endsOf(joint: Joint, bodies: Bodies, places: ArrayLike<number>, orientations: Float32Array | null): { first: Triple; second: Triple; axis: Triple } {
  const flat = bodies.dimension === 2;
  const world = [1, 0, 0, 0, 1, 0, 0, 0, 1];
  const of = (body: number | null, point: readonly number[], isDirection = false): Triple => {
    const turn = body === null ? world : rotationOf(orientations, body, flat);
    return body === null || isDirection ? placed(turn, [0, 0, 0], 0, point) : placed(turn, places, 3 * body, point);
  };
  return { first: of(joint.first, joint.on_first), second: of(joint.second, joint.on_second), axis: of(joint.second, joint.axis, true) };
}

/** Two points each: what is drawn as lines. */
export function linesOf(joint: Joint, ends: ReturnType<typeof endsOf>, reach: number): Triple[] {
  if (joint.kind === "distance" || joint.kind === "rope") return [ends.first, ends.second];
  if (joint.kind !== "slider") return [];
  const along = (side: number): Triple => ends.first.map((x, k) => x + side * 1.5 * reach * ends.axis[k]!) as Triple;
  return [along(-1), along(1)];
}

/** Its places are farther from each other than an unbroken joint lets them be. */
export function isBroken(joint: Joint, { first, second }: ReturnType<typeof endsOf>, reach: number): boolean {
  return joint.apart !== null && Math.hypot(...first.map((x, k) => x - second[k]!)) > joint.apart + 0.05 * reach;
}

const isPin = (joint: Joint): boolean => !["distance", "rope", "slider", "gear"].includes(joint.kind);

export class JointMarks {
  readonly group = new three.Group();
  private readonly pins: three.Points;
  private readonly lines: three.LineSegments;

  constructor(
    private readonly bodies: Bodies,
    private readonly radius: (index: number) => number,
    color: string,
  ) {
    const joints = bodies.joints ?? [];
    const geometry = (count: number): three.BufferGeometry =>
      new three.BufferGeometry().setAttribute("position", new three.BufferAttribute(new Float32Array(3 * count), 3).setUsage(three.DynamicDrawUsage));
    this.pins = new three.Points(geometry(joints.filter(isPin).length), new three.PointsMaterial({ color, size: 6, sizeAttenuation: false, transparent: true, depthTest: false, depthWrite: false }));
    this.lines = new three.LineSegments(geometry(2 * joints.filter((joint) => ["distance", "rope", "slider"].includes(joint.kind)).length), new three.LineBasicMaterial({ color, transparent: true, opacity: 0.8, depthTest: bodies.dimension === 3, depthWrite: false }));
    for (const part of [this.lines, this.pins]) {
      part.frustumCulled = false;
      part.renderOrder = 5;
      this.group.add(part);
    }
  }

  update(places: ArrayLike<number>, orientations: Float32Array | null): void {
    const pin = this.pins.geometry.getAttribute("position") as three.BufferAttribute;
    const line = this.lines.geometry.getAttribute("position") as three.BufferAttribute;
    let pins = 0;
    let points = 0;
    for (const joint of this.bodies.joints ?? []) {
      const ends = endsOf(joint, this.bodies, places, orientations);
      if (isBroken(joint, ends, this.radius(joint.first))) continue;
      if (isPin(joint)) pin.setXYZ(pins++, ...ends.first);
      for (const point of linesOf(joint, ends, this.radius(joint.first))) line.setXYZ(points++, ...point);
    }
    this.pins.geometry.setDrawRange(0, pins);
    this.lines.geometry.setDrawRange(0, points);
    pin.needsUpdate = line.needsUpdate = true;
  }

  dispose(): void {
    for (const part of [this.pins, this.lines]) {
      part.geometry.dispose();
      (part.material as three.Material).dispose();
    }
  }
}
