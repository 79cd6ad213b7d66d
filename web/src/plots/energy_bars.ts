// The energies at the shown instant, as bars that share one scale.
import { make, setText } from "../dom";
import { formatName, formatSteady, formatUnit } from "../format";
import { curveColor, type Theme } from "../palette";
import type { Series } from "../protocol";
import type { Session } from "../session";

export class EnergyBars {
  readonly element: HTMLElement;
  private readonly rows: { series: Series; bar: HTMLElement; value: HTMLElement }[];
  private largest = 0;

  constructor(
    private readonly session: Session,
    energies: readonly Series[],
    theme: Theme,
  ) {
    const body = make("div", { class: "bars" });
    this.rows = energies.map((series, index) => {
      const bar = make("i", { style: `background: ${curveColor(theme, index)}` });
      const value = make("span", { class: "number" });
      const name = series.label === "energy" ? "sum" : formatName(series.label);
      body.append(make("span", { class: "name", title: series.label }, name), make("span", { class: "track" }, bar), value);
      return { series, bar, value };
    });
    const unit = formatUnit(energies[0]?.unit ?? "");
    this.element = make("figure", { class: "plot-card bars-card", "aria-label": "Energies now" }, make("figcaption", {}, make("b", {}, unit ? `Energy now [${unit}]` : "Energy now")), body);
    session.on("model", () => (this.largest = 0));
  }

  update(): void {
    const { history, shownTime } = this.session;
    const values = this.rows.map(({ series }) => history.valueAt(series.column, shownTime));
    for (const value of values) if (Math.abs(value) < Infinity) this.largest = Math.max(this.largest, Math.abs(value));
    const negative = values.some((value) => value < 0) || this.element.classList.contains("signed");
    this.element.classList.toggle("signed", negative);
    this.rows.forEach(({ bar, value }, index) => {
      const part = this.largest > 0 ? Math.min(1, Math.abs(values[index]!) / this.largest) : 0;
      const share = (Number.isFinite(part) ? part : 0) * (negative ? 50 : 100);
      bar.style.width = `${share}%`;
      bar.style.left = negative ? (values[index]! < 0 ? `${50 - share}%` : "50%") : "0";
      setText(value, formatSteady(values[index]!, 4));
    });
  }
}
