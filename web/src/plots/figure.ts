// One plot: curves of the history against time or against one another, by uPlot.
import uPlot from "uplot";
import { formatName, formatNumber, withUnit } from "../format";
import type { History } from "../history";
import { curveColor, type Theme } from "../palette";
import type { Session } from "../session";
import { atLeast, calm, decades, equalScales, finiteRange, leastDrift, powersBetween, timeWindow, type Range } from "./range";
import type { PlotSpec } from "./specs";

export interface Look {
  theme: Theme;
  ink: string;
  muted: string;
  grid: string;
  event: string;
  background: string;
  font: string;
  rem: number;
}

const none = new Float32Array(0);

export class Figure {
  readonly plot: uPlot;
  private readonly cursor = document.createElement("div");
  private readonly dot = document.createElement("div");
  private ranges = new Map<string, Range>();
  private readonly units: string[];
  /** Powers of ten along an axis, of the size of what is plotted: for errors and distances. */
  private readonly logarithmic: boolean;
  private readonly logarithmicX: boolean;

  constructor(
    readonly spec: PlotSpec,
    private readonly session: Session,
    private readonly host: HTMLElement,
    private readonly look: Look,
    private windowLength: number,
  ) {
    this.logarithmic = spec.log?.y ?? false;
    this.logarithmicX = spec.log?.x ?? false;
    this.units = [...new Set(spec.curves.map(({ unit }) => unit))];
    this.plot = new uPlot(this.options(), this.emptyData(), host);
    this.cursor.className = "now";
    this.dot.className = "now-dot";
    this.plot.over.append(spec.against ? this.dot : this.cursor);
    this.listen();
  }

  set window(length: number) {
    this.windowLength = length;
    this.ranges.clear();
  }

  resize(): void {
    const width = this.host.clientWidth;
    const height = this.host.clientHeight;
    if (width > 0 && height > 0 && (width !== this.plot.width || height !== this.plot.height)) this.plot.setSize({ width, height });
  }

  /** A curve's colour, the same in its legend. */
  color(index: number): string {
    return curveColor(this.look.theme, index);
  }

  update(): void {
    const { history } = this.session;
    const { spec, plot } = this;
    const length = history.length;
    const [from, to] = this.times(history);
    const begin = Math.max(0, history.indexAfter(from) - 1);
    const end = Math.min(length, history.indexAfter(to) + 1);
    const piece = (values: Float32Array | undefined): Float32Array => values?.subarray(begin, end) ?? none;
    const sized = (values: Float32Array): Float32Array => (this.logarithmic ? values.map(sizeOrNone) : values);
    const curves = spec.curves.map(({ column }) => sized(piece(history.columns[column])));
    const ghosts = spec.curves.map(({ column }) => (spec.id === "distance" ? none : sized(piece(history.ghosts[column]))));
    const ranges = new Map<string, Range>();
    spec.curves.forEach(({ unit }, index) => {
      for (const values of [curves[index]!, ghosts[index]!]) {
        const range = finiteRange(values, 0, values.length);
        const before = ranges.get(unit);
        if (range) ranges.set(unit, before ? [Math.min(before[0], range[0]), Math.max(before[1], range[1])] : range);
      }
    });
    for (const unit of this.units) {
      const data = ranges.get(unit);
      const isDrift = spec.id === "drift" && (unit === "" || unit === "1");
      const range = data && isDrift ? atLeast(data, leastDrift(this.session.state?.rtol ?? null)) : data;
      if (range) this.ranges.set(unit, this.logarithmic ? decades(range) : calm(this.ranges.get(unit) ?? null, range));
    }
    if (spec.against) {
      const sizedX = (values: Float32Array): Float32Array => (this.logarithmicX ? values.map(sizeOrNone) : values);
      const xs = sizedX(piece(history.columns[spec.against.column]));
      const range = finiteRange(xs, 0, xs.length);
      if (range) this.ranges.set("x", this.logarithmicX ? decades(range) : calm(this.ranges.get("x") ?? null, range));
      const gx = sizedX(piece(history.ghosts[spec.against.column]));
      plot.setData([null, ...curves.map((ys) => [xs, ys]), ...ghosts.map((ys) => [ys.length > 0 ? gx : none, ys])] as unknown as uPlot.AlignedData, false);
    } else {
      // The start at t = 0 is not on a logarithmic axis: six powers of ten before the end are.
      const firstShown = this.logarithmicX ? Math.max(from, history.t.find((t) => t > 0) ?? to / 10, 1e-6 * to) : from;
      this.ranges.set("x", [firstShown, to > firstShown ? to : 10 * firstShown]);
      const ts = this.logarithmicX ? history.t.slice(begin, end).map((t) => Math.max(t, 1e-300)) : history.t.subarray(begin, end);
      const absent = ghosts.some((ys) => ys.length > 0) ? null : new Float32Array(ts.length).fill(NaN);
      plot.setData([ts, ...curves, ...ghosts.map((ys) => (ys.length > 0 ? ys : (absent ?? ys)))] as unknown as uPlot.AlignedData, false);
    }
    this.setScales();
    this.showCursor();
  }

  /** The shared instant: a line against time, a point in a plane. */
  showCursor(): void {
    const { session, spec, plot } = this;
    const t = session.shownTime;
    const { history } = session;
    if (!spec.against) {
      const x = plot.valToPos(t, "x");
      const seen = Number.isFinite(x) && x >= 0 && x <= plot.over.clientWidth;
      this.cursor.hidden = !seen;
      if (seen) this.cursor.style.transform = `translateX(${x}px)`;
      return;
    }
    const curve = spec.curves[0]!;
    const along = history.valueAt(spec.against.column, t);
    const x = plot.valToPos(this.logarithmicX ? sizeOrNone(along) : along, "x");
    const value = history.valueAt(curve.column, t);
    const y = plot.valToPos(this.logarithmic ? sizeOrNone(value) : value, this.scale(curve.unit));
    const seen = Number.isFinite(x + y);
    this.dot.hidden = !seen;
    if (seen) this.dot.style.transform = `translate(${x}px, ${y}px)`;
  }

  destroy(): void {
    this.plot.destroy();
  }

  private times(history: History): Range {
    return timeWindow(history.first, history.last, this.windowLength);
  }

  private scale(unit: string): string {
    return `y${this.units.indexOf(unit)}`;
  }

  private setScales(): void {
    const { plot, spec } = this;
    const x = this.ranges.get("x") ?? [0, 1];
    const unit = this.units[0]!;
    const y = this.ranges.get(unit);
    if (spec.against && !this.logarithmic && !this.logarithmicX && spec.against.unit === unit && unit !== "" && unit !== "1" && this.units.length === 1 && y && plot.over.clientWidth > 0 && alike(x, y)) {
      const [wideX, wideY] = equalScales(x, y, plot.over.clientWidth, plot.over.clientHeight);
      plot.batch(() => {
        plot.setScale("x", { min: wideX[0], max: wideX[1] });
        plot.setScale(this.scale(unit), { min: wideY[0], max: wideY[1] });
      });
      return;
    }
    plot.batch(() => {
      plot.setScale("x", { min: x[0], max: x[1] });
      for (const each of this.units) {
        const [min, max] = this.ranges.get(each) ?? (this.logarithmic ? [0.1, 1] : [0, 1]);
        plot.setScale(this.scale(each), { min, max });
      }
    });
  }

  private emptyData(): uPlot.AlignedData {
    const count = 2 * this.spec.curves.length;
    const empty = this.spec.against ? [null, ...Array.from({ length: count }, () => [[], []])] : Array.from({ length: count + 1 }, () => []);
    return empty as unknown as uPlot.AlignedData;
  }

  private options(): uPlot.Options {
    const { spec, look, host } = this;
    const phase = spec.against !== null;
    const series = (index: number, ghost: boolean): uPlot.Series => ({
      label: formatName(spec.curves[index]!.label) + (ghost ? " (ghost)" : ""),
      scale: this.scale(spec.curves[index]!.unit),
      ...(phase ? { facets: [{ scale: "x", auto: false }, { scale: this.scale(spec.curves[index]!.unit), auto: false }], paths: wayThroughPlane } : {}),
      stroke: this.color(index),
      alpha: ghost ? 0.55 : 1,
      ...(ghost ? { dash: [6, 4] } : {}),
      width: 2,
      points: { show: false },
    } as uPlot.Series);
    const indices = spec.curves.map((_, index) => index);
    const timeUnit = this.session.model?.time_unit ?? "";
    const axis: uPlot.Axis = {
      stroke: look.muted,
      font: look.font,
      labelFont: look.font,
      labelSize: 1.3 * look.rem,
      labelGap: 0,
      gap: 4,
      grid: { stroke: look.grid, width: 1 },
      ticks: { show: false },
      values: (_, splits) => splits.map((value) => formatNumber(value, 6)),
    };
    return {
      mode: phase ? 2 : 1,
      width: Math.max(50, host.clientWidth),
      height: Math.max(50, host.clientHeight),
      padding: [8, this.units.length > 1 ? 0 : 14, 0, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: false, auto: false, ...(this.logarithmicX ? { distr: 3 } : {}), range: (_u, min, max) => [min, max] },
        ...Object.fromEntries(this.units.map((unit) => [this.scale(unit), { auto: false, ...(this.logarithmic ? { distr: 3 } : {}), range: (_u: uPlot, min: number, max: number) => [min, max] }])),
      } as uPlot.Scales,
      axes: [
        {
          ...axis,
          label: phase ? this.nameOf(spec.against!.label, spec.against!.unit, this.logarithmicX) : withUnit("t", timeUnit),
          ...(this.logarithmicX ? powerAxis : {}),
          size: 1.5 * look.rem,
          space: 4.2 * look.rem,
        },
        ...this.units.slice(0, 2).map((unit, index) => ({
          ...axis,
          scale: this.scale(unit),
          side: index === 0 ? 3 : 1,
          label: this.nameOf(this.namesOf(unit), unit, this.logarithmic),
          ...(this.logarithmic ? powerAxis : {}),
          grid: { ...axis.grid!, show: index === 0 },
          space: 2 * look.rem,
          size: (_u: uPlot, values: string[] | null) => Math.max(2.2, 0.6 + 0.5 * Math.max(0, ...(values ?? []).map((text) => text.length))) * look.rem,
        }) as uPlot.Axis),
      ],
      series: [phase ? (null as unknown as uPlot.Series) : {}, ...indices.map((i) => series(i, false)), ...indices.map((i) => series(i, true))],
      hooks: { drawClear: [(u) => this.paintGround(u)], drawAxes: [(u) => this.drawZero(u)], draw: [(u) => this.drawEvents(u)] },
    };
  }

  /** Of a logarithmic axis the name is that of the size: "|x| [m]". */
  private nameOf(names: string, unit: string, logarithmic: boolean): string {
    return logarithmic ? `|${withUnit(names, unit).replace(/ \[|$/, "|$&")}` : withUnit(names, unit);
  }

  /** What stands beside the axis of a unit. */
  private namesOf(unit: string): string {
    if (this.spec.id === "energy") return "energy";
    const names = this.spec.curves.filter((curve) => curve.unit === unit).map(({ label }) => label);
    return names.length > 3 ? `${names[0]}, …` : names.join(", ");
  }

  private paintGround(u: uPlot): void {
    u.ctx.save();
    u.ctx.fillStyle = this.look.background;
    u.ctx.fillRect(0, 0, u.ctx.canvas.width, u.ctx.canvas.height);
    u.ctx.restore();
  }

  /** The line of zero, where curves cross it: a floor, a rest, no error. */
  private drawZero(u: uPlot): void {
    const { min, max } = u.scales[this.scale(this.units[0]!)]!;
    if (this.logarithmic || !((min ?? 0) < 0 && (max ?? 0) > 0)) return;
    const y = Math.round(u.valToPos(0, this.scale(this.units[0]!), true));
    const { left, width } = u.bbox;
    u.ctx.save();
    u.ctx.fillStyle = this.look.muted;
    u.ctx.globalAlpha = 0.55;
    u.ctx.fillRect(left, y, width, Math.max(1, Math.round(u.ctx.canvas.width / u.width)));
    u.ctx.restore();
  }

  private drawEvents(u: uPlot): void {
    if (this.spec.against) return;
    const { min, max } = u.scales["x"]!;
    const inWindow = this.session.events.filter(({ t }) => t >= (min ?? 0) && t <= (max ?? 0));
    // A clock that ticks hundreds of times says nothing; what the model marks does.
    const seen = inWindow.length > 40 ? inWindow.filter(({ mark }) => mark) : inWindow;
    const { ctx } = u;
    const { left, top, width, height } = u.bbox;
    const ratio = ctx.canvas.width / u.width;
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    ctx.strokeStyle = this.look.event;
    ctx.fillStyle = this.look.event;
    ctx.lineWidth = ratio;
    ctx.textAlign = "left";
    // Many events are a row of ticks: lines would cover the curves.
    const lines = seen.length <= 30;
    ctx.globalAlpha = lines ? 0.8 : 0.45;
    ctx.font = `${0.68 * this.look.rem * ratio}px ${this.look.font.replace(/^\S+\s/, "")}`;
    for (const { t, mark } of seen) {
      const x = Math.round(u.valToPos(t, "x", true)) + 0.5;
      ctx.setLineDash([3 * ratio, 4 * ratio]);
      if (lines) {
        ctx.beginPath();
        ctx.moveTo(x, top);
        ctx.lineTo(x, top + height);
        ctx.stroke();
      }
      ctx.beginPath();
      ctx.moveTo(x - 3.5 * ratio, top);
      ctx.lineTo(x + 3.5 * ratio, top);
      ctx.lineTo(x, top + 6 * ratio);
      ctx.fill();
      if (mark && seen.length <= 8) ctx.fillText(mark, x + 5 * ratio, top + 10 * ratio);
    }
    ctx.restore();
  }

  private listen(): void {
    const { over } = this.plot;
    if (this.spec.against) return;
    let dragging = false;
    const at = (event: PointerEvent): number => this.plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x");
    const inRun = (t: number): number => Math.min(this.session.history.last, Math.max(this.session.history.first, t));
    over.addEventListener("pointermove", (event) => {
      const t = inRun(at(event));
      if (!Number.isFinite(t)) return;
      this.session.setCursor(t);
      if (dragging) this.session.send({ do: "seek", t });
    });
    over.addEventListener("pointerleave", () => this.session.setCursor(null));
    over.addEventListener("pointerdown", (event) => {
      const t = inRun(at(event));
      if (event.button !== 0 || !Number.isFinite(t)) return;
      dragging = true;
      over.setPointerCapture(event.pointerId);
      if (this.session.state?.playing) this.session.send({ do: "pause" });
      this.session.send({ do: "seek", t });
    });
    for (const name of ["pointerup", "pointercancel"] as const) over.addEventListener(name, () => (dragging = false));
  }
}

/** Lines and numbers at powers of ten, some six of them. */
const powerAxis: Partial<uPlot.Axis> = {
  splits: (_u, _axis, min, max) => powersBetween(min, max, 6),
  filter: (_u, splits) => splits,
};

/** What a logarithmic axis can show: a size, if it is any. */
const sizeOrNone = (value: number): number => (Math.abs(value) > 0 ? Math.abs(value) : NaN);

/** Two ranges of one unit that one scale can show. */
const alike = (x: Range, y: Range): boolean => {
  const ratio = (x[1] - x[0]) / (y[1] - y[0]);
  return ratio > 0.1 && ratio < 10;
};

/** A way through the plane, its points in the order of time; uPlot's own curves need growing x. */
const wayThroughPlane = ((u: uPlot, index: number) => {
  const [xs, ys] = u.data[index] as unknown as [Float32Array, Float32Array];
  const path = new Path2D();
  const yScale = (u.series[index] as unknown as { facets: { scale: string }[] }).facets[1]!.scale;
  let pen = false;
  // Beyond a few thousand points neighbours fall on one pixel.
  const stride = Math.max(1, Math.floor(xs.length / 8000));
  for (let i = 0; i < xs.length; i += stride) {
    const x = u.valToPos(xs[i]!, "x", true);
    const y = u.valToPos(ys[i]!, yScale, true);
    if (!Number.isFinite(x + y)) {
      pen = false;
    } else if (pen) {
      path.lineTo(x, y);
    } else {
      path.moveTo(x, y);
      pen = true;
    }
  }
  const clip = new Path2D();
  clip.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
  return { stroke: path, fill: null, clip, band: null, gaps: null, flags: 0 };
}) as unknown as uPlot.Series.PathBuilder;
