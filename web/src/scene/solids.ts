// The bodies of a world that are no balls: polygons of the plane, polyhedra in space. All are one mesh, whose corners are
// placed anew in every frame: one draw call, however many there are.
import * as three from "three";
import type { Bodies, Form } from "../protocol";

export type Triple = [number, number, number];

/** The matrix of a quaternion x y z w, or of an angle in the plane, row by row. */
export function rotationOf(orientations: Float32Array | null, index: number, flat: boolean): number[] {
  if (!orientations) return [1, 0, 0, 0, 1, 0, 0, 0, 1];
  if (flat) {
    const c = Math.cos(orientations[index]!);
    const s = Math.sin(orientations[index]!);
    return [c, -s, 0, s, c, 0, 0, 0, 1];
  }
  const [x, y, z, w] = orientations.subarray(4 * index, 4 * index + 4) as unknown as [number, number, number, number];
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
    2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
    2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y),
  ];
}

/** A point of a body in the world. */
export function placed(turn: readonly number[], centre: ArrayLike<number>, first: number, point: readonly number[]): Triple {
  const [x, y, z = 0] = point as [number, number, number?];
  const row = (k: number): number => centre[first + k]! + turn[3 * k]! * x + turn[3 * k + 1]! * y + turn[3 * k + 2]! * z;
  return [row(0), row(1), row(2)];
}

const minus = (a: readonly number[], b: readonly number[]): Triple => [a[0]! - b[0]!, a[1]! - b[1]!, (a[2] ?? 0) - (b[2] ?? 0)];
const cross = (a: Triple, b: Triple): Triple => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a: Triple, b: Triple): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** The normal of a face, 0 of one without an area. */
export function normalOf(form: Form, face: readonly number[]): Triple {
  const sum: Triple = [0, 0, 0];
  for (let k = 1; k + 1 < face.length; ++k) {
    const part = cross(minus(form.corners[face[k]!]!, form.corners[face[0]!]!), minus(form.corners[face[k + 1]!]!, form.corners[face[0]!]!));
    for (let axis = 0; axis < 3; ++axis) sum[axis]! += part[axis]!;
  }
  const size = Math.hypot(...sum);
  return size > 0 ? [sum[0] / size, sum[1] / size, sum[2] / size] : sum;
}

/** Pairs of corners: in the plane all sides; in space those where two faces meet by more than 30 degrees, since round parts have many faces. */
export function edgesOf(form: Form, flat: boolean): [number, number][] {
  const edges: [number, number][] = [];
  const seen = new Map<string, Triple>();
  for (const face of form.faces) {
    const normal = normalOf(form, face);
    face.forEach((from, k) => {
      const to = face[(k + 1) % face.length]!;
      if (flat) return void edges.push([from, to]);
      const other = seen.get(`${to} ${from}`);
      if (!other) seen.set(`${from} ${to}`, normal);
      else if (dot(other, normal) < Math.cos(Math.PI / 6)) edges.push([from, to]);
    });
  }
  return edges;
}

/** How far along a ray a convex form is entered, in its own frame; null where it is missed. In the plane the ray is a point. */
export function entry(form: Form, origin: Triple, direction: Triple, flat: boolean): number | null {
  if (flat) {
    const isIn = (face: readonly number[]): boolean => face.every((corner, k) => {
      const a = form.corners[corner]!;
      return cross(minus(form.corners[face[(k + 1) % face.length]!]!, a), minus([origin[0], origin[1]], a))[2] >= 0;
    });
    return form.faces.some(isIn) ? 0 : null;
  }
  let enter = 0;
  let leave = Infinity;
  for (const face of form.faces) {
    const normal = normalOf(form, face);
    const height = dot(normal, minus(origin, form.corners[face[0]!]!));
    const rate = dot(normal, direction);
    if (rate < 0) enter = Math.max(enter, -height / rate);
    else if (rate > 0) leave = Math.min(leave, -height / rate);
    else if (height > 0) return null;
  }
  return enter <= leave ? enter : null;
}

const light: Triple = [-0.35, -0.45, 0.82];

export class Solids {
  readonly group = new three.Group();
  private readonly faces: three.Mesh;
  private readonly lines: three.LineSegments;
  /** Of every corner of a triangle and of an edge: its body, its place and normal in the body, its colour. */
  private readonly corners: { body: number; at: number[]; normal: Triple; color: Triple }[] = [];
  private readonly ends: { body: number; at: number[] }[] = [];

  constructor(
    private readonly bodies: Bodies,
    colorOf: (index: number) => readonly [number, number, number],
    look: { flat: boolean; ghost: boolean },
  ) {
    const { flat, ghost } = look;
    bodies.form?.forEach((number, body) => {
      const form = number === null ? undefined : bodies.forms?.[number];
      if (!form) return;
      const { r, g, b } = new three.Color().setRGB(...(colorOf(body) as Triple), three.SRGBColorSpace);
      const color: Triple = [r, g, b];
      for (const face of form.faces) {
        const normal = normalOf(form, face);
        for (let k = 1; k + 1 < face.length; ++k)
          for (const corner of [face[0]!, face[k]!, face[k + 1]!]) this.corners.push({ body, at: form.corners[corner]!, normal, color });
      }
      for (const edge of edgesOf(form, flat)) for (const corner of edge) this.ends.push({ body, at: form.corners[corner]! });
    });
    const opacity = ghost ? 0.4 : 1;
    const geometry = (count: number, colored: boolean): three.BufferGeometry => {
      const made = new three.BufferGeometry();
      made.setAttribute("position", new three.BufferAttribute(new Float32Array(3 * count), 3).setUsage(three.DynamicDrawUsage));
      if (colored) made.setAttribute("color", new three.BufferAttribute(new Float32Array(3 * count), 3).setUsage(three.DynamicDrawUsage));
      return made;
    };
    const order = ghost ? -5 : 4;
    this.faces = new three.Mesh(
      geometry(this.corners.length, true),
      new three.MeshBasicMaterial({ vertexColors: true, transparent: flat || ghost, opacity, depthTest: !flat, depthWrite: !flat && !ghost, side: three.DoubleSide, polygonOffset: !flat, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }),
    );
    this.lines = new three.LineSegments(geometry(this.ends.length, false), new three.LineBasicMaterial({ color: "#1c2732", transparent: true, opacity: 0.7 * opacity, depthTest: !flat, depthWrite: false }));
    this.faces.renderOrder = order;
    this.lines.renderOrder = order + 0.1;
    for (const part of [this.faces, this.lines]) {
      part.frustumCulled = false;
      this.group.add(part);
    }
  }

  /** Places all corners; `places` are the centres, three numbers each. */
  update(places: ArrayLike<number>, orientations: Float32Array | null): void {
    const flat = this.bodies.dimension === 2;
    const position = this.faces.geometry.getAttribute("position") as three.BufferAttribute;
    const color = this.faces.geometry.getAttribute("color") as three.BufferAttribute;
    let body = -1;
    let turn: number[] = [];
    const turnTo = (next: number): void => {
      if (next !== body) turn = rotationOf(orientations, next, flat);
      body = next;
    };
    this.corners.forEach((corner, i) => {
      turnTo(corner.body);
      position.setXYZ(i, ...placed(turn, places, 3 * body, corner.at));
      const lit = flat ? 1 : 0.72 + 0.28 * dot(placed(turn, [0, 0, 0], 0, corner.normal), light);
      color.setXYZ(i, corner.color[0] * lit, corner.color[1] * lit, corner.color[2] * lit);
    });
    const line = this.lines.geometry.getAttribute("position") as three.BufferAttribute;
    this.ends.forEach((end, i) => {
      turnTo(end.body);
      line.setXYZ(i, ...placed(turn, places, 3 * body, end.at));
    });
    position.needsUpdate = color.needsUpdate = line.needsUpdate = true;
  }

  /** The body that a ray meets first, of those of the plane the one on top, and how far it is; null where it meets none. */
  pick(places: ArrayLike<number>, orientations: Float32Array | null, origin: readonly number[], direction: readonly number[]): { index: number; along: number } | null {
    const flat = this.bodies.dimension === 2;
    let best: { index: number; along: number } | null = null;
    this.bodies.form?.forEach((number, index) => {
      const form = number === null ? undefined : this.bodies.forms?.[number];
      if (!form) return;
      const turn = rotationOf(orientations, index, flat);
      const back = [turn[0]!, turn[3]!, turn[6]!, turn[1]!, turn[4]!, turn[7]!, turn[2]!, turn[5]!, turn[8]!];
      const from = [0, 1, 2].map((k) => origin[k]! - places[3 * index + k]!);
      if (flat) from[2] = 0;
      const along = entry(form, placed(back, [0, 0, 0], 0, from), placed(back, [0, 0, 0], 0, direction), flat);
      if (along !== null && (!best || along <= best.along)) best = { index, along };
    });
    return best;
  }

  dispose(): void {
    for (const part of [this.faces, this.lines]) {
      part.geometry.dispose();
      (part.material as three.Material).dispose();
    }
  }
}
