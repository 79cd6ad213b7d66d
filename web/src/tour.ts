// A tour of the page, five sentences long: what each part is for, beside the part itself.
import { make, setText } from "./dom";
import { recall, remember } from "./memory";

const remembered = "continuo-tour";

interface Stop {
  /** What is pointed at: the first of these that is seen. */
  at: string;
  words: string;
}

const stops: readonly Stop[] = [
  { at: ".scene", words: "This is the motion, as it is computed. Drag what looks movable and let go; the wheel zooms." },
  { at: ".transport .buttons", words: "Play, pause, one step, back to the start. The space bar is play and pause." },
  { at: ".controls, .tabs", words: "Sliders change the parameters while it moves. Here one also chooses the method." },
  { at: ".plots, .tabs", words: "The curves grow as it moves. Point at one, and everything shows that instant." },
  { at: ".tools", words: "The signs: the model's text, which you can change and run, presenting, and help for everything else." },
];

export const tourIsKnown = (): boolean => recall(remembered) !== null;
export const forgoTour = (): void => remember(remembered, "seen");

const seen = (selector: string): Element | null => [...document.querySelectorAll(selector)].find((each) => each.getClientRects().length > 0) ?? null;

/** Begins at the first stop; Escape and its cross end it. It is not offered again. */
export function startTour(): void {
  document.querySelector(".tour")?.remove();
  forgoTour();
  const before = document.activeElement;
  let index = 0;
  const words = make("p", { id: "tour-words" });
  const count = make("span", { class: "tour-count" });
  const next = make("button", { type: "button", class: "primary", onclick: () => go(index + 1) });
  const frame = make("div", { class: "tour-frame", "aria-hidden": "true" });
  const bubble = make(
    "div",
    { class: "tour-bubble", role: "dialog", "aria-label": "Tour", "aria-describedby": "tour-words" },
    words,
    make("div", { class: "tour-buttons" }, count, make("span", { class: "grow" }), make("button", { type: "button", onclick: () => end() }, "End"), next),
  );
  const element = make("div", { class: "tour" }, frame, bubble);
  const end = (): void => {
    element.remove();
    removeEventListener("resize", place);
    if (before instanceof HTMLElement) before.focus();
  };
  const place = (): void => {
    const box = seen(stops[index]!.at)?.getBoundingClientRect();
    if (!box) return;
    const [left, top] = [Math.max(2, box.left), Math.max(2, box.top)];
    const [right, bottom] = [Math.min(innerWidth - 2, box.right), Math.min(innerHeight - 2, box.bottom)];
    Object.assign(frame.style, { left: `${left}px`, top: `${top}px`, width: `${right - left}px`, height: `${bottom - top}px` });
    const { offsetWidth: width, offsetHeight: height } = bubble;
    const below = bottom + 10 + height < innerHeight;
    const above = top - 10 - height > 0;
    const y = below ? bottom + 10 : above ? top - 10 - height : (top + bottom - height) / 2;
    const x = Math.min(innerWidth - width - 8, Math.max(8, (left + right - width) / 2));
    Object.assign(bubble.style, { left: `${x}px`, top: `${Math.max(8, y)}px` });
  };
  const go = (to: number): void => {
    if (to >= stops.length) return end();
    index = to;
    setText(words, stops[index]!.words);
    setText(count, `${index + 1} of ${stops.length}`);
    setText(next, index + 1 < stops.length ? "Next" : "Done");
    place();
    next.focus();
  };
  element.addEventListener("keydown", (event) => {
    event.stopPropagation();
    if (event.key === "Escape") end();
  });
  addEventListener("resize", place);
  document.body.append(element);
  go(0);
}
