// The run as a table of text, a plot as an image.
import { download } from "../dom";
import type { History } from "../history";
import type { Column } from "../protocol";

const quoted = (text: string): string => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** Rows of `columns` with a heading line, as other programs read it: decimal points, one row for each instant. */
export function csv(history: History, columns: readonly Column[], chosen: readonly number[], timeUnit: string, begin = 0, end = history.length): string {
  const heading = [{ name: "t", unit: timeUnit }, ...chosen.map((index) => columns[index]!)].map(({ name, unit }) => quoted(unit && unit !== "1" ? `${name} [${unit}]` : name));
  const lines = [heading.join(",")];
  for (let row = begin; row < end; ++row) {
    // The numbers came as float32: nine digits say all of them.
    lines.push([String(history.t[row]), ...chosen.map((index) => String(Number(history.columns[index]![row]!.toPrecision(9))))].join(","));
  }
  return `${lines.join("\n")}\n`;
}

export const saveText = (name: string, text: string): void => download(name, new Blob([text], { type: "text/csv" }));

export function savePicture(name: string, canvas: HTMLCanvasElement): void {
  canvas.toBlob((image) => image && download(name, image), "image/png");
}
