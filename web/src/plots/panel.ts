// The plots below the scene: which there are, their frames, legends and buttons.
import { iconButton, make } from "../dom";
import { formatName } from "../format";
import type { Theme } from "../palette";
import type { ModelMessage } from "../protocol";
import type { Session } from "../session";
import { EnergyBars } from "./energy_bars";
import { csv, savePicture, saveText } from "./export";
import { Figure, type Look } from "./figure";
import { choosePlot } from "./choose";
import { defaultSpecs, distanceSpec, energiesOf, specText, type PlotSpec } from "./specs";

interface Shown {
  figure: Figure;
  card: HTMLElement;
}

export class PlotPanel {
  readonly element = make("section", { class: "plots", "aria-label": "Plots" });
  private readonly cards = make("div", { class: "plot-cards" });
  private readonly windowChoice = make("select", { "aria-label": "Window of time", title: "How much of the run the plots show" });
  private specs: PlotSpec[] = [];
  private added: PlotSpec[] = [];
  private shown: Shown[] = [];
  private bars: EnergyBars | null = null;
  private windowLength = Infinity;
  private dirty = true;
  private queued = 0;
  private last = 0;
  private theme: Theme;
  /** Called when a person adds or removes a plot. */
  changed = (): void => {};

  constructor(
    private readonly session: Session,
    theme: Theme,
  ) {
    this.theme = theme;
    const bar = make(
      "div",
      { class: "plots-bar" },
      make("h2", {}, "Plots"),
      make("label", {}, "window ", this.windowChoice),
      make("span", { class: "grow" }),
      iconButton("add", "Add a plot", "", () => this.choose()),
      iconButton("table", "Save the run as CSV", "", () => this.saveRun()),
    );
    this.element.append(bar, this.cards);
    this.windowChoice.addEventListener("change", () => this.setWindow(Number(this.windowChoice.value)));
    new ResizeObserver(() => this.resize()).observe(this.cards);
    session.on("model", (model) => this.open(model));
    session.on("frame", () => this.invalidate());
    session.on("event", () => this.invalidate());
    session.on("cursor", () => this.showCursor());
    session.on("state", (state) => {
      const has = this.specs.some(({ id }) => id === "distance");
      if ((state.ghost !== null) !== has && session.model) this.rebuild();
    });
    session.on("theme", (now) => {
      this.theme = now;
      this.rebuild();
    });
  }

  get customPlots(): string[] {
    return [...this.replaced.values(), ...this.added].map(specText);
  }

  add(spec: PlotSpec): void {
    this.added.push(spec);
    this.rebuild();
  }

  /** After a change of the page's letter size. */
  restyle(): void {
    this.rebuild();
  }

  private open(model: ModelMessage): void {
    this.added = [];
    this.replaced.clear();
    this.hidden.clear();
    const { from, to } = model.experiment;
    const span = Number.isFinite(to - from) && to > from ? to - from : Infinity;
    const choices: [string, number][] = Number.isFinite(span)
      ? [["whole run", Infinity], [`${Number((span / 10).toPrecision(3))} ${model.time_unit}`, span / 10], [`${Number((span / 3).toPrecision(3))} ${model.time_unit}`, span / 3], [`${Number(span.toPrecision(6))} ${model.time_unit}`, span], [`${Number((3 * span).toPrecision(6))} ${model.time_unit}`, 3 * span]]
      : [["whole run", Infinity]];
    this.windowChoice.replaceChildren(...choices.map(([text, value]) => make("option", { value }, text)));
    this.windowLength = span;
    this.windowChoice.value = String(span);
    this.element.classList.toggle("alone", model.drawing.length === 0 && !model.bodies);
    this.rebuild();
  }

  private setWindow(length: number): void {
    this.windowLength = length;
    for (const { figure } of this.shown) figure.window = length;
    this.invalidate();
  }

  private rebuild(): void {
    const model = this.session.model;
    for (const { figure } of this.shown) figure.destroy();
    this.shown = [];
    this.cards.replaceChildren();
    if (!model) return;
    const distance = this.session.state?.ghost ? distanceSpec(model.columns) : null;
    this.specs = [...defaultSpecs(model), ...(distance ? [distance] : [])].map((spec) => this.replaced.get(spec.id) ?? spec);
    this.specs.splice(this.specs.length - (distance ? 1 : 0), 0, ...this.added);
    this.element.classList.toggle("ghosted", distance !== null);
    const look = this.look();
    for (const spec of this.specs) if (!this.hidden.has(spec.id)) this.show(spec, look);
    const energies = energiesOf(model.columns);
    this.bars = energies.length > 1 ? new EnergyBars(this.session, energies, this.theme) : null;
    if (this.bars) {
      const energy = this.shown.find(({ figure }) => figure.spec.id === "energy");
      if (energy) energy.card.after(this.bars.element);
      else this.cards.append(this.bars.element);
    }
    this.dirty = true;
    this.resize();
  }

  private readonly hidden = new Set<string>();
  /** What stands in the place of the model's own plots. */
  private readonly replaced = new Map<string, PlotSpec>();

  private show(spec: PlotSpec, look: Look): void {
    const host = make("div", { class: "plot-host", role: "img", "aria-label": `Plot: ${spec.title}` });
    const legend = make("span", { class: "legend" });
    const card = make(
      "figure",
      { class: `plot-card ${spec.against ? "phase" : ""}`, "data-plot": spec.id },
      make(
        "figcaption",
        {},
        make("b", { title: spec.title }, formatName(spec.title)),
        legend,
        make(
          "span",
          { class: "plot-buttons" },
          make("button", { type: "button", class: "small", title: "Choose what is plotted against what", "aria-label": `Axes of “${spec.title}”`, onclick: () => this.chooseAxes(spec) }, "axes"),
          this.logButton(spec),
          iconButton("picture", `Save “${spec.title}” as PNG`, "", () => this.savePlot(spec)),
          iconButton("table", `Save “${spec.title}” as CSV`, "", () => this.saveColumns(spec)),
          iconButton("close", `Close “${spec.title}”`, "", () => this.close(spec)),
        ),
      ),
      host,
    );
    this.cards.append(card);
    const figure = new Figure(spec, this.session, host, look, this.windowLength);
    if (spec.curves.length > 1) {
      spec.curves.slice(0, 8).forEach(({ label }, index) => legend.append(make("i", { style: `--color: ${figure.color(index)}` }), spec.id === "energy" && label === "energy" ? "sum" : formatName(label)));
    }
    this.shown.push({ figure, card });
  }

  private logButton(spec: PlotSpec): HTMLButtonElement {
    const on = spec.log?.y ?? false;
    const button = make("button", { type: "button", class: "small log", title: "Logarithmic axis, for the absolute values", "aria-label": `Logarithmic axis of “${spec.title}”`, "aria-pressed": String(on), onclick: () => {
      this.change(spec, { ...spec, log: { x: spec.log?.x ?? false, y: !on } });
    } }, "log");
    return button;
  }

  private close(spec: PlotSpec): void {
    const index = this.added.indexOf(spec);
    if (index >= 0) this.added.splice(index, 1);
    else this.hidden.add(spec.id);
    this.rebuild();
    this.changed();
  }

  /** Another plot in the place of one. */
  private change(spec: PlotSpec, other: PlotSpec): void {
    const index = this.added.indexOf(spec);
    if (index >= 0) this.added[index] = { ...other, id: spec.id };
    else this.replaced.set(spec.id, { ...other, id: spec.id });
    this.rebuild();
    this.changed();
  }

  private chooseAxes(spec: PlotSpec): void {
    const model = this.session.model;
    if (model) choosePlot(model.columns, (other) => this.change(spec, other), spec);
  }

  private choose(): void {
    const model = this.session.model;
    if (!model) return;
    choosePlot(model.columns, (spec) => {
      this.add(spec);
      this.changed();
      this.shown.at(-1)?.card.scrollIntoView({ block: "nearest" });
    });
  }

  private saveRun(): void {
    const { model, history } = this.session;
    if (model) saveText(`${model.name}.csv`, csv(history, model.columns, model.columns.map((_, index) => index), model.time_unit));
  }

  private saveColumns(spec: PlotSpec): void {
    const { model, history } = this.session;
    if (!model) return;
    const columns = [...(spec.against ? [spec.against.column] : []), ...spec.curves.map(({ column }) => column)];
    saveText(`${model.name}_${spec.id}.csv`, csv(history, model.columns, columns, model.time_unit));
  }

  private savePlot(spec: PlotSpec): void {
    const shown = this.shown.find(({ figure }) => figure.spec === spec);
    const canvas = shown?.figure.plot.ctx.canvas;
    if (!canvas || !this.session.model) return;
    const look = this.look();
    const ratio = canvas.width / (canvas.clientWidth || canvas.width);
    const head = Math.round(1.8 * look.rem * ratio);
    const whole = make("canvas", { width: canvas.width, height: canvas.height + head });
    const context = whole.getContext("2d")!;
    context.fillStyle = look.background;
    context.fillRect(0, 0, whole.width, whole.height);
    context.drawImage(canvas, 0, head);
    context.font = `600 ${0.85 * look.rem * ratio}px ${getComputedStyle(this.element).fontFamily}`;
    context.textBaseline = "middle";
    let x = 0.7 * look.rem * ratio;
    const write = (text: string, color: string): void => {
      context.fillStyle = color;
      context.fillText(text, x, head / 2 + 2);
      x += context.measureText(text).width + 0.8 * look.rem * ratio;
    };
    write(formatName(spec.title), look.ink);
    if (spec.curves.length > 1) spec.curves.forEach(({ label }, index) => write(`— ${formatName(label)}`, shown.figure.color(index)));
    savePicture(`${this.session.model.name}_${spec.id}.png`, whole);
  }

  private look(): Look {
    const style = getComputedStyle(this.element);
    const color = (name: string): string => style.getPropertyValue(name).trim();
    const rem = parseFloat(getComputedStyle(document.documentElement).fontSize) || 16;
    return {
      theme: this.theme, rem, ink: color("--ink"), muted: color("--muted"), grid: color("--grid"), event: color("--event"), background: color("--panel"),
      font: `${0.75 * rem}px ${style.fontFamily}`,
    };
  }

  private resize(): void {
    for (const { figure } of this.shown) figure.resize();
    this.dirty = true;
    this.invalidate();
  }

  /** Redraws soon: at the rate of pictures while that is cheap, else less often. */
  invalidate(): void {
    this.dirty = true;
    this.queued ||= requestAnimationFrame(() => this.draw());
  }

  private cost = 0;

  private draw(): void {
    this.queued = 0;
    if (!this.dirty || this.element.offsetParent === null) return;
    const now = performance.now();
    // Plots may take a quarter of the time; the scene comes first.
    if (now - this.last < Math.max(30, 4 * this.cost)) {
      this.queued = requestAnimationFrame(() => this.draw());
      return;
    }
    this.last = now;
    this.dirty = false;
    for (const { figure } of this.shown) figure.update();
    this.bars?.update();
    this.cost = performance.now() - now;
  }

  private showCursor(): void {
    for (const { figure } of this.shown) figure.showCursor();
    this.bars?.update();
  }
}

