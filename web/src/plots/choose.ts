// The dialog that asks what to plot against what.
import { make } from "../dom";
import { formatName } from "../format";
import { openDialog } from "../dialog";
import type { Column } from "../protocol";
import { titleOf, type PlotSpec } from "./specs";

let made = 0;

/** `begun`: a plot whose axes are changed; else a new one is made. */
export function choosePlot(columns: readonly Column[], done: (spec: PlotSpec) => void, begun: PlotSpec | null = null): void {
  const chosen = new Set(begun?.curves.map(({ column }) => column));
  const boxes = columns.map((_, index) => make("input", { type: "checkbox", value: index, id: `curve${index}`, checked: chosen.has(index) }));
  const against = make("select", { id: "against" }, make("option", { value: "t" }, "time"), ...columns.map((column, index) => make("option", { value: index }, formatName(column.name))));
  against.value = begun?.against ? String(begun.against.column) : "t";
  const log = (on: boolean): HTMLInputElement => make("input", { type: "checkbox", checked: on });
  const [logX, logY] = [log(begun?.log?.x ?? false), log(begun?.log?.y ?? false)];
  const filter = make("input", { type: "search", placeholder: "find…", "aria-label": "Find a quantity" });
  const rows = columns.map((column, index) => make("label", { class: "choice", for: `curve${index}` }, boxes[index]!, formatName(column.name), make("small", {}, column.unit && column.unit !== "1" ? `${column.kind}, ${column.unit}` : column.kind)));
  filter.addEventListener("input", () => rows.forEach((row, index) => (row.hidden = !columns[index]!.name.includes(filter.value))));
  const none = make("p", { role: "alert", hidden: true }, "Choose at least one quantity.");
  const form = make(
    "form",
    { method: "dialog", class: "choose" },
    make("fieldset", {}, make("legend", {}, "Vertical axis"), columns.length > 12 ? filter : null, make("div", { class: "choices" }, ...rows), make("label", { class: "choice" }, logY, "logarithmic, of the absolute values")),
    make("fieldset", {}, make("legend", {}, "Horizontal axis"), against, make("label", { class: "choice" }, logX, "logarithmic")),
    none,
    make("button", { type: "submit", class: "primary" }, "Plot"),
  );
  against.setAttribute("aria-label", "Horizontal axis");
  const close = openDialog(begun ? "Axes" : "Add a plot", form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const series = (index: number) => ({ label: columns[index]!.name, column: index, unit: columns[index]!.unit });
    const curves = boxes.flatMap((box, index) => (box.checked ? [series(index)] : []));
    none.hidden = curves.length > 0;
    if (curves.length === 0) return;
    const x = against.value === "t" ? null : series(Number(against.value));
    close();
    done({ id: `added${++made}`, title: titleOf(curves, x), curves, against: x, log: { x: logX.checked, y: logY.checked } });
  });
}
