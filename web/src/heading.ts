// The comment at the top of a model, as a page shows it: its first line is the title; what begins with "Watch" or "To see" says
// what to see and always stays in sight.
import { make } from "./dom";

export interface Heading {
  title: string;
  watch: string | null;
  paragraphs: { text: string; code: boolean }[];
}

/** Lines that are indented, or show a command, stay as they are; others flow. */
export function parseHeading(comment: string): Heading {
  const lines = comment.split("\n").map((line) => line.replace(/^\s*#\s?/, "").trimEnd());
  const paragraphs: Heading["paragraphs"] = [];
  let open = false;
  for (const line of lines) {
    if (line.trim() === "") {
      open = false;
      continue;
    }
    const code = /^\s{2,}\S/.test(line) || /^(Try:)?\s*continuo /.test(line);
    const last = paragraphs.at(-1);
    if (open && last && last.code === code) last.text += code ? `\n${line}` : ` ${line.trim()}`;
    else if (!code && last && !last.code && /^(Watch|See)\b/.test(line) === false && open) last.text += ` ${line.trim()}`;
    else paragraphs.push({ text: code ? line : line.trim(), code });
    open = true;
  }
  const split = paragraphs.flatMap((paragraph) => {
    const at = paragraph.code ? -1 : paragraph.text.search(/(?<=[.:;] )(Watch|See|To see)\b/);
    return at > 0 ? [{ text: paragraph.text.slice(0, at).trim(), code: false }, { text: paragraph.text.slice(at), code: false }] : [paragraph];
  });
  const [first, ...rest] = split;
  const watch = rest.find(({ text, code }) => !code && /^(Watch|See|To see)\b/.test(text)) ?? null;
  // What announces commands is nothing without them: they are below "More".
  return { title: first?.text ?? "", watch: watch?.text.replace(/\s*[^.:;!?]*:$/, "") ?? null, paragraphs: rest.filter((each) => each !== watch) };
}

/** Words between backquotes are code. */
export const spans = (text: string): (Node | string)[] => text.split("`").map((part, index) => (index % 2 === 1 ? make("code", {}, part) : part));

/** The band above the scene. */
export function headingElement(name: string, comment: string): HTMLElement {
  const { title, watch, paragraphs } = parseHeading(comment);
  const lead = watch ?? paragraphs.find(({ code }) => !code)?.text ?? null;
  const more = paragraphs.filter(({ text }) => text !== lead);
  return make(
    "section",
    { class: "heading", "aria-label": "What to see" },
    make("h1", {}, ...spans(title || name)),
    lead ? make("p", { class: "watch" }, ...spans(lead)) : null,
    more.length > 0 ? make("details", {}, make("summary", {}, "More"), ...more.map(({ text, code }) => (code ? make("pre", {}, text) : make("p", {}, ...spans(text))))) : null,
  );
}
