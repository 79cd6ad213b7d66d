// Numbers and units as people read them.

const minus = "\u2212";

/** A number in at most `digits` significant digits, without noise: 0.5, 12 300, 1.2e−7. */
export function formatNumber(value: number, digits = 4): string {
  if (Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : `${minus}∞`;
  if (value === 0) return "0";
  const size = Math.abs(value);
  let text: string;
  if (size >= 1e6 || size < 1e-4) {
    text = value.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e");
  } else {
    text = value.toPrecision(digits);
    if (text.includes("e")) text = String(Math.round(value));
    if (text.includes(".")) text = text.replace(/\.?0+$/, "");
  }
  return text.replaceAll("-", minus);
}

/** As `formatNumber`, with as many digits always, so that a changing value does not dance. */
export function formatSteady(value: number, digits = 5): string {
  if (!Number.isFinite(value) || value === 0) return formatNumber(value);
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(digits - 2) : value.toFixed(Math.max(0, digits - 1 - Math.max(0, Math.floor(Math.log10(size)))));
  return text.replaceAll("-", minus).replace("e+", "e");
}

const superscripts: Record<string, string> = {
  "0": "⁰", "1": "¹", "2": "²", "3": "³", "4": "⁴", "5": "⁵", "6": "⁶", "7": "⁷", "8": "⁸", "9": "⁹", "-": "⁻", ".": "·",
};

/** `kg*m^2/s^2` as kg·m²/s². */
export function formatUnit(unit: string): string {
  if (unit === "1") return "";
  return unit
    .replace(/\^\(?(-?\d+)\)?/g, (_, digits: string) => [...digits].map((digit) => superscripts[digit] ?? digit).join(""))
    .replace(/([A-Za-z])(-?\d)(?=$|[\s/*])/g, (_, letter: string, digit: string) => letter + [...digit].map((d) => superscripts[d] ?? d).join(""))
    .replaceAll("*", "·");
}

/** `x'` with a typographic prime. */
export const formatName = (name: string): string => name.replaceAll("''", "″").replaceAll("'", "′");

export const withUnit = (name: string, unit: string): string => (formatUnit(unit) ? `${formatName(name)} [${formatUnit(unit)}]` : formatName(name));

/** What a person typed into a field of numbers: a comma or a typographic minus will do. */
export function parseNumber(text: string): number {
  const plain = text.trim().replaceAll(minus, "-").replace(",", ".");
  return plain === "" ? NaN : Number(plain);
}

/** A speed as times real time: 1×, 0.25×, "as fast as it can". */
export const formatSpeed = (speed: number): string => (speed === 0 ? "max" : `${formatNumber(speed, 3)}×`);

/** The speed that was reached, told without noise: the target where it is within 3 per cent of it, else two digits. */
export function formatReached(reached: number, target: number): string {
  if (!Number.isFinite(reached) || reached < 0) return "–";
  if (target > 0 && Math.abs(reached / target - 1) < 0.03) return formatSpeed(target);
  return reached === 0 ? "0×" : `${formatNumber(reached, 2)}×`;
}
