#!/usr/bin/env python3
"""The tables of `continuo run -o`, read by SciPy and NumPy. Without SciPy it prints a message and exits with 77."""
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy
    import scipy.io
except ImportError as missing:
    print("skipped:", missing)
    sys.exit(77)

continuo, models = sys.argv[1], pathlib.Path(sys.argv[2])


def equal(what, left, right):
    if not numpy.array_equal(left, right):
        sys.exit(f"{what}: {left}, expected {right}")


with tempfile.TemporaryDirectory() as folder:
    def path_of(model, ending):
        path = pathlib.Path(folder) / ("run." + ending)
        subprocess.run([continuo, "run", str(models / model), "-o", str(path)], check=True, stdout=subprocess.DEVNULL)
        return path

    text = numpy.genfromtxt(path_of("mass_spring.sim", "csv"), delimiter=",", names=True, skip_header=1,
                            deletechars="", replace_space=" ")
    tabs = numpy.genfromtxt(path_of("mass_spring.sim", "tsv"), delimiter="\t", names=True, skip_header=1,
                            deletechars="", replace_space=" ")
    matlab = scipy.io.loadmat(path_of("mass_spring.sim", "mat"))
    names = [str(name[0]) for name in matlab["column_names"][:, 0]]
    equal("names", names, list(text.dtype.names))
    for name, variable in zip(names, (str(of[0]) for of in matlab["column_variables"][:, 0])):
        equal(name + " in .tsv", tabs[name], text[name])
        equal(name + " in .mat", matlab[variable][:, 0], text[name])
    with scipy.io.netcdf_file(path_of("mass_spring.sim", "nc"), mmap=False) as file:
        for name in names:
            equal(name + " in .nc", file.variables["time" if name == "t" else name][:], text[name])
    table = json.loads(path_of("mass_spring.sim", "json").read_text())
    equal("columns of .json", table["columns"], names)
    equal("rows of .json", numpy.array(table["rows"]), numpy.array([list(row) for row in text]))

    heat = scipy.io.loadmat(path_of("heat_equation.sim", "mat"))
    equal("a family", heat["u"].shape, (len(heat["t"]), 19))
    equal("its tenth member", heat["u"][:, 9], heat["middle"][:, 0])
