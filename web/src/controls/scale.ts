// What a slider's place means. A slider has 1000 places; a range over many powers of ten is spread over them.
export const places = 1000;

export interface Scale {
  toPlace(value: number): number;
  toValue(place: number): number;
}

/** Linear, or where the range spans more than three powers of ten logarithmic; from 0 far beyond the value, by a cube. */
export function sliderScale(min: number, max: number, usual: number): Scale {
  const clamp = (part: number): number => Math.min(1, Math.max(0, part));
  const make = (part: (value: number) => number, value: (part: number) => number): Scale => ({
    toPlace: (number) => Math.round(places * clamp(part(number))),
    toValue: (place) => tidy(value(clamp(place / places)), min, max),
  });
  if (min > 0 && max / min >= 1000) {
    const span = Math.log(max / min);
    return make((value) => Math.log(Math.max(value, min) / min) / span, (part) => min * Math.exp(span * part));
  }
  if (min === 0 && usual > 0 && max / usual > 50) {
    return make((value) => Math.cbrt(value / max), (part) => max * part ** 3);
  }
  return make((value) => (value - min) / (max - min), (part) => min + (max - min) * part);
}

/** As few digits as tell neighbouring places apart. */
function tidy(value: number, min: number, max: number): number {
  if (value <= min) return min;
  if (value >= max) return max;
  const step = Math.max((max - min) / places, Math.abs(value) * 1e-3 * 0.5);
  const rounded = Number(value.toFixed(Math.min(20, Math.max(0, Math.ceil(-Math.log10(Math.min(step, Math.abs(value) * 0.02 || step)))))));
  return Math.min(max, Math.max(min, rounded));
}
