// The choice of a method with its step or its tolerance.
import { make } from "../dom";
import { formatNumber, parseNumber } from "../format";
import type { Choice, ModelMessage } from "../protocol";

export interface Chosen {
  method: string | null;
  numbers: { step?: number; rtol?: number };
}

export class MethodChoice {
  readonly element = make("div", { class: "method" });
  opened = (): void => {};
  private readonly list: HTMLSelectElement;
  private readonly number = make("input", { class: "number", type: "text", inputmode: "decimal", autocomplete: "off" });
  private readonly what = make("select", { "aria-label": "Step or tolerance" }, make("option", { value: "step" }, "step"), make("option", { value: "rtol" }, "tolerance"));
  private readonly row: HTMLElement;
  private shown: Choice | null;
  private busyUntil = 0;

  constructor(
    private readonly model: ModelMessage,
    private readonly optional: boolean,
    private readonly change: (chosen: Chosen) => void,
  ) {
    const { methods, experiment } = model;
    this.shown = optional ? null : { method: experiment.method, step: experiment.step, rtol: experiment.rtol };
    const group = (title: string, fixed: boolean): HTMLOptGroupElement =>
      make("optgroup", { label: title }, ...methods.filter((method) => method.fixed === fixed).map(({ name, title: text }) => make("option", { value: name, title: text }, readable(name, text))));
    this.list = make("select", { "aria-label": optional ? "Method of the ghost" : "Method" }, optional ? make("option", { value: "" }, "none") : null, group("with a fixed step", true), group("with adaptive steps", false));
    this.list.addEventListener("change", () => this.choose());
    this.number.addEventListener("change", () => this.choose());
    this.what.addEventListener("change", () => {
      this.displayNumber(this.byStep ? this.shown?.step : this.shown?.rtol);
      this.choose();
    });
    const halve = make("button", { type: "button", class: "small", title: "Halve the value", "aria-label": "Half", onclick: () => this.scale(0.5) }, "÷2");
    const double = make("button", { type: "button", class: "small", title: "Double the value", "aria-label": "Twice", onclick: () => this.scale(2) }, "×2");
    this.row = make("div", { class: "method-number" }, this.what, this.number, halve, double);
    this.element.append(this.list, this.row);
    this.display();
  }

  show(choice: Choice | null): void {
    if (performance.now() < this.busyUntil || document.activeElement === this.number) return;
    this.shown = choice ? { method: choice.method, step: choice.step, rtol: choice.rtol } : null;
    this.display();
  }

  focus(): void {
    this.list.focus();
  }

  /** A ghost comes, by the first of the two classical choices that differs from the method in use, or goes. */
  toggle(): void {
    this.opened();
    const other = this.model.experiment.method === "rk4" ? "explicit_euler" : "rk4";
    this.list.value = this.list.value === "" ? (this.model.methods.some(({ name }) => name === other) ? other : (this.model.methods[0]?.name ?? "")) : "";
    this.choose();
  }

  private get fixed(): boolean {
    return this.model.methods.find(({ name }) => name === this.list.value)?.fixed ?? false;
  }

  /** A method that chooses its steps can be held to one as well. */
  private get byStep(): boolean {
    return this.what.value === "step";
  }

  private display(): void {
    this.list.value = this.shown?.method ?? "";
    this.what.value = this.fixed || (this.shown?.step ?? null) !== null ? "step" : "rtol";
    this.displayNumber(this.byStep ? this.shown?.step : this.shown?.rtol);
  }

  private displayNumber(value: number | null | undefined): void {
    this.row.hidden = this.list.value === "";
    this.what.disabled = this.fixed || this.list.disabled;
    this.number.setAttribute("aria-label", this.byStep ? "Step" : "Relative tolerance");
    if (document.activeElement !== this.number) this.number.value = formatNumber(value ?? this.usual, 6);
  }

  private get usual(): number {
    const { experiment } = this.model;
    if (!this.byStep) return experiment.rtol ?? 1e-6;
    return experiment.step ?? Number(((experiment.to - experiment.from) / 500).toPrecision(1));
  }

  private scale(factor: number): void {
    const value = parseNumber(this.number.value);
    if (!(value > 0)) return;
    this.number.value = formatNumber(Number((value * factor).toPrecision(6)), 6);
    this.choose();
  }

  private choose(): void {
    const method = this.list.value || null;
    const before = this.shown?.method === method;
    if (!before) this.what.value = this.fixed ? "step" : "rtol";
    const typed = before ? parseNumber(this.number.value) : ((this.byStep ? this.shown?.step : this.shown?.rtol) ?? this.usual);
    const value = typed > 0 ? typed : this.usual;
    this.shown = method ? { method, step: this.byStep ? value : null, rtol: this.byStep ? null : value } : null;
    this.displayNumber(value);
    this.busyUntil = performance.now() + 400;
    this.change({ method, numbers: method ? (this.byStep ? { step: value } : { rtol: value }) : {} });
    if (!this.optional || method) this.opened();
  }
}

/** A title is a name for people where it is short; else the name itself. */
export const readable = (name: string, title: string): string => (title && title.length <= 34 ? title : name.replaceAll("_", " "));
