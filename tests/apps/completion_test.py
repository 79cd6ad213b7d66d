#!/usr/bin/env python3
"""The completion of command lines and the manual pages, which come from the declarations of the verbs."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

continuo, root = sys.argv[1], pathlib.Path(sys.argv[2])
failures = []


def fail(*text):
    failures.append(" ".join(str(part) for part in text))
    print("FAILED", failures[-1])


def run(*words):
    return subprocess.run(words, capture_output=True, text=True, timeout=120)


def completed(*words):
    done = run(continuo, "--complete", *words)
    if done.returncode or done.stderr:
        fail("completion of", words, "ends with", done.returncode, done.stderr)
    return done.stdout.split("\n")[:-1]


def expect(words, found, exactly=None, has=(), has_not=()):
    if exactly is not None and found != exactly:
        fail(words, "is completed by", found, "not", exactly)
    for word in has:
        if word not in found:
            fail(words, "is not completed by", word, "but by", found)
    for word in has_not:
        if word in found:
            fail(words, "is completed by", word)


def in_the_command():
    def check(*words, **expected):
        expect(words, completed(*words), **expected)

    verbs = [verb["name"] for verb in json.loads(run(continuo, "help", "--json").stdout)["verbs"]]
    check("", has=verbs)
    check("ver", exactly=["verify"])
    check("--ver", exactly=["--version"])
    check("help", "st", exactly=["stability", "steady"])
    for verb in verbs:  # of both programs
        declared = json.loads(run(continuo, "help", verb, "--json").stdout)
        names = sorted(name for option in declared["options"] for name in option["names"] if name.startswith("--"))
        if sorted(completed(verb, "--")) != names:
            fail(verb, "completes other options than it has")
    check("run", "", exactly=[":files .sim"])
    check("check", "good.sim", "", exactly=[":files .sim"])
    check("run", "good.sim", "", exactly=[])
    check("replay", "", exactly=[":files"])
    check("fit", "good.sim", "", exactly=[":files"])
    check("run", "good.sim", "-o", "", exactly=[":files"])
    check("run", "good.sim", "--method", "dop", has=["dop853", "dop853_radau"], has_not=["rk4"])
    check("run", "good.sim", "--method=rk", has=["--method=rk4"])
    check("compare", "good.sim", "--methods", "rk4,eul", exactly=[])
    check("view", "good.sim", "--viewers", "", exactly=["watch", "own"])
    check("compare", "good.sim", "--methods", "rk4,explicit", exactly=["rk4,explicit_euler"])
    check("stability", "ver", has=["verner7", "verner9"])
    check("run", "good.sim", "--set", "", exactly=["k=", "cut="])
    check("run", "good.sim", "--set", "c", exactly=["cut="])
    check("run", "good.sim", "--set=c", exactly=["--set=cut="])
    check("sense", "good.sim", "--param", "k,c", exactly=["k,cut"])
    check("steady", "good.sim", "--along", "k", exactly=["k="])
    check("phase", "good.sim", "--box", "", exactly=["x=", "x'="])
    check("phase", "modes.sim", "--mode", "", exactly=["up", "down"])
    check("run", "broken.sim", "--set", "", exactly=[])
    check("run", "nothing.sim", "--set", "", exactly=[])
    check("run", "good.sim", "--until", "", exactly=[])
    check("explain", "E20", has=["E201"], has_not=["E101"])
    check("nothing", "", has=verbs)


def in_shells():
    """Each shell, told to complete a line as if the tab key were pressed, gives the same words."""
    folder = root / "apps/continuo/completions"
    path = f"PATH='{pathlib.Path(continuo).parent}':$PATH"
    if shutil.which("bash"):
        for line, wanted in (("continuo ver", ["verify"]), ("continuo run good.sim --meth", ["--method"]),
                             ("continuo run g", ["good.sim"]), ("continuo run good.sim --set c", ["cut="])):
            words = line.split(" ")
            script = (f"{path}; source '{folder}/continuo.bash'; COMP_WORDS=({' '.join(words)}); "
                      f"COMP_CWORD={len(words) - 1}; COMP_LINE='{line}'; COMP_POINT={len(line)}; compopt() {{ :; }}; "
                      "_continuo; printf '%s\\n' \"${COMPREPLY[@]}\"")
            done = run("bash", "-c", script)
            expect(("bash", line), done.stdout.split(), exactly=wanted)
            if done.stderr:
                fail("bash", done.stderr)
    if shutil.which("fish"):
        for line, wanted in (("continuo ver", ["verify"]), ("continuo run good.sim --meth", ["--method"]),
                             ("continuo run good.sim --set c", ["cut="])):
            done = run("fish", "--no-config", "-c",
                       f"set -x PATH '{pathlib.Path(continuo).parent}' $PATH; source '{folder}/continuo.fish'; "
                       f"complete --do-complete '{line}'")
            expect(("fish", line), done.stdout.split(), exactly=wanted)
    if shutil.which("zsh"):
        done = run("zsh", "-f", "-n", str(folder / "_continuo"))
        if done.returncode:
            fail("zsh cannot read its completion:", done.stderr)


def manual():
    verbs = [verb["name"] for verb in json.loads(run(continuo, "help", "--json").stdout)["verbs"]]
    for words in [["help", "--man"]] + [["help", verb, "--man"] for verb in verbs]:
        page = run(continuo, *words).stdout
        for part in (".TH CONTINUO", "\n.SH NAME\n", "\n.SH SYNOPSIS\n", "\n.SH EXIT STATUS\n"):
            if part not in page:
                fail(words, "has no", part)
        if shutil.which("groff"):
            done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z"], input=page, capture_output=True, text=True)
            if done.stderr or done.returncode:
                fail(words, "is no page for groff:", done.stderr[:300])
            shown = subprocess.run(["groff", "-man", "-Tascii", "-P-cbou"], input=page, capture_output=True, text=True)
            declared = run(continuo, "help", words[1], "--json").stdout if len(words) > 2 else "{}"
            for option in json.loads(declared).get("options", []):
                if option["names"][-1] not in shown.stdout:
                    fail(words, "does not show", option["names"][-1])


with tempfile.TemporaryDirectory() as scratch:
    os.chdir(scratch)
    pathlib.Path("good.sim").write_text(
        "param k = 1 in 0.1..10\nparam cut = 0.4\nx'' = -k*x - cut*x'\nx(0) = 1; x'(0) = 0\nrun 0..5\n")
    pathlib.Path("broken.sim").write_text("x' = -y\n")
    pathlib.Path("modes.sim").write_text(
        "mode up { x' = 1 }\nmode down { x' = -1 }\nstart in up\nx(0) = 0\nwhen x rises through 1 in up { go down }\n"
        "run 0..3\n")
    in_the_command()
    in_shells()
    manual()
    os.chdir(root)
sys.exit(f"{len(failures)} failures" if failures else 0)
