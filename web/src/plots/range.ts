// The ranges of a plot's axes: calm while the numbers move, and never spoilt by one that is not finite.

export type Range = [number, number];

/** The smallest and largest finite value of a piece of an array, null where there is none. */
export function finiteRange(values: ArrayLike<number>, begin: number, end: number): Range | null {
  let low = Infinity;
  let high = -Infinity;
  for (let i = begin; i < end; ++i) {
    const value = values[i]!;
    if (!(Math.abs(value) < Infinity)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : null;
}

/** The range, or one of the extent `least` about its middle where it is smaller: what nobody has computed is not magnified. */
export function atLeast([low, high]: Range, least: number): Range {
  const more = (least - (high - low)) / 2;
  return more > 0 ? [low - more, high + more] : [low, high];
}

/** What the axis of an energy's relative drift shows at least: a thousand tolerances, as in the pictures of `--plot`. */
export const leastDrift = (rtol: number | null): number => 1000 * (rtol ?? 1e-12);

/** The data's range with a margin; around a constant, which single precision makes uneven, a little on both sides. */
export function padded([low, high]: Range, margin = 0.06): Range {
  const span = high - low;
  if (span > 1e-6 * Math.max(Math.abs(low), Math.abs(high))) return [low - margin * span, high + margin * span];
  const around = Math.abs(high) > 0 ? 0.1 * Math.abs(high) : 1;
  return [low - around, high + around];
}

/** Grows at once, shrinks only when the data fill less than a third. */
export function calm(before: Range | null, data: Range): Range {
  const wanted = padded(data);
  if (!before) return wanted;
  const span = before[1] - before[0];
  if (data[0] >= before[0] && data[1] <= before[1] && wanted[1] - wanted[0] > 0.35 * span) return before;
  if (wanted[1] - wanted[0] <= 0.35 * span) return wanted;
  return [data[0] < before[0] ? wanted[0] : before[0], data[1] > before[1] ? wanted[1] : before[1]];
}

/** Whole powers of ten around a range, at most twenty of them from the top. */
export function decades([low, high]: Range): Range {
  const top = Math.ceil(Math.log10(high) - 1e-9);
  const bottom = Math.max(top - 20, Math.floor(Math.log10(low) + 1e-9));
  return [10 ** Math.min(bottom, top - 1), 10 ** top];
}

/** At most about `count` powers of ten from `low` to `high`, equally far apart. */
export function powersBetween(low: number, high: number, count: number): number[] {
  const [first, last] = [Math.ceil(Math.log10(low) - 1e-9), Math.floor(Math.log10(high) + 1e-9)];
  const stride = Math.max(1, Math.ceil((last - first) / count));
  const powers: number[] = [];
  for (let power = last; power >= first; power -= stride) powers.unshift(Number(`1e${power}`));
  return powers;
}

/**
 * The window of time: an eighth of it at first, doubled as the run fills it, so that a young run is not squeezed into a
 * corner; once it is full it follows the newest rows.
 */
export function timeWindow(first: number, last: number, length: number): Range {
  if (!Number.isFinite(first) || !Number.isFinite(last)) return [0, Number.isFinite(length) ? length : 1];
  if (!Number.isFinite(length)) return last > first ? [first, last] : [first, first + 1];
  if (last - first > length) return [last - length, last];
  let shown = length / 8;
  while (shown < last - first) shown *= 2;
  return [first, first + Math.min(shown, length)];
}

/** Both ranges widened so that a unit is as long on both axes of a plot of the given size. */
export function equalScales(x: Range, y: Range, width: number, height: number): [Range, Range] {
  const unit = Math.max((x[1] - x[0]) / width, (y[1] - y[0]) / height);
  const around = ([low, high]: Range, size: number): Range => {
    const middle = (low + high) / 2;
    return [middle - (unit * size) / 2, middle + (unit * size) / 2];
  };
  return [around(x, width), around(y, height)];
}
