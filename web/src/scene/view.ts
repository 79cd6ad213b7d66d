// The scene of the page: joins the stage, the drawing, the bodies and the labels with the session.
import { make, setText } from "../dom";
import { formatName, formatNumber, formatSteady } from "../format";
import type { Theme } from "../palette";
import type { Bodies, Frame, ModelMessage } from "../protocol";
import type { Session } from "../session";
import { BodiesView, radiusOf } from "./bodies";
import { Drawing, itemColors, type Paths } from "./drawing";
import { boundsOfBodies, boundsOfItems, Interest, numberOf, pointOf, union } from "./fit";
import { drawGrid } from "./grid";
import { Hand, type Thing } from "./hand";
import { Labels } from "./labels";
import { Stage } from "./stage";
import { Vectors } from "./vectors";

/** Place, velocity, spin, and what does not change last. */
function bodyOrder(names: string[]): string[] {
  const rank = (name: string): number => (/^[xyz]$/.test(name) ? 0 : /^[xyz]'$/.test(name) ? 1 : name.startsWith("spin") ? 2 : 3);
  return names.sort((a, b) => rank(a) - rank(b) || a.localeCompare(b));
}

/** From so many bodies on, each is small: smooth edges cost more than they show. */
const many = 500;

export class SceneView {
  readonly element: HTMLElement;
  readonly stage: Stage;
  readonly hand: Hand;
  gridShown = true;
  private jointsShown = true;
  private readonly grid = make("canvas", { class: "grid", "aria-hidden": "true" });
  private readonly labels = new Labels();
  private readonly vectors = new Vectors();
  private readonly card = make("div", { class: "card", role: "status", hidden: true });
  private readonly ring = make("div", { class: "ring", hidden: true });
  private drawing: Drawing | null = null;
  private ghost: Drawing | null = null;
  private bodies: BodiesView | null = null;
  private ghostBodies: BodiesView | null = null;
  private ghostTrails: Drawing["trails"] = [];
  private interest = new Interest(false);
  private selected: Thing | null = null;
  private following: Thing | null = null;
  private firstFrame = true;
  private theme: Theme;
  private lastPicture = 0;
  private gridDrawn = "";

  constructor(
    private readonly session: Session,
    theme: Theme,
    moved: () => void,
  ) {
    this.theme = theme;
    this.element = make("div", { class: "scene", tabindex: 0, "aria-label": "Scene" });
    this.element.append(this.grid);
    this.stage = new Stage(this.element, () => this.beforeDrawing(), moved);
    const { surface } = this.stage;
    surface.element.setAttribute("role", "img");
    this.element.append(surface.element, this.ring, this.labels.element, this.card, this.vectors.legend);
    this.stage.scene.add(this.vectors.group);
    this.hand = new Hand({
      session,
      stage: this.stage,
      bodies: () => {
        const { bodies } = this;
        return bodies && { places: bodies.spheres.places, pick: (origin, direction, least) => bodies.pick(origin, direction, least) };
      },
      select: (thing) => this.select(thing),
    });
    surface.element.addEventListener("dblclick", () => this.fit());
    session.on("model", (model) => this.open(model));
    session.on("frame", (frame) => this.show(frame));
    session.on("rewound", (t) => this.forgetFrom(t));
    session.on("values", (values) => this.tellBody(values));
    session.on("frame", () => this.askBody());
    session.on("theme", (now) => {
      this.theme = now;
      if (session.model) this.build(session.model);
      if (session.frame) this.show(session.frame);
    });
    session.on("state", (state) => {
      if (!state.ghost && (this.ghost || this.ghostBodies)) this.dropGhost();
    });
  }

  /** Whether there is anything to show. */
  get empty(): boolean {
    const model = this.session.model;
    return !model || !this.stage.surface.works || (model.drawing.length === 0 && !model.bodies);
  }

  fit(): void {
    this.following = null;
    this.stage.automatic = true;
    this.stage.invalidate();
  }

  /** The scene as it stands, with its grid, as an image. */
  picture(background: string): HTMLCanvasElement {
    this.stage.draw();
    const { canvas } = this.stage.surface;
    const whole = make("canvas", { width: canvas?.width ?? 1, height: canvas?.height ?? 1 });
    const context = whole.getContext("2d")!;
    context.fillStyle = background;
    context.fillRect(0, 0, whole.width, whole.height);
    if (this.stage.isFlat && this.gridShown) context.drawImage(this.grid, 0, 0, whole.width, whole.height);
    if (canvas) context.drawImage(canvas, 0, 0);
    return whole;
  }

  private open(model: ModelMessage): void {
    this.clear();
    this.stage.begin(model.dimension, (model.bodies?.count ?? 0) >= many);
    this.stage.surface.element.setAttribute("aria-label", `Moving picture of ${model.name}`);
    this.interest = new Interest(!model.bodies && !model.drawing.some((item) => item.shape === "trail"));
    this.firstFrame = true;
    this.gridDrawn = "";
    this.hand.forget();
    this.select(null);
    this.build(model);
  }

  private clear(): void {
    for (const part of [this.drawing, this.ghost, this.bodies, this.ghostBodies]) {
      if (!part) continue;
      this.stage.scene.remove(part.group);
      part.dispose();
    }
    this.drawing = this.ghost = this.bodies = this.ghostBodies = null;
    this.ghostTrails = [];
  }

  private build(model: ModelMessage): void {
    const trails = this.drawing?.trails ?? [];
    const ghostTrails = this.ghost?.trails ?? [];
    this.clear();
    this.ghostTrails = ghostTrails;
    this.drawing = new Drawing(model.drawing, this.theme, this.stage.isFlat, false, trails);
    this.stage.scene.add(this.drawing.group);
    this.vectors.build(model, this.theme, this.stage.isFlat);
    this.labels.build(model.drawing, itemColors(model.drawing, this.theme));
  }

  private dropGhost(): void {
    for (const part of [this.ghost, this.ghostBodies]) {
      if (!part) continue;
      this.stage.scene.remove(part.group);
      part.dispose();
    }
    this.ghost = this.ghostBodies = null;
    this.ghostTrails = [];
    this.stage.invalidate();
  }

  private forgetFrom(t: number): void {
    this.drawing?.forgetFrom(t);
    this.ghost?.forgetFrom(t);
  }

  private show(frame: Frame): void {
    const model = this.session.model;
    if (!model || !this.drawing) return;
    const bounds = boundsOfItems(model.drawing, frame.scene, this.stage.isFlat ? 1 : 2);
    if (frame.positions && model.bodies) {
      this.bodies = this.showBodies(this.bodies, model.bodies, frame.positions, frame.orientations, false);
      if (frame.ghostPositions) this.ghostBodies = this.showBodies(this.ghostBodies, model.bodies, frame.ghostPositions, frame.ghostOrientations, true);
      union(bounds, boundsOfBodies(frame.positions, model.bodies.dimension, radiusOf(model.bodies)));
      this.bodies.includeSurroundings(bounds);
    }
    if (frame.ghostScene) union(bounds, boundsOfItems(model.drawing, frame.ghostScene, this.stage.isFlat ? 1 : 2));
    this.interest.see(bounds);
    const floor = model.drawing.find((item) => item.shape === "floor");
    this.stage.floor = floor ? numberOf(floor, frame.scene, "height", 0) : null;
    if (this.firstFrame && this.stage.automatic) this.stage.approach(this.interest.wanted(), 1);
    this.firstFrame = false;
    const size = this.stage.seenHeight;
    const paths = (points: Float32Array | null): Paths | null => (points ? { times: frame.rowTimes, points, width: model.path_count ?? 0 } : null);
    this.drawing.update(frame.scene, frame.t, size, paths(frame.paths));
    if (frame.ghostScene) {
      if (!this.ghost) {
        this.ghost = new Drawing(model.drawing, this.theme, this.stage.isFlat, true, this.ghostTrails);
        this.stage.scene.add(this.ghost.group);
      }
      this.ghost.update(frame.ghostScene, frame.t, size, paths(frame.ghostPaths));
    }
    this.vectors.update(model, frame, this.session.state?.mode ?? null, size);
    if (this.selected) this.tellItem();
    this.stage.invalidate();
  }

  /** Arrows for velocity and acceleration, or none. */
  toggleVectors(): boolean {
    this.vectors.shown = !this.vectors.shown;
    const { model, frame } = this.session;
    if (model && frame) this.vectors.update(model, frame, this.session.state?.mode ?? null, this.stage.seenHeight);
    this.stage.invalidate();
    return this.vectors.shown;
  }

  /** The marks of joints, or none. */
  toggleJoints(): boolean {
    this.jointsShown = !this.jointsShown;
    if (this.bodies) this.bodies.joints.group.visible = this.jointsShown;
    this.stage.invalidate();
    return this.jointsShown;
  }

  /** The view of the bodies, made anew where there is none of as many. */
  private showBodies(old: BodiesView | null, bodies: Bodies, positions: Float32Array, orientations: Float32Array | null, ghost: boolean): BodiesView {
    const count = positions.length / bodies.dimension;
    let view = old;
    if (!view || view.spheres.count !== count) {
      if (view) {
        this.stage.scene.remove(view.group);
        view.dispose();
      }
      const seen = boundsOfBodies(positions, bodies.dimension, radiusOf(bodies));
      const size = Math.max(1, ...[0, 1, 2].map((axis) => seen.upper[axis]! - seen.lower[axis]!).filter(Number.isFinite));
      // Where the drawing connects things itself the world's springs are not shown once more.
      const connected = this.session.model?.drawing.some((item) => item.numbers["to"] !== undefined && item.shape !== "arrow") ?? false;
      view = new BodiesView({ ...bodies, count, springs: connected ? [] : (bodies.springs ?? []) }, this.theme, ghost, size);
      view.joints.group.visible = this.jointsShown;
      this.stage.scene.add(view.group);
    }
    view.update(positions, orientations);
    return view;
  }

  /** Just before a picture: camera, grid and labels take their places. */
  private beforeDrawing(): void {
    const now = performance.now();
    const passed = Math.min(0.1, (now - this.lastPicture) / 1000);
    this.lastPicture = now;
    const followed = this.following && this.hand.placeOf(this.following);
    if (followed) this.stage.lookAt(followed);
    if (this.stage.automatic && this.stage.approach(this.interest.wanted(), 1 - Math.exp(-8 * passed), this.interest.following)) {
      requestAnimationFrame(() => this.stage.invalidate());
    }
    const { model, frame } = this.session;
    if (!model || !frame) return;
    const pixelsPerUnit = this.stage.height / this.stage.seenHeight;
    this.labels.update(frame.scene, (point) => this.stage.project(point), pixelsPerUnit);
    this.drawRing();
    this.grid.hidden = !this.stage.isFlat || !this.gridShown;
    if (!this.grid.hidden) this.drawGrid(model, frame);
  }

  /** Around what is selected. */
  private drawRing(): void {
    const place = this.selected && this.hand.placeOf(this.selected);
    const at = place && this.stage.project(place);
    this.ring.hidden = !at?.visible;
    if (!place || !at?.visible) return;
    const radius = Math.max(9, this.sizeOf(this.selected!) / this.stage.pixelAt(place) + 4);
    this.ring.style.transform = `translate(${at.x - radius}px, ${at.y - radius}px)`;
    this.ring.style.width = this.ring.style.height = `${2 * radius}px`;
  }

  private sizeOf({ kind, index }: Thing): number {
    const { model, frame } = this.session;
    if (kind === "body") return model?.bodies ? radiusOf(model.bodies)(index) : 0;
    const item = model?.drawing[index];
    if (!item || !frame) return 0;
    if (item.shape === "box") return Math.hypot(numberOf(item, frame.scene, "size", 1, 0), numberOf(item, frame.scene, "size", 1, 1)) / 2;
    return Math.abs(numberOf(item, frame.scene, "radius", 0));
  }

  /** Where the picture stands still its grid is drawn once. */
  private drawGrid(model: ModelMessage, frame: Frame): void {
    const { stage, grid } = this;
    const floors = model.drawing
      .filter((item) => item.shape === "floor")
      .map((item) => ({ height: numberOf(item, frame.scene, "height", 0), color: item.color ?? null }));
    const { x, y } = stage.target;
    const height = stage.seenHeight;
    const drawn = [x, y, height, stage.width, stage.height, window.devicePixelRatio, document.documentElement.className, this.theme, ...floors.map((floor) => floor.height)].join();
    if (drawn === this.gridDrawn) return;
    this.gridDrawn = drawn;
    const style = getComputedStyle(this.element);
    const color = (name: string): string => style.getPropertyValue(name).trim();
    drawGrid(grid, { centre: [x, y], height, width: (height * stage.width) / stage.height }, floors, {
      line: color("--grid"), axis: color("--grid-axis"), text: color("--muted"), floor: color("--floor"), floorLine: color("--floor-line"),
    });
  }

  private select(thing: Thing | null): void {
    this.stage.invalidate();
    this.selected = thing;
    this.following = this.following && thing;
    this.asked = -Infinity;
    this.card.hidden = thing === null;
    if (!thing) return;
    this.card.replaceChildren();
    if (thing.kind === "item") this.tellItem();
    else this.askBody();
  }

  private asked = -Infinity;

  /** The state of the picked body, as it moves on. */
  private askBody(): void {
    if (this.selected?.kind !== "body" || !this.session.live || performance.now() - this.asked < 100) return;
    this.asked = performance.now();
    this.session.send({ do: "pick", body: this.selected.index });
  }

  /** The camera goes with what is selected, or stays again. */
  toggleFollow(): void {
    this.following = this.following ? null : this.selected;
    this.card.classList.toggle("followed", this.following !== null);
    this.stage.invalidate();
  }

  private tellItem(): void {
    const { model, frame } = this.session;
    if (!model || !frame || this.selected?.kind !== "item") return;
    const item = model.drawing[this.selected.index];
    if (!item) return;
    const point = pointOf(item, frame.scene, "at").slice(0, model.dimension).map((number) => formatNumber(number, 4));
    const words = `${item.label ?? item.shape} at (${point.join(", ")})${item.drag ? " · drag it, or move it with the arrow keys" : ""}`;
    setText(this.card, words);
  }

  private tellBody({ t, body, name, values }: { t: number; body: number; name: string; values: Record<string, number> }): void {
    if (this.selected?.kind !== "body" || body !== this.selected.index) return;
    const row = (what: string, value: string): HTMLElement => make("tr", {}, make("th", { scope: "row" }, formatName(what)), make("td", {}, value));
    const rows = bodyOrder(Object.keys(values)).map((key) => row(key, formatSteady(values[key]!, 5)));
    const title = name ? `${name} · ${body + 1}` : `Body ${body + 1}`;
    this.card.replaceChildren(make("b", {}, title), make("table", {}, make("tbody", {}, row("t", formatSteady(t, 5)), ...rows)), make("small", {}, "v: the camera follows it"));
  }

  /** Pictures drawn so far: tests and the measurement of the rate read it. */
  get drawn(): number {
    return this.stage.drawn;
  }

  /** Where a point of the model is on the page. */
  onPage(point: [number, number, number]): { x: number; y: number } {
    const box = this.stage.surface.element.getBoundingClientRect();
    const { x, y } = this.stage.project(point);
    return { x: box.left + x, y: box.top + y };
  }

}
