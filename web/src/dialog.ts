// A dialog over the page: Escape, a click beside it and its cross close it; the focus comes back to where it was.
import { iconButton, make } from "./dom";

/** Shows it, and gives what closes it. `closed` is called once, however it is closed. */
export function openDialog(title: string, content: HTMLElement, classes = "", closed = (): void => {}): () => void {
  const dialog = make("dialog", { class: `dialog ${classes}`, "aria-label": title });
  const close = (): void => dialog.close();
  dialog.append(make("header", {}, make("h2", {}, title), iconButton("close", "Close", "Escape", close)), content);
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) close();
  });
  dialog.addEventListener("close", () => {
    dialog.remove();
    closed();
  });
  document.body.append(dialog);
  dialog.showModal();
  return close;
}

export const dialogIsOpen = (): boolean => document.querySelector("dialog[open]") !== null;
