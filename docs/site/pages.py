"""Turns Markdown pages into pages for Doxygen: the text as HTML, the headings as Doxygen's own, so that search, the
sidebar and links know them."""
import html
import os
import re

import markdown

KEYWORDS = {
    "sim": r"\b(model|param|mode|when|in|go|energy|run|output|method|tol|plot|check|within|let|input|unknown|world|body|wall|"
           r"falls|rises|crosses|through|if|else|for|sum|every|at|against|step|until|view|boundary|table)\b",
    "cpp": r"\b(auto|bool|class|const|constexpr|double|else|enum|false|float|for|if|int|namespace|return|static|std|struct|"
           r"template|true|typename|using|void|while)\b",
}


def slug_of(heading):
    """The anchor of a heading, by the rules of GitHub."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").strip().lower()
    return re.sub(r"\s", "-", re.sub(r"[^\w\s-]", "", text))


def plain(heading):
    return re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").strip()


def code_block(information, text):
    """A block of code with its comments, keywords and typed commands marked."""
    language = (information.split() or ["text"])[0]
    lines = []
    for line in text.split("\n"):
        shown = html.escape(line, quote=False)
        if language == "console" and line.startswith("$ "):
            shown = f"<b>{shown}</b>"
        elif language in KEYWORDS:
            mark = {"sim": "#", "cpp": "//"}[language]
            code, comment = shown, ""
            if mark in shown and not (language == "cpp" and line.startswith("#")):
                code, comment = shown[:shown.index(mark)], shown[shown.index(mark):]
            code = re.sub(KEYWORDS[language], r"<b>\1</b>", code)
            shown = code + (f"<i>{comment}</i>" if comment else "")
        lines.append(shown)
    return f'<pre class="language-{language}">' + "\n".join(lines) + "</pre>"


def with_room_for_lists(text):
    """A list may follow its sentence without a blank line, as on a forge."""
    lines, result = text.split("\n"), []
    item = re.compile(r"^(\s*)([-*]|\d+\.) ")
    in_list = False
    for line in lines:
        if item.match(line) and not in_list and result and result[-1].strip():
            result.append("")
        if item.match(line):
            in_list = True
        elif not line.strip() or not line.startswith(" "):
            in_list = in_list and line.strip() == "" and False
        result.append(line)
    return "\n".join(result)


class Page:
    """One Markdown file. `path`: relative to the root of the repository; `name`: of the page in the site."""

    def __init__(self, name, path, text):
        self.name, self.path, self.text = name, path, text
        self.title, self.sections, self.anchors = None, [], set()
        self._split(text)

    def _split(self, text):
        self.sections = [(None, None, None, [])]
        fence = None
        counts = {}
        for line in text.split("\n"):
            if line.startswith("```"):
                fence = None if fence else line
            heading = None if fence or line.startswith("```") else re.match(r"(#{1,5}) (.*)", line)
            if heading and self.title is None:
                self.title = plain(heading.group(2))
                self.anchors.add(slug_of(heading.group(2)))
            elif heading:
                slug = slug_of(heading.group(2))
                counts[slug] = counts.get(slug, -1) + 1
                if counts[slug]:
                    slug = f"{slug}-{counts[slug]}"
                self.anchors.add(slug)
                self.sections.append((len(heading.group(1)), slug, plain(heading.group(2)), []))
            else:
                self.sections[-1][3].append(line)
        if self.title is None:
            self.title = self.name

    def _html(self, lines, link):
        """HTML of one section; `link` maps the address of a link to one in the site, or to None for text alone."""
        blocks, prose, fence = [], [], None
        for line in lines:
            if line.startswith("```"):
                if fence is None:
                    fence = (line[3:].strip(), [])
                    prose.append(f"\n@@block{len(blocks)}@@\n")
                else:
                    blocks.append(code_block(fence[0], "\n".join(fence[1])))
                    fence = None
            elif fence is not None:
                fence[1].append(line)
            else:
                prose.append(line)
        text = markdown.Markdown(extensions=["tables", "sane_lists"], tab_length=2).convert(
            with_room_for_lists("\n".join(prose)))
        for i, block in enumerate(blocks):
            text = text.replace(f"<p>@@block{i}@@</p>", block).replace(f"@@block{i}@@", block)
        text = text.replace("<table>", '<table class="page">')

        def anchor(match):
            address = html.unescape(match.group(1))
            target, text = link(address), match.group(2)
            if text.endswith(".md"):  # the name of a file says less than its title
                text = html.escape(link.title_of(address) or text)
            return text if target is None else f'<a href="{html.escape(target)}">{text}</a>'

        def picture(match):
            return match.group(0).replace(match.group(1), link(html.unescape(match.group(1))))

        text = re.sub(r'<a href="([^"]*)">(.*?)</a>', anchor, text, flags=re.S)
        return re.sub(r'<img [^>]*src="([^"]*)"[^>]*>', picture, text)

    def doxygen(self, link, front=False):
        """The page in a comment for Doxygen."""
        out = ["/**", f"\\mainpage {self.title}" if front else f"\\page {self.name} {self.title}"]
        if sum(1 for level, *_ in self.sections if level == 2) > 3:
            out.append("\\tableofcontents")
        for level, slug, title, lines in self.sections:
            if level is not None:
                command = {2: "section", 3: "subsection"}.get(level, "subsubsection")
                escaped = re.sub(r"([\\@#<>%&\"]|--)", r"\\\1", title)  # -- would become a dash
                out.append(f"\\{command} {self.name}--{slug} {escaped}")
            body = self._html(lines, link).replace("/*", "&#47;*").replace("*/", "*&#47;")
            if body.strip():
                out += ["\\htmlonly", body, "\\endhtmlonly"]
        out.append("*/")
        return "\n".join(out) + "\n"


def relative(page, target):
    """The path in the repository that a link of a page means."""
    return os.path.normpath(os.path.join(os.path.dirname(page.path), target))
