// Where the motion comes from: the server behind a WebSocket, or a recording in the page.
import { decodeFrame, runOfFrame } from "./protocol";
import type { Command, Frame, ModelMessage, Say } from "./protocol";

export type Link = "connecting" | "open" | "lost" | "recording";

export interface Listener {
  said(message: Say): void;
  arrived(frame: Frame): void;
  linked(link: Link): void;
}

export interface Source {
  readonly live: boolean;
  start(listener: Listener): void;
  send(command: Command): void;
}

/** The server. A connection that breaks is tried again, at ever longer intervals up to 3 s. */
export class Server implements Source {
  readonly live = true;
  private socket: WebSocket | null = null;
  private tries = 0;
  private waiting: Command[] = [];
  private model: ModelMessage | null = null;

  constructor(private readonly address: string) {}

  start(listener: Listener): void {
    listener.linked("connecting");
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.tries = 0;
      listener.linked("open");
      for (const command of this.waiting.splice(0)) this.send(command);
    };
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      if (typeof data !== "string") return this.read(data, listener);
      const message = JSON.parse(data) as Say;
      if (message.say === "model") this.model = message;
      listener.said(message);
    };
    socket.onclose = () => {
      this.socket = null;
      listener.linked("lost");
      setTimeout(() => this.start(listener), Math.min(3000, 250 * 2 ** this.tries++));
    };
  }

  /** Frames of another run than the model's are dropped: their numbers mean something else. */
  private read(data: ArrayBuffer, listener: Listener): void {
    if (!this.model || runOfFrame(data) !== this.model.run) return;
    const frame = decodeFrame(data, this.model);
    if (typeof frame === "string") console.error(`continuo: ${frame}`);
    else listener.arrived(frame);
  }

  send(command: Command): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(command));
    else if (this.tries === 0) this.waiting.push(command);
  }
}

/** The address of the server's socket, from that of the page. */
export function socketAddress(location: Pick<Location, "protocol" | "host" | "search">): string {
  const query = new URLSearchParams(location.search);
  const token = query.get("token");
  const secure = location.protocol === "https:" ? "wss:" : "ws:";
  return `${secure}//${location.host}/live${token ? `?token=${encodeURIComponent(token)}` : ""}${token && query.has("own") ? "&own" : ""}`;
}
