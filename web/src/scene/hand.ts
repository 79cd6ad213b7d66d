// The hand in the scene: finds what is under the pointer, drags what may be dragged, picks what is clicked.
import * as three from "three";
import type { Session } from "../session";
import { numberOf, pointOf } from "./fit";
import { pickSphere } from "./spheres";
import type { Stage } from "./stage";

/** An item of the drawing or a body of the world. */
export interface Thing {
  kind: "item" | "body";
  index: number;
}

export interface Surroundings {
  session: Session;
  stage: Stage;
  /** The positions of all bodies, three numbers each, and the one under a ray, or -1. */
  bodies(): { places: ArrayLike<number>; pick: (origin: readonly number[], direction: readonly number[], least: (distance: number) => number) => number } | null;
  select(thing: Thing | null): void;
}

const nearPixels = 10;

export class Hand {
  private held: { thing: Thing; through: three.Vector3; offset: three.Vector3; moved: boolean; id: number; x: number; y: number } | null = null;
  private next: number[] | null = null;
  private queued = 0;
  private selected: Thing | null = null;
  private nudge: [number, number, number] | null = null;
  private nudgedAt = -Infinity;
  private nudging = false;

  constructor(private readonly around: Surroundings) {
    const { element } = around.stage.surface;
    element.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    element.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"] as const) element.addEventListener(name, (event) => this.up(event));
  }

  /** The next thing that may be dragged, or the next body, for those who use keys; after the last one none. */
  selectNext(): Thing | null {
    const drawing = this.around.session.model?.drawing ?? [];
    const bodies = (this.around.bodies()?.places.length ?? 0) / 3;
    const things: Thing[] = [
      ...drawing.flatMap((item, index): Thing[] => (item.drag ? [{ kind: "item", index }] : [])),
      ...Array.from({ length: bodies }, (_, index): Thing => ({ kind: "body", index })),
    ];
    const now = things.findIndex(({ kind, index }) => kind === this.selected?.kind && index === this.selected.index);
    this.selected = things[now + 1] ?? null;
    this.around.select(this.selected);
    return this.selected;
  }

  get holdsByKey(): boolean {
    if (this.selected?.kind === "body") return true;
    return this.selected !== null && (this.around.session.model?.drawing[this.selected.index]?.drag ?? false);
  }

  /** Where a thing is now. */
  placeOf({ kind, index }: Thing): [number, number, number] | null {
    const { model, frame } = this.around.session;
    if (!model || !frame) return null;
    if (kind === "item") return model.drawing[index] ? pointOf(model.drawing[index], frame.scene, "at") : null;
    const places = this.around.bodies()?.places;
    return places && 3 * index < places.length ? [places[3 * index]!, places[3 * index + 1]!, places[3 * index + 2]!] : null;
  }

  /** Drags the selected thing by parts of the picture. */
  shift(right: number, up: number): void {
    const { session, stage } = this.around;
    if (!this.selected || !session.model || !session.frame) return;
    // Presses in quick succession go on from one another, not from a picture that is older than the last.
    if (!this.nudge || performance.now() - this.nudgedAt > 400) {
      this.nudge = this.placeOf(this.selected);
    }
    if (!this.nudge) return;
    this.nudgedAt = performance.now();
    this.nudging = true;
    this.nudge[0] += right * stage.seenHeight;
    this.nudge[stage.isFlat ? 1 : 2] += up * stage.seenHeight;
    const to = this.nudge.slice(0, session.model.dimension);
    session.send(this.selected.kind === "item" ? { do: "drag", item: this.selected.index, to } : { do: "drag", body: this.selected.index, to });
  }

  letGo(): void {
    if (!this.nudging) return;
    this.nudging = false;
    // Keys move by jumps: what they set down does not fly on.
    this.around.session.send({ do: "release", still: true });
  }

  /** A new model has other things. */
  forget(): void {
    this.held = null;
    this.selected = null;
    this.nudge = null;
    this.nudging = false;
    this.around.stage.movable = true;
  }

  private place(event: PointerEvent): [number, number] {
    const box = this.around.stage.surface.element.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  private find(x: number, y: number): { thing: Thing; at: three.Vector3; drag: boolean } | null {
    const { session, stage } = this.around;
    const { model, frame } = session;
    if (!model || !frame) return null;
    const ray = stage.ray(x, y);
    const pixel = stage.seenHeight / stage.height;
    const eye = stage.camera.position.distanceTo(stage.target) || 1;
    const least = (distance: number): number => nearPixels * pixel * (stage.isFlat ? 1 : distance / eye);
    const candidates = model.drawing.flatMap((item, index) => (item.shape === "ball" || item.shape === "box" || item.drag ? [index] : []));
    const places = new Float64Array(3 * candidates.length);
    candidates.forEach((item, i) => places.set(pointOf(model.drawing[item]!, frame.scene, "at"), 3 * i));
    const sizeOf = (i: number): number => {
      const item = model.drawing[candidates[i]!]!;
      if (item.shape === "box") return Math.max(numberOf(item, frame.scene, "size", 1, 0), numberOf(item, frame.scene, "size", 1, 1)) / 2;
      return Math.max(Math.abs(numberOf(item, frame.scene, "radius", 0)), item.drag ? 1.6 * least(eye) : 0);
    };
    const origin = ray.origin.toArray();
    const direction = ray.direction.toArray();
    const item = pickSphere(places, sizeOf, origin, direction, least);
    const bodies = this.around.bodies();
    const body = bodies ? bodies.pick(origin, direction, (distance) => least(distance) / 3) : -1;
    // Where the drawing shows a body once more, the body is what is meant.
    if (item >= 0 && (body < 0 || model.drawing[candidates[item]!]!.drag)) {
      const index = candidates[item]!;
      return { thing: { kind: "item", index }, at: new three.Vector3(...pointOf(model.drawing[index]!, frame.scene, "at")), drag: model.drawing[index]!.drag };
    }
    if (!bodies || body < 0) return null;
    return { thing: { kind: "body", index: body }, at: new three.Vector3(bodies.places[3 * body], bodies.places[3 * body + 1], bodies.places[3 * body + 2]), drag: true };
  }

  private down(event: PointerEvent): void {
    const { session, stage } = this.around;
    if (event.button !== 0 || !event.isPrimary) return;
    const [x, y] = this.place(event);
    const found = this.find(x, y);
    stage.movable = !(found?.drag && session.live);
    if (!found) {
      if (this.selected) this.around.select((this.selected = null));
      return;
    }
    const point = stage.onPlane(x, y, found.at) ?? found.at.clone();
    this.held = { thing: found.thing, through: found.at, offset: found.at.clone().sub(point), moved: false, id: event.pointerId, x, y };
    if (found.drag && session.live) stage.surface.element.setPointerCapture(event.pointerId);
  }

  private move(event: PointerEvent): void {
    const { stage } = this.around;
    const [x, y] = this.place(event);
    const held = this.held;
    if (!held) {
      if (event.pointerType === "mouse" && event.buttons === 0) stage.surface.element.style.cursor = this.find(x, y)?.drag ? "grab" : "";
      return;
    }
    if (event.pointerId !== held.id) return;
    if (!held.moved && Math.hypot(x - held.x, y - held.y) < 4) return;
    held.moved = true;
    if (!stage.surface.element.hasPointerCapture(held.id)) return;
    stage.surface.element.style.cursor = "grabbing";
    const point = stage.onPlane(x, y, held.through);
    if (!point) return;
    this.next = point.add(held.offset).toArray().slice(0, stage.isFlat ? 2 : 3);
    this.queued ||= requestAnimationFrame(() => this.send());
  }

  private send(): void {
    this.queued = 0;
    if (!this.held || !this.next) return;
    const { kind, index } = this.held.thing;
    this.around.session.send(kind === "item" ? { do: "drag", item: index, to: this.next } : { do: "drag", body: index, to: this.next });
    this.next = null;
  }

  private up(event: PointerEvent): void {
    const held = this.held;
    const { session, stage } = this.around;
    if (!held || event.pointerId !== held.id) return;
    if (this.queued) {
      cancelAnimationFrame(this.queued);
      this.send();
    }
    this.held = null;
    if (held.moved) {
      if (stage.surface.element.hasPointerCapture(held.id)) session.send({ do: "release" });
    } else {
      this.selected = held.thing;
      this.around.select(held.thing);
    }
    stage.movable = true;
    stage.surface.element.style.cursor = "";
  }
}
