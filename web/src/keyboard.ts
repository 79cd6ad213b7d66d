// The keys of the page. A model's own keys come first; where a person types text, all keys are text.
import { make } from "./dom";
import { dialogIsOpen, openDialog } from "./dialog";

export interface Action {
  keys: string[];
  /** Empty where the row of another key speaks for this one too. */
  words: string;
  /** The keys that the help shows in this row, where they are not `keys`. */
  also?: string[];
  group: "Time" | "Scene" | "Page";
  run: () => void;
}

/** A key press as the table of actions writes it: `Space`, `ArrowLeft`, `Shift+ArrowLeft`, `r`, `?`. */
export function pressed(event: Pick<KeyboardEvent, "key" | "shiftKey" | "ctrlKey" | "metaKey" | "altKey">): string {
  if (event.ctrlKey || event.metaKey || event.altKey) return "";
  const key = event.key === " " ? "Space" : event.key.length === 1 ? event.key.toLowerCase() : event.key;
  return event.shiftKey && key.startsWith("Arrow") ? `Shift+${key}` : key;
}

const typing = (target: EventTarget | null): boolean => {
  const element = target instanceof HTMLElement ? target : null;
  if (!element) return false;
  if (element.isContentEditable || element instanceof HTMLTextAreaElement) return true;
  return element instanceof HTMLInputElement && element.type !== "range" && element.type !== "checkbox";
};

/** Keys that a control which has the focus needs for itself. */
const ownKey = (target: EventTarget | null, key: string): boolean => {
  if (target instanceof HTMLSelectElement) return key !== "?" && key !== "Escape";
  if (target instanceof HTMLInputElement) return key.includes("Arrow") || key === "Home" || key === "End";
  return (target instanceof HTMLButtonElement || (target instanceof HTMLElement && target.tagName === "SUMMARY")) && (key === "Space" || key === "Enter");
};

const shownAs: Record<string, string> = {
  ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓", "Shift+Arrows": "Shift ← → ↑ ↓", Escape: "Esc",
};

export function listenToKeys(actions: readonly Action[], modelKey: (key: string, shift: boolean, down: boolean) => boolean, letGo: () => void): void {
  const held = new Set<string>();
  document.addEventListener("keydown", (event) => {
    if (typing(event.target) || dialogIsOpen()) return;
    const plain = !(event.ctrlKey || event.metaKey || event.altKey);
    const code = event.key.toLowerCase();
    if (plain && !ownKey(event.target, pressed(event)) && (held.has(code) || modelKey(event.key, event.shiftKey, true))) {
      held.add(code);  // a key that repeats is still one press
      event.preventDefault();
      return;
    }
    const key = pressed(event);
    if (ownKey(event.target, key)) return;
    const action = actions.find(({ keys }) => keys.includes(key));
    if (!action) return;
    event.preventDefault();
    action.run();
  });
  const release = (key: string): void => {
    if (held.delete(key)) modelKey(key, false, false);
  };
  document.addEventListener("keyup", (event) => {
    release(event.key.toLowerCase());
    if (event.key.startsWith("Arrow")) letGo();
  });
  // A window that loses the focus hears no key go up.
  window.addEventListener("blur", () => {
    for (const key of [...held]) release(key);
    letGo();
  });
}

export function openHelp(actions: readonly Action[], modelKeys: readonly { key: string; words: string }[]): void {
  const row = (keys: string[], words: string): HTMLElement =>
    make("div", { class: "help-row" }, make("span", {}, ...keys.map((key) => make("kbd", {}, shownAs[key] ?? key))), make("span", {}, words));
  const group = (title: string, rows: HTMLElement[]): HTMLElement => make("section", {}, make("h3", {}, title), ...rows);
  const content = make("div", { class: "help" });
  if (modelKeys.length > 0) content.append(group("This model", modelKeys.map(({ key, words }) => row([key], words))));
  for (const title of ["Time", "Scene", "Page"] as const) {
    content.append(group(title, actions.filter((action) => action.group === title && action.words).map(({ keys, words, also }) => row(also ?? keys, words))));
  }
  content.append(
    group("Mouse and touch", [
      row(["drag"], "move objects that can be dragged; elsewhere move the picture, or rotate it in space"),
      row(["wheel", "pinch"], "zoom"),
      row(["click"], "show the state of a body"),
      row(["double click"], "the whole scene; on a slider: the value in the file"),
      row(["drag in a plot"], "look back to that time"),
    ]),
  );
  openDialog("Help", content, "wide");
}
