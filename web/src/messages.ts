// What the solver has to say, in plain sight: an error stays until it is closed or another run begins.
import { iconButton, make } from "./dom";
import { spans } from "./heading";
import type { SolverMessage } from "./protocol";
import type { Session } from "./session";

const most = 4;

export class Messages {
  readonly element = make("div", { class: "messages", "aria-live": "polite" });
  private ended: string | null = null;

  constructor(session: Session, goTo: (line: number, column: number) => void) {
    session.on("message", (message) => this.add(message, goTo));
    session.on("model", () => this.element.replaceChildren());
    session.on("rewound", () => this.clear("ended"));
    session.on("state", ({ ended }) => {
      if (ended === this.ended) return;
      this.ended = ended;
      this.clear("ended");
      if (ended) this.add({ say: "message", severity: "note", code: null, text: ended, hint: null, line: null, column: null }, goTo, "ended");
    });
    session.on("link", (link) => {
      this.clear("link");
      if (link === "lost") {
        this.add({ say: "message", severity: "warning", code: null, text: "The simulator does not answer.", hint: "The page will reconnect as soon as possible.", line: null, column: null }, goTo, "link");
      }
    });
  }

  private clear(kind: string): void {
    for (const element of this.element.querySelectorAll(`.${kind}`)) element.remove();
  }

  private add(message: SolverMessage, goTo: (line: number, column: number) => void, kind = ""): void {
    const { severity, code, text, hint, line, column } = message;
    const same = [...this.element.children].filter((old) => old.querySelector<HTMLElement>(".what")?.dataset["text"] === text);
    if (same.length > 0 && kind === "ended") return;  // the error said it already
    for (const old of same) old.remove();
    const row: HTMLElement = make(
      "div",
      { class: `message ${severity} ${kind}`, role: severity === "error" ? "alert" : null },
      make("b", {}, severity === "note" ? "Note" : severity === "warning" ? "Warning" : "Error"),
      code ? make("code", {}, code) : null,
      make("span", { class: "what", "data-text": text }, ...spans(text)),
      line ? make("button", { type: "button", class: "link", onclick: () => goTo(line, column ?? 1) }, `line ${line}`) : null,
      hint ? make("span", { class: "hint" }, ...spans(hint)) : null,
      iconButton("close", "Close this message", "", () => row.remove()),
    );
    this.element.append(row);
    while (this.element.childElementCount > most) this.element.firstElementChild?.remove();
  }
}
