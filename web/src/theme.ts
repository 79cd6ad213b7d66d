// Light or dark: as the system says until a person chooses.
import type { Theme } from "./palette";

const remembered = "continuo-theme";

function recall(): Theme | null {
  try {
    const value = localStorage.getItem(remembered);
    return value === "light" || value === "dark" ? value : null;
  } catch {
    return null;  // a page from a file may have no memory
  }
}

export class ThemeChoice {
  private chosen = recall();
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
    try {
      localStorage.setItem(remembered, this.chosen);
    } catch {
      // it will be asked again
    }
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
