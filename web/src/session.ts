// What the page knows of the run, and who wants to hear of changes. The one place that messages pass through.
import { History } from "./history";
import type { BusyMessage, Command, Diagnostic, EventMessage, Frame, ModelMessage, RoleMessage, Say, SolverMessage, StateMessage } from "./protocol";
import type { Link, Listener, Source } from "./source";

export interface Changes {
  link: Link;
  role: RoleMessage;
  room: { viewers: number };
  busy: BusyMessage;
  model: ModelMessage;
  state: StateMessage;
  frame: Frame;
  event: EventMessage;
  message: SolverMessage;
  checked: { id: number; diagnostics: Diagnostic[] };
  saved: string;
  values: { t: number; body: number; name: string; values: Record<string, number> };
  cursor: number | null;
  rewound: number;
  theme: "light" | "dark";
}

type Handlers = { [Name in keyof Changes]: ((what: Changes[Name]) => void)[] };

export class Session implements Listener {
  /** Null: of a recording, or not said yet. */
  role: RoleMessage | null = null;
  model: ModelMessage | null = null;
  state: StateMessage | null = null;
  frame: Frame | null = null;
  history = new History(0);
  events: EventMessage[] = [];
  /** Where the pointer is in a plot: every view shows this instant. */
  cursor: number | null = null;
  private readonly handlers: Handlers = {
    link: [], role: [], room: [], busy: [], model: [], state: [], frame: [], event: [], message: [], checked: [], saved: [], values: [], cursor: [], rewound: [], theme: [],
  };

  private run = -1;
  private eventsInFrames = 0;

  constructor(private readonly source: Source) {}

  /** Whether somebody at this page can change what moves: it is no recording, and not the presenter's alone. */
  get live(): boolean {
    return this.source.live && this.may("run");
  }

  /** Whether the server takes this command from this page. */
  may(command: Command["do"]): boolean {
    return this.role === null || this.role.may.includes(command);
  }

  on<Name extends keyof Changes>(name: Name, handler: (what: Changes[Name]) => void): void {
    this.handlers[name].push(handler);
  }

  tell<Name extends keyof Changes>(name: Name, what: Changes[Name]): void {
    for (const handler of this.handlers[name]) handler(what);
  }

  start(): void {
    this.source.start(this);
  }

  send(command: Command): void {
    if (this.may(command.do)) this.source.send(command);
  }

  /** The instant that is shown: under the pointer, else that of the picture. */
  get shownTime(): number {
    return this.cursor ?? this.frame?.t ?? this.state?.t ?? 0;
  }

  setCursor(t: number | null): void {
    if (t === this.cursor) return;
    this.cursor = t;
    this.tell("cursor", t);
  }

  linked(link: Link): void {
    this.tell("link", link);
  }

  said(message: Say): void {
    switch (message.say) {
      case "role":
        this.role = message;
        this.tell("role", message);
        break;
      case "room":
        this.tell("room", message);
        break;
      case "busy":
        this.tell("busy", message);
        break;
      case "model": {
        const before = this.model;
        const same = before !== null && sameModel(before, message);
        this.model = message;
        this.beginAnew(message.run);
        if (!same) {
          this.frame = null;
          this.cursor = null;
          this.tell("model", message);
        }
        break;
      }
      case "state":
        if (this.state?.ghost && !message.ghost) this.history.forgetGhost();
        this.state = message;
        this.tell("state", message);
        break;
      case "event":
        this.events.push(message);
        if (this.events.length > 5000) this.eventsInFrames = Math.max(0, this.eventsInFrames - this.events.splice(0, 1000).length);
        this.tell("event", message);
        break;
      case "message":
        this.tell("message", message);
        break;
      case "checked":
        this.tell("checked", message);
        break;
      case "saved":
        this.tell("saved", message.path);
        break;
      case "values":
        this.tell("values", message);
        break;
      case "pong":
        break;
    }
  }

  arrived(frame: Frame): void {
    // Events are told at once, frames a little later: those told since the last frame belong to this one's time.
    const fresh = this.events.splice(this.eventsInFrames).filter(({ t }) => frame.lookingBack || t <= frame.t);
    if (frame.run !== this.run) this.beginAnew(frame.run);
    if (frame.rewound) {
      const from = frame.rowTimes[0] ?? frame.t;
      this.events = this.events.filter((event) => event.t < from);
      this.tell("rewound", from);
    }
    this.events.push(...fresh);
    this.eventsInFrames = this.events.length;
    this.history.append(frame);
    this.frame = frame;
    this.tell("frame", frame);
  }

  /** The same model from its start again. */
  private beginAnew(run: number): void {
    this.run = run;
    this.history = new History(this.model?.columns.length ?? 0);
    this.events = [];
    this.eventsInFrames = 0;
    this.tell("rewound", -Infinity);
  }
}

/** Whether a page built for one model serves the other: then only the run is another. */
function sameModel(a: ModelMessage, b: ModelMessage): boolean {
  const essence = ({ run, undo, gallery, parameters, inputs, ...rest }: ModelMessage): string =>
    JSON.stringify([rest, parameters.map(({ value, ...each }) => each), inputs.map(({ value, ...each }) => each)]);
  return essence(a) === essence(b);
}
