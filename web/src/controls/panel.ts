// The controls beside the scene: inputs, parameters, the method and its ghost, the table of values.
import { iconButton, make, setText } from "../dom";
import type { ModelMessage, StateMessage } from "../protocol";
import type { Session } from "../session";
import { keyName, restOf, valueOfKey } from "./keys";
import { MethodChoice } from "./method";
import { QuantityRow } from "./quantity";
import { ValueTable } from "./values";

const section = (title: string, ...content: (Node | null)[]): HTMLDetailsElement =>
  make("details", { class: "section", open: true }, make("summary", {}, title), ...content);

export class ControlPanel {
  readonly element = make("aside", { class: "controls", "aria-label": "Controls" });
  private parameters = new Map<string, QuantityRow>();
  private inputs = new Map<string, QuantityRow>();
  private method: MethodChoice | null = null;
  private ghost: MethodChoice | null = null;
  private readonly undo: HTMLButtonElement;
  private readonly restore: HTMLButtonElement;
  private readonly mode = make("p", { class: "mode", hidden: true });
  private readonly cost = make("p", { class: "cost" });
  private readonly values: ValueTable;

  constructor(private readonly session: Session) {
    this.undo = iconButton("undo", "Undo the last change", "u", () => session.send({ do: "undo" }));
    this.restore = iconButton("file", "Parameters as in the file", "p", () => session.send({ do: "restore" }));
    this.values = new ValueTable(session);
    session.on("model", (model) => this.open(model));
    session.on("state", (state) => this.show(state));
  }

  /** A key of the model goes down or up; false where the model has no such key. */
  key(key: string, shift: boolean, down: boolean): boolean {
    const input = this.session.model?.inputs.find((each) => each.key && keyName(each.key) === key.toLowerCase());
    if (!input || !this.session.live) return false;
    this.inputs.get(input.name)?.put(down ? valueOfKey(input, shift) : restOf(input));
    return true;
  }

  focusMethod(): void {
    this.method?.focus();
  }

  toggleGhost(): void {
    this.ghost?.toggle();
  }

  focusFirstSlider(): void {
    this.element.querySelector<HTMLInputElement>(".quantity input[type=range], .quantity input")?.focus();
  }

  private open(model: ModelMessage): void {
    const { session } = this;
    this.parameters.clear();
    this.inputs.clear();
    const parts: HTMLElement[] = [];
    if (!session.live) parts.push(make("p", { class: "frozen-note" }, session.role ? "You see what the presenter does. Looking back and the plots are yours." : "A recording: play it, look back. To change something, run the model in Continuo."));
    if (model.inputs.length > 0) {
      const rows = model.inputs.map((input) => {
        const hold = input.key ? make("button", { type: "button", class: "key", title: `Hold ${input.key}; with Shift for the opposite direction`, "aria-label": `Hold: ${input.name}` }, input.key) : null;
        const row = new QuantityRow(input, (value) => session.send({ do: "input", name: input.name, value }), hold);
        hold?.addEventListener("pointerdown", (event) => {
          hold.setPointerCapture(event.pointerId);
          row.put(valueOfKey(input, event.shiftKey));
        });
        for (const name of ["pointerup", "pointercancel"] as const) hold?.addEventListener(name, () => row.put(restOf(input)));
        this.inputs.set(input.name, row);
        return row.element;
      });
      parts.push(section("Inputs", ...rows));
    }
    if (model.parameters.length > 0) {
      // Lists of start values and the like: at hand, not in the way.
      const plain = model.parameters.filter(({ min, max }) => min === null || max === null);
      const folded = plain.length > 5 ? make("details", { class: "more" }, make("summary", {}, `${plain.length} without a range`)) : null;
      const rows: HTMLElement[] = [];
      for (const parameter of model.parameters) {
        const again = parameter.structural ? make("small", { title: "A change of this parameter restarts the run" }, " ↻") : null;
        const row = new QuantityRow(parameter, (value) => session.send({ do: "set", parameter: parameter.name, value }), again);
        this.parameters.set(parameter.name, row);
        if (folded && plain.includes(parameter)) folded.append(row.element);
        else rows.push(row.element);
      }
      parts.push(section("Parameters", make("div", { class: "section-buttons" }, this.undo, this.restore), ...rows, folded));
    }
    this.method = new MethodChoice(model, false, (choice) => choice.method !== null && session.send({ do: "method", name: choice.method, ...choice.numbers }));
    this.ghost = new MethodChoice(model, true, (choice) => session.send({ do: "ghost", name: choice.method, ...choice.numbers }));
    parts.push(section("Method", this.method.element, this.mode, this.cost));
    const ghost = section("Ghost: a second method", this.ghost.element);
    ghost.open = false;
    this.ghost.opened = () => (ghost.open = true);
    parts.push(ghost);
    this.values.open(model);
    parts.push(section("Values", this.values.element));
    this.element.replaceChildren(...parts);
    this.element.classList.toggle("frozen", !session.live);
    if (!session.live) for (const field of this.element.querySelectorAll<HTMLInputElement>("input, select, .section button")) field.disabled = true;
    if (this.session.state) this.show(this.session.state);
  }

  private show(state: StateMessage): void {
    for (const [name, row] of this.parameters) if (name in state.parameters) row.show(state.parameters[name]!);
    for (const [name, row] of this.inputs) if (name in state.inputs) row.show(state.inputs[name]!);
    this.method?.show(state);
    this.ghost?.show(state.ghost);
    this.undo.disabled = state.undo === 0 || !this.session.live;
    this.restore.disabled = !this.session.live || !this.changed;
    this.mode.hidden = !state.mode;
    if (state.mode) setText(this.mode, `mode: ${state.mode}`);
    setText(this.cost, state.steps > 0 ? `${state.steps.toLocaleString("en").replaceAll(",", "\u2009")} steps${state.rejected > 0 ? `, ${state.rejected} rejected` : ""}` : "");
  }

  private get changed(): boolean {
    const { model, state } = this.session;
    if (!model || !state) return false;
    return model.parameters.some(({ name, value, file }) => (state.parameters[name] ?? value) !== file) || model.inputs.some(({ name, value, file, from_file }) => !from_file && (state.inputs[name] ?? value) !== file);
  }
}
