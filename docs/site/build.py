#!/usr/bin/env python3
"""Builds the documentation as one site: the Markdown pages, a page for each verb of the command, and the reference of
the public headers.

usage: build.py --command CONTINUO --out FOLDER [--root REPOSITORY]

Prints the path of index.html, and warnings on standard error: of Doxygen, of links, and for public functions and types
without documentation. With warnings the exit code is 1."""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

sys.dont_write_bytecode = True
import headers
import layout
import pages
import search

HERE = pathlib.Path(__file__).resolve().parent
UNDOCUMENTED = re.compile(r"(?:Compound|Member) .* is not documented\.$")
# Members that are data, and short names of types within a class, may explain themselves.
PLAIN = re.compile(r"Member .* \((variable|enumvalue|typedef)\) of .* is not documented\.$")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--command", required=True)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--root", default=HERE.parent.parent, type=pathlib.Path)
    return parser.parse_args()


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


class Site:
    def __init__(self, root, command, out):
        self.root, self.out = root.resolve(), out.resolve()
        self.command = os.path.abspath(command)
        self.stage = self.out / ".stage"
        self.groups = []  # (title, [names of pages])
        self.pages = {}  # path in the repository -> Page
        self.warnings = []
        self.headers = []

    # Pages

    def add(self, name, path, text):
        self.pages[path] = pages.Page(name, path, text)
        return self.pages[path]

    def read_pages(self):
        """The front page lists the others in tables, each under the heading of its group."""
        front = (self.root / "docs/README.md").read_text()
        self.add("index", "docs/README.md", front)
        self.add("introduction", "README.md", (self.root / "README.md").read_text())
        self.add("gallery", "models/README.md", (self.root / "models/README.md").read_text())
        self.groups = [("Introduction", ["introduction"])]
        for line in front.split("\n"):
            if line.startswith("## "):
                self.groups.append((line[3:].strip(), []))
            row = re.match(r"\| \[[^]]*\]\(([^)]*\.md)\)", line)
            if not row:
                continue
            path = os.path.normpath(os.path.join("docs", row.group(1)))
            if path not in self.pages:
                name = pathlib.Path(path).stem
                self.add(name, path, (self.root / path).read_text())
            self.groups[-1][1].append(self.pages[path].name)
        self.groups = [group for group in self.groups if group[1]]
        for path in sorted((self.root / "docs").glob("*.md")):
            if f"docs/{path.name}" not in self.pages:
                self.warnings.append(f"docs/README.md: {path.name} is not listed")

    def read_verbs(self):
        overview = run([self.command, "help", "--markdown"])
        names = re.findall(r"\(verb_(\w+)\.md\)", overview.stdout)
        if overview.returncode or not names:
            sys.exit(f"{self.command} help --markdown: {overview.stderr}")
        self.add("verbs", "docs/verbs.md", overview.stdout)
        for name in names:
            text = run([self.command, "help", name, "--markdown"]).stdout
            text = re.sub(r"<!-- json: (.*) -->", lambda match: self.json_layout(match.group(1)), text)
            if "`--json`" in text and "## Layout of --json" not in text:
                self.warnings.append(f"continuo {name}: no example shows the layout of --json")
            self.add(f"verb_{name}", f"docs/verb_{name}.md", text)
        self.groups.insert(len(self.groups) - 1 if len(self.groups) > 2 else len(self.groups),
                           ("The command", ["verbs"] + [f"verb_{name}" for name in names]))

    def json_layout(self, commands):
        """The output of the last command, which may need the files of those before it."""
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(self.root / "models", f"{folder}/models")
            for command in commands.split(" && "):
                done = run([self.command] + command.split()[1:], cwd=folder)
        try:
            values = layout.documents(done.stdout)
            if not values:
                raise ValueError
        except ValueError:
            self.warnings.append(f"{command}: no JSON, exit code {done.returncode}: {done.stderr.strip()}")
            return ""
        shown = "\n".join(layout.layout(value) for value in values[:1])
        return f"```text\n$ {commands}\n{shown}\n```"

    def link(self, page):
        """How the links of a page become links in the site."""

        def target_of(address):
            if re.match(r"\w+:", address):
                return address
            path, _, anchor = address.partition("#")
            path = pages.relative(page, path) if path else page.path
            if (self.root / path / "README.md").is_file():
                path = f"{path}/README.md" if f"{path}/README.md" in self.pages else path
            if path in self.pages:
                other = self.pages[path]
                if anchor and anchor not in other.anchors:
                    self.warnings.append(f"{page.path}: {other.path} has no heading #{anchor}")
                file = f"{other.name}.html"
                if anchor and any(slug == anchor for _, slug, *_ in other.sections):
                    return f"{file}#{other.name}--{anchor}"
                return file
            if path in self.headers:
                return f"header:{path}"
            source = self.root / path
            if source.is_file():
                name = path if path.startswith("models/") else f"files/{path}"
                copy = self.out / name
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, copy)
                return name
            if not source.is_dir():
                self.warnings.append(f"{page.path}: {address} does not exist")
            return None

        def title_of(address):
            other = self.pages.get(pages.relative(page, address.partition("#")[0]))
            return other.title if other else None

        target_of.title_of = title_of
        return target_of

    # Headers

    def stage_headers(self):
        found = sorted((self.root / "continuo").glob("*.hpp")) + sorted((self.root / "continuo").glob("*/*.hpp"))
        self.headers = [str(path.relative_to(self.root)) for path in found]
        namespaces = {}
        for header in self.headers:
            copy = self.stage / header
            copy.parent.mkdir(parents=True, exist_ok=True)
            text = (self.root / header).read_text()
            copy.write_text(headers.staged(text, header))
            for line, name in headers.undocumented_concepts(copy.read_text()):
                self.warnings.append(f"{header}:{line}: warning: Member {name} (concept) is not documented.")
            for name in re.findall(r"^namespace ([\w:]+) \{", text, flags=re.M):
                namespaces.setdefault(name, set()).add("/".join(header.split("/")[:2]))
        # Doxygen shows the members of documented namespaces only.
        modules = ["/** \\namespace continuo\n\\brief The library. */\n"]
        for name, places in sorted(namespaces.items()):
            if name.startswith("continuo::"):
                modules.append(f"/** \\namespace {name}\n\\brief Declared in {', '.join(sorted(places))}. */\n")
        for readme in sorted((self.root / "continuo").glob("*/README.md")):
            if not any(header.startswith(f"continuo/{readme.parent.name}/") for header in self.headers):
                continue
            text = readme.read_text().split("\n", 1)[1].strip().split("\n\n")[0]
            sentence = "" if text.startswith("|") else re.split(r"(?<=[.:;])\s", text.replace("\n", " "))[0].rstrip(":;")
            modules.append(f"/** \\dir continuo/{readme.parent.name}\n\\brief {headers.escaped(sentence)} */\n")
        (self.stage / "modules.dox").write_text("".join(modules))

    # The site

    def write_layout(self):
        path = self.stage / "layout.xml"
        run(["doxygen", "-l", str(path)])
        titles = {page.name: page.title for page in self.pages.values()}

        def quoted(text):
            return text.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")

        tabs = ['<tab type="mainpage" visible="yes" title="Contents"/>']
        for title, names in self.groups:
            tabs.append(f'<tab type="usergroup" visible="yes" title="{quoted(title)}">')
            tabs += [f'<tab type="user" visible="yes" url="{name}.html" title="{quoted(titles[name])}"/>'
                     for name in names]
            tabs.append("</tab>")
        tabs.append('<tab type="usergroup" visible="yes" title="C++ reference">')
        tabs += [f'<tab type="{kind}" visible="yes" title="{title}" intro=""/>'
                 for kind, title in (("filelist", "Headers"), ("classlist", "Classes"), ("concepts", "Concepts"),
                                     ("namespacelist", "Namespaces"), ("namespacemembers", "Index of names"))]
        tabs.append("</tab>")
        text = re.sub(r"<navindex>.*</navindex>", lambda _: "<navindex>" + "\n".join(tabs) + "</navindex>",
                      path.read_text(), flags=re.S)
        path.write_text(text)

    def doxygen(self):
        version = re.search(r"project\(\w+ VERSION ([\d.]+)", (self.root / "CMakeLists.txt").read_text()) \
            if (self.root / "CMakeLists.txt").exists() else None
        settings = (HERE / "Doxyfile").read_text() + f"""
PROJECT_NUMBER = {version.group(1) if version else ""}
OUTPUT_DIRECTORY = {self.out}
INPUT = {self.stage}
STRIP_FROM_PATH = {self.stage}
LAYOUT_FILE = {self.stage}/layout.xml
HTML_EXTRA_STYLESHEET = {HERE}/style.css
GENERATE_TAGFILE = {self.stage}/names.tag
WARN_LOGFILE = {self.stage}/warnings.txt
"""
        (self.stage / "Doxyfile").write_text(settings)
        done = run(["doxygen", str(self.stage / "Doxyfile")])
        if done.returncode:
            sys.exit(f"doxygen failed: {done.stderr}")
        for line in (self.stage / "warnings.txt").read_text().split("\n"):
            if line.strip() and not PLAIN.search(line):
                self.warnings.append(line.replace(f"{self.stage}/", ""))

    def link_headers(self):
        """The names of the pages of headers are known only now."""
        places = {}
        for compound in ElementTree.parse(self.stage / "names.tag").getroot().findall("compound[@kind='file']"):
            name = compound.findtext("path", "") + compound.findtext("name", "")
            places[os.path.relpath(name, self.stage) if name.startswith("/") else name] = compound.findtext("filename")
        for page in self.pages.values():
            file = self.out / f"{page.name}.html"
            if not file.exists():
                self.warnings.append(f"{page.path}: it has no page in the site")
                continue
            text = file.read_text()

            def place(match):
                name = places.get(match.group(1), "")
                if name and not name.endswith(".html"):
                    name += ".html"
                if not name or not (self.out / name).exists():
                    self.warnings.append(f"{page.path}: {match.group(1)} has no page in the site")
                return f'href="{name}"'

            file.write_text(re.sub(r'href="header:([^"]*)"', place, text))

    def add_to_search(self):
        rows = []
        for page in self.pages.values():
            if page.name == "index":
                continue
            rows.append((page.title, f"{page.name}.html", "page"))
            rows += [(title, f"{page.name}.html#{page.name}--{slug}", page.title)
                     for level, slug, title, _ in page.sections if level is not None]
            if page.name == "words":
                for word, target in re.findall(r"^\| ([^|]+) \| [^|]+ \| \[[^]]*\]\(([^)]*)\) \|$", page.text, flags=re.M):
                    target = self.link(page)(target)
                    rows.append((word.strip("`"), "words.html" if target.startswith("header:") else target, page.title))
        search.add(self.out / "search", rows)

    def build(self):
        if self.out.exists() and any(self.out.iterdir()) and not self.stage.exists():
            sys.exit(f"{self.out} is no site, and is not overwritten")
        shutil.rmtree(self.out, ignore_errors=True)
        self.stage.mkdir(parents=True)
        self.stage_headers()
        self.read_pages()
        self.read_verbs()
        for page in self.pages.values():
            text = page.doxygen(self.link(page), front=page.name == "index")
            (self.stage / f"{page.name}.dox").write_text(text)
        self.write_layout()
        self.doxygen()
        self.link_headers()
        self.add_to_search()


def main():
    options = arguments()
    if shutil.which("doxygen") is None:
        sys.exit("doxygen is not installed")
    site = Site(options.root, options.command, options.out)
    site.build()
    for line in site.warnings:
        print(line, file=sys.stderr)
    print(site.out / "index.html")
    return 1 if site.warnings else 0


if __name__ == "__main__":
    sys.exit(main())
