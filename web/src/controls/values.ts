// Every variable's value at the shown instant.
import { make, setText } from "../dom";
import { formatName, formatSteady, formatUnit } from "../format";
import type { ModelMessage } from "../protocol";
import type { Session } from "../session";

const most = 60;

export class ValueTable {
  readonly element = make("table", { class: "values" });
  private readonly time = make("td", { class: "number" });
  private cells: { column: number; cell: HTMLElement }[] = [];
  private queued = 0;

  constructor(private readonly session: Session) {
    for (const name of ["frame", "cursor"] as const) session.on(name, () => (this.queued ||= requestAnimationFrame(() => this.update())));
  }

  open(model: ModelMessage): void {
    const body = make("tbody", {}, make("tr", {}, make("th", { scope: "row" }, "t"), this.time, make("td", { class: "unit" }, formatUnit(model.time_unit))));
    this.cells = [];
    model.columns.forEach(({ name, unit, kind }, column) => {
      if (kind === "distance" || kind === "curve" || this.cells.length >= most) return;
      const cell = make("td", { class: "number" });
      this.cells.push({ column, cell });
      body.append(make("tr", {}, make("th", { scope: "row", title: `${kind} ${name}` }, kind === "drift" ? "energy drift" : formatName(name)), cell, make("td", { class: "unit" }, formatUnit(unit))));
    });
    const left = model.columns.length - this.cells.length;
    const note = left > 2 ? make("caption", {}, `${left} more can be plotted and saved`) : null;
    this.element.replaceChildren(...(note ? [note] : []), body);
  }

  private update(): void {
    this.queued = 0;
    if (this.element.offsetParent === null) return;
    const t = this.session.shownTime;
    setText(this.time, formatSteady(t, 6));
    for (const { column, cell } of this.cells) setText(cell, formatSteady(this.session.history.valueAt(column, t), 5));
  }
}
