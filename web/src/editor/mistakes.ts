// In place of the scene of a text that is wrong: what is wrong, by line and column.
import { make } from "../dom";
import { spans } from "../heading";
import type { Diagnostic } from "../protocol";

export class Mistakes {
  readonly element = make("section", { class: "mistakes", "aria-label": "Mistakes in the text", hidden: true });

  constructor(private readonly goTo: (line: number, column: number) => void) {}

  show(path: string, mistakes: readonly Diagnostic[]): void {
    this.element.hidden = mistakes.length === 0;
    const errors = mistakes.filter(({ severity }) => severity === "error");
    const rows = (errors.length > 0 ? errors : mistakes).slice(0, 20).map(({ text, hint, line, column }) =>
      make(
        "li",
        {},
        line ? make("button", { type: "button", class: "link", onclick: () => this.goTo(line, column ?? 1) }, `line ${line}, column ${column ?? 1}`) : null,
        make("span", {}, ...spans(text)),
        hint ? make("small", {}, ...spans(hint)) : null,
      ),
    );
    this.element.replaceChildren(
      make("h1", {}, `${path.replace(/^.*[\\/]/, "")} cannot run yet`),
      make("p", {}, errors.length > 1 ? `There are ${errors.length} errors. Mend them in the text: it runs as soon as it is in order.` : "There is an error. Mend it in the text: it runs as soon as it is in order."),
      make("ol", {}, ...rows),
    );
  }
}
