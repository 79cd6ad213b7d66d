"""Adds the headings of the pages and the index of words to the search of Doxygen, which finds names of C++ and titles of
pages, and these by their first letters only. A heading is found by each of its words."""
import json
import re

COMMON = {"a", "an", "and", "are", "as", "at", "by", "for", "from", "how", "in", "is", "it", "its", "more", "not", "of",
          "on", "or", "that", "the", "their", "to", "what", "when", "where", "which", "with"}


def identifier(text):
    """As search.js turns what is typed into the name of a row."""
    return "".join(c if re.match(r"[a-z0-9\u0080-\uffff]", c) else f"_{ord(c):02x}" for c in text.lower())


def entries_of(title, target, scope):
    """(first letter, line) for each word of a title."""
    for match in re.finditer(r"[^\W_][\w']*", title):
        rest = title[match.start():]
        if match.group(0).lower() not in COMMON and rest[0].isascii():
            yield rest[0].lower(), identifier(rest), title, target, scope


def add(folder, rows):
    """`rows`: (title, address from the root of the site, the page's title)."""
    data = (folder / "searchdata.js").read_text()
    letters = re.search(r'0: "([^"]*)"', data).group(1)
    by_letter, seen = {}, set()
    for row in rows:
        for letter, name, title, target, scope in entries_of(*row):
            if (name, target) not in seen:
                seen.add((name, target))
                by_letter.setdefault(letter, []).append((name, title, target, scope))
    for letter, found in by_letter.items():
        if letter not in letters:
            continue  # no file for it
        file = folder / f"all_{letters.index(letter):x}.js"
        lines = [f"  ['{name}_d{i}',[{json.dumps(title)},['../{target}',1,{json.dumps(scope)}]]],\n"
                 for i, (name, title, target, scope) in enumerate(sorted(found))]
        text = file.read_text()
        start = "var searchData=\n[\n"
        if not text.startswith(start):
            raise RuntimeError(f"{file} has another layout")
        file.write_text(start + "".join(lines) + text[len(start):])
