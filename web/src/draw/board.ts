// Drawing a world by hand: what the pointer or the keys put down, move and take away becomes text of the model, and the
// text runs. The text is the truth: what is shown here is read from it.
import { iconButton, make, setText } from "../dom";
import type { Bodies } from "../protocol";
import type { Session } from "../session";
import { gridStep } from "../scene/fit";
import type { SceneView } from "../scene/view";
import { distanceTo, fromSegment, room, wallThrough, type Disc, type HalfPlane } from "./geometry";
import { addBody, addSpring, addWall, moveTo, moveWall, remove, worldOf, type Change, type Item, type Place, type WorldText } from "./world_text";

/** What the board needs of the editor. */
export interface Paper {
  readonly text: string;
  /** Changes the text, in one step of its undoing, and runs it. */
  write(changes: readonly Change[]): void;
  undo(): void;
  redo(): void;
}

type Tool = "move" | "ball" | "wall" | "spring" | "delete";

const tools: readonly { tool: Tool; key: string; icon: string; words: string; how: string }[] = [
  { tool: "move", key: "m", icon: "hand", words: "Move", how: "Drag a ball, a wall or the end of a spring." },
  { tool: "ball", key: "b", icon: "ball", words: "Ball", how: "Click for a ball; drag for its size." },
  { tool: "wall", key: "w", icon: "wall", words: "Wall", how: "Drag along the wall. It has no ends." },
  { tool: "spring", key: "s", icon: "spring", words: "Spring", how: "Drag from a ball to another one, or to a point." },
  { tool: "delete", key: "d", icon: "eraser", words: "Delete", how: "Click on what is to go." },
];

const nearPixels = 12;

export class Board {
  readonly element: HTMLElement;
  /** Told when drawing begins and ends. */
  toggled = (_on: boolean): void => {};
  private readonly layer: HTMLElement;
  private readonly preview = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  private readonly hint = make("p", { class: "draw-hint", role: "status" });
  private readonly buttons = new Map<Tool, HTMLButtonElement>();
  private tool: Tool = "ball";
  private on = false;
  private view: number[] | null = null;
  private from: Place | null = null;
  private at: Place = { x: 0, y: 0 };
  private taken: Item | null = null;

  constructor(
    private readonly session: Session,
    private readonly scene: SceneView,
    private readonly paper: Paper,
  ) {
    this.preview.setAttribute("aria-hidden", "true");
    this.layer = make("div", { class: "draw-layer", tabindex: 0, role: "application", "aria-label": "Drawing: arrow keys move the cross, Enter presses and lets go" });
    this.layer.append(this.preview);
    for (const { tool, key, icon, words } of tools) {
      const button = iconButton(icon, words, key, () => this.choose(tool));
      button.append(make("span", {}, words));
      this.buttons.set(tool, button);
    }
    const bar = make(
      "div",
      { class: "draw-bar", role: "toolbar", "aria-label": "Drawing" },
      ...this.buttons.values(),
      iconButton("undo", "Undo", "Ctrl+Z", () => this.paper.undo()),
      iconButton("redo", "Redo", "Ctrl+Y", () => this.paper.redo()),
      make("button", { type: "button", class: "primary", onclick: () => this.play() }, "Play"),
      make("button", { type: "button", class: "framed", onclick: () => this.end() }, "Done"),
    );
    this.element = make("div", { class: "draw", hidden: true }, this.layer, bar, this.hint);
    this.listen();
    session.on("model", () => this.arrived());
    session.on("frame", () => this.on && this.redraw());
  }

  get active(): boolean {
    return this.on;
  }

  /** Whether the model shown has a world in the plane to draw in. */
  get possible(): boolean {
    return this.session.live && this.session.model?.dimension === 2 && worldOf(this.paper.text) !== null;
  }

  begin(): void {
    if (this.on || !this.possible) return;
    this.on = true;
    this.element.hidden = false;
    this.toStart();
    this.toggled(true);
    this.scene.fit();
    this.choose("ball");
    this.layer.focus();
    // When the picture has taken its new size it stands still.
    window.setTimeout(() => {
      if (this.on && this.scene.stage.automatic) this.holdView();
    }, 500);
  }

  private holdView(): void {
    this.view = this.scene.stage.view;
    this.scene.stage.automatic = false;
  }

  end(): void {
    if (!this.on) return;
    this.on = false;
    this.view = null;
    this.element.hidden = true;
    this.drop();
    this.scene.fit();
    this.toggled(false);
  }

  private play(): void {
    this.end();
    this.session.send({ do: "play" });
  }

  /** The text says where things are at the start. */
  private toStart(): void {
    if (this.session.state?.playing) this.session.send({ do: "pause" });
    this.session.send({ do: "reset" });
  }

  /** After each change another model comes: the picture stays where it was. */
  private arrived(): void {
    if (!this.on) return;
    if (!this.possible) return this.end();
    if (this.view) this.scene.stage.view = this.view;
    this.redraw();
  }

  private choose(tool: Tool): void {
    this.tool = tool;
    this.drop();
    for (const [name, button] of this.buttons) button.setAttribute("aria-pressed", String(name === tool));
    this.say(tools.find((each) => each.tool === tool)!.how);
    this.layer.dataset["tool"] = tool;
  }

  private say(words: string, bad = false): void {
    setText(this.hint, words);
    this.hint.classList.toggle("bad", bad);
  }

  private drop(): void {
    this.from = null;
    this.taken = null;
    this.redraw();
  }

  // ---- pointer and keys -----------------------------------------------------------------------------------------------

  private listen(): void {
    const { layer } = this;
    layer.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || !event.isPrimary) return;
      layer.setPointerCapture(event.pointerId);
      this.at = this.placeOf(event);
      this.press();
    });
    layer.addEventListener("pointermove", (event) => {
      if (!event.isPrimary) return;
      this.at = this.placeOf(event);
      this.redraw();
    });
    layer.addEventListener("pointerup", (event) => {
      if (!event.isPrimary || !this.from) return;
      this.at = this.placeOf(event);
      this.release();
    });
    layer.addEventListener("pointercancel", () => this.drop());
    layer.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.scene.stage.zoom(event.deltaY < 0 ? 1.1 : 1 / 1.1);
      this.view = this.scene.stage.view;
      this.redraw();
    }, { passive: false });
    this.element.addEventListener("keydown", (event) => this.key(event));
  }

  private key(event: KeyboardEvent): void {
    const undoes = event.ctrlKey || event.metaKey;
    const step = (event.shiftKey ? 1 : 8) * this.pixel;
    const way: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const tool = tools.find(({ key }) => key === event.key);
    const moved = way[event.key];
    if (undoes && event.key === "z") this.paper.undo();
    else if (undoes && event.key === "y") this.paper.redo();
    else if (undoes || event.altKey) return;
    else if (event.key === "Escape") this.from ? this.drop() : this.end();
    else if (event.target === this.layer && moved) this.at = { x: this.at.x + step * moved[0], y: this.at.y + step * moved[1] };
    else if (event.target === this.layer && event.key === "Enter") this.from ? this.release() : this.press();
    else if (event.key === "Delete") this.take(this.under(this.at));
    else if (tool) this.choose(tool.tool);
    else return;
    event.preventDefault();
    event.stopPropagation();
    this.redraw();
  }

  private placeOf(event: PointerEvent): Place {
    const box = this.layer.getBoundingClientRect();
    const { stage } = this.scene;
    const scale = stage.seenHeight / stage.height;
    return { x: stage.target.x + (event.clientX - box.left - box.width / 2) * scale, y: stage.target.y - (event.clientY - box.top - box.height / 2) * scale };
  }

  private press(): void {
    const { model, frame } = this.session;
    if (!model || !frame) return;
    if (frame.t > model.experiment.from) {
      this.toStart();
      return this.say("Back at the start: that is what the text describes. Draw now.");
    }
    if (this.tool === "delete") return this.take(this.under(this.at));
    this.taken = this.tool === "move" || this.tool === "spring" ? this.under(this.at, this.tool === "spring") : null;
    if (this.tool === "move" && !this.taken) return this.say("There is nothing to move here.", true);
    this.from = this.at;
    this.redraw();
  }

  private release(): void {
    const from = this.from;
    this.from = null;
    if (!from) return;
    const finish: Record<Tool, (from: Place) => void> = { move: () => this.move(), ball: (place) => this.ball(place), wall: (place) => this.wall(place), spring: (place) => this.spring(place), delete: () => undefined };
    finish[this.tool](from);
    this.taken = null;
    this.redraw();
  }

  // ---- what the gestures do ---------------------------------------------------------------------------------------------

  private ball(from: Place): void {
    const world = this.world;
    if (!world) return;
    const dragged = Math.hypot(this.at.x - from.x, this.at.y - from.y);
    const place = this.rounded(from);
    const free = room(place, this.discs, this.walls);
    const wanted = dragged > nearPixels * this.pixel ? dragged : 0.04 * this.scene.stage.seenHeight;
    const radius = this.down(Math.min(wanted, free));
    if (!(radius > 0.2 * this.unit)) return this.say("There is no room for a ball here.", true);
    const { name, changes } = addBody(this.paper.text, world, place, radius, this.digits);
    this.write(changes, `${name} is in the text.`);
  }

  private wall(from: Place): void {
    const world = this.world;
    if (!world) return;
    if (Math.hypot(this.at.x - from.x, this.at.y - from.y) < 2 * nearPixels * this.pixel) return this.say("Drag along the wall: from one point of it to another.", true);
    const wall = wallThrough(from, this.at, this.discs, (value) => this.round(value));
    if (wall === null) return;
    if (wall === "cuts") return this.say("A wall here would cut a ball.", true);
    const { name, changes } = addWall(this.paper.text, world, wall.normal, wall.offset, wall.thin, this.digits);
    this.write(changes, wall.thin ? `${name} is in the text: thin, since there are balls on both sides.` : `${name} is in the text.`);
  }

  private spring(from: Place): void {
    const world = this.world;
    if (!world) return;
    const first = this.taken?.kind === "body" ? this.taken : null;
    const under = this.under(this.at, true);
    const second = under?.kind === "body" && under !== first && under.name !== first?.name ? under : null;
    const body = first ?? second;
    if (!body) return this.say("A spring begins or ends at a ball.", true);
    if (first && second) {
      const { changes } = addSpring(this.paper.text, world, first.name, second.name, this.digits);
      return this.write(changes, `A spring between ${first.name} and ${second.name} is in the text.`);
    }
    const point = this.rounded(first ? this.at : from);
    const centre = body.at ?? point;
    if (Math.hypot(point.x - centre.x, point.y - centre.y) < 2 * nearPixels * this.pixel) return this.say("Drag from a ball to another one, or to a point away from it.", true);
    const { changes } = addSpring(this.paper.text, world, body.name, point, this.digits);
    this.write(changes, `A spring from ${body.name} to a point is in the text.`);
  }

  private move(): void {
    const item = this.taken;
    const moved = item && this.movedPlace(item);
    if (!item || moved === null) return;
    if (moved === "full") return this.say("There is no room for it there.", true);
    this.write(moved.changes, "Moved.");
  }

  /** What the taken item's numbers become where it is let go now. */
  private movedPlace(item: Item): { place: Place; changes: Change[] } | "full" | null {
    if (item.kind === "wall") {
      const size = Math.hypot(item.normal.x, item.normal.y);
      const offset = this.round(item.normal.x * this.at.x + item.normal.y * this.at.y);
      const wall = { normal: { x: item.normal.x / size, y: item.normal.y / size }, offset: offset / size, thin: false };
      const before = { ...wall, offset: item.offset / size };
      // Each ball stays on its side.
      if (this.discs.some((disc) => Math.sign(distanceTo(before, disc)) * distanceTo(wall, disc) < disc.radius)) return "full";
      return { place: this.at, changes: moveWall(item, offset, this.digits) };
    }
    if (!item.numbers) {
      this.say(`Its place is no plain number: change it in the text, in line ${this.paper.text.slice(0, item.from).split("\n").length}.`, true);
      return null;
    }
    const place = this.rounded(this.at);
    if (item.kind === "body") {
      const index = this.indexOf(item.name);
      const others = this.discs.filter((_, each) => each !== index);
      if (room(place, others, this.walls) < (this.discs[index]?.radius ?? 0)) return "full";
    } else if (Math.hypot(...this.centreOf(item.a, place)) < nearPixels * this.pixel) {
      return "full";
    }
    return { place, changes: moveTo(item, place, this.digits) };
  }

  private take(item: Item | null): void {
    const world = this.world;
    if (!world || !item) return this.say("There is nothing to delete here.", true);
    const changes = remove(this.paper.text, world, item);
    if (!Array.isArray(changes)) return this.say(`The text reads ${changes.name} in line ${changes.readIn}: change that first.`, true);
    this.write(changes, item.kind === "spring" ? "The spring is gone." : `${item.name || "It"} is gone.`);
  }

  private write(changes: readonly Change[], words: string): void {
    this.holdView();
    this.paper.write(changes);
    this.say(words);
  }

  // ---- what is there ------------------------------------------------------------------------------------------------------

  private get world(): WorldText | null {
    return worldOf(this.paper.text);
  }

  private get bodies(): Bodies | null {
    return this.session.model?.bodies ?? null;
  }

  private get discs(): Disc[] {
    const positions = this.session.frame?.positions;
    const bodies = this.bodies;
    if (!positions || !bodies) return [];
    return Array.from({ length: bodies.count }, (_, i) => ({ x: positions[2 * i]!, y: positions[2 * i + 1]!, radius: typeof bodies.radius === "number" ? bodies.radius : bodies.radius[i]! }));
  }

  private get walls(): HalfPlane[] {
    return (this.bodies?.walls ?? []).map(({ normal, offset, thin }) => {
      const [x, y] = normal as [number, number];
      const size = Math.hypot(x, y);
      return { normal: { x: x / size, y: y / size }, offset: offset / size, thin: thin ?? false };
    });
  }

  private indexOf(name: string): number {
    return this.bodies?.names?.indexOf(name) ?? -1;
  }

  private centreOf(name: string, from: Place): [number, number] {
    const disc = this.discs[this.indexOf(name)];
    return disc ? [disc.x - from.x, disc.y - from.y] : [Infinity, Infinity];
  }

  /** The item of the text that is shown at a place. */
  private under(at: Place, bodiesOnly = false): Item | null {
    const items = this.world?.items ?? [];
    const near = nearPixels * this.pixel;
    const { discs } = this;
    const body = items.find((item) => item.kind === "body" && Math.hypot(...this.centreOf(item.name, at)) < Math.max(near, discs[this.indexOf(item.name)]?.radius ?? 0));
    if (body || bodiesOnly) return body ?? null;
    const spring = items.find((item) => {
      if (item.kind !== "spring") return false;
      const a = discs[this.indexOf(item.a)];
      const b = typeof item.b === "string" ? discs[this.indexOf(item.b)] : item.b;
      return a !== undefined && b !== undefined && fromSegment(at, a, b) < near;
    });
    if (spring) return spring;
    return items.find((item) => item.kind === "wall" && Math.abs(item.normal.x * at.x + item.normal.y * at.y - item.offset) < near * Math.hypot(item.normal.x, item.normal.y)) ?? null;
  }

  // ---- numbers that one would write ---------------------------------------------------------------------------------------

  private get pixel(): number {
    return this.scene.stage.seenHeight / this.scene.stage.height;
  }
  /** Places are multiples of this: about five pixels. */
  private get unit(): number {
    return gridStep(this.scene.stage.seenHeight, 120);
  }
  private get digits(): number {
    return Math.max(0, -Math.floor(Math.log10(this.unit) + 1e-9));
  }
  private round(value: number): number {
    return Number((Math.round(value / this.unit) * this.unit).toFixed(this.digits + 1));
  }
  /** A radius that surely fits: rounded down. */
  private down(value: number): number {
    const step = this.unit / 2;
    return Number((Math.floor(value / step + 1e-6) * step).toFixed(this.digits + 1));
  }
  private rounded({ x, y }: Place): Place {
    return { x: this.round(x), y: this.round(y) };
  }

  // ---- the preview --------------------------------------------------------------------------------------------------------

  private redraw(): void {
    if (!this.on) return this.preview.replaceChildren();
    const toPage = ({ x, y }: Place): Place => this.scene.stage.project([x, y, 0]);
    const element = (name: string, attributes: Record<string, number>): SVGElement => {
      const made = document.createElementNS(this.preview.namespaceURI, name) as SVGElement;
      for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
      return made;
    };
    const line = (a: Place, b: Place): SVGElement => element("line", { x1: a.x, y1: a.y, x2: b.x, y2: b.y });
    const at = toPage(this.at);
    const shown: SVGElement[] = [line({ x: at.x - 8, y: at.y }, { x: at.x + 8, y: at.y }), line({ x: at.x, y: at.y - 8 }, { x: at.x, y: at.y + 8 })];
    if (this.from) {
      const from = toPage(this.from);
      const along = Math.hypot(at.x - from.x, at.y - from.y);
      if (this.tool === "ball") {
        const free = room(this.from, this.discs, this.walls) / this.pixel;
        shown.push(element("circle", { cx: from.x, cy: from.y, r: Math.max(1, Math.min(free, along > nearPixels ? along : (0.04 * this.scene.stage.seenHeight) / this.pixel)) }));
      } else if (this.tool === "wall" && along > 1) {
        const reach = 3000 / along;
        const way = { x: (at.x - from.x) * reach, y: (at.y - from.y) * reach };
        shown.push(line({ x: from.x - way.x, y: from.y - way.y }, { x: from.x + way.x, y: from.y + way.y }));
      } else if (this.tool === "spring") {
        shown.push(line(from, at));
      } else if (this.tool === "move" && this.taken?.kind === "body") {
        const index = this.indexOf(this.taken.name);
        shown.push(element("circle", { cx: at.x, cy: at.y, r: Math.max(4, (this.discs[index]?.radius ?? 0) / this.pixel) }), line(from, at));
      } else {
        shown.push(line(from, at));
      }
    }
    this.preview.replaceChildren(...shown);
  }
}
