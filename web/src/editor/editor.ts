// The model's text: highlighted, checked as one types, run on Ctrl-Enter.
import { defaultKeymap, history, historyKeymap, indentWithTab, isolateHistory, redo, undo } from "@codemirror/commands";
import { bracketMatching, HighlightStyle, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics, type Diagnostic as Mark } from "@codemirror/lint";
import { EditorState, type Text } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { galleryName } from "../address";
import { download, iconButton, make, setText } from "../dom";
import type { Diagnostic, ModelMessage } from "../protocol";
import type { Session } from "../session";
import { beside, besideEffects } from "./beside";
import { sim } from "./language";

const colors = HighlightStyle.define([
  { tag: tags.comment, color: "var(--code-comment)", fontStyle: "italic" },
  { tag: tags.keyword, color: "var(--code-keyword)", fontWeight: "600" },
  { tag: tags.modifier, color: "var(--code-keyword)" },
  { tag: tags.typeName, color: "var(--code-shape)" },
  { tag: tags.number, color: "var(--code-number)" },
  { tag: tags.labelName, color: "var(--code-unit)" },
  { tag: tags.string, color: "var(--code-string)" },
  { tag: tags.macroName, color: "var(--code-function)" },
]);

/** Where a message belongs in the text: lines and columns count from 1, and the text may be shorter by now. */
export function rangeOf(text: Text, { line, column, length }: Pick<Diagnostic, "line" | "column" | "length">): { from: number; to: number } {
  const at = text.line(Math.min(Math.max(1, line ?? 1), text.lines));
  const from = Math.min(at.to, at.from + Math.max(0, (column ?? 1) - 1));
  const to = Math.min(at.to, from + Math.max(1, length ?? 1));
  // At the very end of a line there is nothing to underline but what stands before it.
  return from === to && from > at.from ? { from: from - 1, to } : { from, to };
}

export class Editor {
  readonly element: HTMLElement;
  private readonly view: EditorView;
  private readonly status = make("span", { class: "editor-status", role: "status" });
  private readonly save: HTMLButtonElement;
  private timer = 0;
  private asked = 0;
  /** Texts that run, and that no model has come of yet. */
  private waiting: string[] = [];

  constructor(private readonly session: Session) {
    this.view = new EditorView({
      state: EditorState.create({
        doc: "",
        extensions: [
          lineNumbers(),
          lintGutter(),
          beside,
          history(),
          drawSelection(),
          bracketMatching(),
          highlightActiveLine(),
          EditorView.lineWrapping,
          sim,
          syntaxHighlighting(colors),
          EditorState.tabSize.of(2),
          EditorView.contentAttributes.of({ "aria-label": "The model's text" }),
          EditorState.readOnly.of(!session.live),
          keymap.of([
            { key: "Mod-Enter", run: () => this.run() },
            { key: "Mod-s", run: () => this.saveText(), preventDefault: true },
            { key: "Escape", run: (view) => (view.contentDOM.blur(), true) },
            ...lintKeymap,
            ...historyKeymap,
            ...defaultKeymap,
            indentWithTab,
          ]),
          EditorView.updateListener.of((update) => update.docChanged && this.edited()),
        ],
      }),
    });
    this.save = iconButton("save", "Save the file", "Ctrl-S", () => this.saveText());
    const run = make("button", { type: "button", class: "primary", title: "Run this text (Ctrl-Enter)", disabled: !session.live, onclick: () => this.run() }, "Run");
    this.element = make("section", { class: "editor", "aria-label": "Editor" }, make("header", {}, make("h2", {}, "Model"), this.status, make("span", { class: "grow" }), this.save, run), this.view.dom);
    session.on("model", (model) => this.open(model));
    session.on("checked", ({ id, diagnostics }) => {
      if (id === this.asked) this.mark(diagnostics);
    });
    session.on("checked", ({ id, diagnostics }) => {
      // A text that was wrong runs as soon as it is in order.
      if (id === this.asked && session.model?.mistakes?.length && !diagnostics.some(({ severity }) => severity === "error")) this.run();
    });
    session.on("saved", (path) => setText(this.status, `saved to ${path}`));
    session.on("message", (message) => {
      if (message.line) this.mark([message]);
    });
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  focus(): void {
    this.view.focus();
  }

  /** Changes the text, in one step of its undoing, and runs it. */
  write(changes: readonly { from: number; to: number; insert: string }[]): void {
    this.view.dispatch({ changes: [...changes], annotations: isolateHistory.of("full") });
    this.run();
  }

  undo(): void {
    if (undo(this.view)) this.run();
  }

  redo(): void {
    if (redo(this.view)) this.run();
  }

  /** The mistakes of the text, and the first of them in view. */
  showMistakes(mistakes: readonly Diagnostic[]): void {
    this.mark(mistakes);
    const first = mistakes.find(({ severity }) => severity === "error") ?? mistakes[0];
    if (first) this.goTo(first.line ?? 1, first.column ?? 1);
  }

  goTo(line: number, column: number): void {
    const { from } = rangeOf(this.view.state.doc, { line, column, length: 1 });
    this.view.dispatch({ selection: { anchor: from }, effects: EditorView.scrollIntoView(from, { y: "center" }) });
    this.view.focus();
  }

  private open(model: ModelMessage): void {
    const saves = model.saveable && this.session.may("save");
    this.save.title = saves ? "Save the file (Ctrl-S)" : "Save a copy (Ctrl-S)";
    this.save.setAttribute("aria-label", saves ? "Save the file" : "Save a copy");
    // What was just run, or is being typed on, stays as it is, and so does what was run after it.
    const answered = this.waiting.indexOf(model.text);
    if (model.text !== this.text && answered < 0) {
      this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: model.text } });
      this.mark([]);
      this.view.scrollDOM.scrollTop = 0;
    }
    this.waiting = answered < 0 ? [] : this.waiting.slice(answered + 1);
    if (model.text !== this.text) return;  // what has been typed on meanwhile is still to be checked
    clearTimeout(this.timer);
    setText(this.status, "");
  }

  private edited(): void {
    if (!this.session.live || this.text === this.session.model?.text) return;
    clearTimeout(this.timer);
    setText(this.status, "changed");
    this.timer = window.setTimeout(() => this.session.send({ do: "check", id: ++this.asked, text: this.text }), 200);
  }

  private mark(diagnostics: readonly Diagnostic[]): void {
    const { doc } = this.view.state;
    const marks: Mark[] = diagnostics.map((each) => ({
      ...rangeOf(doc, each),
      severity: each.severity === "note" ? "info" : each.severity,
      message: `${each.code ? `${each.code}: ` : ""}${each.text}${each.hint ? `\n${each.hint}` : ""}`,
    }));
    this.view.dispatch({ effects: besideEffects(doc, diagnostics) });
    this.view.dispatch(setDiagnostics(this.view.state, marks));
    const errors = marks.filter(({ severity }) => severity === "error").length;
    setText(this.status, errors > 0 ? `${errors} error${errors > 1 ? "s" : ""}` : this.text === this.session.model?.text ? "" : "in order; Ctrl-Enter runs it");
    this.status.classList.toggle("bad", errors > 0);
  }

  private run(): boolean {
    if (this.session.live) {
      this.waiting.push(this.text);
      this.session.send({ do: "run", text: this.text });
    }
    return true;
  }

  private saveText(): boolean {
    const { model, live } = this.session;
    if (live && model?.saveable && this.session.may("save")) this.session.send({ do: "save", text: this.text });
    else if (model) download(`${galleryName(model)}.sim`, new Blob([this.text], { type: "text/plain" }));
    return true;
  }
}
