#!/usr/bin/env python3
"""Printed digits of AUTO-07p and MatCont against ours: printed.py COMMAND

The models are AUTO's demos ab, cusp, plp, pp2, tor and lor, and MatCont's catalytic oscillator. AUTO's digits are those
of its own log of all demos (test/hyper.all of AUTO-07p), MatCont's those of its manual. A place is the parameters (and the
period) of what is printed; ours is the nearest of the same kind. Exit 1 where one is further off than three units of the last
digit printed.
"""
import json, math, subprocess, sys, tempfile, os

AB = """model ab
param d = 0.05
param b = 17
x' = -x + d*(1 - x)*exp(y)
y' = -4*y + d*b*(1 - x)*exp(y)
x(0) = 0; y(0) = 0
run 0..50
"""
CUSP = """model cusp
param mu = 0
param lambda = 1
x' = mu + lambda*x - x^3
x(0) = 1
run 0..50
"""
PLP = """model plp
param s0 = 110
param rh = 2.021628
let rate = rh*s*a/(1 + s + 0.1*s^2)
s' = s0 - s - rate
a' = 0.2*(500 - a) - rate
s(0) = 45.56; a(0) = 177.8
run 0..50
"""
PP2 = """model pp2
param p = 0
param r = 3
x' = r*x*(1 - x) - x*y - p*(1 - exp(-5*x))
y' = -y + 3*x*y
x(0) = 0.3; y(0) = 1
run 0..50
"""
TOR = """model tor
param rn = -0.9
param be = 0.5
let across = be*(y - x) + 0.933578*(y - x)^3
x' = (-rn*x + across - 0.328578*x^3)/0.6
y' = -across + 0.6*y - z
z' = y
x(0) = 0.1; y(0) = 0; z(0) = 0
run 0..200
"""
LOR = """model lor
param rho = 280
param sigma = 10
x' = sigma*(y - x)
y' = rho*x - y - x*z
z' = x*y - 8/3*z
x(0) = 20; y(0) = 20; z(0) = 250
run 0..200
"""
CATALYST = """model catalyst
param q2 = 1.2
param k = 0.4
let z = 1 - x - y - s
x' = 5*z^2 - 2*x^2 - 10*x*y
y' = q2*z - 0.1*y - 10*x*y
s' = 0.0675*(z - k*s)
x(0) = 0.01; y(0) = 0.7; s(0) = 0.1
run 0..100
"""

# (problem, model, arguments, [(kind, values by name with the digits as printed)])
PROBLEMS = [
    ("ab, b = 17", AB, "steady --along d=0..0.25",
     [("Hopf point", {"d": "1.20866E-01"}), ("fold", {"d": "1.21901E-01"}), ("fold", {"d": "1.17015E-01"}),
      ("Hopf point", {"d": "2.17079E-01"})]),
    ("ab, b = 18", AB.replace("b = 17", "b = 18"), "steady --along d=0..0.25",
     [("Hopf point", {"d": "1.11153E-01"}), ("fold", {"d": "1.11565E-01"}), ("fold", {"d": "9.95741E-02"}),
      ("Hopf point", {"d": "1.83833E-01"})]),
    ("cusp", CUSP, "steady --along mu=-2..2 --and lambda=-1..3",
     [("fold", {"mu": "3.84900E-01"}), ("cusp", {"mu": "0.00000E+00", "lambda": "0.00000E+00"})]),
    ("pp2", PP2, "steady --along p=0..1",
     [("transcritical point", {"p": "6.00000E-01"}), ("transcritical point", {"p": "8.21904E-01"}),
      ("fold", {"p": "8.32929E-01"}), ("Hopf point", {"p": "6.71594E-01"})]),
    ("plp", PLP, "steady --along rh=2..6",
     [("Hopf point", {"rh": "3.49995E+00"}), ("Hopf point", {"rh": "4.65046E+00"})]),
    ("plp, Hopf points at s0 = 109", PLP, "steady --along rh=2..6 --and s0=109..120",
     [("end", {"rh": "5.10967E+00", "s0": "1.09000E+02"}), ("end", {"rh": "3.10386E+00", "s0": "1.09000E+02"})]),
    ("plp, folds of orbits", PLP, "orbit --from-hopf --along rh=2..6",
     [("fold", {"rh": "2.75969E+00", "period": "1.00064E+01"}), ("fold", {"rh": "5.00784E+00", "period": "5.67658E+00"})]),
    ("plp, folds of orbits at s0 = 109", PLP, "orbit --from-hopf --along rh=2..6 --and s0=109..120",
     [("end", {"rh": "5.24332E+00", "s0": "1.09000E+02"}), ("end", {"rh": "2.58264E+00", "s0": "1.09000E+02"})]),
    ("plp, folds of orbits at s0 = 111", PLP, "orbit --from-hopf --along rh=2..6 --and s0=100..111",
     [("end", {"rh": "2.98629E+00", "s0": "1.11000E+02"}), ("end", {"rh": "4.72213E+00", "s0": "1.11000E+02"})]),
    ("tor", TOR, "steady --along rn=-0.9..-0.4", [("Hopf point", {"rn": "-5.89337E-01"})]),
    ("tor, orbits", TOR, "orbit --from-hopf --along rn=-0.7..-0.55 --branches 2",
     [("fold", {"rn": "-5.84335E-01", "period": "8.42647E+00"}),
      ("crossing of branches", {"rn": "-5.87029E-01", "period": "8.68967E+00"}),
      ("torus", {"rn": "-5.91650E-01", "period": "8.79415E+00"}),
      ("period doubling", {"rn": "-6.14955E-01", "period": "9.26630E+00"})]),
    ("lor", LOR, "orbit --along rho=200..300 --branches 2",
     [("period doubling", {"rho": "2.29407E+02", "period": "4.80867E-01"}),
      ("period doubling", {"rho": "2.18210E+02", "period": "9.87949E-01"}),
      ("period doubling", {"rho": "2.15966E+02", "period": "1.98675E+00"})]),
    ("catalytic oscillator", CATALYST, "steady --along q2=0.5..2 --and k=0.1..2",
     [("Hopf point", {"q2": "1.051558"}), ("fold", {"q2": "1.042049"}),
      ("fold", {"q2": "1.052200"}), ("Hopf point", {"q2": "1.040991"})]),
]


def found_of(result):
    """All that has a kind, and the ends of curves."""
    for group in ("branches", "curves"):
        for entry in result.get(group, []):
            for point in entry.get("bifurcations", []) + entry.get("degenerate", []):
                yield point
            if group == "curves":
                for end in entry.get("ends", []):
                    yield dict(end, kind="end")


def unit_of(text):
    """Of the last digit printed."""
    mantissa, _, exponent = text.upper().partition("E")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def main():
    command = sys.argv[1]
    wrong = 0
    print("| Problem | What | Ours | Printed |\n|---|---|---|---|")
    for name, model, arguments, wanted in PROBLEMS:
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "model.sim")
            with open(file, "w") as out:
                out.write(model)
            verb, *rest = arguments.split()
            run = subprocess.run([command, verb, file, *rest, "--json"], capture_output=True, text=True, timeout=600)
        points = list(found_of(json.loads(run.stdout))) if run.stdout else []
        for kind, values in wanted:
            alike = [point for point in points if point["kind"] == kind]

            def apart(point):
                return max(abs(point.get(key, math.inf) - float(text)) / unit_of(text) for key, text in values.items())

            best = min(alike, key=apart, default=None)
            good = best is not None and apart(best) <= 3
            wrong += not good
            ours = ", ".join(f"{key} = {best[key]:.8g}" for key in values) if best else "not found"
            printed = ", ".join(f"{key} = {text}" for key, text in values.items())
            print(f"| {name} | {kind} | {ours if good else '**' + ours + '**'} | {printed} |", flush=True)
    return 1 if wrong else 0


sys.exit(main())
