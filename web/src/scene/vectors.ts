// Arrows at balls, boxes and bodies: how fast they move, and how their velocity changes (the force on them divided by
// their mass). The largest that has been seen is a sixth of the picture; the legend says how much that is.
import * as three from "three";
import { make } from "../dom";
import { formatNumber, formatUnit } from "../format";
import { curveColors, type Theme } from "../palette";
import type { Frame, Item, ModelMessage } from "../protocol";
import { Polyline } from "./polyline";

type Kind = "velocity" | "acceleration";
type Point = [number, number, number];

/** The part of the picture's height that the largest arrow takes. */
const largestPart = 1 / 6;

/** The vector of an item in a mode, null where the motion does not say it. */
export function vectorOf(item: Item, kind: Kind, mode: string | null, scene: Float32Array): Point | null {
  const places = item.numbers[kind] ?? (mode !== null ? item.numbers[`${kind}:${mode}`] : undefined);
  if (places === undefined) return null;
  const [x, y = 0, z = 0] = (typeof places === "number" ? [places] : places).map((place) => scene[place]!);
  return x === undefined ? null : [x, y, z];
}

/** 1, 2 or 5 times a power of ten, not above a length. */
export function roundBelow(length: number): number {
  const power = 10 ** Math.floor(Math.log10(length));
  return (length >= 5 * power ? 5 : length >= 2 * power ? 2 : 1) * power;
}

interface Arrow {
  line: Polyline;
  head: three.Mesh;
}

class Field {
  readonly group = new three.Group();
  largest = 0;
  private arrows: Arrow[] = [];
  private readonly geometry = new three.ConeGeometry(0.5, 1, 16);
  private readonly material: three.MeshBasicMaterial;

  constructor(
    readonly kind: Kind,
    readonly color: string,
    private readonly flat: boolean,
  ) {
    this.material = new three.MeshBasicMaterial({ color, depthTest: !flat, transparent: flat });
  }

  /** Arrows from points along vectors, `size` the height of the picture. */
  show(from: readonly Point[], along: readonly Point[], size: number): void {
    for (const [x, y, z] of along) {
      const length = Math.hypot(x, y, z);
      if (Number.isFinite(length)) this.largest = Math.max(this.largest, length);
    }
    const scale = this.largest > 0 ? (largestPart * size) / this.largest : 0;
    while (this.arrows.length < from.length) this.add();
    this.arrows.forEach((arrow, index) => this.place(arrow, from[index], along[index], scale, size));
  }

  hide(): void {
    for (const arrow of this.arrows) this.place(arrow, undefined, undefined, 0, 1);
  }

  dispose(): void {
    for (const { line } of this.arrows) line.dispose();
    this.geometry.dispose();
    this.material.dispose();
  }

  private add(): void {
    const line = new Polyline({ color: this.color, width: 3, flat: this.flat, order: 6 });
    const head = new three.Mesh(this.geometry, this.material);
    head.renderOrder = 6;
    this.arrows.push({ line, head });
    this.group.add(line.object, head);
  }

  private place({ line, head }: Arrow, from: Point | undefined, along: Point | undefined, scale: number, size: number): void {
    const way = new three.Vector3(...(along ?? [0, 0, 0])).multiplyScalar(scale);
    const length = way.length();
    head.visible = from !== undefined && length > 0.004 * size && Number.isFinite(length);
    if (!head.visible) return line.set([], 0);
    const start = new three.Vector3(...from!);
    const tip = Math.min(0.03 * size, 0.6 * length);
    way.divideScalar(length);
    const neck = start.clone().addScaledVector(way, length - tip);
    line.set([start.x, start.y, start.z, neck.x, neck.y, neck.z], 2);
    head.position.copy(neck).addScaledVector(way, tip / 2);
    head.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), way);
    head.scale.set(0.75 * tip, tip, 0.75 * tip);
  }
}

export class Vectors {
  readonly group = new three.Group();
  readonly legend = make("div", { class: "vector-legend", role: "note", "aria-label": "Arrows", hidden: true });
  shown = false;
  private fields: Field[] = [];
  private units: Record<Kind, string> = { velocity: "", acceleration: "" };
  private legendText = "";

  build(model: ModelMessage, theme: Theme, flat: boolean): void {
    for (const field of this.fields) field.dispose();
    this.group.clear();
    const palette = curveColors[theme];
    this.fields = [new Field("velocity", palette[2]!, flat), new Field("acceleration", palette[1]!, flat)];
    this.group.add(...this.fields.map(({ group }) => group));
    const time = model.time_unit;
    // Lengths are in the unit of the picture.
    this.units = { velocity: time ? `per ${time}` : "", acceleration: time ? `per ${time}^2` : "" };
    this.legendText = "";
  }

  update(model: ModelMessage, frame: Frame, mode: string | null, size: number): void {
    this.group.visible = this.shown;
    this.legend.hidden = !this.shown;
    if (!this.shown) return;
    for (const field of this.fields) {
      const from: Point[] = [];
      const along: Point[] = [];
      const add = (at: Point, vector: Point | null): void => {
        if (vector) {
          from.push(at);
          along.push(vector);
        }
      };
      const bodies = field.kind === "velocity" && model.bodies && frame.positions && frame.velocities ? model.bodies : null;
      // The bodies of a world say it of all things; what the drawing shows once more has no second arrow.
      if (bodies) {
        const { dimension } = bodies;
        const point = (values: Float32Array, i: number): Point => [values[dimension * i]!, values[dimension * i + 1]!, dimension === 3 ? values[dimension * i + 2]! : 0];
        for (let i = 0; i < frame.positions!.length / dimension; ++i) add(point(frame.positions!, i), point(frame.velocities!, i));
      } else {
        for (const item of model.drawing) {
          const at = item.numbers["at"];
          if (!Array.isArray(at)) continue;
          const [x, y = 0, z = 0] = at.map((place) => frame.scene[place]!);
          add([x!, y, z], vectorOf(item, field.kind, mode, frame.scene));
        }
      }
      field.show(from, along, size);
      if (from.length === 0) field.hide();
    }
    this.tell(size);
  }

  /** What an arrow of a round length means. */
  private tell(size: number): void {
    const rows = this.fields.filter(({ largest }) => largest > 0).map(({ kind, color, largest }) => ({ kind, color, round: roundBelow(largest), part: (largestPart * roundBelow(largest)) / largest }));
    const text = JSON.stringify([rows, size > 0]);
    if (text === this.legendText) return;
    this.legendText = text;
    const unit = (kind: Kind): string => (this.units[kind] ? ` ${formatUnit(this.units[kind])}` : "");
    this.legend.replaceChildren(
      ...rows.map(({ kind, color, round, part }) =>
        make("span", {}, make("i", { style: `background: ${color}; width: calc(${part} * var(--scene-height, 20rem))` }), `${kind} ${formatNumber(round, 3)}${unit(kind)}`),
      ),
    );
    if (rows.length === 0) this.legend.textContent = "Nothing here has a velocity that the model says.";
  }
}
