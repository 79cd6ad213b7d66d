// The spheres of a world, its walls and its containers.
import * as three from "three";
import { channels, curveColors, modelColor, type Theme } from "../palette";
import type { Bodies } from "../protocol";
import { gridStep, include, type Bounds } from "./fit";
import { Polyline } from "./polyline";
import { Spheres } from "./spheres";

export const radiusOf = (bodies: Bodies) => (index: number): number => (typeof bodies.radius === "number" ? bodies.radius : (bodies.radius[index] ?? bodies.radius[0] ?? 1));

/** The box that six walls along the axes make: drawn by its edges, since six planes would hide what is in it. */
export function boxOfWalls(walls: Bodies["walls"]): { lower: number[]; upper: number[] } | null {
  const lower = [NaN, NaN, NaN];
  const upper = [NaN, NaN, NaN];
  for (const { normal, offset } of walls) {
    const axis = normal.findIndex((part) => part !== 0);
    if (axis < 0 || normal.some((part, index) => index !== axis && part !== 0)) return null;
    const place = offset / normal[axis]!;
    if (normal[axis]! > 0) lower[axis] = place;
    else upper[axis] = place;
  }
  return [...lower, ...upper].every(Number.isFinite) ? { lower, upper } : null;
}

export class BodiesView {
  readonly group = new three.Group();
  readonly spheres: Spheres;
  private readonly lines: Polyline[] = [];
  private readonly surfaces: { geometry: three.BufferGeometry; material: three.Material }[] = [];

  constructor(
    readonly bodies: Bodies,
    theme: Theme,
    ghost: boolean,
    private readonly size: number,
  ) {
    const flat = bodies.dimension === 2;
    this.spheres = new Spheres(bodies.count, { flat, opacity: ghost ? 0.4 : 1, least: 1, order: ghost ? -5 : 4.5 });
    const radius = radiusOf(bodies);
    for (let i = 0; i < bodies.count; ++i) {
      this.spheres.place(i, 0, 0, 0, radius(i));
      this.spheres.tint(i, channels(this.colorOf(i, theme)));
    }
    this.spheres.placed();
    this.group.add(this.spheres.object);
    const line = theme === "light" ? "#5c6b7a" : "#9aa8b5";
    for (const { lower, upper } of ghost ? [] : bodies.containers) this.outline(lower, upper, line, flat);
    const box = flat ? null : boxOfWalls(bodies.walls);
    if (box && !ghost) this.outline(box.lower, box.upper, line, false);
    for (const { normal, offset } of ghost || box ? [] : bodies.walls) this.wall(normal, offset, line, flat);
  }

  update(positions: Float32Array, orientations: Float32Array | null): void {
    this.spheres.placeAll(positions, this.bodies.dimension);
    this.spheres.turnAll(orientations, this.bodies.dimension);
  }

  /** Containers belong into the picture whole. */
  includeContainers(bounds: Bounds): void {
    const box = this.bodies.dimension === 3 ? boxOfWalls(this.bodies.walls) : null;
    for (const { lower, upper } of box ? [box, ...this.bodies.containers] : this.bodies.containers) {
      include(bounds, lower[0]!, lower[1]!, lower[2] ?? 0);
      include(bounds, upper[0]!, upper[1]!, upper[2] ?? 0);
    }
  }

  dispose(): void {
    this.spheres.dispose();
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
    if (flat) return this.add([x0, y0, 0, x1, y0, 0, x1, y1, 0, x0, y1, 0, x0, y0, 0], color, flat);
    // A thin line on a pale broad one: smooth also where a pixel has one sample.
    for (const [width, opacity] of [[3, 0.25], [1.2, 0.8]] as const) {
      for (const z of [z0, z1]) this.add([x0, y0, z, x1, y0, z, x1, y1, z, x0, y1, z, x0, y0, z], color, flat, width, opacity);
      for (const [x, y] of [[x0, y0], [x1, y0], [x1, y1], [x0, y1]] as const) this.add([x, y, z0, x, y, z1], color, flat, width, opacity);
    }
    this.ground([x0, y0], [x1, y1], z0, color);
  }

  /** The bottom of a box, ruled as the plane is: it gives the eye depth. */
  private ground([x0, y0]: [number, number], [x1, y1]: [number, number], z: number, color: string): void {
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
  private wall(normal: number[], offset: number, color: string, flat: boolean): void {
    const length = Math.hypot(...normal);
    const n = normal.map((part) => part / length);
    const foot = n.map((part) => (part * offset) / length);
    if (flat) {
      const reach = 1000 * this.size;
      this.add([foot[0]! - n[1]! * reach, foot[1]! + n[0]! * reach, 0, foot[0]! + n[1]! * reach, foot[1]! - n[0]! * reach, 0], color, flat);
      return;
    }
    const mesh = new three.Mesh(new three.PlaneGeometry(3 * this.size, 3 * this.size), new three.MeshBasicMaterial({ color, transparent: true, opacity: 0.12, side: three.DoubleSide, depthWrite: false }));
    mesh.position.set(foot[0]!, foot[1]!, foot[2]!);
    mesh.quaternion.setFromUnitVectors(new three.Vector3(0, 0, 1), new three.Vector3(n[0], n[1], n[2]));
    this.surfaces.push(mesh);
    this.group.add(mesh);
  }
}
