// The bar on top: play, pause, step, back, reset, to the next event; time, speed and whether the machine keeps up.
import { iconButton, make, setText } from "./dom";
import { formatReached, formatSpeed, formatSteady, formatUnit } from "./format";
import type { StateMessage } from "./protocol";
import type { Session } from "./session";

const speeds = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50, 100, 1000, 1e4, 1e6, 0];

export class Transport {
  readonly element = make("div", { class: "transport", role: "toolbar", "aria-label": "Transport" });
  private readonly play: HTMLButtonElement;
  private readonly pause: HTMLButtonElement;
  private readonly time = make("output", { class: "time", "aria-label": "Time" });
  private readonly speed = make("select", { "aria-label": "Speed, times real time", title: "Speed, times real time ([ slower, ] faster)" });
  private readonly reached = make("span", { class: "reached", title: "The speed reached" });
  private readonly slow = make("span", { class: "slow", role: "status", hidden: true });
  private readonly line = make("input", { type: "range", class: "timeline", min: 0, max: 1, step: "any", value: 0, "aria-label": "Time in the history" });
  private scrubbing = false;

  constructor(private readonly session: Session) {
    const send = (name: "play" | "pause" | "step" | "back" | "reset" | "until_event") => () => session.send({ do: name });
    this.play = iconButton("play", "Play", "Space", send("play"));
    this.pause = iconButton("pause", "Pause", "Space", send("pause"));
    this.play.classList.add("main");
    this.pause.classList.add("main");
    this.pause.hidden = true;
    this.speed.append(...speeds.map((value) => make("option", { value }, formatSpeed(value))));
    this.speed.addEventListener("change", () => {
      session.send({ do: "speed", value: Number(this.speed.value) });
      this.speed.blur();
    });
    this.line.addEventListener("input", () => {
      this.scrubbing = true;
      if (session.state?.playing) session.send({ do: "pause" });
      session.send({ do: "seek", t: Number(this.line.value) });
    });
    this.line.addEventListener("change", () => (this.scrubbing = false));
    this.element.append(
      make(
        "div",
        { class: "buttons" },
        iconButton("reset", "Reset to the start", "r", send("reset")),
        iconButton("back", "One step back", "←", send("back")),
        this.play,
        this.pause,
        iconButton("step", "One step on", "→", send("step")),
        iconButton("event", "Run until the next event", "n", send("until_event")),
      ),
      this.time,
      this.line,
      make("label", { class: "speed" }, make("span", { class: "label" }, "speed"), this.speed),
      this.reached,
      this.slow,
    );
    if (!session.may("play")) for (const part of this.element.querySelectorAll<HTMLInputElement>("button, select, input")) part.disabled = true;
    session.on("state", (state) => this.show(state));
    session.on("frame", ({ t }) => this.showTime(t));
  }

  toggle(): void {
    this.session.send({ do: this.session.state?.playing ? "pause" : "play" });
  }

  /** The next speed of the list, slower or faster. */
  change(by: number): void {
    const now = this.session.state?.target ?? 1;
    const order = (value: number): number => (value === 0 ? Infinity : value);
    const index = by > 0 ? speeds.findIndex((value) => order(value) > order(now) * 1.0001) : speeds.findLastIndex((value) => order(value) < order(now) * 0.9999);
    if (index >= 0) this.session.send({ do: "speed", value: speeds[index]! });
  }

  private show(state: StateMessage): void {
    this.play.hidden = state.playing;
    this.pause.hidden = !state.playing;
    this.element.classList.toggle("playing", state.playing);
    if (document.activeElement !== this.speed) {
      if (![...this.speed.options].some(({ value }) => Number(value) === state.target)) {
        this.speed.append(make("option", { value: state.target }, formatSpeed(state.target)));
      }
      this.speed.value = String(state.target);
    }
    setText(this.reached, state.playing ? `reached ${formatReached(state.reached, state.target)}` : state.ended ? "ended" : "paused");
    this.slow.hidden = !(state.slow && state.playing);
    if (state.slow) setText(this.slow, this.slow.title = `Too slow for ${formatSpeed(state.target)}: this model runs at ${formatReached(state.reached, state.target)} here`);
    this.line.min = String(state.history[0]);
    this.line.max = String(Math.max(state.history[1], state.history[0]));
    this.showTime(this.session.frame?.t ?? state.t);
  }

  private showTime(t: number): void {
    const unit = formatUnit(this.session.model?.time_unit ?? "");
    setText(this.time, `t = ${formatSteady(t, 5)}${unit ? `\u2009${unit}` : ""}`);
    if (this.scrubbing) return;
    if (t > Number(this.line.max)) this.line.max = String(t);
    this.line.value = String(t);
    const span = Number(this.line.max) - Number(this.line.min);
    this.line.style.setProperty("--part", span > 0 ? `${(100 * (t - Number(this.line.min))) / span}%` : "100%");
    this.line.setAttribute("aria-valuetext", this.time.textContent ?? "");
  }
}
