// The bodies of a world, its joints, walls, containers and meshes.
import * as three from "three";
import { channels, curveColors, modelColor, type Theme } from "../palette";
import type { Bodies, StaticMesh } from "../protocol";
import { spring, springPoints, type Point } from "./curves";
import { emptyBounds, gridStep, include, isEmpty, union, type Bounds } from "./fit";
import { bandOf, bandWidth, chainLines, surfaceOf } from "./ground";
import { JointMarks } from "./joints";
import { Polyline } from "./polyline";
import { Solids } from "./solids";
import { pickSphere, Spheres } from "./spheres";

export const radiusOf = (bodies: Bodies) => (index: number): number => (typeof bodies.radius === "number" ? bodies.radius : (bodies.radius[index] ?? bodies.radius[0] ?? 1));

/** So small a ball, in pixels of its radius, can still be seen; of many each is less. */
export const leastRadius = (count: number): number => (count <= 30 ? 6 : count <= 300 ? 3 : 1);

/**
 * The box that walls along all axes make: four in the plane, a table with its edge; six in space, drawn by their edges,
 * since planes would hide what is in it.
 */
export function boxOfWalls(walls: Bodies["walls"], dimension: 2 | 3): { lower: number[]; upper: number[] } | null {
  const lower = Array<number>(dimension).fill(NaN);
  const upper = Array<number>(dimension).fill(NaN);
  for (const { normal, offset, thin } of walls) {
    if (thin) return null;
    const axis = normal.findIndex((part) => part !== 0);
    if (axis < 0 || normal.some((part, index) => index !== axis && part !== 0)) return null;
    const place = offset / normal[axis]!;
    if (normal[axis]! > 0) lower[axis] = place;
    else upper[axis] = place;
  }
  return [...lower, ...upper].every(Number.isFinite) ? { lower, upper } : null;
}

type SpringEnds = NonNullable<Bodies["springs"]>[number];

interface ShownSpring {
  ends: SpringEnds;
  coil: Polyline;
  width: number;
}

/** Of more springs, as in a cloth, coils would hide what they hold. */
const mostSprings = 60;
const coilTurns = 9;
const coilPoints = new Float32Array(3 * springPoints(coilTurns));

export class BodiesView {
  readonly group = new three.Group();
  readonly spheres: Spheres;
  readonly joints: JointMarks;
  private readonly solids: Solids;
  private orientations: Float32Array | null = null;
  private readonly ofMeshes: Bounds = emptyBounds();
  private readonly lines: Polyline[] = [];
  private readonly springs: ShownSpring[];
  private readonly surfaces: { geometry: three.BufferGeometry; material: three.Material }[] = [];

  constructor(
    readonly bodies: Bodies,
    theme: Theme,
    ghost: boolean,
    private readonly size: number,
  ) {
    const flat = bodies.dimension === 2;
    this.spheres = new Spheres(bodies.count, { flat, opacity: ghost ? 0.4 : 1, least: leastRadius(bodies.count), order: ghost ? -5 : 4.5 });
    const radius = radiusOf(bodies);
    for (let i = 0; i < bodies.count; ++i) {
      this.spheres.place(i, 0, 0, 0, (bodies.form?.[i] ?? null) === null ? radius(i) : 0);
      this.spheres.tint(i, channels(this.colorOf(i, theme)));
    }
    this.spheres.placed();
    this.group.add(this.spheres.object);
    this.solids = new Solids(bodies, (index) => channels(this.colorOf(index, theme)), { flat, ghost });
    this.group.add(this.solids.group);
    this.joints = new JointMarks(bodies, radius, theme === "light" ? "#303030" : "#e8eef4");
    if (!ghost) this.group.add(this.joints.group);
    const line = theme === "light" ? "#5c6b7a" : "#9aa8b5";
    for (const { lower, upper } of ghost ? [] : bodies.containers) this.outline(lower, upper, line, flat);
    const box = boxOfWalls(bodies.walls, bodies.dimension);
    if (box && !ghost) this.outline(box.lower, box.upper, line, flat);
    for (const { normal, offset, thin } of ghost || box ? [] : bodies.walls) this.wall(normal, offset, line, flat, thin ?? false);
    for (const mesh of ghost ? [] : (bodies.meshes ?? [])) this.ground(mesh, line, flat);
    this.springs = (ghost || (bodies.springs?.length ?? 0) > mostSprings ? [] : (bodies.springs ?? [])).map((ends) => {
      const coil = new Polyline({ color: line, width: 2, flat, order: 3 });
      this.lines.push(coil);
      this.group.add(coil.object);
      return { ends, coil, width: NaN };
    });
  }

  update(positions: Float32Array, orientations: Float32Array | null): void {
    this.spheres.placeAll(positions, this.bodies.dimension);
    this.spheres.turnAll(orientations, this.bodies.dimension);
    this.orientations = orientations;
    this.solids.update(this.spheres.places, orientations);
    this.joints.update(this.spheres.places, orientations);
    for (const each of this.springs) this.stretch(each);
  }

  /** The body under a ray; one that it misses by no more than `least` at its distance, where it meets none. */
  pick(origin: readonly number[], direction: readonly number[], least: (distance: number) => number): number {
    const { places } = this.spheres;
    const radius = radiusOf(this.bodies);
    const ballRadius = (index: number): number => ((this.bodies.form?.[index] ?? null) === null ? radius(index) : 0);
    const solid = this.solids.pick(places, this.orientations, origin, direction);
    const ball = pickSphere(places, ballRadius, origin, direction, solid ? () => 0 : least);
    if (!solid || ball < 0) return solid?.index ?? ball;
    const along = [0, 1, 2].reduce((sum, k) => sum + (places[3 * ball + k]! - origin[k]!) * direction[k]!, 0);
    return this.bodies.dimension === 2 || along < solid.along ? ball : solid.index;
  }

  private stretch(shown: ShownSpring): void {
    const { a, b, point } = shown.ends;
    const { places } = this.spheres;
    const placeOf = (index: number): Point => [places[3 * index]!, places[3 * index + 1]!, places[3 * index + 2]!];
    const from = placeOf(a);
    const to: Point = b !== null ? placeOf(b) : [point?.[0] ?? 0, point?.[1] ?? 0, point?.[2] ?? 0];
    const length = Math.hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
    if (Number.isNaN(shown.width) && length > 0) shown.width = Math.min(0.12 * length, radiusOf(this.bodies)(a));
    if (!Number.isFinite(length + shown.width)) return;
    spring(coilPoints, from, to, coilTurns, shown.width, this.bodies.dimension === 2);
    shown.coil.set(coilPoints, coilPoints.length / 3);
  }

  /** Containers, meshes and chains belong into the picture whole. */
  includeSurroundings(bounds: Bounds): void {
    if (!isEmpty(this.ofMeshes)) union(bounds, this.ofMeshes);
    const box = boxOfWalls(this.bodies.walls, this.bodies.dimension);
    for (const { lower, upper } of box ? [box, ...this.bodies.containers] : this.bodies.containers) {
      include(bounds, lower[0]!, lower[1]!, lower[2] ?? 0);
      include(bounds, upper[0]!, upper[1]!, upper[2] ?? 0);
    }
  }

  dispose(): void {
    this.spheres.dispose();
    this.solids.dispose();
    this.joints.dispose();
    for (const line of this.lines) line.dispose();
    for (const { geometry, material } of this.surfaces) {
      geometry.dispose();
      material.dispose();
    }
  }

  private colorOf(index: number, theme: Theme): string {
    const { color } = this.bodies;
    if (typeof color === "string") return modelColor(theme, color);
    if (color && color.length > 0) return modelColor(theme, color[index % color.length]!);
    return curveColors[theme][index % 5]!;
  }

  private add(points: number[], color: string, flat: boolean, width = 2, opacity = 0.9): void {
    const line = new Polyline({ color, width, opacity, flat, order: 0 });
    line.set(points, points.length / 3);
    this.lines.push(line);
    this.group.add(line.object);
  }

  private outline(lower: number[], upper: number[], color: string, flat: boolean): void {
    const [x0, y0, z0 = 0] = lower as [number, number, number?];
    const [x1, y1, z1 = 0] = upper as [number, number, number?];
    if (flat) {
      this.add([x0, y0, 0, x1, y0, 0, x1, y1, 0, x0, y1, 0, x0, y0, 0], color, flat, 4);
      const table = new three.Mesh(new three.PlaneGeometry(x1 - x0, y1 - y0), new three.MeshBasicMaterial({ color: "#009e73", transparent: true, opacity: 0.14, depthTest: false, depthWrite: false }));
      table.position.set((x0 + x1) / 2, (y0 + y1) / 2, 0);
      table.renderOrder = -9;
      this.surfaces.push(table);
      this.group.add(table);
      return;
    }
    // A thin line on a pale broad one: smooth also where a pixel has one sample.
    for (const [width, opacity] of [[3, 0.25], [1.2, 0.8]] as const) {
      for (const z of [z0, z1]) this.add([x0, y0, z, x1, y0, z, x1, y1, z, x0, y1, z, x0, y0, z], color, flat, width, opacity);
      for (const [x, y] of [[x0, y0], [x1, y0], [x1, y1], [x0, y1]] as const) this.add([x, y, z0, x, y, z1], color, flat, width, opacity);
    }
    this.bottom([x0, y0], [x1, y1], z0, color);
  }

  /** The bottom of a box, ruled as the plane is: it gives the eye depth. */
  private bottom([x0, y0]: [number, number], [x1, y1]: [number, number], z: number, color: string): void {
    const surface = new three.Mesh(new three.PlaneGeometry(x1 - x0, y1 - y0), new three.MeshBasicMaterial({ color, transparent: true, opacity: 0.1, side: three.DoubleSide, depthWrite: false }));
    surface.position.set((x0 + x1) / 2, (y0 + y1) / 2, z);
    surface.renderOrder = -8;
    const step = gridStep(Math.max(x1 - x0, y1 - y0), 10);
    const points: number[] = [];
    const rule = (from: number, to: number, line: (at: number) => number[]): void => {
      for (let i = Math.ceil(from / step - 1e-9); i * step <= to * (1 + 1e-9); ++i) points.push(...line(i * step));
    };
    rule(x0, x1, (x) => [x, y0, z, x, y1, z]);
    rule(y0, y1, (y) => [x0, y, z, x1, y, z]);
    const geometry = new three.BufferGeometry().setAttribute("position", new three.Float32BufferAttribute(points, 3));
    const rules = new three.LineSegments(geometry, new three.LineBasicMaterial({ color, transparent: true, opacity: 0.22, depthWrite: false }));
    rules.renderOrder = -7;
    this.surfaces.push(surface, rules);
    this.group.add(surface, rules);
  }

  /** The half space normal . x >= offset is free. */
  private wall(normal: number[], offset: number, color: string, flat: boolean, thin: boolean): void {
    const length = Math.hypot(...normal);
    const n = normal.map((part) => part / length);
    const foot = n.map((part) => (part * offset) / length);
    if (flat) {
      const reach = 1000 * this.size;
      if (!thin) this.behind(n, foot, reach, color);
      this.add([foot[0]! - n[1]! * reach, foot[1]! + n[0]! * reach, 0, foot[0]! + n[1]! * reach, foot[1]! - n[0]! * reach, 0], color, flat);
      return;
    }
    const mesh = new three.Mesh(new three.PlaneGeometry(3 * this.size, 3 * this.size), new three.MeshBasicMaterial({ color, transparent: true, opacity: 0.12, side: three.DoubleSide, depthWrite: false }));
    mesh.position.set(foot[0]!, foot[1]!, foot[2]!);
    mesh.quaternion.setFromUnitVectors(new three.Vector3(0, 0, 1), new three.Vector3(n[0], n[1], n[2]));
    this.surfaces.push(mesh);
    this.group.add(mesh);
  }

  /** A chain is a line, with a band behind it where only one side is free; a mesh has faces. */
  private ground(mesh: StaticMesh, color: string, flat: boolean): void {
    for (const [x, y, z] of mesh.corners) include(this.ofMeshes, x!, y!, z ?? 0);
    if (!flat) {
      const surface = surfaceOf(mesh, color);
      this.surfaces.push(...surface.parts);
      this.group.add(surface);
      return;
    }
    for (const points of chainLines(mesh)) this.add(points, color, flat);
    if (mesh.thin) return;
    const geometry = new three.BufferGeometry().setAttribute("position", new three.Float32BufferAttribute(bandOf(mesh, bandWidth(mesh)), 3));
    const band = new three.Mesh(geometry, new three.MeshBasicMaterial({ color, transparent: true, opacity: 0.16, depthTest: false, depthWrite: false, side: three.DoubleSide }));
    band.renderOrder = -9;
    this.surfaces.push(band);
    this.group.add(band);
  }

  /** What is behind a wall is solid. */
  private behind(n: readonly number[], foot: readonly number[], reach: number, color: string): void {
    const mesh = new three.Mesh(new three.PlaneGeometry(2 * reach, reach), new three.MeshBasicMaterial({ color, transparent: true, opacity: 0.16, depthTest: false, depthWrite: false, side: three.DoubleSide }));
    mesh.position.set(foot[0]! - (n[0]! * reach) / 2, foot[1]! - (n[1]! * reach) / 2, 0);
    mesh.rotation.z = Math.atan2(-n[0]!, n[1]!);
    mesh.renderOrder = -9;
    this.surfaces.push(mesh);
    this.group.add(mesh);
  }
}
