#!/usr/bin/env python3
"""The netCDF files of `continuo run -o`, read by xarray. Without xarray it prints a message and exits with 77."""
import pathlib
import subprocess
import sys
import tempfile
import warnings

try:
    import numpy
    import xarray
except ImportError as missing:
    print("skipped:", missing)
    sys.exit(77)

continuo, models = sys.argv[1], pathlib.Path(sys.argv[2])


def data_of(model, *options):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "run.nc"
        subprocess.run([continuo, "run", str(models / model), "-o", str(path), *options], check=True, stdout=subprocess.DEVNULL)
        with warnings.catch_warnings():
            warnings.filterwarnings("error", module="xarray")  # reading the file must cause no warning
            with xarray.open_dataset(path) as data:
                return data.load()


def equal(what, left, right):
    if left != right:
        sys.exit(f"{what}: {left}, expected {right}")


cradle = data_of("newtons_cradle.sim")
equal("dimensions", dict(cradle.position.sizes), {"time": 201, "body": 7, "component": 2})
equal("time", (cradle.time.dtype.kind, cradle.time.attrs["units"], float(cradle.time[-1])), ("f", "s", 15.0))
equal("units", (cradle.position.units, cradle.velocity.units), ("m", "m/s"))
equal("names", list(cradle.body.values[:2]), ["ball[1]", "ball[2]"])
ball = cradle.sel(body="ball[2]", component="x")
equal("a body by its name", float(ball.position[0]), float(cradle.position[0, 1, 0]))
kinetic = (cradle.mass * (cradle.velocity**2).sum("component") / 2).sum("body")  # it does not spin
if not numpy.allclose(kinetic, cradle["world.kinetic"], rtol=1e-12):
    sys.exit("the kinetic energy from masses and velocities is not the world's")

gas = data_of("maxwell_gas.sim", "--until", "1")
equal("in space", gas.orientation.dims, ("time", "body", "part"))
if not numpy.allclose((gas.orientation**2).sum("part"), 1, rtol=0, atol=1e-14):
    sys.exit("quaternions are not of length 1")

heat = data_of("heat_equation.sim")
equal("a family", heat.u.dims, ("time", "i"))
equal("its indices", list(heat.i.values), list(range(1, 20)))
if not (heat.u.sel(i=10) == heat.middle).all():
    sys.exit("the middle of the rod is not u[10]")
