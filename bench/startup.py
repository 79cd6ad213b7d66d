#!/usr/bin/env python3
"""How long whole calls of the command take, its start included: startup.py COMMAND [CALLS].

Prints the rows of the table in RESULTS.md. The least of many calls is what the machine needs; the median says how busy
it was. The processor's time is the process's own, in user and system, by wait4.
"""
import os
import subprocess
import sys
import tempfile
import time

root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
command = os.path.abspath(sys.argv[1])
calls = int(sys.argv[2]) if len(sys.argv) > 2 else 300


def measure(arguments):
    """Milliseconds by the clock and by the processor, each the least and the median."""
    quiet = [(os.POSIX_SPAWN_OPEN, fd, "/dev/null", os.O_WRONLY, 0) for fd in (1, 2)]
    wall, processor = [], []
    for _ in range(calls):
        begin = time.perf_counter()
        child = os.posix_spawn(arguments[0], arguments, os.environ, file_actions=quiet)
        _, status, used = os.wait4(child, 0)
        wall.append(1e3 * (time.perf_counter() - begin))
        processor.append(1e3 * (used.ru_utime + used.ru_stime))
        if status != 0:
            sys.exit(f"{' '.join(arguments)} failed; without the quiet it says why")
    return [(min(times), sorted(times)[calls // 2]) for times in (wall, processor)]


def libraries(*files):
    loaded = set()
    for file in files:
        loaded.update(line.split()[0] for line in subprocess.check_output(["ldd", file], text=True).splitlines())
    return len(loaded)


def row(what, wanted, files, *arguments):
    (wall, usual_wall), (processor, usual_processor) = measure([command, *arguments])
    print(f"| {what} | {wanted} | {wall:.1f} ms, {usual_wall:.1f} ms | {processor:.1f} ms, {usual_processor:.1f} ms "
          f"| {libraries(*files)} |", flush=True)


def module(name):
    places = (os.path.dirname(command), os.path.join(os.path.dirname(command), "../lib/continuo"))
    return next(file for place in places if os.path.exists(file := os.path.join(place, f"continuo_{name}.so")))


decay = "param a = 1 [1/s] in 0..5, l = 1 [%s]\nx' = -a*x\nx(0) = 1\nrun 0..2 [s] output 1\n"
spring = os.path.join(root, "models", "mass_spring.sim")
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for name, unit in (("decay.sim", "m"), ("inches.sim", "inch")):
        with open(name, "w") as file:
            file.write(decay % unit)
    with open("measured.csv", "w") as file:
        file.write("t,x\n0,1\n1,0.1353352832366127\n2,0.01831563888873418\n")
    print("| Call | Wanted | Clock: least, median | Processor: least, median | Shared libraries |\n|---|---|---|---|---|")
    row("`continuo --version`", "under 5 ms", [command], "--version")
    row("`continuo run models/mass_spring.sim`", "under 10 ms", [command], "run", spring)
    row("`continuo check` of a model", "", [command], "check", "decay.sim")
    row("the same with a unit from the database of UDUNITS-2", "", [command], "check", "inches.sim")
    row("`continuo run -o decay.nc`", "", [command, module("netcdf")], "run", "decay.sim", "-o", "decay.nc")
    row("`continuo fit` of one parameter", "", [command, module("least_squares")], "fit", "decay.sim", "measured.csv",
        "--param", "a")
