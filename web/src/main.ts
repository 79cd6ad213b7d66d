import "uplot/dist/uPlot.min.css";
import "./style/base.css";
import "./style/layout.css";
import "./style/top.css";
import "./style/room.css";
import "./style/plots.css";
import "./style/controls.css";
import "./style/text.css";
import "./style/small.css";
import "./style/draw.css";
import "./style/present.css";
import { App } from "./app";
import { findRecording, Player } from "./recording";
import { Session } from "./session";
import { Server, socketAddress } from "./source";

const recording = findRecording(document);
const session = new Session(recording ? new Player(recording) : new Server(socketAddress(location)));
const embedded = new URLSearchParams(location.search).has("embed");
let begun = false;

/** As soon as it is known what this page may do. */
function begin(): void {
  if (begun) return;
  begun = true;
  const app = new App(session, document.getElementById("app")!, embedded);
  /** For those who script the page from its console, and for the tests. */
  Object.assign(window, { continuo: { session, app } });
}

session.on("role", begin);
session.on("model", begin);
session.on("link", (link) => link === "lost" && begin());
if (recording) begin();
session.start();
