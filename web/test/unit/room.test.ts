import { expect, test } from "vitest";
import { addressWithOwn } from "../../src/room";
import { Session } from "../../src/session";
import { socketAddress } from "../../src/source";
import type { Command, RoleMessage } from "../../src/protocol";

const role = (parts: Partial<RoleMessage>): RoleMessage => ({ say: "role", role: "viewer", may: ["ping", "rate"], own_sessions: false, viewers_address: null, ...parts });

test("a page sends what the server's table allows, and nothing else", () => {
  const sent: Command[] = [];
  const session = new Session({ live: true, start: () => undefined, send: (command) => sent.push(command) });
  session.said(role({}));
  expect([session.live, session.may("ping"), session.may("play"), session.may("save")]).toEqual([false, true, false, false]);
  session.send({ do: "play" });
  session.send({ do: "save", text: "" });
  session.send({ do: "ping", id: 1 });
  expect(sent).toEqual([{ do: "ping", id: 1 }]);
  session.said(role({ role: "presenter", may: ["ping", "play", "run"] }));
  expect([session.live, session.may("play"), session.may("save")]).toEqual([true, true, false]);
});

test("a page that was told no role may do all", () => {
  const session = new Session({ live: true, start: () => undefined, send: () => undefined });
  expect([session.live, session.may("save")]).toEqual([true, true]);
  const recorded = new Session({ live: false, start: () => undefined, send: () => undefined });
  expect([recorded.live, recorded.may("play")]).toEqual([false, true]);
});

test("a session of one's own has an address of its own", () => {
  const watching = "http://lecture.example:8000/?token=abc#p.k=3";
  const own = addressWithOwn(watching, true);
  expect(own).toBe("http://lecture.example:8000/?token=abc&own=");
  expect(addressWithOwn(own, false)).toBe("http://lecture.example:8000/?token=abc");
  expect(socketAddress(new URL(own))).toBe("ws://lecture.example:8000/live?token=abc&own");
  expect(socketAddress(new URL(watching))).toBe("ws://lecture.example:8000/live?token=abc");
});
