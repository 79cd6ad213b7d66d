// The dialog that asks what to plot against what.
import { make } from "../dom";
import { formatName } from "../format";
import { openDialog } from "../dialog";
import type { Column } from "../protocol";
import { titleOf, type PlotSpec } from "./specs";

let made = 0;

export function choosePlot(columns: readonly Column[], done: (spec: PlotSpec) => void): void {
  const boxes = columns.map((_, index) => make("input", { type: "checkbox", value: index, id: `curve${index}` }));
  const against = make("select", { id: "against" }, make("option", { value: "t" }, "time"), ...columns.map((column, index) => make("option", { value: index }, formatName(column.name))));
  const filter = make("input", { type: "search", placeholder: "find…", "aria-label": "Find a variable" });
  const rows = columns.map((column, index) => make("label", { class: "choice", for: `curve${index}` }, boxes[index]!, formatName(column.name), make("small", {}, column.kind)));
  filter.addEventListener("input", () => rows.forEach((row, index) => (row.hidden = !columns[index]!.name.includes(filter.value))));
  const form = make(
    "form",
    { method: "dialog", class: "choose" },
    make("p", {}, "Which variables?"),
    columns.length > 12 ? filter : null,
    make("div", { class: "choices" }, ...rows),
    make("label", {}, "against ", against),
    make("button", { type: "submit", class: "primary" }, "Plot"),
  );
  const close = openDialog("Add a plot", form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const series = (index: number) => ({ label: columns[index]!.name, column: index, unit: columns[index]!.unit });
    const curves = boxes.flatMap((box, index) => (box.checked ? [series(index)] : []));
    if (curves.length === 0) return;
    const x = against.value === "t" ? null : series(Number(against.value));
    close();
    done({ id: `added${++made}`, title: titleOf(curves, x), curves, against: x });
  });
}
