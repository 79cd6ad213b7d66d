// The gallery: every model one click away.
import { make } from "./dom";
import { openDialog } from "./dialog";
import type { Session } from "./session";

export function openGallery(session: Session): void {
  const models = session.model?.gallery ?? [];
  const search = make("input", { type: "search", placeholder: "find a model…", "aria-label": "Find a model" });
  let close = (): void => {};
  const cards = models.map(({ name, title }) =>
    make(
      "button",
      {
        type: "button",
        class: "gallery-card",
        "data-model": name,
        onclick: () => {
          close();
          session.send({ do: "open", model: name });
          session.send({ do: "play" });
        },
      },
      make("b", {}, name.replaceAll("_", " ")),
      make("span", {}, title),
    ),
  );
  search.addEventListener("input", () => {
    const wanted = search.value.toLowerCase();
    models.forEach(({ name, title }, index) => (cards[index]!.hidden = !`${name.replaceAll("_", " ")} ${title}`.toLowerCase().includes(wanted)));
  });
  search.addEventListener("keydown", (event) => {
    if (event.key === "Enter") cards.find((card) => !card.hidden)?.click();
  });
  const empty = models.length === 0 ? make("p", {}, "No other models are available.") : null;
  close = openDialog("Gallery", make("div", { class: "gallery" }, search, empty, make("div", { class: "gallery-cards" }, ...cards)), "wide");
  search.focus();
}
