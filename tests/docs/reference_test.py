"""usage: reference_test.py CONTINUO REPOSITORY

Builds the documentation as a site, as `./continuo.sh docs` does, and tests that Doxygen and the links give no warning, that
every public function, class and concept is documented, and that the reference names all that libclang finds."""
import pathlib
import re
import sys
import tempfile
import unittest
import urllib.parse
import xml.etree.ElementTree as ElementTree

sys.dont_write_bytecode = True
COMMAND, ROOT = sys.argv[1], pathlib.Path(sys.argv[2])
sys.path.insert(0, str(ROOT / "docs/site"))
import build  # noqa: E402


def missing_of(site):
    """The warnings for functions, types and concepts without documentation."""
    return [line for line in site.warnings if build.UNDOCUMENTED.search(line)]


class Reference(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.site = build.Site(ROOT, COMMAND, pathlib.Path(cls.folder.name) / "site")
        cls.site.build()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_is_built_without_a_warning(self):
        self.assertEqual([line for line in self.site.warnings if not build.UNDOCUMENTED.search(line)], [])

    def test_every_public_function_type_and_concept_has_a_docstring(self):
        self.assertEqual(missing_of(self.site), [])

    def test_every_link_leads_somewhere(self):
        out = self.site.out
        anchors = {}
        for file in out.glob("*.html"):
            text = file.read_text()
            anchors[file.name] = (set(re.findall(r'\b(?:id|name)="([^"]*)"', text)), text)
        self.assertGreater(len(anchors), 100)
        for page in self.site.pages.values():
            _, text = anchors[f"{page.name}.html"]
            for target in re.findall(r'<(?:a|img)\b[^>]*\b(?:href|src)="([^"]*)"', text):
                if re.match(r"\w+:", target) or not target:
                    continue
                name, _, anchor = urllib.parse.unquote(target).partition("#")
                with self.subTest(page=page.path, target=target):
                    self.assertTrue(not name or (out / name).exists())
                    if anchor and (name or f"{page.name}.html").endswith(".html"):
                        self.assertIn(anchor, anchors[name or f"{page.name}.html"][0])

    def test_every_verb_has_a_page_in_the_search(self):
        index = "".join(file.read_text() for file in (self.site.out / "search").glob("pages_*.js"))
        for page in self.site.pages.values():
            if page.name != "index":
                self.assertIn(f"{page.name}.html", index)

    def test_names_every_public_function(self):
        try:
            from clang import cindex
        except ImportError:
            self.skipTest("no libclang")
        named = set()
        for compound in ElementTree.parse(self.site.stage / "names.tag").getroot().iter("compound"):
            scope = without_arguments(compound.findtext("name", ""))
            if compound.get("kind") in ("class", "struct", "union", "concept"):
                named.add(scope)
            for member in compound.findall("member"):
                named.add(f"{scope}::" + re.sub(r"\s", "", member.findtext("name", "")))
        missing = []
        names = public_names(cindex)
        self.assertGreater(len(names), 1000)
        for name, place in names:
            if name not in named:
                missing.append(f"{place}: {name}")
        self.assertEqual(missing, [])


def without_arguments(name):
    """A qualified name without the arguments of templates."""
    while True:
        shorter = re.sub(r"\s*<[^<>]*>", "", name)
        if shorter == name:
            return name
        name = shorter


def public_names(cindex):
    """(qualified name, place) of each function, class and concept of the public headers, as libclang sees them."""
    kinds = {cindex.CursorKind.FUNCTION_DECL, cindex.CursorKind.FUNCTION_TEMPLATE, cindex.CursorKind.CXX_METHOD,
             cindex.CursorKind.CLASS_DECL, cindex.CursorKind.STRUCT_DECL, cindex.CursorKind.CLASS_TEMPLATE,
             cindex.CursorKind.CONCEPT_DECL}
    scopes = {cindex.CursorKind.NAMESPACE, cindex.CursorKind.CLASS_DECL, cindex.CursorKind.STRUCT_DECL,
              cindex.CursorKind.CLASS_TEMPLATE}
    headers = sorted(ROOT.glob("continuo/*/*.hpp"))
    text = "".join(f"#include <{header.relative_to(ROOT)}>\n" for header in headers)
    unit = cindex.Index.create().parse(
        "all.cpp", args=["-std=c++20", f"-I{ROOT}", "-I/usr/include/eigen3", "-w"], unsaved_files=[("all.cpp", text)],
        options=cindex.TranslationUnit.PARSE_SKIP_FUNCTION_BODIES)
    fatal = [problem for problem in unit.diagnostics if problem.severity >= cindex.Diagnostic.Error]
    if fatal:
        raise AssertionError(f"libclang cannot read the headers: {fatal[0]}")
    public = {str(header) for header in headers}

    def found(cursor, scope):
        spelling = cursor.spelling
        name = spelling if spelling.startswith("operator") else without_arguments(spelling)
        place = f"{pathlib.Path(cursor.location.file.name).relative_to(ROOT)}:{cursor.location.line}"
        return scope + re.sub(r"\s", "", name), place

    def walk(cursor, scope):
        for child in cursor.get_children():
            is_public = child.location.file is not None and child.location.file.name in public
            if child.kind == cindex.CursorKind.NAMESPACE and child.spelling in (
                    "bracketing", "detail", "enclosing", "isolating", ""):
                continue
            if child.access_specifier in (cindex.AccessSpecifier.PRIVATE, cindex.AccessSpecifier.PROTECTED):
                continue
            # Doxygen and libclang name a conversion to a template differently.
            if child.spelling.startswith("<deduction guide") or "type-parameter" in child.spelling:
                continue
            if is_public and child.kind in kinds and child.spelling and not child.is_anonymous() \
                    and (child.is_definition() or child.kind not in scopes):
                yield found(child, scope)
            if is_public and child.kind == cindex.CursorKind.FRIEND_DECL:  # functions that are defined in a class
                yield from (found(friend, scope) for friend in child.get_children()
                            if friend.kind in kinds - scopes and friend.is_definition())
            if child.kind in scopes and (is_public or child.kind == cindex.CursorKind.NAMESPACE):
                yield from walk(child, f"{scope}{without_arguments(child.spelling)}::")

    return list(walk(unit.cursor, ""))


class TestOfTheTest(unittest.TestCase):
    """A repository of one header with and without docstrings."""

    def build(self, header):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder) / "root"
            for path, text in {"README.md": "# A\n", "docs/README.md": "# B\n", "models/README.md": "# C\n",
                               "continuo/status/one.hpp": header}.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text)
            (root / "models").mkdir(exist_ok=True)
            site = build.Site(root, COMMAND, pathlib.Path(folder) / "site")
            site.read_verbs = lambda: None
            site.build()
            return "\n".join(missing_of(site))

    HEADER = """// One header.
#pragma once
namespace continuo {{
{0}template <class X>
concept Thing = sizeof(X) > 0;
{1}template <Thing X>
struct Box {{
  X x;
  {2}int size() const {{ return 1; }}
}};
{3}inline int number(int a) {{ return a; }}
}}  // namespace continuo
"""

    def test_a_name_without_docstring_is_found(self):
        doc = "/// A docstring.\n"
        self.assertEqual(self.build(self.HEADER.format(doc, doc, doc, doc)), "")
        for i, name in enumerate(["Thing", "Box", "size", "number"]):
            docs = [doc] * 4
            docs[i] = ""
            with self.subTest(name=name):
                self.assertIn(name, self.build(self.HEADER.format(*docs)))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
