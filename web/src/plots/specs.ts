// Which plots a model has: what it says itself, its energies and their drift, the ghost's distance. And their short form
// for the address. No drawing here.
import type { Column, ModelMessage, Series } from "../protocol";

export interface PlotSpec {
  id: string;
  title: string;
  curves: Series[];
  /** Null: against time. */
  against: Series | null;
  /** The axes that are logarithmic. */
  log?: { x: boolean; y: boolean };
}

const seriesOf = (columns: readonly Column[], index: number): Series => ({ label: columns[index]!.name, column: index, unit: columns[index]!.unit });

const ofKind = (columns: readonly Column[], kind: Column["kind"]): Series[] =>
  columns.flatMap((column, index) => (column.kind === kind ? [seriesOf(columns, index)] : []));

export const energiesOf = (columns: readonly Column[]): Series[] => {
  const all = ofKind(columns, "energy");
  // One energy is its own sum: one line is enough.
  return all.length === 2 ? all.slice(0, 1) : all;
};

const joined = (curves: readonly Series[]): string => {
  const names = curves.map(({ label }) => label);
  return names.length > 4 ? `${names.slice(0, 3).join(", ")}, …` : names.join(", ");
};

export function titleOf(curves: readonly Series[], against: Series | null): string {
  return against ? `${joined(curves)} against ${against.label}` : joined(curves);
}

/** A world whose text plots nothing comes with all its sums in one plot: its energies say most, and have one scale. */
function tellingSums(curves: Series[]): Series[] {
  const energies = curves.filter(({ label }) => label === "world.kinetic" || label === "world.potential");
  return curves.length > 3 && curves.every(({ label }) => label.startsWith("world.")) && energies.length > 0 ? energies : curves;
}

/** The plots to begin with. */
export function defaultSpecs(model: Pick<ModelMessage, "columns" | "plots" | "drawing" | "bodies">): PlotSpec[] {
  const { columns } = model;
  const specs: PlotSpec[] = [];
  for (const [index, plot] of model.plots.entries()) {
    const against = plot.against === "t" ? null : plot.against;
    // The energies have a plot of their own below.
    const curves = tellingSums(plot.curves).filter(({ label }) => against || plot.curves.length === 1 || !columns.some(({ kind, name }) => kind === "energy" && name === label));
    specs.push({ id: `model${index}`, title: titleOf(curves, against), curves, against });
  }
  const states = ofKind(columns, "state");
  if (specs.length === 0 && states.length > 0) {
    const curves = states.slice(0, 4);
    specs.push({ id: "states", title: joined(curves), curves, against: null });
  }
  const bare = model.drawing.length === 0 && !model.bodies;
  if (bare && states.length >= 2 && !specs.some(({ against }) => against)) {
    const rate = states.find(({ label }) => label === `${states[0]!.label}'`) ?? states[1]!;
    specs.push({ id: "phase", title: titleOf([rate], states[0]!), curves: [rate], against: states[0]! });
  }
  const energies = energiesOf(columns);
  if (energies.length > 0) specs.push({ id: "energy", title: "Energy", curves: energies, against: null });
  const drift = ofKind(columns, "drift");
  if (drift.length > 0) specs.push({ id: "drift", title: "Drift of the energy", curves: drift.map((series) => ({ ...series, label: "drift" })), against: null });
  return specs;
}

export function distanceSpec(columns: readonly Column[]): PlotSpec | null {
  const distance = ofKind(columns, "distance");
  return distance.length > 0 ? { id: "distance", title: "Distance of the ghost", curves: distance, against: null } : null;
}

/** `x,v:t` or `y:x`, with `:logxy` where axes are logarithmic; names that need it are escaped. */
export const specText = ({ curves, against, log }: PlotSpec): string =>
  `${curves.map(({ label }) => encodeURIComponent(label)).join(",")}:${against ? encodeURIComponent(against.label) : "t"}` +
  (log?.x || log?.y ? `:log${log.x ? "x" : ""}${log.y ? "y" : ""}` : "");

export function specFromText(text: string, columns: readonly Column[], id: string): PlotSpec | null {
  const [names, x, log] = text.split(":");
  if (!names || !x) return null;
  const find = (name: string): Series[] => {
    const index = columns.findIndex((column) => column.name === decodeURIComponent(name));
    return index < 0 ? [] : [seriesOf(columns, index)];
  };
  const curves = names.split(",").flatMap(find);
  const against = x === "t" ? null : (find(x)[0] ?? null);
  if (curves.length === 0 || (x !== "t" && !against)) return null;
  const logs = log?.startsWith("log") ? { log: { x: log.includes("x"), y: log.includes("y") } } : {};
  return { id, title: titleOf(curves, against), curves, against, ...logs };
}
