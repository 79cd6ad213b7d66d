// Light or dark: as the system says until a person chooses.
import { recall, remember } from "./memory";
import type { Theme } from "./palette";

const remembered = "continuo-theme";

function chosenBefore(): Theme | null {
  const value = recall(remembered);
  return value === "light" || value === "dark" ? value : null;
}

export class ThemeChoice {
  private chosen = chosenBefore();
  private readonly dark = matchMedia("(prefers-color-scheme: dark)");

  constructor(private readonly changed: (theme: Theme) => void) {
    this.apply();
    this.dark.addEventListener("change", () => this.update());
  }

  get theme(): Theme {
    return this.chosen ?? (this.dark.matches ? "dark" : "light");
  }

  toggle(): void {
    this.chosen = this.theme === "light" ? "dark" : "light";
    remember(remembered, this.chosen);
    this.update();
  }

  private update(): void {
    this.apply();
    this.changed(this.theme);
  }

  private apply(): void {
    document.documentElement.dataset["theme"] = this.theme;
  }
}
