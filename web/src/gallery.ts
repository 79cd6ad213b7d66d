// The gallery: every model one click away, with its picture, under its subject.
import { icon, make } from "./dom";
import { openDialog } from "./dialog";
import { spans } from "./heading";
import type { GalleryEntry } from "./protocol";
import type { Session } from "./session";
import { thumbnailOf } from "./thumbnails";
import { forgoTour, startTour, tourIsKnown } from "./tour";

/** The models under their subjects, in the order in which they come; what has no subject is last. */
export function bySubject(models: readonly GalleryEntry[]): { subject: string; models: GalleryEntry[] }[] {
  const groups = new Map<string, GalleryEntry[]>();
  for (const model of models) groups.set(model.subject ?? "", [...(groups.get(model.subject ?? "") ?? []), model]);
  const named = [...groups].map(([subject, members]) => ({ subject, models: members }));
  return [...named.filter(({ subject }) => subject !== ""), ...named.filter(({ subject }) => subject === "").map(({ models: rest }) => ({ subject: named.length > 1 ? "More" : "", models: rest }))];
}

/** Whether all words that somebody looks for are in what a model says of itself. */
export function isFound({ name, title, subject }: GalleryEntry, wanted: string): boolean {
  const text = `${name.replaceAll("_", " ")} ${title} ${subject ?? ""}`.toLowerCase();
  return wanted.toLowerCase().split(/[\s_]+/).every((word) => text.includes(word));
}

/** `closed` is called when a model has been chosen, and when the gallery is left without. */
export function openGallery(session: Session, draw: (() => void) | null, closed: () => void): void {
  const models = session.model?.gallery ?? [];
  const search = make("input", { type: "search", placeholder: "find a model…", "aria-label": "Find a model" });
  let close = (): void => {};
  const open = (name: string): void => {
    close();
    session.send({ do: "open", model: name });
    session.send({ do: "play" });
  };
  const sections = bySubject(models).map(({ subject, models: members }) => {
    const cards = members.map((model) => ({ model, element: card(model, () => open(model.name)) }));
    const element = make("section", {}, subject ? make("h3", {}, subject) : null, make("div", { class: "gallery-cards" }, ...cards.map(({ element: each }) => each)));
    return { element, cards };
  });
  const none = make("p", { role: "status", hidden: models.length > 0 }, models.length > 0 ? "No model has all of these words." : "No other models are available.");
  search.addEventListener("input", () => {
    for (const { element, cards } of sections) {
      for (const each of cards) each.element.hidden = !isFound(each.model, search.value);
      element.hidden = cards.every((each) => each.element.hidden);
    }
    none.hidden = sections.some(({ element }) => !element.hidden);
  });
  search.addEventListener("keydown", (event) => {
    if (event.key === "Enter") sections.flatMap(({ cards }) => cards).find((each) => !each.element.hidden)?.element.click();
  });
  const tour = (): void => {
    close();
    startTour();
  };
  const head = make(
    "div",
    { class: "gallery-head" },
    search,
    draw ? make("button", { type: "button", class: "framed", title: "An empty world, to put balls, walls and springs into", onclick: () => {
      close();
      draw();
    } }, "Draw a world") : null,
    make("button", { type: "button", class: "framed", onclick: tour }, "Tour"),
  );
  close = openDialog("Gallery", make("div", { class: "gallery" }, head, offerOfTour(tour), none, ...sections.map(({ element }) => element)), "wide", closed);
  search.focus();
}

function card({ name, title }: GalleryEntry, open: () => void): HTMLButtonElement {
  const address = thumbnailOf(name);
  const picture = address ? make("img", { src: address, alt: "", width: 96, height: 60, loading: "lazy" }) : icon("gallery");
  const words = make("span", { class: "words" }, make("b", {}, name.replaceAll("_", " ")), make("span", {}, ...spans(title)));
  return make("button", { type: "button", class: "gallery-card", "data-model": name, onclick: open }, make("span", { class: "thumbnail" }, picture), words);
}

/** Asked once. */
function offerOfTour(tour: () => void): HTMLElement | null {
  if (tourIsKnown()) return null;
  const offer: HTMLElement = make(
    "p",
    { class: "tour-offer" },
    make("span", {}, "New here? A tour shows the page in thirty seconds."),
    make("button", { type: "button", class: "primary", onclick: tour }, "Show me"),
    make("button", { type: "button", class: "framed", onclick: () => {
      forgoTour();
      offer.remove();
    } }, "No, thanks"),
  );
  return offer;
}
