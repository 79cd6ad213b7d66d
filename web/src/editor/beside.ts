// What is wrong with a line, written below it: nobody has to point at it to read it.
import { StateEffect, StateField, type Text } from "@codemirror/state";
import { Decoration, EditorView, WidgetType, type DecorationSet } from "@codemirror/view";
import { make } from "../dom";
import type { Diagnostic } from "../protocol";

class Note extends WidgetType {
  constructor(private readonly diagnostic: Diagnostic) {
    super();
  }

  override eq(other: Note): boolean {
    return other.diagnostic.text === this.diagnostic.text && other.diagnostic.hint === this.diagnostic.hint;
  }

  override toDOM(): HTMLElement {
    const { severity, text, hint, column } = this.diagnostic;
    const where = column ? `column ${column}: ` : "";
    return make("div", { class: `beside ${severity}` }, make("span", {}, where + text), hint ? make("small", {}, hint) : null);
  }
}

const shown = StateEffect.define<DecorationSet>();

export const beside = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update: (notes, transaction) => transaction.effects.reduce((now, effect) => (effect.is(shown) ? effect.value : now), notes.map(transaction.changes)),
  provide: (field) => EditorView.decorations.from(field),
});

/** The notes of a text; at most one for each line, the first. */
export function besideEffects(text: Text, diagnostics: readonly Diagnostic[]): StateEffect<DecorationSet> {
  const first = new Map<number, Diagnostic>();
  for (const diagnostic of diagnostics) {
    const line = Math.min(Math.max(1, diagnostic.line ?? 1), text.lines);
    if (diagnostic.severity !== "note" && !first.has(line)) first.set(line, diagnostic);
  }
  const notes = [...first].sort(([a], [b]) => a - b).map(([line, diagnostic]) => Decoration.widget({ widget: new Note(diagnostic), block: true, side: 1 }).range(text.line(line).to));
  return shown.of(Decoration.set(notes));
}
