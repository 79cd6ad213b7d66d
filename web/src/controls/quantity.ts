// A row of the controls: a name, a number that can be typed, and a slider where there is a range.
import { make } from "../dom";
import { formatName, formatNumber, formatUnit, parseNumber } from "../format";
import type { Parameter } from "../protocol";
import { places, sliderScale, type Scale } from "./scale";

export type Quantity = Pick<Parameter, "name" | "value" | "file" | "unit" | "min" | "max" | "comment">;

export class QuantityRow {
  readonly element: HTMLElement;
  readonly slider: HTMLInputElement | null = null;
  private readonly field: HTMLInputElement;
  private readonly scale: Scale | null = null;
  private value: number;
  /** Until when what the server says is older than what the hand did. */
  private busyUntil = 0;

  constructor(
    private readonly quantity: Quantity,
    private readonly change: (value: number) => void,
    extra: Node | null = null,
  ) {
    const { name, min, max, unit, comment } = quantity;
    this.value = quantity.value;
    const shownUnit = formatUnit(unit);
    const label = shownUnit ? `${name} in ${shownUnit}` : name;
    this.field = make("input", { class: "number", type: "text", inputmode: "decimal", spellcheck: "false", autocomplete: "off", "aria-label": label, value: formatNumber(this.value, 6) });
    this.field.addEventListener("change", () => this.typed());
    this.field.addEventListener("keydown", (event) => {
      if (event.key === "Escape") {
        this.field.value = formatNumber(this.value, 6);
        this.field.blur();
        event.stopPropagation();
      }
    });
    this.element = make(
      "div",
      { class: "quantity", title: comment || null, "data-quantity": name },
      make("span", { class: "name" }, formatName(name), extra),
      this.field,
      make("span", { class: "unit" }, shownUnit),
    );
    if (min !== null && max !== null && max > min) {
      this.scale = sliderScale(min, max, quantity.file);
      const slider = make("input", { type: "range", min: 0, max: places, step: 1, value: this.scale.toPlace(this.value), "aria-label": label });
      slider.addEventListener("input", () => this.slid());
      slider.addEventListener("dblclick", () => this.put(quantity.file));
      this.slider = slider;
      this.element.append(slider);
      this.describe();
    } else {
      this.element.classList.add("plain");
    }
    this.element.classList.toggle("changed", this.value !== quantity.file);
  }

  /** What the server says the value is. */
  show(value: number): void {
    if (performance.now() < this.busyUntil || value === this.value) return;
    this.display(value);
  }

  /** As a hand would. */
  put(value: number): void {
    const { min, max } = this.quantity;
    const inside = Math.min(max ?? Infinity, Math.max(min ?? -Infinity, value));
    this.display(inside);
    this.busyUntil = performance.now() + 400;
    this.change(inside);
  }

  private display(value: number): void {
    this.value = value;
    if (document.activeElement !== this.field) this.field.value = formatNumber(value, 6);
    if (this.slider && this.scale) this.slider.value = String(this.scale.toPlace(value));
    this.element.classList.toggle("changed", value !== this.quantity.file);
    this.describe();
  }

  private describe(): void {
    if (!this.slider) return;
    this.slider.style.setProperty("--part", `${Number(this.slider.value) / (places / 100)}%`);
    this.slider.setAttribute("aria-valuetext", `${formatNumber(this.value, 6)} ${formatUnit(this.quantity.unit)}`.trim());
  }

  private slid(): void {
    if (!this.slider || !this.scale) return;
    const value = this.scale.toValue(Number(this.slider.value));
    this.value = value;
    this.field.value = formatNumber(value, 6);
    this.element.classList.toggle("changed", value !== this.quantity.file);
    this.busyUntil = performance.now() + 400;
    this.describe();
    this.change(value);
  }

  private typed(): void {
    const value = parseNumber(this.field.value);
    if (Number.isFinite(value)) {
      this.value = NaN;
      this.display(value);
      this.busyUntil = performance.now() + 400;
      this.change(value);
    }
    this.field.value = formatNumber(this.value, 6);
  }
}
