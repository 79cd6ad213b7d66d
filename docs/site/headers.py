"""Copies headers for Doxygen, whose notation for comments differs from that of the headers.

The line numbers stay the same, so that a warning names a line of the header itself. In the copy
- the comment at the top of a header is the description of the file;
- the comment behind a member is its documentation;
- adjacent overloads of one name share the comment above the first;
- all declarations between `/// @{` and `/// @}` share the comment above these marks;
- functions that the compiler defines (`= default`, `= delete`) are documented as such;
- characters with a meaning for Doxygen are escaped, and indented lines of a comment are code.
"""
import re

SCOPE_HEADS = (
    ("namespace", re.compile(r"^\s*(inline\s+)?namespace\b")),
    ("enum", re.compile(r"^\s*enum\b")),
    ("class", re.compile(r"^\s*(template\s*<.*>\s*)?(requires\b.*\s)?(class|struct|union)\b", re.S)),
)


def kind_of(head):
    head = re.sub(r"^\s*(public|private|protected)\s*:", "", head.strip())
    for kind, pattern in SCOPE_HEADS:
        if pattern.match(head) and not (kind == "class" and re.search(r"\)\s*(const)?\s*$", head)):
            return kind
    return "body"


class Scopes:
    """The kinds of the braces that are open, read line by line."""

    def __init__(self):
        self.stack, self.head, self.in_comment = [], "", False

    def declares(self):
        """Whether a line here declares something: it is in no function and in no initialiser."""
        return all(kind != "body" for kind in self.stack) and self.head.count("(") <= self.head.count(")")

    def feed(self, code):
        for c in code + "\n":
            if c == "{":
                self.stack.append(kind_of(self.head))
                self.head = ""
            elif c == "}":
                if self.stack:
                    closed = self.stack.pop()
                    self.head = "" if closed != "body" else " "
            elif c == ";":
                self.head = ""
            else:
                self.head += c
        if self.head.lstrip().startswith("#"):
            self.head = ""


LITERAL = re.compile(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'')


def split_comment(line):
    """(code, comment) of a line; the comment without its slashes, None where there is none."""
    position = 0
    while True:
        slash = line.find("//", position)
        if slash < 0:
            return line, None
        literal = next((m for m in LITERAL.finditer(line) if m.start() < slash < m.end()), None)
        if literal is None:
            return line[:slash], line[slash:]
        position = literal.end()


def escaped(text):
    """Text of a comment for Doxygen: `code` stays code, everything else stands for itself."""
    parts = re.split(r"(`[^`]*`)", text)
    for i, part in enumerate(parts):
        if i % 2:
            parts[i] = "``" + part[1:-1] + "``"
        else:
            parts[i] = re.sub(r"([\\@#<>%*\"])", r"\\\1", part)
    return "".join(parts)


def comment_line(text, state):
    """One line of a block of comments after its slashes; `state` remembers whether the lines above are code."""
    indent = len(text) - len(text.lstrip(" "))
    if not text.strip():
        state["blank"] = True
        return text
    if indent >= 3 and (state["code"] or state["blank"]):
        state["code"], state["blank"] = True, False
        return "    " + text
    state["code"] = state["blank"] = False
    return escaped(text)


DECLARED = re.compile(r"(~?\w+|operator\s*(?:\(\)|\[\]|[^\s(]+|\w+))\s*\(")
GENERATED = re.compile(r"=\s*(default|delete)\s*;")


def declared_name(code):
    code = re.sub(r"\[\[.*?\]\]", "", code)
    code = re.sub(r"(explicit|noexcept|requires)\s*\([^()]*\)", "", code)
    match = DECLARED.search(code.split(" = ")[0])
    return re.sub(r"\s", "", match.group(1)) if match else None


def first_line_of_declaration(lines, number):
    """The line with the name, behind those of template parameters and requirements."""
    while number + 1 < len(lines) and re.match(r"\s*(template\b|requires\b)", lines[number]):
        number += 1
    return split_comment(lines[number])[0]


def undocumented_concepts(text):
    """(line, name) of each concept in a copy that has no comment. Doxygen does not warn of them."""
    lines, inside_private = text.split("\n"), None
    for number, line in enumerate(lines):
        private = re.match(r"namespace (\w*(?:bracketing|detail|enclosing|isolating)) \{", line)
        if private:
            inside_private = private.group(1)
        elif inside_private and line == f"}}  // namespace {inside_private}":
            inside_private = None
        concept = re.match(r"concept (\w+)", line)
        if not concept or inside_private:
            continue
        above = number
        while above > 0 and re.match(r"\s*(template\b|requires\b)", lines[above - 1]):
            above -= 1
        if not lines[above - 1].startswith("///") and "*/" not in lines[above]:
            yield number + 1, concept.group(1)


def staged(source, path):
    """The copy of a header's text. `path`: as programs include it."""
    lines = source.split("\n")
    result = []
    scopes = Scopes()
    at_top, state = True, {"code": False, "blank": False}
    last_doc, last_name, doc = [], None, []
    shared = None  # the comment of an open group
    for number, line in enumerate(lines):
        if line.startswith("extern template") or (result and result[-1] == " " and not line.startswith("}")):
            result.append("" if line.endswith(";") else " ")  # an instantiation is no declaration of its own
            continue
        code, comment = split_comment(line)
        if at_top and comment is not None and not code.strip():
            text = comment[2:]
            result.append("///" if text.strip().startswith("continuo/") else "///" + comment_line(text, state))
            continue
        if at_top and code.strip():
            at_top = False
            state = {"code": False, "blank": False}
            if code.strip() == "#pragma once":
                result.append(f"/// \\file {path}")
                continue
        if not code.strip():
            if comment is None:
                doc, last_name = [], None
                state = {"code": False, "blank": False}
                result.append(line)
            elif comment.strip() == "/// @{":
                for back in range(len(doc)):
                    result[-1 - back] = ""
                shared, doc, last_name = doc, [], None
                result.append("")
            elif comment.strip() == "/// @}":
                shared, last_name = None, None
                result.append("")
            elif comment.startswith("///"):
                text = comment_line(comment[3:], state)
                doc.append(text)
                last_name = None
                result.append(code + "///" + text)
            else:
                last_name = None
                result.append(line)
            continue
        state = {"code": False, "blank": False}
        declares = scopes.declares() and not code.lstrip().startswith(("#", "}", "public:", "private:", "protected:"))
        begins = declares and not scopes.head.strip()
        scopes.feed(LITERAL.sub("0", code))
        name = declared_name(first_line_of_declaration(lines, number)) if begins else None
        prefix = ""
        if begins and not doc and shared:
            prefix = "/** " + " ".join(shared).strip() + " */ "
        elif begins and not doc and name and name == last_name:
            prefix = "/** " + " ".join(last_doc).strip() + " */ "
        elif begins and not doc and GENERATED.search(code):
            prefix = "/** Defined by the compiler. */ " if "default" in GENERATED.search(code).group(1) else \
                     "/** Not available. */ "
        if comment is not None and declares and not comment.startswith("///") and not doc and not prefix \
                and re.search(r"[;,}\w)]\s*$", code) and "NOLINT" not in comment and "(" not in code.split("=")[0]:
            comment = "///<" + escaped(comment[2:])
        if begins:
            last_name = name
            if doc or not prefix:
                last_doc = doc
        if code.strip():
            doc = []
        indent = len(code) - len(code.lstrip())
        code = code.replace("explicit(false) ", "")  # which Doxygen takes for a part of the name
        result.append(code[:indent] + prefix + code[indent:] + (comment or ""))
    return "\n".join(result)
