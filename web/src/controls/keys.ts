// The keys that a model declares for its inputs: held down they move the input to its largest value, with Shift to its
// smallest, let go back to where it rests.
import type { Input } from "../protocol";

const named: Record<string, string> = { left: "arrowleft", right: "arrowright", up: "arrowup", down: "arrowdown", space: " " };

/** A key as the browser names it, in small letters. */
export const keyName = (key: string): string => named[key.toLowerCase()] ?? key.toLowerCase();

/** Where a key takes its input; without a range, one unit from where it rests. */
export function valueOfKey(input: Pick<Input, "file" | "min" | "max">, shift: boolean): number {
  const rest = restOf(input);
  return shift ? (input.min ?? rest - 1) : (input.max ?? rest + 1);
}

/** The value in the text, unless that is an end of the range which a key could not leave. */
export const restOf = (input: Pick<Input, "file" | "min" | "max">): number =>
  input.max !== null && input.file >= input.max && input.min !== null ? input.min : input.file;
