// What a model's `draw` says, as objects of three.js; the numbers come with every frame.
import * as three from "three";
import { channels, curveColors, modelColor, type Theme } from "../palette";
import type { Item } from "../protocol";
import { spring, springPoints, rope, ropePoints, Trail, type Point } from "./curves";
import { numberOf, placeOf, pointOf } from "./fit";
import { leastRadius } from "./bodies";
import { Polyline } from "./polyline";
import { Spheres } from "./spheres";

/** What lies over what in the plane. */
const layer: Record<string, number> = { floor: 0, trail: 1, rope: 2, rod: 3, spring: 3, box: 4, ball: 5, arrow: 6, text: 7 };

/** Where the points of trails were at the times of a frame's rows. */
export interface Paths {
  times: Float64Array;
  points: Float32Array;
  width: number;
}

interface Part {
  update(scene: Float32Array, t: number, size: number, paths: Paths | null): void;
}

/** The colours of items that name none: balls differ from one another where they are few, a trail has its ball's. */
export function itemColors(items: readonly Item[], theme: Theme): string[] {
  const plain = items.filter((item) => item.shape === "ball" && !item.color).length;
  const palette = curveColors[theme];
  let next = 0;
  const colors = items.map((item) => {
    if (item.color) return modelColor(theme, item.color);
    switch (item.shape) {
      case "ball":
        return palette[plain > 1 && plain <= 8 ? next++ % palette.length : 0]!;
      case "box":
        return palette[0]!;
      case "arrow":
        return palette[1]!;
      case "trail":
        return "";
      case "floor":
        return theme === "light" ? "#8996a3" : "#5d6a77";
      case "text":
        return theme === "light" ? "#1b2733" : "#e6ebf0";
      default:
        return theme === "light" ? "#5c6b7a" : "#9aa8b5";
    }
  });
  return colors.map((color, index) => {
    if (color !== "") return color;
    // A trail is that of the ball before it, or of the next one.
    const before = items.slice(0, index).findLastIndex((item) => item.shape === "ball");
    const ball = before >= 0 ? before : items.findIndex((item) => item.shape === "ball");
    return ball >= 0 ? colors[ball]! : palette[1]!;
  });
}

/** A bar or a string as broad as the model says ends as it is; others end in a dot. */
const hasJoints = (item: Item): boolean => item.shape === "spring" || ((item.shape === "rod" || item.shape === "rope") && placeOf(item, "width") < 0);

export class Drawing {
  readonly group = new three.Group();
  readonly trails: Trail[] = [];
  readonly spheres: Spheres;
  /** The item that each sphere shows. */
  readonly ballItems: number[] = [];
  /** Small dots at the ends of springs, rods and ropes. */
  private readonly joints: Spheres;
  private readonly jointItems: number[] = [];
  private readonly parts: Part[] = [];
  private readonly disposed: { dispose(): void }[] = [];

  constructor(
    private readonly items: readonly Item[],
    private readonly theme: Theme,
    private readonly flat: boolean,
    private readonly ghost: boolean,
    oldTrails: Trail[] = [],
  ) {
    const colors = itemColors(items, theme);
    items.forEach((item, index) => item.shape === "ball" && this.ballItems.push(index));
    this.spheres = new Spheres(this.ballItems.length, { flat, opacity: ghost ? 0.45 : 1, least: leastRadius(this.ballItems.length), order: this.order("ball") });
    this.ballItems.forEach((index, at) => this.spheres.tint(at, channels(colors[index]!)));
    if (this.ballItems.length > 0) this.group.add(this.spheres.object);
    items.forEach((item, index) => hasJoints(item) && this.jointItems.push(index));
    this.joints = new Spheres(2 * this.jointItems.length, { flat, opacity: ghost ? 0.4 : 1, least: 4, order: this.order("rod") + 0.5 });
    this.jointItems.forEach((index, at) => [2 * at, 2 * at + 1].forEach((joint) => this.joints.tint(joint, channels(colors[index]!))));
    if (this.jointItems.length > 0) this.group.add(this.joints.object);
    items.forEach((item, index) => {
      const part = this.partFor(item, colors[index]!, oldTrails);
      if (part) this.parts.push(part);
    });
  }

  update(scene: Float32Array, t: number, size: number, paths: Paths | null = null): void {
    this.ballItems.forEach((index, at) => {
      const item = this.items[index]!;
      this.spheres.place(at, ...pointOf(item, scene, "at"), Math.abs(numberOf(item, scene, "radius", 0.02 * size)));
    });
    this.spheres.placed();
    this.jointItems.forEach((index, at) => {
      this.joints.place(2 * at, ...pointOf(this.items[index]!, scene, "at"), 0);
      this.joints.place(2 * at + 1, ...pointOf(this.items[index]!, scene, "to"), 0);
    });
    this.joints.placed();
    for (const part of this.parts) part.update(scene, t, size, paths);
  }

  forgetFrom(t: number): void {
    for (const trail of this.trails) trail.forgetFrom(t);
  }

  dispose(): void {
    this.spheres.dispose();
    this.joints.dispose();
    for (const part of this.disposed) part.dispose();
  }

  private order(shape: string): number {
    return (layer[shape] ?? 0) - (this.ghost ? 10 : 0);
  }

  /** Mixed with the ground: a line that is see-through would show where its pieces overlap. */
  private paler(color: string, part: number): string {
    const [from, ground] = [channels(color), channels(this.theme === "light" ? "#fbfcfd" : "#131a20")];
    const mixed = from.map((value, i) => Math.round(255 * (value + part * (ground[i]! - value))));
    return `#${mixed.map((value) => value.toString(16).padStart(2, "0")).join("")}`;
  }

  private partFor(item: Item, color: string, oldTrails: Trail[]): Part | null {
    switch (item.shape) {
      case "floor":
        return this.flat ? null : this.floor(item, color);
      case "rod":
        return this.bar(item, color);
      case "spring":
        return this.coil(item, color);
      case "rope":
        return this.rope(item, color);
      case "trail":
        return this.trail(item, color, oldTrails[this.trails.length]);
      case "arrow":
        return this.arrow(item, color);
      case "box":
        return this.box(item, color);
      default:
        return null;  // balls are drawn at once, texts are written over the picture
    }
  }

  private line(item: Item, color: string, pixels: number): { line: Polyline; widen: (scene: Float32Array) => void } {
    const place = placeOf(item, "width");
    const asWidth = place >= 0 && item.shape !== "spring";
    const line = new Polyline({ color: this.ghost ? this.paler(color, 0.6) : color, width: pixels, world: asWidth, flat: this.flat, order: this.order(item.shape) });
    this.group.add(line.object);
    this.disposed.push(line);
    return { line, widen: (scene) => void (asWidth && (line.material.linewidth = Math.max(1e-9, scene[place]!))) };
  }

  private bar(item: Item, color: string): Part {
    const { line, widen } = this.line(item, color, 4.5);
    return {
      update: (scene) => {
        widen(scene);
        line.set([...pointOf(item, scene, "at"), ...pointOf(item, scene, "to")], 2);
      },
    };
  }

  private coil(item: Item, color: string): Part {
    const { line } = this.line(item, color, 2.5);
    let width = NaN;
    let points = new Float32Array(0);
    return {
      update: (scene, _t, size) => {
        const from = pointOf(item, scene, "at");
        const to = pointOf(item, scene, "to");
        const length = Math.hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
        if (!Number.isFinite(length)) return;
        if (Number.isNaN(width) && length > 0) width = 0.13 * length;
        const turns = Math.min(200, numberOf(item, scene, "turns", 9));
        if (points.length !== 3 * springPoints(turns)) points = new Float32Array(3 * springPoints(turns));
        spring(points, from, to, turns, numberOf(item, scene, "width", Number.isNaN(width) ? 0.05 * size : Math.min(width, 0.09 * size)), this.flat);
        line.set(points, points.length / 3);
      },
    };
  }

  private rope(item: Item, color: string): Part {
    const { line, widen } = this.line(item, color, 3);
    const points = new Float32Array(3 * ropePoints);
    const down: Point = this.flat ? [0, -1, 0] : [0, 0, -1];
    return {
      update: (scene) => {
        widen(scene);
        rope(points, pointOf(item, scene, "at"), pointOf(item, scene, "to"), numberOf(item, scene, "length", NaN), down);
        line.set(points, ropePoints);
      },
    };
  }

  private trail(item: Item, color: string, old: Trail | undefined): Part {
    const { line, widen } = this.line(item, this.paler(color, 0.35), 2);
    const trail = old ?? new Trail();
    this.trails.push(trail);
    return {
      update: (scene, t, _size, paths) => {
        widen(scene);
        const length = numberOf(item, scene, "length", Infinity);
        const at = pointOf(item, scene, "at");
        const place = item.path;
        if (paths && place) {
          const { times, points, width } = paths;
          const number = (row: number, axis: number): number => (axis < place.length ? points[row * width + place[axis]!]! : 0);
          for (let row = 0; row < times.length; ++row) trail.add(times[row]!, [number(row, 0), number(row, 1), number(row, 2)]);
        } else {
          trail.add(t, at);
        }
        trail.forgetBefore(t - 2 * length);
        const [begin, end] = trail.range(t, length);
        // From its newest row to where the point is now.
        const tip = end === trail.times.length && end > begin;
        if (tip) trail.points.push(...at);
        line.set(trail.points, end - begin + (tip ? 1 : 0), begin);
        if (tip) trail.points.length -= 3;
      },
    };
  }

  private arrow(item: Item, color: string): Part {
    const { line } = this.line(item, color, 3.5);
    const head = new three.Mesh(
      new three.ConeGeometry(0.5, 1, 20),
      new three.MeshBasicMaterial({ color, transparent: true, opacity: this.ghost ? 0.4 : 1, depthTest: !this.flat }),
    );
    head.renderOrder = this.order("arrow");
    this.group.add(head);
    this.disposed.push(head.geometry, head.material);
    const up = new three.Vector3(0, 1, 0);
    return {
      update: (scene, _t, size) => {
        const from = new three.Vector3(...pointOf(item, scene, "at"));
        const way = new three.Vector3(...pointOf(item, scene, "to")).sub(from).multiplyScalar(numberOf(item, scene, "scale", 1));
        const length = way.length();
        const seen = length > 1e-6 * size && Number.isFinite(length);
        head.visible = seen;
        if (!seen) return line.set([], 0);
        const tip = Math.min(0.045 * size, 0.6 * length);
        way.divideScalar(length);
        const neck = from.clone().addScaledVector(way, length - tip);
        line.set([from.x, from.y, from.z, neck.x, neck.y, neck.z], 2);
        head.position.copy(neck).addScaledVector(way, tip / 2);
        head.quaternion.setFromUnitVectors(up, way);
        head.scale.set(0.75 * tip, tip, 0.75 * tip);
      },
    };
  }

  private box(item: Item, color: string): Part {
    const geometry = this.flat ? new three.PlaneGeometry(1, 1) : new three.BoxGeometry(1, 1, 1);
    const opacity = this.ghost ? 0.35 : 1;
    const paint = { color, transparent: this.flat || opacity < 1, opacity, depthTest: !this.flat };
    const mesh = new three.Mesh(geometry, this.flat ? new three.MeshBasicMaterial(paint) : new three.MeshLambertMaterial(paint));
    mesh.renderOrder = this.order("box");
    this.group.add(mesh);
    this.disposed.push(mesh.geometry, mesh.material);
    const edge = new three.Color(color).multiplyScalar(0.55);
    const outline = new Polyline({ color: `#${edge.getHexString()}`, width: 2, opacity, flat: this.flat, order: this.order("box") });
    if (this.flat) this.group.add(outline.object);
    this.disposed.push(outline);
    return {
      update: (scene) => {
        const [x, y, z] = pointOf(item, scene, "at");
        const width = numberOf(item, scene, "size", 1, 0);
        const height = numberOf(item, scene, "size", width, 1);
        const angle = numberOf(item, scene, "angle", 0);
        mesh.position.set(x, y, z);
        mesh.rotation.z = angle;
        mesh.scale.set(width, height, this.flat ? 1 : numberOf(item, scene, "size", Math.min(width, height), 2));
        const corners: number[] = [];
        for (const [a, b] of [[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]] as const) {
          const u = (a * width) / 2;
          const v = (b * height) / 2;
          corners.push(x + u * Math.cos(angle) - v * Math.sin(angle), y + u * Math.sin(angle) + v * Math.cos(angle), z);
        }
        if (this.flat) outline.set(corners, 5);
      },
    };
  }

  /** In space a floor is a disc; in the plane the grid paints it. */
  private floor(item: Item, color: string): Part {
    const mesh = new three.Mesh(new three.CircleGeometry(1, 96), new three.MeshBasicMaterial({ color, transparent: true, opacity: 0.25, side: three.DoubleSide, depthWrite: false }));
    this.group.add(mesh);
    this.disposed.push(mesh.geometry, mesh.material);
    return {
      update: (scene, _t, size) => {
        mesh.position.z = numberOf(item, scene, "height", 0);
        mesh.scale.setScalar(2 * size);
      },
    };
  }
}
