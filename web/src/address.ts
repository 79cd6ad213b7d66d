// What the address of the page carries after its #: model, parameters, inputs, method, speed, view, added plots.
import type { Choice, ModelMessage, StateMessage } from "./protocol";

export interface Shared {
  model?: string;
  parameters: Record<string, number>;
  inputs: Record<string, number>;
  method?: { name: string; step?: number; rtol?: number };
  ghost?: { name: string; step?: number; rtol?: number };
  speed?: number;
  view?: number[];
  plots: string[];
}

const methodText = ({ method, step, rtol }: Choice): string => `${method},${step !== null ? `step=${step}` : `rtol=${rtol}`}`;

function methodOf(text: string): { name: string; step?: number; rtol?: number } | undefined {
  const [name, number] = text.split(",");
  if (!name) return undefined;
  const [what, value] = (number ?? "").split("=");
  const amount = Number(value);
  if (!(amount > 0)) return { name };
  return what === "step" ? { name, step: amount } : what === "rtol" ? { name, rtol: amount } : { name };
}

/** Only what differs from the model's text is written. */
export function toHash(model: ModelMessage, state: StateMessage | null, view: readonly number[] | null, plots: readonly string[]): string {
  const hash = new URLSearchParams();
  if (model.gallery.some(({ name }) => name === galleryName(model))) hash.set("model", galleryName(model));
  if (state) {
    for (const { name, file } of model.parameters) if (name in state.parameters && state.parameters[name] !== file) hash.set(`p.${name}`, String(state.parameters[name]));
    for (const { name, file, from_file } of model.inputs) if (!from_file && name in state.inputs && state.inputs[name] !== file) hash.set(`i.${name}`, String(state.inputs[name]));
    const { experiment } = model;
    const same = state.method === experiment.method && (state.step !== null ? state.step === experiment.step : state.rtol === experiment.rtol);
    if (!same) hash.set("method", methodText(state));
    if (state.ghost) hash.set("ghost", methodText(state.ghost));
    if (state.target !== 1) hash.set("speed", String(state.target));
  }
  if (view) hash.set("view", view.map((number) => Number(number.toPrecision(5))).join(","));
  for (const plot of plots) hash.append("plot", plot);
  return hash.toString();
}

export function fromHash(text: string): Shared {
  const hash = new URLSearchParams(text.replace(/^#/, ""));
  const shared: Shared = { parameters: {}, inputs: {}, plots: hash.getAll("plot") };
  for (const [name, value] of hash) {
    const number = Number(value);
    if (value.trim() === "" || !Number.isFinite(number)) continue;
    if (name.startsWith("p.")) shared.parameters[name.slice(2)] = number;
    if (name.startsWith("i.")) shared.inputs[name.slice(2)] = number;
    if (name === "speed" && number >= 0) shared.speed = number;
  }
  const model = hash.get("model");
  if (model) shared.model = model;
  const view = hash.get("view")?.split(",").map(Number);
  if (view && view.every(Number.isFinite)) shared.view = view;
  const method = methodOf(hash.get("method") ?? "");
  if (method) shared.method = method;
  const ghost = methodOf(hash.get("ghost") ?? "");
  if (ghost) shared.ghost = ghost;
  return shared;
}

/** The name a model has in the gallery: that of its file. */
export const galleryName = (model: Pick<ModelMessage, "path">): string => model.path.replace(/^.*[\\/]/, "").replace(/\.sim$/, "");
