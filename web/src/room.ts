// Who is in the room: that this page only sees, or has a session of its own; how many see the presenter's page, and by
// which address; and what takes the simulator long.
import { openDialog } from "./dialog";
import { iconButton, make, setText } from "./dom";
import type { Session } from "./session";

/** The same page with a session of its own, or with that of the presenter again. */
export function addressWithOwn(address: string, own: boolean): string {
  const url = new URL(address);
  url.searchParams.delete("own");
  if (own) url.searchParams.set("own", "");
  url.hash = "";  // what it says of parameters is of the other session
  return url.toString();
}

export class Room {
  readonly element = make("div", { class: "room" });
  private readonly busy = make("span", { class: "busy", role: "status", hidden: true });
  private readonly busyWords = make("span", {});
  private readonly watchers = make("button", { type: "button", class: "link watchers", title: "The address for viewers", onclick: () => this.showAddress() });

  constructor(private readonly session: Session) {
    this.watchers.hidden = true;
    const stop = iconButton("close", "Stop: give up this step, and pause", "", () => session.send({ do: "cancel" }));
    this.busy.append(make("span", { class: "wheel", "aria-hidden": "true" }), this.busyWords);
    if (session.may("cancel")) this.busy.append(stop);
    this.element.append(this.busy, ...this.roleParts(), this.watchers);
    session.on("busy", ({ with: what, seconds }) => {
      this.busy.hidden = what === null;
      if (what !== null) setText(this.busyWords, `${what === "motion" ? "computing a step" : "preparing the model"}: ${seconds.toFixed(0)} s`);
    });
    session.on("room", ({ viewers }) => {
      this.watchers.hidden = viewers === 0 && session.role?.viewers_address === null;
      setText(this.watchers, viewers === 1 ? "1 viewer" : `${viewers} viewers`);
    });
    session.on("link", (link) => {
      if (link === "lost") this.busy.hidden = true;
    });
  }

  private roleParts(): HTMLElement[] {
    const { role } = this.session;
    if (!role || role.role === "presenter") return [];
    const own = role.role === "owner";
    const badge = make("span", { class: "badge" }, own ? "your own session" : "you are watching");
    if (!own && !role.own_sessions) return [badge];
    const words = own ? "Watch the presenter" : "Try it yourself";
    return [badge, make("button", { type: "button", class: "link own", onclick: () => location.assign(addressWithOwn(location.href, !own)) }, words)];
  }

  private showAddress(): void {
    const address = this.session.role?.viewers_address;
    if (!address) return;
    openDialog("For viewers", make("div", { class: "viewers-address" }, make("p", {}, "Who opens this address sees the page, and changes nothing on it:"), make("p", { class: "address" }, address)));
  }
}
