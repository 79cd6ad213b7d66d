"""Models in process: their runs against the command's own, settings, errors, copies, and what they cost."""

import copy
import csv
import gc
import math
import os
import pickle
import shutil
import signal
import subprocess
import sys
import textwrap
import threading
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

import continuo
from continuo import Interrupted, Model, ModelError, ModelWarning, RunError

MODELS = Path(__file__).resolve().parents[2] / "models"
COMMAND = os.environ.get("CONTINUO_COMMAND") or shutil.which("continuo")
needs_command = pytest.mark.skipif(COMMAND is None, reason="the command continuo is not there")

# Events, modes, stiff and implicit systems, conditions at several times, worlds, inputs from files, families.
SAMPLE = [
    "arenstorf", "ball_located", "ball_on_stairs", "billiards", "blasius", "bouncing_ball", "bratu",
    "brusselator_line", "car", "double_pendulum", "falling_balls", "fed_batch", "heat_equation", "hires",
    "lorenz", "mass_spring", "newtons_cradle", "pendulum_dae", "predator_prey", "rc_ladder", "robertson",
    "stiff_spring_explicit", "thermostat", "wave_equation",
]  # fmt: skip

SPRING = """model Spring
param k = 4 [N/m] in 1..10, m = 1 [kg]  # the stiffness
param w = 2*k [N/m]
x'' = -k/m*x
x(0) = 1 [m]; x'(0) = 0 [m/s]
energy kinetic = 1/2*m*x'^2, elastic = 1/2*k*x^2
let doubled = 2*x
output thrice = 3*x
run 0..3 [s] output 0.5 method dop853 tol 1e-10
"""
OSCILLATOR = "x'' = -x; x(0) = 1; x'(0) = 0\nrun 0..1e9 output 1e4 method rk4 step 0.01\n"

LORENZ = """param s = 10, salt = SALT
x' = s*(y - x); y' = x*(28 - z) - y; z' = x*y - 8/3*z + 0*salt
x(0) = 1; y(0) = 1; z(0) = 1
run 0..1000 output 100 tol 1e-12
"""


def rows_of_command(*arguments: str) -> np.ndarray:
    done = subprocess.run(
        [str(COMMAND), "run", *arguments, "-o", "-"], capture_output=True, text=True, check=False
    )
    lines = [line for line in done.stdout.splitlines() if not line.startswith("#")]
    return np.array(list(csv.reader(lines))[1:], dtype=float)


# ---- the same as the command -------------------------------------------------------------------------------


@needs_command
@pytest.mark.parametrize("name", SAMPLE)
def test_gallery_to_the_bit(name: str) -> None:
    file = str(MODELS / f"{name}.sim")
    run = Model(file).run()
    assert run.success and all(run.checks)
    # A table in CSV does not tell -0 from 0.
    np.testing.assert_array_equal(run.table, rows_of_command(file))


@needs_command
def test_random_settings_to_the_bit() -> None:
    rng = np.random.default_rng(25)
    model = Model(MODELS / "mass_spring_damper.sim")
    for _ in range(5):
        k, c, x = rng.uniform(1, 10), rng.uniform(0, 2), rng.normal()
        run = model.run(7, k=k, c=np.float64(c), x=x, output=0.25, method="verner7", tol=1e-8)
        wanted = rows_of_command(
            str(MODELS / "mass_spring_damper.sim"), f"--set=k={k!r}", f"--set=c={c!r}", f"--initial=x={x!r}",
            "--until=7", "--output=0.25", "--method=verner7", "--tol=1e-8",
        )  # fmt: skip
        np.testing.assert_array_equal(run.table, wanted)


def test_closed_form_at_random_parameters() -> None:
    # x(t) = x0 cos(w t) + v0/w sin(w t); the global error of tol 1e-10 over a few turns is some hundred of
    # it.
    rng = np.random.default_rng(7)
    model = Model(text=SPRING)
    for _ in range(20):
        k, m, x0, v0 = rng.uniform(1, 10), rng.uniform(0.1, 5), rng.normal(), rng.normal()
        run = model.run(k=k, m=m, set={"x(0)": x0, "x'": v0})
        w = math.sqrt(k / m)
        exact = x0 * np.cos(w * run.t) + v0 / w * np.sin(w * run.t)
        np.testing.assert_allclose(run["x"], exact, atol=1e-7 * (abs(x0) + abs(v0) + 1))


def test_native_is_the_same() -> None:
    runs = [Model(MODELS / "double_pendulum.sim", native=native).run(5) for native in ("never", "auto")]
    np.testing.assert_array_equal(runs[0].table, runs[1].table)


def test_fused_operations_differ_by_rounding() -> None:
    try:
        fused = Model(MODELS / "lorenz.sim", native="fused").run(2)
    except ValueError as error:
        pytest.skip(str(error))
    run = Model(MODELS / "lorenz.sim", native="never").run(2)
    np.testing.assert_allclose(fused.table[-1], run.table[-1], rtol=1e-9)
    assert fused.manifest["native"]["fused"] and "fused" not in (run.manifest["native"] or {})


def test_native_is_one_of_four_words() -> None:
    with pytest.raises(ValueError, match="fused"):
        Model(text=SPRING, native="sometimes")


# ---- what a run has ----------------------------------------------------------------------------------------


def test_rows_and_names() -> None:
    run = Model(text=SPRING).run()
    assert run.columns == ["t", "x", "x'", "thrice", "kinetic", "elastic"]
    assert run.units["x'"] == "m/s" and run.states == ["x", "x'"]
    np.testing.assert_array_equal(run["doubled"], 2 * run["x"])
    np.testing.assert_array_equal(run["thrice"], 3 * run["x"])
    np.testing.assert_allclose(run["energy"], run["kinetic"] + run["elastic"], rtol=1e-15)
    assert run.y.shape == (2, 7) and len(run) == 7
    assert run.final["x"].unit == "m" and run.final["x"] == run["x"][-1]
    assert "x" in run and "q" not in run
    with pytest.raises(ValueError, match="read-only"):
        run.t[0] = 1
    with pytest.raises(KeyError, match="did you mean `thrice`"):
        run["thrise"]
    assert run.energy is not None and run.energy.drift < 1e-9 and run.energy.unit == "J"
    assert run.statistics["steps"] > 0 and run.method == "dop853"
    assert run.manifest["model"]["name"] == "Spring" and run.manifest["method"] == "dop853"
    assert "reached end at t = 3" in str(run) and "Spring" in repr(run)


def test_rows_outlive_the_run() -> None:
    t = Model(text=SPRING).run().t
    gc.collect()
    np.testing.assert_array_equal(t, np.arange(7) * 0.5)


def test_data_is_that_of_netcdf(tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("scipy")
    if COMMAND is None:
        pytest.skip("the command continuo is not there")
    for name in ("bouncing_ball", "heat_equation", "newtons_cradle"):
        file = tmp_path / f"{name}.nc"
        subprocess.run(
            [COMMAND, "run", str(MODELS / f"{name}.sim"), "-o", str(file)], capture_output=True, check=True
        )
        data = Model(MODELS / f"{name}.sim").run().data
        with xarray.open_dataset(file, engine="scipy", decode_times=False) as wanted:
            assert set(data.variables) == set(wanted.variables)
            for variable in wanted.variables:
                assert data[variable].dims == wanted[variable].dims
                if wanted[variable].dtype.kind == "f":
                    np.testing.assert_array_equal(data[variable].values, wanted[variable].values)
                assert data[variable].attrs == wanted[variable].attrs


def test_both_sides_of_an_event_are_kept() -> None:
    pytest.importorskip("xarray")
    run = Model(MODELS / "bouncing_ball.sim").run(2)
    impact = run.times_of("h falls")[0]
    assert abs(impact - 10 / 7) < 1e-12
    np.testing.assert_allclose(run["h'"][run.t == impact], [-14, 12.6], rtol=1e-12)
    np.testing.assert_allclose(run.data["h'"].sel(time=impact), [-14, 12.6], rtol=1e-12)


def test_events_as_a_table() -> None:
    pytest.importorskip("pandas")
    events = Model(MODELS / "bouncing_ball.sim").run().events
    assert list(events.columns) == ["t", "event", "before h", "before h'", "after h", "after h'"]
    assert len(events) == 69 and events["event"][0] == "h falls through 0 in flight"
    np.testing.assert_allclose(events["after h'"][:68], -0.9 * events["before h'"][:68], rtol=1e-12)
    contacts = Model(MODELS / "newtons_cradle.sim").run().events
    assert (contacts["impulse"] > 0).any()
    assert len(Model(text=SPRING).run().events) == 0


def test_families_are_arrays() -> None:
    run = Model(
        text="param N = 3\nfor i in 1..N { u[i]' = -i*u[i]; u[i](0) = 1 }\nrun 0..1 output 0.5 tol 1e-9"
    ).run(N=5)
    assert run["u"].shape == (3, 5)
    np.testing.assert_allclose(run["u"][-1], np.exp(-np.arange(1, 6)), rtol=1e-7)
    cradle = Model(MODELS / "newtons_cradle.sim").run()
    assert cradle["position"].shape[0] == len(cradle) and cradle["position"].ndim == 3


def test_a_size_and_a_member_are_set_together() -> None:
    model = Model(text="param N = 3\nfor i in 1..N { u[i]' = 0; u[i](0) = 1 }\nrun 0..1 output 1")
    run = model.run(N=6, set={"u[6](0)": 7, "u": 2})
    np.testing.assert_array_equal(run["u"][-1], [2, 2, 2, 2, 2, 7])
    with pytest.raises(ModelError):
        model.run(set={"u[6]": 7})
    model.N = 4
    assert len(model.states) == 4 and model.N == 4.0
    model.states["u[4]"] = 9
    assert model.states["u[4]"] == 9 and model.run()["u"].shape == (2, 4)


def test_error_estimate() -> None:
    run = Model(text=SPRING).run(estimate_error=True, tol=1e-6)
    assert run.error is not None and run.error.at_end.shape == (2,)
    assert abs(run["x"][-1] - math.cos(6)) < 10 * max(run.error.at_end[0], 1e-12)


def test_output_steps() -> None:
    assert len(Model(text=SPRING).run(output="steps")) == Model(text=SPRING).run().statistics["steps"] + 1


def test_pictures() -> None:
    run = Model(MODELS / "bouncing_ball.sim").run()
    html = run._repr_html_()
    assert "<svg" in html and "BouncingBall" in html and "nan" not in html
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("Agg")
    axes = run.plot()
    assert [axis.get_ylabel() for axis in axes] == ["h [m]", "energy [m^2/s^2]"]
    axis = run.plot("h'", against="h", events=True)
    assert axis.get_xlabel() == "h [m]" and axis.get_ylabel() == "h' [m/s]"
    np.testing.assert_array_equal(axis.lines[0].get_ydata(), run["h'"])
    assert run.plot("h", "h'", ax=axis) is axis
    pyplot.close("all")


# ---- settings ----------------------------------------------------------------------------------------------


def test_parameters_are_attributes() -> None:
    model = Model(text=SPRING)
    assert model.k == 4 and repr(model.k) == "4.0 N/m" and model.w == 8
    model.k = 9
    assert model.k == 9 and model.w == 18 and model.run()["elastic"][0] == 4.5
    model.k = "0.05 N/cm"
    assert model.k == pytest.approx(5, rel=1e-14)
    model.m = "500 g"
    assert model.parameters["m"] == 0.5 and model.parameters["k"].range == (1, 10)
    del model.parameters["k"]
    assert model.k == 4
    assert "k" in dir(model) and "k" in model.parameters and list(model.parameters) == ["k", "m", "w"]
    model.states["x'"] = "36 km/h"
    assert model.run().y[1, 0] == 10
    assert repr(model.states["x'"]) == "10.0 m/s"
    model.reset()
    assert model.m == 1 and model.states["x'"] == 0
    assert model.outputs["kinetic"].unit == "J"


def test_a_setting_for_one_run_stays_there() -> None:
    model = Model(text=SPRING)
    model.run(k=9, x=3)
    assert model.k == 4 and model.states["x"] == 1


def test_names_in_any_script() -> None:
    model = Model(text="param ω = 2\nφ' = -ω*φ; φ(0) = 1\nrun 0..1 tol 1e-9")
    model.ω = 3
    assert model.run()["φ"][-1] == pytest.approx(math.exp(-3), rel=1e-7)


def test_inputs_are_set_by_numbers() -> None:
    model = Model(text="input F = 2 [N]\nparam m = 1 [kg]\nv' = F/m; v(0) = 0 [m/s]\nrun 0..1 [s] tol 1e-10")
    assert model.inputs["F"].unit == "N" and model.F == 2
    assert model.run()["v"][-1] == pytest.approx(2, rel=1e-9)
    assert model.run(F=5)["v"][-1] == pytest.approx(5, rel=1e-9)
    model.F = 7
    assert model.run()["v"][-1] == pytest.approx(7, rel=1e-9)


@pytest.mark.parametrize(
    "settings, error, words",
    [
        ({"q": 1}, ModelError, "no parameter, input or state `q`"),
        ({"k": "3 s"}, ModelError, "is no"),
        ({"k": "three"}, ModelError, "cannot be set"),
        ({"k": math.nan}, ValueError, "finite"),
        ({"k": math.inf}, ValueError, "finite"),
        ({"k": [1, 2]}, TypeError, "sweep"),
        ({"k": np.array([1.0])}, TypeError, "one number"),
        ({"k": None}, TypeError, "one number"),
        ({"k": True}, TypeError, "one number"),
        ({"k": 1j}, TypeError, "one number"),
        ({"k": 10**400}, ValueError, "too large"),
        ({"until": 1e12, "output": 1e-6}, MemoryError, "ask for fewer"),
        ({"set": {"x(1)": 2}}, ModelError, "begins at t = 0"),
        ({"set": {3: 2}}, TypeError, "from names"),
        ({"until": -1}, ModelError, "cannot go"),
        ({"until": "9"}, TypeError, "one number"),
        ({"untill": 3}, ModelError, "did you mean `until`"),
        ({"method": "rk5"}, ModelError, "no method"),
        ({"method": 4}, TypeError, "str"),
        ({"tol": 0}, ValueError, "between 0 and 1"),
        ({"tol": 1}, ValueError, "between 0 and 1"),
        ({"tol": 1e-3, "rtol": 1e-3}, TypeError, "two names"),
        ({"atol": {"q": 1e-3}}, ModelError, "no state"),
        ({"step": -0.1}, ModelError, "positive"),
        ({"output": 0}, ModelError, ""),
        ({"max_steps": 1.5}, ValueError, "whole number"),
        ({"progress": 3}, TypeError, "progress"),
    ],
)
def test_what_cannot_be_meant(settings: dict, error: type, words: str) -> None:
    with pytest.raises(error, match=words):
        Model(text=SPRING).run(**settings)


def test_wrong_attributes() -> None:
    model = Model(text=SPRING)
    with pytest.raises(AttributeError, match="no parameter `kk`; did you mean `k`"):
        model.kk
    with pytest.raises(AttributeError, match="no parameter `kk`"):
        model.kk = 3
    with pytest.raises(AttributeError, match="did you mean `linearize`"):
        model.linearise()
    with pytest.raises(AttributeError, match="is a state"):
        model.x
    with pytest.raises(AttributeError, match="cannot be replaced"):
        model.run = 3
    with pytest.raises(KeyError, match="no parameter `x`"):
        model.parameters["x"] = 3
    assert not hasattr(model, "_repr_png_")


def test_a_parameter_called_like_an_option() -> None:
    model = Model(text="param step = 3, fit = 1\nx' = step*fit; x(0) = 0\nrun 0..1 method rk4 step 0.5")
    with pytest.warns(ModelWarning, match="`step` is an option"):
        model.run()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert model.run(step=0.25, set={"step": 5})["x"][-1] == pytest.approx(5)
        model.parameters["fit"] = 2
        assert model.run()["x"][-1] == pytest.approx(6)
    with pytest.raises(AttributeError, match="model.parameters"):
        model.fit = 2


def test_a_value_out_of_range_is_warned_of() -> None:
    with pytest.warns(ModelWarning, match="E342") as caught:
        Model(text=SPRING).run(k=100)
    assert caught[0].filename == __file__


# ---- what goes wrong ---------------------------------------------------------------------------------------


def test_errors_of_the_text() -> None:
    with pytest.raises(ModelError) as caught:
        Model(text="x'' = -k*x\nx(0) = 1; x'(0) = 0\nrun 0..1", name="spring")
    error = caught.value
    assert (error.code, error.line, error.column) == ("E210", 1, 8)
    assert "declare it" in error.hint and "--> spring:1:8" in str(error) and "^" in str(error)
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) and again.code == "E210" and again.messages == error.messages


@needs_command
def test_errors_are_the_text_of_the_command(tmp_path: Path) -> None:
    file = tmp_path / "wrong.sim"
    file.write_text("param k = 3 [N]\nx'' = -k*x + y\nx(0) = 1\nrun 0..1\n")
    printed = subprocess.run(
        [str(COMMAND), "check", str(file)], capture_output=True, text=True, check=False
    ).stderr
    with pytest.raises(ModelError) as caught:
        Model(file)
    assert str(caught.value) == printed.rstrip("\n")


def test_files_that_are_not_there(tmp_path: Path) -> None:
    (tmp_path / "ball.sim").write_text(SPRING)
    with pytest.raises(FileNotFoundError, match="did you mean .*ball.sim"):
        Model(tmp_path / "bal.sim")
    with pytest.raises(FileNotFoundError, match="text="):
        Model("x' = 1\nx(0) = 0")
    with pytest.raises(IsADirectoryError):
        Model(tmp_path)
    with pytest.raises(TypeError, match="a file"):
        Model()
    with pytest.raises(TypeError, match="str"):
        Model(text=b"x' = 1")  # type: ignore[arg-type]  # what must be refused


@pytest.mark.parametrize("text", ["", "\0", "x' =", "\ud800", "x' = 1\nx(0) = 0\0", "(" * 10000, "🙂 = 3"])
def test_texts_that_are_none(text: str) -> None:
    with pytest.raises(ModelError):
        Model(text=text)


def test_a_run_that_fails_keeps_its_rows() -> None:
    model = Model(text="x' = x^2; x(0) = 1\nrun 0..2 output 0.1 tol 1e-8")  # x = 1/(1 - t)
    with pytest.raises(RunError) as caught:
        model.run()
    error = caught.value
    assert error.code.startswith("E30") and error.run is not None and not error.run.outcome
    assert 0.9 <= error.run.t[-1] <= 1.000001
    t = error.run.t[error.run.t < 0.95]
    np.testing.assert_allclose(error.run["x"][: len(t)], 1 / (1 - t), rtol=1e-6)
    with pytest.warns(ModelWarning, match="E302"):
        run = model.run(check=False)
    assert not run.success and len(run) == len(error.run)
    assert str(pickle.loads(pickle.dumps(error)).run.outcome) == str(run.outcome)


def test_checks_that_do_not_hold_are_warned_of() -> None:
    model = Model(text="x' = 1; x(0) = 0\nrun 0..1\ncheck x at end = 2 within 0.1")
    with pytest.warns(ModelWarning, match="does not hold"):
        run = model.run()
    assert not run.checks[0] and run.checks[0].value == pytest.approx(1)
    assert "does not hold" in run._repr_html_()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model.run(2)  # they are meant for the model as written


def test_progress_is_told_and_may_raise() -> None:
    model, seen = Model(text=OSCILLATOR), []

    def watch(t: float, part: float) -> None:
        seen.append((t, part))
        if len(seen) == 3:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough") as caught:
        model.run(progress=watch)
    assert caught.traceback[-1].name == "watch"
    assert all(0 <= part <= 1 and part == pytest.approx(t / 1e9) for t, part in seen) and seen[0] < seen[-1]


def test_ctrl_c_ends_a_run_at_once_and_keeps_it() -> None:
    script = f"""
        import os, signal, threading, time
        from continuo import Interrupted, Model
        model = Model(text={OSCILLATOR!r})
        def press():
            global pressed
            pressed = time.monotonic()
            os.kill(os.getpid(), signal.SIGINT)
        threading.Timer(0.4, press).start()
        try:
            model.run()
        except KeyboardInterrupt as error:
            assert isinstance(error, Interrupted)
            run = error.run
            print(time.monotonic() - pressed, len(run), run.outcome.interrupted, abs(run["x"]).max())
        print(model.run(1).success)
    """
    done = subprocess.run(
        [
            sys.executable, "-c", textwrap.dedent(script)
        ], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    seconds, rows, interrupted, largest = done.stdout.split()[:4]
    assert float(seconds) < 1 and int(rows) > 1 and interrupted == "True" and float(largest) <= 1.001
    assert done.stdout.split()[4] == "True"


def test_what_a_signal_raises_passes_through() -> None:
    def late(*_: object) -> None:
        raise TimeoutError("late")

    before = signal.signal(signal.SIGALRM, late)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        with pytest.raises(TimeoutError, match="late"):
            Model(text=OSCILLATOR).run()
    finally:
        signal.signal(signal.SIGALRM, before)


# ---- copies, threads, cost ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["bouncing_ball", "car", "newtons_cradle", "heat_equation"])
def test_pickled_runs_are_the_same(name: str) -> None:
    run = Model(MODELS / f"{name}.sim").run()
    again = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(again.table, run.table)
    assert repr(again) == repr(run) and str(again) == str(run) and again.manifest == run.manifest
    assert again.keys() == run.keys() and again.outcome == run.outcome and again.checks == run.checks
    assert again._repr_html_() == run._repr_html_()
    for key in run.keys():
        np.testing.assert_array_equal(again[key], run[key])


def test_pickled_and_copied_models() -> None:
    model = Model(text=SPRING)
    model.k, model.states["x"] = 9, 2
    for other in (pickle.loads(pickle.dumps(model)), copy.copy(model), copy.deepcopy(model), model.copy()):
        np.testing.assert_array_equal(other.run().table, model.run().table)
        other.k = 5
        assert model.k == 9
    car = pickle.loads(pickle.dumps(Model(MODELS / "car.sim")))  # its tables lie beside it
    assert car.run().success


def test_threads_share_a_model() -> None:
    model = Model(MODELS / "double_pendulum.sim")
    alone = [model.run(2, method="dop853", tol=tol).table for tol in (1e-6, 1e-8, 1e-10, 1e-12)]
    found: dict = {}

    def run(i: int) -> None:
        for _ in range(5):
            found[i] = model.run(2, method="dop853", tol=(1e-6, 1e-8, 1e-10, 1e-12)[i]).table

    threads = [threading.Thread(target=run, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for i in range(4):
        np.testing.assert_array_equal(found[i], alone[i])


def test_forked_processes() -> None:
    # The forked process has no thread that compiles, which its parent's models have.
    script = f"""
        import os, sys, time
        from continuo import Model
        model = Model(text={LORENZ!r}.replace("SALT", str(time.time())))
        model.s = 11
        run, wanted = model.run(), model.run(3).table
        print(run.manifest["native"]["compiled"] >= 0, flush=True)
        if os.fork() == 0:
            same = (model.run(3).table == wanted).all()
            del run
            sys.exit(0 if same else 1)
        print(os.waitstatus_to_exitcode(os.wait()[1]))
    """
    done = subprocess.run(
        [
            sys.executable, "-c", textwrap.dedent(script)
        ], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.stdout.split() == ["True", "0"], done.stderr


def present_memory() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_nothing_leaks() -> None:
    model = Model(text=SPRING)

    def use() -> None:
        run = model.run(k=5)
        run["doubled"], run.final, run.outcome, run.manifest
        with pytest.raises(ModelError):
            model.run(q=3)

    for _ in range(300):
        use()
    gc.collect()
    before = present_memory()
    for _ in range(1000):
        use()
    gc.collect()
    assert present_memory() - before < 1e6


def test_a_short_run_costs_less_than_a_millisecond() -> None:
    model = Model(text=SPRING)
    best = math.inf
    for _ in range(100):
        begin = time.perf_counter()
        model.run(1, k=5)
        best = min(best, time.perf_counter() - begin)
    assert best < 1e-3


def test_version_is_in_the_manifest() -> None:
    assert Model(text=SPRING).run().manifest["continuo"] == continuo.__version__
    assert issubclass(Interrupted, KeyboardInterrupt)
