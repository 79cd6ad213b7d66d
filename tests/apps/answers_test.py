#!/usr/bin/env python3
"""The answers of every verb to --json, over models of every kind and over failures: each is one object that satisfies
the schema of its layout, exactly. Without jsonschema it prints a message and exits with 77."""
import json
import math
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

try:
    from jsonschema import Draft202012Validator, RefResolver
except ImportError as missing:
    print("skipped:", missing)
    sys.exit(77)

continuo, root = sys.argv[1], pathlib.Path(sys.argv[2])
schemas = {path.name: json.loads(path.read_text()) for path in (root / "apps/continuo/schemas").glob("*.json")}
failures, seen_layouts, seen_verbs = [], set(), set()


def fail(*text):
    failures.append(" ".join(str(part) for part in text))
    print("FAILED", failures[-1])


def unknown_number(text):
    raise ValueError(f"{text} is no JSON")


def validator_of(layout):
    name, version = layout.removeprefix("continuo.").split("/")
    schema = schemas[f"{name}.{version}.json"]
    resolver = RefResolver(schema["$id"], schema, store=schemas)
    return Draft202012Validator(schema, resolver=resolver)


def call(words, stdin="", before=()):
    return subprocess.run([*before, continuo, *words], input=stdin.encode(), capture_output=True, timeout=300)


def answer(words, exit=None, stdin="", layout=None):
    """The answer, after all that holds for every answer has been tested."""
    done = call([*words, "--json"], stdin)
    shown = " ".join(words)
    try:
        document = json.loads(done.stdout.decode(), parse_constant=unknown_number)
    except (UnicodeDecodeError, ValueError) as problem:
        fail(shown, "prints no JSON:", problem, done.stdout[:200], done.stderr[-300:])
        return {}
    if not isinstance(document, dict) or "layout" not in document:
        fail(shown, "prints no object with a layout")
        return {}
    for problem in list(validator_of(document["layout"]).iter_errors(document))[:3]:
        fail(shown, document["layout"], "/".join(map(str, problem.absolute_path)), problem.message[:300])
    if document.get("exit", done.returncode) != done.returncode:
        fail(shown, "says exit", document["exit"], "and ends with", done.returncode)
    if exit is not None and done.returncode != exit:
        fail(shown, "ends with", done.returncode, "not", exit, done.stderr.decode(errors="replace")[:300])
    if layout is not None and document["layout"] != layout:
        fail(shown, "has the layout", document["layout"], "not", layout)
    said = done.stderr.decode(errors="replace")
    for message in document.get("messages", []):
        if message["message"].split("\n")[0] not in said:
            fail(shown, "has a message that was not said:", message["message"])
    if document["layout"] == "continuo.failure/1" and not document["messages"]:
        fail(shown, "fails without a message")
    seen_layouts.add(document["layout"])
    if words and document.get("verb", words[0]) == words[0]:
        seen_verbs.add(words[0])
    return document


def schemas_are_strict():
    """Every object of every schema names all of its fields, so that no field can be forgotten in it."""
    def walk(schema, place):
        if isinstance(schema, dict):
            if "properties" in schema and (schema.get("additionalProperties") is not False or "required" not in schema):
                fail(place, "admits unknown fields")
            for key, inner in schema.items():
                walk(inner, f"{place}/{key}")
        elif isinstance(schema, list):
            for inner in schema:
                walk(inner, place)
    for name, schema in schemas.items():
        Draft202012Validator.check_schema(schema)
        walk(schema, name)
    unknown = {"layout": "continuo.new/1", "exit": 0, "messages": [], "file": "a.sim", "model": "A"}
    if list(validator_of("continuo.new/1").iter_errors(unknown)):
        fail("a right answer is refused")
    for wrong in ({**unknown, "more": 1}, {k: v for k, v in unknown.items() if k != "file"}, {**unknown, "exit": 7},
                  {**unknown, "messages": [{"message": "x"}]}, {**unknown, "file": 3}):
        if not list(validator_of("continuo.new/1").iter_errors(wrong)):
            fail("a wrong answer is accepted:", wrong)


def gallery():
    for path in sorted((root / "models").glob("*.sim")):
        answer(["check", f"models/{path.name}"], 0, layout="continuo.check/1")
        answer(["info", f"models/{path.name}"], 0, layout="continuo.info/1")
        answer(["methods", "--why", f"models/{path.name}"], 0, layout="continuo.method_choice/1")
    for name in ("bouncing_ball", "kepler", "pendulum_dae", "thermostat", "heat_equation", "newtons_cradle", "car",
                 "bratu", "spring_pendulum", "robertson", "fed_batch", "lorenz"):
        answer(["run", f"models/{name}.sim"], 0, layout="continuo.run/1")
    answer(["check", "models", "models/pendulum.sim"], 0)
    answer(["check", "models/robertson.sim", "--jacobian"], 0)
    answer(["check", "models/bouncing_ball.sim", "--jacobian"])
    answer(["verify", "models/pendulum.sim", "models/newtons_cradle.sim"], 0, layout="continuo.verify/1")
    answer(["run", "models/kepler.sim", "--estimate-error"], 0)
    answer(["run", "models/mass_spring.sim", "--set", "k=1,2", "--initial", "x=1..2/3"], 0, layout="continuo.sweep/1")
    answer(["run", "models/mass_spring.sim", "--set", "k=1,2", "--max-steps", "3"], 3, layout="continuo.sweep/1")
    answer(["run", "models/bratu.sim", "--family", "lambda=0.1..4"], 0, layout="continuo.families/1")
    call(["run", "models/newtons_cradle.sim", "--record", "cradle.run"])
    answer(["replay", "cradle.run"], 0, layout="continuo.run/1")
    answer(["resume", "cradle.run", "--until", "16"], 0, layout="continuo.run/1")


def studies():
    answer(["compare", "models/mass_spring.sim", "--methods", "euler,rk4", "--step", "0.1,0.05"], 0)
    answer(["compare", "models/kepler.sim", "--methods", "dop853,rodas5p", "--tol", "1e-6"], 0)
    answer(["converge", "models/mass_spring_damper.sim", "--methods", "rk4,euler", "--most-steps", "256"], 0)
    answer(["converge", "models/kepler.sim", "--methods", "tsitouras5", "--tol", "1e-3,1e-6"], 0)
    answer(["converge", "models/bouncing_ball.sim", "--methods", "rk4", "--most-steps", "256", "--float"], 0)
    answer(["converge", "--derivative", "sin(x)", "--at", "1"], 0, layout="continuo.differences/1")
    answer(["converge", "--derivative", "abs(x - 1)", "--at", "0"], 0)
    answer(["stability", "euler,rk4,gauss4,bdf2"], 0)
    answer(["stability", "rk4", "--model", "models/heat_equation.sim"], 0)
    for name in ("lorenz", "pendulum", "predator_prey", "mass_spring_damper"):
        answer(["steady", f"models/{name}.sim"], 0, layout="continuo.steady/1")
        answer(["linearize", f"models/{name}.sim", "--start"], 0, layout="continuo.linearize/1")
    answer(["steady", "models/lorenz.sim", "--along", "rho=0..30"], 0)
    answer(["steady", "bazykin.sim", "--along", "alpha=0..1", "--and", "delta=0..1"], 0)
    answer(["linearize", "dae.sim"], 0)
    for name in ("pendulum", "predator_prey", "van_der_pol_stiff"):
        answer(["phase", f"models/{name}.sim"], 0, layout="continuo.phase/1")
    answer(["orbit", "models/van_der_pol_stiff.sim", "--set", "mu=1"], 0, layout="continuo.orbit/1")
    answer(["orbit", "models/thermostat.sim"], 0, layout="continuo.orbit/1")
    answer(["orbit", "models/van_der_pol_stiff.sim", "--set", "mu=1", "--along", "mu=0.5..2"], 0)
    answer(["orbit", "bautin.sim", "--along", "mu=-1..1", "--and", "nu=0.5..1.5"], 0, layout="continuo.orbit_branches/1")
    answer(["orbit", "models/lorenz.sim", "--section", "z=27", "--duration", "10"], 0, layout="continuo.section/1")
    answer(["orbit", "models/lorenz.sim", "--lyapunov", "--duration", "20"], 0, layout="continuo.exponents/1")
    answer(["explore", "models/mass_spring_damper.sim"], 0, layout="continuo.explore/1")
    answer(["sense", "models/mass_spring_damper.sim", "--param", "k,c"], 0, layout="continuo.sense/1")
    answer(["sense", "models/bouncing_ball.sim", "--param", "g"])
    answer(["sense", "models/thermostat.sim", "--param", "tau", "--of", "period"], 0, layout="continuo.sense_period/1")
    answer(["sense", "rest.sim", "--param", "a", "--of", "equilibrium"], 0, layout="continuo.sense_equilibrium/1")
    answer(["sweep", "models/mass_spring_damper.sim", "--vary", "k from 1 to 4 count 3", "--keep",
            "max(x), x at 0..1 by 0.5"], 0, layout="continuo.sweep/2")
    for runs in ("48 indices", "6 morris"):
        answer(["sweep", "models/mass_spring_damper.sim", "--vary", "k uniform(1, 4)", "--keep", "max(x)", "--runs", runs],
               0, layout="continuo.sweep/2")
    call(["run", "models/mass_spring_damper.sim", "-o", "measured.csv"])
    answer(["fit", "models/mass_spring_damper.sim", "few.csv", "--param", "k,c", "--profile"], layout="continuo.fit/1")


def verbs_without_a_model():
    listed = answer(["help"], 0, layout="continuo.verbs/1")
    for verb in listed.get("verbs", []):
        declared = answer(["help", verb["name"]], 0, layout="continuo.help/1")
        if not any("--json" in option["names"] for option in declared.get("options", [])):
            fail(verb["name"], "has no --json")
    answer(["methods"], 0, layout="continuo.methods/1")
    answer(["explain"], 0, layout="continuo.explain/1")
    answer(["explain", "E201"], 0, layout="continuo.explain/1")
    answer(["export", "models/pendulum.sim", "--c"], 0, layout="continuo.export/1")
    answer(["export", "models/newtons_cradle.sim", "--c"], 2, layout="continuo.failure/1")
    answer(["new", "fresh"], 0, layout="continuo.new/1")
    answer(["new", "fresh"], 1, layout="continuo.failure/1")
    answer(["report", "models/bouncing_ball.sim", "--with", "steady", "-o", "page.html"], layout="continuo.report/1")
    recorded = answer(["view", "models/pendulum.sim", "--export", "view.html", "--until", "0.2"])
    if recorded.get("layout") not in ("continuo.recording/1", "continuo.failure/1"):  # a build without its page
        fail("view --export has the layout", recorded.get("layout"))
    return [verb["name"] for verb in listed.get("verbs", [])]


def live_view():
    """Its answer comes before its end."""
    server = subprocess.Popen([continuo, "view", "models/pendulum.sim", "--no-open", "--json"], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL)
    text = b""
    while not text.endswith(b"\n}\n"):
        line = server.stdout.readline()
        if not line:
            break
        text += line
    server.send_signal(signal.SIGINT)
    server.wait(timeout=60)
    document = json.loads(text)
    for problem in validator_of("continuo.view/1").iter_errors(document):
        fail("view", problem.message)
    if document["layout"] != "continuo.view/1" or document["exit"] is not None:
        fail("view answers", text)
    seen_layouts.add(document["layout"])


# What each verb needs to be given a model, by `{}`.
on_a_model = {"run": "{}", "check": "{}", "info": "{}", "verify": "{}", "methods": "--why {}", "report": "{} -o r.html",
              "compare": "{} --methods rk4 --step 0.1", "converge": "{} --methods rk4", "steady": "{}",
              "stability": "rk4 --model {}", "linearize": "{}", "phase": "{}", "orbit": "{}", "explore": "{}",
              "sense": "{} --param k", "sweep": "{} --vary x(0)in(1,2)", "fit": "{} few.csv --param k",
              "view": "{} --export v.html"}
# What they do not: their own argument.
others = {"replay": "{}", "resume": "{}"}
one_exit_code_for_a_file_that = {"is not there": ("nothing.sim", 1), "is a folder without models": ("empty", 1)}


def exit_codes_are_the_same_for_all_verbs():
    for verb, form in {**on_a_model, **others}.items():
        for file, exit in one_exit_code_for_a_file_that.values():
            answer([verb, *form.format(file).split()], exit, layout="continuo.failure/1")
        answer([verb, "--no-such-option"], 1, layout="continuo.failure/1")
        answer([verb, *form.format("good.sim").split(), "--nothing"], 1, layout="continuo.failure/1")
        answer([verb, *form.format("").split()], 1, layout="continuo.failure/1")
    for verb, form in on_a_model.items():
        document = answer([verb, *form.format("broken.sim").split()], 2)
        if not any(message.get("code") == "E210" and message.get("line") == 2 for message in document["messages"]):
            fail(verb, "does not say what is wrong with a model:", document["messages"])
        answer([verb, *form.format("latin.sim").split()], 2)
        if verb not in ("check", "verify", "info", "report", "methods", "view"):
            answer([verb, *form.format("good.sim").split(), "--set", "nothing=1"], 1)
            answer([verb, *form.format("good.sim").split(), "--plot", "no/such/folder/p.svg"], 1)
            answer([verb, *form.format("good.sim").split(), "--plot", "p.doc"], 1)
    for verb in ("steady", "linearize", "phase", "orbit", "explore"):
        answer([verb, "models/billiards.sim"], 2, layout="continuo.failure/1")  # bodies, no equations
    answer(["run", "blows.sim"], 3, layout="continuo.run/1")
    answer(["verify", "blows.sim"], 3, layout="continuo.verify/1")
    answer(["run", "fails.sim"], 4, layout="continuo.run/1")
    answer(["verify", "fails.sim"], 4, layout="continuo.verify/1")
    answer(["steady", "flies.sim"], 3, layout="continuo.failure/1")
    answer(["nothing"], 1, layout="continuo.failure/1")
    answer([], 1, layout="continuo.failure/1")
    answer(["explain", "E999"], 1, layout="continuo.failure/1")
    answer(["help", "nothing"], 1, layout="continuo.failure/1")


def an_interrupt_is_answered():
    """While a model is read, in a run, in a study, and in a run that another verb has begun."""
    all_words = [["run", "long.sim"], ["run", "long.sim", "--set", "k=1,2"], ["verify", "long.sim"], ["info", "-"],
                 ["check", "-"], ["report", "long.sim", "-o", "long.html"],
                 ["view", "long.sim", "--record", "long", "--until", "1e5"],
                 ["compare", "long.sim", "--methods", "rk4,gauss4", "--step", "0.001"], ["sense", "long.sim", "--param", "k"],
                 ["explore", "long.sim"], ["orbit", "models/lorenz.sim", "--lyapunov", "--duration", "1e7"]]
    all_running = [subprocess.Popen([continuo, *words, "--json"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                    stderr=subprocess.DEVNULL) for words in all_words]
    time.sleep(3)
    for running in all_running:
        running.send_signal(signal.SIGINT)
    for words, running in zip(all_words, all_running):
        document = json.loads(running.stdout.read())  # standard input stays open: who reads it waits
        running.wait(timeout=100)
        if running.returncode != 130 or document["exit"] != 130:
            fail(words, "after Ctrl-C ends with", running.returncode, document["exit"])
        for problem in validator_of(document["layout"]).iter_errors(document):
            fail(words, problem.message)
    # A run of a fit is not cut off: a second Ctrl-C ends it, with an answer.
    far = "t,x\n" + "".join(f"{1e5*i},{i % 3}\n" for i in range(10))
    pathlib.Path("far.csv").write_text(far)
    running = subprocess.Popen([continuo, "fit", "long.sim", "far.csv", "--param", "k", "--json"], stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL)
    for _ in range(2):
        time.sleep(1.5)
        running.send_signal(signal.SIGINT)
    document = json.loads(running.communicate(timeout=100)[0])
    if (running.returncode, document["layout"]) != (130, "continuo.failure/1"):
        fail("fit after two Ctrl-C:", running.returncode, document)


def standard_input():
    """A model from a pipe is what it is from a file, and its messages name it."""
    good = pathlib.Path("good.sim").read_text()
    measured = pathlib.Path("few_good.csv").read_text()
    volatile = {"seconds"}

    def without_times(value):
        if isinstance(value, dict):
            return {key: without_times(inner) for key, inner in value.items() if key not in volatile}
        return [without_times(inner) for inner in value] if isinstance(value, list) else value

    for verb, form in on_a_model.items():
        if verb in ("view",):
            answer([verb, *form.format("-").split()], 1)
            continue
        if verb == "fit":
            form = "{} few_good.csv --param k"
        named = json.dumps(without_times(answer([verb, *form.format("good.sim").split()])))
        piped = json.dumps(without_times(answer([verb, *form.format("-").split()], stdin=good)))
        if named.replace("good.sim", "standard input") != piped.replace("run -", "run standard input"):
            fail(verb, "differs from standard input:", named[:300], piped[:300])
        document = answer([verb, *form.format("-").split()], 2, stdin="model Broken\nx' = -y\nx(0) = 1\nrun 0..1\n")
        if not any(message.get("file") == "standard input" and message.get("line") == 2
                   for message in document["messages"]):
            fail(verb, "does not name standard input:", document["messages"])
    named = without_times(answer(["fit", "good.sim", "few_good.csv", "--param", "k"]))
    piped = without_times(answer(["fit", "good.sim", "-", "--param", "k"], stdin=measured))
    if json.dumps(named).replace("few_good.csv", "standard input") != json.dumps(piped):
        fail("fit differs from standard input")
    bad = answer(["fit", "good.sim", "-", "--param", "k"], 1, stdin="t,x\n0,a\n1,2\n2,b\n")
    if not all(place in bad["messages"][0]["message"] for place in ("standard input:2: `a`", "standard input:4: `b`")):
        fail("bad cells are not all named:", bad["messages"])
    for words in (["fit", "-", "-", "--param", "k"], ["check", "-", "-"], ["verify", "-", "-"],
                  ["run", "-", "--guess", "-"]):
        document = answer(words, 1, stdin=good)
        if "read once" not in document["messages"][0]["message"]:
            fail(words, "takes standard input twice")
    recording = subprocess.run([continuo, "replay", "-", "--json"], stdin=open("cradle.run", "rb"), capture_output=True)
    if json.loads(recording.stdout)["state"] != answer(["replay", "cradle.run"])["state"]:
        fail("a recording from standard input is another one")
    rows = "t,x,x'\n0,0.25,0\n"
    begun = answer(["run", "good.sim", "--initial-from", "-", "--until", "0"], stdin=rows)
    if begun.get("state", {}).get("x") != 0.25:
        fail("--initial-from - begins elsewhere:", begun)
    for words in (["new", "-"], ["view", "good.sim", "--record", "-"]):
        answer(words, 1, layout="continuo.failure/1")
        if os.path.exists("-") or os.path.exists("-.sim"):
            fail(words, "writes a file called -")
    for words in (["run", "good.sim", "-o", "-"], ["run", "good.sim", "--manifest", "-"]):
        answer(words, 1, layout="continuo.failure/1")  # two things for standard output


def numbers_read_back():
    """The last row of the CSV, which has the shortest digits that read back, is the state of the answer."""
    rng = random.Random(7)
    for number in range(12):
        names = rng.sample(["x", "hash", "kind", "period", "t1", "\u03b8", "exit", "layout", "u", "message"], 3)
        lines = ["model Random"]
        for name in names:
            rates = [f"{rng.uniform(-1, 0.2):.3g}*{other}" for other in names]
            lines.append(f"{name}' = {' + '.join(rates)}; {name}(0) = {rng.uniform(-5, 5):.3g}e{rng.randint(-200, 200)}")
        lines.append(f"param p = {rng.random()} in -1..2")
        lines.append(f"run 0..{rng.uniform(0.1, 3):.3g} output 0.1 tol 1e-6")
        text = "\n".join(lines) + "\n"
        pathlib.Path("random.sim").write_text(text)
        document = answer(["run", "random.sim"])
        answer(["info", "random.sim"], 0)
        if document.get("layout") != "continuo.run/1":
            continue
        rows = call(["run", "random.sim", "-o", "-"]).stdout.decode().splitlines()
        last = dict(zip([name.split(" [")[0] for name in rows[1].split(",")], rows[-1].split(",")))
        for name, value in document["state"].items():
            if value is None or float(last[name]) != value or (value == 0 and math.copysign(1, value) != math.copysign(1, float(last[name]))):
                fail("state of", text, name, value, last[name])


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    os.symlink(root / "models", "models")
    os.mkdir("empty")
    files = {
        "good.sim": "model Good\nparam k = 1 in 0.1..10\nparam c = 0.4 in 0..5\nx'' = -k*x - c*x'\nx(0) = 1; x'(0) = 0\n"
                    "run 0..5 output 0.5\n",
        "broken.sim": "model Broken\nx' = -y\nx(0) = 1\nrun 0..1\n",
        "blows.sim": "x' = x^2\nx(0) = 1\nrun 0..2\n",
        "fails.sim": "x' = -x\nx(0) = 1\nrun 0..1\ncheck x(1) = 5 within 1e-3\n",
        "flies.sim": "x' = 1 + x^2\nx(0) = 0\nrun 0..1\n",
        "long.sim": "param k = 1\nx'' = -k*x\nx(0) = 1; x'(0) = 0\nrun 0..1e9 output 1e8 method rk4 step 0.001\n",
        "rest.sim": "param a = 2\nx' = a - x\nx(0) = 0\nrun 0..5\n",
        "dae.sim": "x' = -v\n0 = v - 2*x\nx(0) = 1\nunknown v = 2\nrun 0..1\n",
        "bazykin.sim": "param alpha = 0.3\nparam delta = 0.2\nlet eaten = x*y/(1 + alpha*x)\nx' = x - eaten - 0.01*x^2\n"
                       "y' = -y + eaten - delta*y^2\nx(0) = 1; y(0) = 1\nrun 0..100\n",
        "bautin.sim": "param mu = 0.5\nparam nu = 1\nlet grow = mu + nu*(x^2 + y^2) - (x^2 + y^2)^2\n"
                      "x' = grow*x - 1.5*y\ny' = grow*y + 1.5*x\nx(0) = 1; y(0) = 0\nrun 0..40\n",
        "few.csv": "t,x\n" + "".join(f"{0.5*i},{math.exp(-0.1*i)*math.cos(i)}\n" for i in range(12)),
    }
    for name, text in files.items():
        pathlib.Path(name).write_text(text)
    pathlib.Path("latin.sim").write_bytes(b"# caf\xe9\nx' = -x\nx(0) = 1\nrun 0..1\n")
    (pathlib.Path("few_good.csv")).write_text(files["few.csv"])
    schemas_are_strict()
    gallery()
    studies()
    verbs = verbs_without_a_model()
    live_view()
    exit_codes_are_the_same_for_all_verbs()
    an_interrupt_is_answered()
    standard_input()
    numbers_read_back()
    for verb in set(verbs) - seen_verbs:
        fail(verb, "was never asked for JSON")
    layouts = {f"continuo.{name.removesuffix('.json').replace('.', '/')}" for name in schemas if name != "common.json"}
    for layout in layouts - seen_layouts - {"continuo.recording/1"}:
        fail(layout, "was never seen")
    os.chdir(root)
sys.exit(f"{len(failures)} failures" if failures else 0)
