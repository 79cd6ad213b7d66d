// Small helpers to make elements.

type Attributes = Record<string, string | number | boolean | null | undefined | ((event: never) => void)>;

/** `make("button", { class: "icon", onclick: play }, "Play")`; an attribute that is null, undefined or false is left out. */
export function make<Tag extends keyof HTMLElementTagNameMap>(tag: Tag, attributes: Attributes = {}, ...children: (Node | string | null)[]): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") element.addEventListener(name.replace(/^on/, ""), value as EventListener);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  for (const child of children) if (child !== null) element.append(child);
  return element;
}

/** Sets a text where it differs: the browser lays out less. */
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

const paths: Record<string, string> = {
  play: "M7 4.5v15l12-7.5z",
  pause: "M6.5 4.5h4v15h-4zM13.5 4.5h4v15h-4z",
  step: "M5 5v14l9-7zM16 5h3v14h-3z",
  back: "M19 5v14l-9-7zM5 5h3v14H5z",
  reset: "M12 5a7 7 0 1 1-6.7 5h2.6A4.6 4.6 0 1 0 12 7.4V11L6.5 6.4 12 2z",
  event: "M4 5v14l7-7zM12.2 12l2-3 2.8-4.2 2.8 4.2 2 3-2 3-2.8 4.2-2.8-4.2z",
  undo: "M9 4 3.5 9 9 14v-3.4h5a3.4 3.4 0 0 1 0 6.8H8V20h6a6 6 0 0 0 0-12H9z",
  file: "M6 2h8l5 5v15H6zM13 3.5V8h4.5z",
  text: "m8.5 6.5 1.6 1.6L6.2 12l3.9 3.9-1.6 1.6L3 12zM15.5 6.5 21 12l-5.5 5.5-1.6-1.6 3.9-3.9-3.9-3.9z",
  help: "M12 3a5.2 5.2 0 0 0-5.2 5h2.6a2.6 2.6 0 1 1 3.9 2.4c-1.6.9-2.6 2-2.6 4.1h2.6c0-1 .4-1.5 1.4-2.1A5.2 5.2 0 0 0 12 3zm-1.4 14v3h2.8v-3z",
  theme: "M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18zm0 2.4v13.2a6.6 6.6 0 0 1 0-13.2z",
  gallery: "M4 4h7v7H4zM13 4h7v7h-7zM4 13h7v7H4zM13 13h7v7h-7z",
  fit: "M4 4h6v2.4H6.4V10H4zM14 4h6v6h-2.4V6.4H14zM4 14h2.4v3.6H10V20H4zM17.6 14H20v6h-6v-2.4h3.6z",
  share: "M9.2 14.8a4 4 0 0 1 0-5.7l3-3a4 4 0 0 1 5.7 5.7l-1.4 1.4-1.6-1.6 1.4-1.4a1.7 1.7 0 0 0-2.5-2.5l-3 3a1.7 1.7 0 0 0 0 2.5zm5.6-5.6a4 4 0 0 1 0 5.7l-3 3a4 4 0 0 1-5.7-5.7l1.4-1.4 1.6 1.6-1.4 1.4a1.7 1.7 0 0 0 2.5 2.5l3-3a1.7 1.7 0 0 0 0-2.5z",
  close: "m6.4 4.9 5.6 5.6 5.6-5.6 1.5 1.5-5.6 5.6 5.6 5.6-1.5 1.5-5.6-5.6-5.6 5.6-1.5-1.5 5.6-5.6-5.6-5.6z",
  add: "M10.8 5h2.4v5.8H19v2.4h-5.8V19h-2.4v-5.8H5v-2.4h5.8z",
  save: "M5 3h12l3 3v15H4V4zM8 5v5h7V5zm1 9h6v5H9z",
  big: "M3 18 8 6h2.4l5 12h-2.7l-1-2.6H6.6l-1 2.6zm4.4-4.8h3.5L9.2 8.7zM18 8h2v3h3v2h-3v3h-2v-3h-3v-2h3z",
  picture: "M4 5h16v14H4zm2 2v8l3.5-4 3 3.2 2-1.8L18 16V7zm8.6 1.2a1.5 1.5 0 1 1 0 3 1.5 1.5 0 0 1 0-3z",
  redo: "M15 4l5.5 5-5.5 5v-3.4h-5a3.4 3.4 0 0 0 0 6.8h6V20h-6a6 6 0 0 1 0-12h5z",
  pencil: "M4 16.6 15.3 5.3l3.4 3.4L7.4 20H4zM16.6 4l1.2-1.2 3.4 3.4L20 7.4z",
  hand: "M12 2l3 3h-2v6h6V9l3 3-3 3v-2h-6v6h2l-3 3-3-3h2v-6H5v2l-3-3 3-3v2h6V5H9z",
  ball: "M12 4a8 8 0 1 1 0 16 8 8 0 0 1 0-16z",
  wall: "M3 13h18v2.4H3zM4 17l-2 4h2.4l2-4zm6 0-2 4h2.4l2-4zm6 0-2 4h2.4l2-4z",
  spring: "M2 11h3.2L7 6l3.2 9.2L13 6l3.2 9.2L18.4 11H22v2.2h-2.2L16.4 20 13 10.6 10.2 20 6.9 11.2l-.6 2H2z",
  eraser: "m14.5 4 6 6L11 19.5H7L3.5 16zm-5 7.2L6.4 15l2 2h1.6l2.7-2.6zM12 20h9v-2h-7z",
  arrows: "M4 19 14 9h-5V6.5h9.5V16H16v-5L5.8 20.8z",
  table: "M4 5h16v14H4zm2.2 4.6v2.6h4.7V9.6zm6.9 0v2.6h4.7V9.6zm-6.9 4.6v2.6h4.7v-2.6zm6.9 0v2.6h4.7v-2.6z",
};

export function icon(name: string): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(svg.namespaceURI, "path");
  path.setAttribute("d", paths[name] ?? "");
  path.setAttribute("fill-rule", "evenodd");
  svg.append(path);
  return svg as SVGSVGElement;
}

/** A button that shows a sign and says in words, with its key, what it does. */
export function iconButton(name: string, title: string, key: string, action: () => void): HTMLButtonElement {
  const hint = key ? `${title} (${key})` : title;
  const press = (event: MouseEvent): void => {
    action();
    // After a click of the mouse the space bar is play and pause again, not this button.
    if (event.detail > 0 && event.currentTarget instanceof HTMLElement) event.currentTarget.blur();
  };
  return make("button", { type: "button", class: "icon", title: hint, "aria-label": title, "aria-keyshortcuts": key || null, onclick: press }, icon(name));
}

/** Offers `data` as a file. */
export function download(name: string, data: Blob): void {
  const link = make("a", { href: URL.createObjectURL(data), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
