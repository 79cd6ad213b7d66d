// Texts and labels of the drawing, written over the picture by the browser, so that they are sharp and can be read aloud.
import { make, setText } from "../dom";
import type { Item } from "../protocol";
import { numberOf, pointOf } from "./fit";

type Project = (point: [number, number, number]) => { x: number; y: number; visible: boolean };

export class Labels {
  readonly element = make("div", { class: "labels" });
  private entries: { item: Item; element: HTMLElement }[] = [];

  build(items: readonly Item[], colors: readonly string[]): void {
    this.element.replaceChildren();
    this.entries = [];
    items.forEach((item, index) => {
      const text = item.shape === "text" ? (item.text ?? item.label) : item.label;
      if (!text || this.entries.length >= 200) return;
      const element = make("span", { class: item.shape === "text" ? "text" : "label" }, text);
      if (item.shape === "text") element.style.color = colors[index]!;
      this.entries.push({ item, element });
      this.element.append(element);
    });
  }

  update(scene: Float32Array, project: Project, pixelsPerUnit: number): void {
    for (const { item, element } of this.entries) {
      let at = pointOf(item, scene, "at");
      if (item.numbers["to"] !== undefined) {
        const to = pointOf(item, scene, "to");
        at = item.shape === "arrow" ? to : [(at[0] + to[0]) / 2, (at[1] + to[1]) / 2, (at[2] + to[2]) / 2];
      }
      const { x, y, visible } = project(at);
      element.hidden = !visible || !Number.isFinite(x + y);
      const lift = item.shape === "ball" ? Math.max(8, numberOf(item, scene, "radius", 0) * pixelsPerUnit) + 4 : item.shape === "text" ? 0 : 6;
      element.style.transform = item.shape === "text" ? `translate(-50%, -50%) translate(${x}px, ${y}px)` : `translate(-50%, -100%) translate(${x}px, ${y - lift}px)`;
      const size = numberOf(item, scene, "size", NaN);
      if (item.shape === "text" && size > 0) element.style.fontSize = `${Math.min(64, Math.max(9, size * pixelsPerUnit))}px`;
      if (item.shape === "text" && item.text) setText(element, item.text);
    }
  }
}
