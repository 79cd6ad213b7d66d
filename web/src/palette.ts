// Colours that colour-blind eyes tell apart: M. Okabe, K. Ito, "Color Universal Design" (2008), in an order in which
// neighbours differ in lightness too. Light and dark pages take the members that stand out there.
export type Theme = "light" | "dark";

const okabeIto = {
  black: "#000000",
  orange: "#E69F00",
  skyBlue: "#56B4E9",
  green: "#009E73",
  yellow: "#F0E442",
  blue: "#0072B2",
  vermillion: "#D55E00",
  purple: "#CC79A7",
};

export const curveColors: Record<Theme, string[]> = {
  light: [okabeIto.blue, okabeIto.vermillion, okabeIto.green, okabeIto.purple, okabeIto.orange, okabeIto.skyBlue, "#5c6670"],
  dark: [okabeIto.skyBlue, okabeIto.orange, "#2fbf95", okabeIto.purple, okabeIto.yellow, "#ee7733", "#aab4be"],
};

/** What a model means by its colours, in members of the set. */
const named: Record<Theme, Record<string, string>> = {
  light: {
    red: okabeIto.vermillion, blue: okabeIto.blue, green: okabeIto.green, orange: okabeIto.orange, yellow: "#cdbf1a",
    purple: okabeIto.purple, pink: okabeIto.purple, gray: "#7b8794", grey: "#7b8794", black: "#1b2733", white: "#f4f6f8", cyan: okabeIto.skyBlue, brown: "#8a5a2b",
  },
  dark: {
    red: "#ee7733", blue: okabeIto.skyBlue, green: "#2fbf95", orange: okabeIto.orange, yellow: okabeIto.yellow,
    purple: okabeIto.purple, pink: okabeIto.purple, gray: "#93a1ae", grey: "#93a1ae", black: "#e6ebf0", white: "#f4f6f8", cyan: "#8fd0f5", brown: "#b98a5a",
  },
};

export const curveColor = (theme: Theme, index: number): string => curveColors[theme][index % curveColors[theme].length]!;

/** A colour of a model's text: one of the names above, else as CSS has it. */
export const modelColor = (theme: Theme, color: string): string => named[theme][color.toLowerCase()] ?? color;

/** `#rrggbb` as three numbers in 0..1; grey for what is none. */
export function channels(color: string): [number, number, number] {
  const match = /^#([0-9a-f]{6})$/i.exec(color);
  if (!match) return cssChannels(color);
  const value = parseInt(match[1]!, 16);
  return [(value >> 16) / 255, ((value >> 8) & 255) / 255, (value & 255) / 255];
}

const known = new Map<string, [number, number, number]>();

/** The browser's reading of any other colour. */
function cssChannels(color: string): [number, number, number] {
  let value = known.get(color);
  if (!value) {
    value = [0.5, 0.5, 0.5];
    const context = typeof document === "undefined" ? null : document.createElement("canvas").getContext("2d");
    if (context) {
      context.fillStyle = "#808080";
      context.fillStyle = color;
      if (typeof context.fillStyle === "string" && context.fillStyle.startsWith("#")) value = channels(context.fillStyle);
    }
    known.set(color, value);
  }
  return value;
}
