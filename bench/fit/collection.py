#!/usr/bin/env python3
"""Fits of the benchmark collection of parameter estimation, run by `continuo fit` from the collection's own tables.

    collection.py CONTINUO CLONE [--problems Elowitz,Fujita] [--spread 2] [--seeds 5] [--starts 1]

CLONE is a working copy of github.com/Benchmarking-Initiative/Benchmark-Models-PEtab (L. Schmiester et al., "PEtab -
Interoperable specification of parameter estimation problems in systems biology", PLoS Comput. Biol. 17 (2021) e1008646), of
which the measurements and the published parameters are read; the models stand below, written from the equations of their
papers as the collection has them. Each search begins at the published parameters, each multiplied by a random factor between
1/spread and spread (so that --spread 1 begins there), and its -log L is compared with that of the collection. Nothing here
is a test.
"""
import argparse
import csv
import json
import math
import pathlib
import random
import subprocess
import tempfile


def table(path):
    with open(path) as file:
        return list(csv.DictReader(file, delimiter="\t"))


class Elowitz:
    """The repressilator: M. B. Elowitz, S. Leibler, Nature 403 (2000) 335-338. Lognormal noise of unknown size."""
    folder, best = "Elowitz_Nature2000", -63.2028
    not_sought = {"sigma"}

    def model(self, values):
        lines = ["param " + ", ".join(f"{name} = {value!r}" for name, value in values.items())]
        before = {"X": "Z", "Y": "X", "Z": "Y", "GFP": "X"}
        for name, other in before.items():
            made = name == "GFP"
            own = "_GFP" if made else ""
            # The collection makes the protein of GFP, not its messenger, at this rate.
            rate = f"60*tps_repr - KM^n_Hill*(60*tps_repr - 60*tps_active)/(KM^n_Hill + {other}p^n_Hill)"
            lines.append(f"{name}m' = " + ("" if made else rate) + f" - ln2*{name}m/tau_mRNA{own}")
            lines.append(f"{name}p' = eff{own}*{name}m/tau_mRNA{own} - ln2*{name}p/tau_prot{own}"
                         + (f" + {rate}" if made else ""))
            lines.append(f"{name}m(0) = init_{name}_mRNA; {name}p(0) = "
                         + ("init_GFP" if made else f"init_{name}_protein"))
        return "let ln2 = ln(2)\n" + "\n".join(lines) + "\noutput fluorescence = background + scale*GFPp\nrun 0..600\n"

    def data(self, folder, at):
        rows = table(folder / "measurementData_Elowitz_Nature2000.tsv")
        path = at / "elowitz.csv"
        path.write_text("t,fluorescence\n" + "".join(f"{row['time']},{row['measurement']}\n" for row in rows))
        return [path], ["--error", "fluorescence=lognormal", "--likelihood", "plain"]


class Fujita:
    """EGF, Akt and S6: K. A. Fujita et al., Science Signaling 3 (2010) ra56. Six steps of EGF, deviations known."""
    folder, best = "Fujita_SciSignal2010", -53.0838
    not_sought = set()

    def model(self, values):
        return ("param " + ", ".join(f"{name} = {value!r}" for name, value in values.items()) + ", EGF = 0\n"
                "let bind = EGF*EGFR*reaction_1_k1 - E*reaction_1_k2\n"
                "let dock = Akt*pE*reaction_2_k1 - pEA*reaction_2_k2\n"
                "let meet = S6*pA*reaction_5_k1 - pAS*reaction_5_k2\n"
                "EGFR' = -bind - EGFR*EGFR_turnover + 68190*EGFR_turnover\n"
                "E' = bind - E*reaction_9_k1\n"
                "pE' = -dock + pEA*reaction_3_k1 - pE*reaction_4_k1 + E*reaction_9_k1\n"
                "pEA' = dock - pEA*reaction_3_k1\n"
                "Akt' = -dock + pA*reaction_7_k1\n"
                "pA' = pEA*reaction_3_k1 - meet + pAS*reaction_6_k1 - pA*reaction_7_k1\n"
                "S6' = -meet + pS*reaction_8_k1\n"
                "pAS' = meet - pAS*reaction_6_k1\n"
                "pS' = pAS*reaction_6_k1 - pS*reaction_8_k1\n"
                "EGFR(0) = init_EGFR; Akt(0) = init_AKT; S6(0) = init_S6\n"
                "E(0) = 0; pE(0) = 0; pEA(0) = 0; pA(0) = 0; pAS(0) = 0; pS(0) = 0\n"
                "output pEGFR_tot = scaling_pEGFR_tot*(pE + pEA)\n"
                "output pAkt_tot = scaling_pAkt_tot*(pA + pAS)\n"
                "output pS6_tot = scaling_pS6_tot*pS\n"
                "run 0..3600\n")

    def data(self, folder, at):
        doses = {row["conditionId"]: row["EGF_0"] for row in table(folder / f"experimentalCondition_{self.folder}.tsv")}
        rows = table(folder / f"measurementData_step_{self.folder}.tsv")
        files, more = [], []
        for condition in dict.fromkeys(row["simulationConditionId"] for row in rows):
            of = {}
            for row in rows:
                if row["simulationConditionId"] == condition:
                    of.setdefault(float(row["time"]), {})[row["observableId"]] = row
            path = at / f"{condition}.csv"
            names = ["pEGFR_tot", "pAkt_tot", "pS6_tot"]
            lines = ["t," + ",".join(names) + "," + ",".join("s_" + name for name in names)]
            for t in sorted(of):
                cell = lambda name, key: of[t][name][key] if name in of[t] else ""
                lines.append(f"{t}," + ",".join(cell(name, "measurement") for name in names) + ","
                             + ",".join(cell(name, "noiseParameters") for name in names))
            path.write_text("\n".join(lines) + "\n")
            files.append(path)
            more += ["--in", f"{path}:EGF={doses[condition]}"]
        for name in ("pEGFR_tot", "pAkt_tot", "pS6_tot"):
            more += ["--sigma", f"{name}=s_{name}"]
        return files, more


def fitted(command, problem, clone, spread, seed, starts, at, iterations):
    folder = clone / "Benchmark-Models" / problem.folder
    rows = [row for row in table(folder / f"parameters_{problem.folder}.tsv")
            if row["parameterId"] not in problem.not_sought]
    scatter = random.Random(seed)
    values = {}
    for row in rows:
        low, high = float(row["lowerBound"]), float(row["upperBound"])
        value = float(row["nominalValue"]) * math.exp(scatter.uniform(-1, 1) * math.log(spread))
        values[row["parameterId"]] = min(max(value, low * 1.0001), high / 1.0001)
    model = at / f"{problem.folder}_{seed}.sim"
    model.write_text(problem.model(values))
    files, more = problem.data(folder, at)
    names = ",".join(values)
    bounds = [part for row in rows
              for part in ("--bounds", f"{row['parameterId']}={row['lowerBound']}..{row['upperBound']}")]
    done = subprocess.run([command, "fit", str(model), *map(str, files), "--param", names, "--log", names, *bounds, *more,
                           "--starts", str(starts), "--iterations", str(iterations), "--json"],
                          capture_output=True, text=True)
    if not done.stdout.strip():
        return None, done.stderr.strip()
    return json.loads(done.stdout), ""


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("continuo")
    options.add_argument("clone", type=pathlib.Path)
    options.add_argument("--problems", type=lambda text: text.split(","), default=["Elowitz", "Fujita"])
    options.add_argument("--spread", type=float, default=2)
    options.add_argument("--seeds", type=int, default=5)
    options.add_argument("--starts", type=int, default=1)
    options.add_argument("--iterations", type=int, default=500)
    options = options.parse_args()
    for name in options.problems:
        problem = {"Elowitz": Elowitz, "Fujita": Fujita}[name]()
        reached = []
        for seed in range(options.seeds):
            with tempfile.TemporaryDirectory() as folder:
                result, reason = fitted(options.continuo, problem, options.clone, options.spread, seed, options.starts,
                                        pathlib.Path(folder), options.iterations)
            if result is None:
                print(f"{name} seed {seed}: no fit: {reason}", flush=True)
                continue
            objective = -result["statistics"]["log_likelihood"]
            reached.append(objective)
            print(f"{name} seed {seed}: -log L = {objective:.4f}", *(f"[{doubt['kind']}]" for doubt in result["doubts"]), flush=True)
        if reached:
            print(f"{name}: best -log L = {min(reached):.4f} of {len(reached)}, {problem.best} is the collection's")


if __name__ == "__main__":
    main()
