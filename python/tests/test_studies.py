"""Studies by the command: what they find against closed forms, options, settings, errors, Ctrl-C."""

import math
import os
import pickle
import shutil
import subprocess
import sys
import textwrap
import types
import warnings
from pathlib import Path

import numpy as np
import pytest

from continuo import CommandError, Model, ModelError, ModelWarning, RunError
from continuo.command import command_path, options_of
from continuo.study_result import converted

if (os.environ.get("CONTINUO_COMMAND") or shutil.which("continuo")) is None:
    pytest.skip("the command continuo is not there", allow_module_level=True)

MODELS = Path(__file__).resolve().parents[2] / "models"

DAMPED = """model Damped
param k = 4 in 1..20, c = 0.5 in 0.1..2, F0 = 0
x'' = -k*x - c*x' + F0
x(0) = 1; x'(0) = 0
run 0..6 output 0.1 tol 1e-9
"""


def exact(t: np.ndarray, k: float, c: float) -> np.ndarray:
    w = math.sqrt(k - c * c / 4)
    return np.exp(-c * t / 2) * (np.cos(w * t) + c / (2 * w) * np.sin(w * t))


# ---- what is found -----------------------------------------------------------------------------------------


def test_linearize() -> None:
    linear = Model(text=DAMPED).linearize(k=9)
    np.testing.assert_allclose(linear.A, [[0, 1], [-9, -0.5]], rtol=1e-12)
    assert linear.states == ["x", "x'"] and linear.B.shape == (2, 0) and linear.C.shape == (0, 2)
    eigenvalue = linear.modes.eigenvalue[0]
    assert eigenvalue.real == pytest.approx(-0.25) and abs(eigenvalue.imag) == pytest.approx(
        math.sqrt(9 - 1 / 16)
    )


def test_linearize_with_inputs_and_outputs() -> None:
    text = "input u = 0\nx' = -2*x + 3*u; x(0) = 0\noutput y = 5*x + 7*u\nrun 0..1"
    linear = Model(text=text).linearize()
    assert (linear.A, linear.B, linear.C, linear.D) == (-2, 3, 5, 7)
    assert linear.inputs == ["u"] and linear.outputs == ["y"]


def test_linear_models_of_python_control(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list = []
    control = types.ModuleType("control")
    setattr(control, "ss", lambda *matrices, **names: asked.append((matrices, names)))
    monkeypatch.setitem(sys.modules, "control", control)
    Model(
        text="input u = 0\nx' = -2*x + 3*u; x(0) = 0\noutput y = 5*x + 7*u\nrun 0..1"
    ).linearize().to_control()
    (a, b, c, d), names = asked.pop()
    assert (a, b, c, d) == (-2, 3, 5, 7) and names == {"states": ["x"], "inputs": ["u"], "outputs": ["y"]}
    Model(text=DAMPED).linearize().to_control()
    (a, b, c, d), names = asked.pop()
    assert b.shape == (2, 1) and not b.any() and (c == np.eye(2)).all() and d.shape == (2, 1)
    assert names["outputs"] == ["y_x", "y_x'"]
    monkeypatch.setitem(sys.modules, "control", None)
    with pytest.raises(ImportError, match="needs control"):
        Model(text=DAMPED).linearize().to_control()


def test_steady_and_its_stability() -> None:
    found = Model(text="param r = 2\nx' = x*(r - x); x(0) = 1\nrun 0..9").steady(r=3, box={"x": (-1, 5)})
    np.testing.assert_allclose(sorted(found.equilibria.x[:, 0]), [0, 3], atol=1e-9)
    stable = next(one for one in found.equilibria if one.stability.startswith("stable"))
    np.testing.assert_allclose(stable.eigenvalues, [-3], rtol=1e-9)


def test_sensitivities_against_the_closed_form() -> None:
    t_end = 2.0
    found = Model(text="param a = 0.7\nx' = -a*x; x(0) = 2\nrun 0..2 tol 1e-10").sensitivities(
        "a", "x", output=0.5
    )
    assert found.by.tolist() == ["a", "x(0)"] if isinstance(found.by, np.ndarray) else found.by[0] == "a"
    assert found.rows.by.shape == (5, 2, 1)
    np.testing.assert_allclose(
        found.rows.by[-1, :, 0], [-2 * t_end * math.exp(-1.4), math.exp(-1.4)], rtol=1e-7
    )


def test_orders_of_methods() -> None:
    found = Model(text=DAMPED).converge(["rk4", "heun"], most_steps=4096)
    assert found.methods.method == ["rk4", "heun"]
    assert [getattr(one, "global").order for one in found.methods] == pytest.approx([4, 2], abs=0.1)


def test_compare() -> None:
    found = Model(text=DAMPED).compare("rk4", step=[0.1, 0.05])
    errors = found.contenders.final_error
    assert errors.shape == (2,) and 10 < errors[0] / errors[1] < 24  # of order four


def test_stability() -> None:
    found = Model(text=DAMPED).stability(["rk4", "explicit_euler"])
    assert found.methods[0].imaginary_axis_to == pytest.approx(2 * math.sqrt(2), rel=1e-9)
    assert found.methods[1].real_axis_to == pytest.approx(-2)
    assert found.methods[0].largest.step > 0


def test_lyapunov_of_a_linear_system() -> None:
    found = Model(text="x' = -x; y' = -3*y; x(0) = 1; y(0) = 1\nrun 0..5 tol 1e-8").lyapunov(
        settle=1, duration=20
    )
    np.testing.assert_allclose(found.exponents, [-1, -3], rtol=1e-3)


def test_orbit_section_phase_explore() -> None:
    van_der_pol = Model(text="x'' = (1 - x^2)*x' - x; x(0) = 2; x'(0) = 0\nrun 0..20 tol 1e-8")
    orbit = van_der_pol.orbit()
    assert orbit.period == pytest.approx(6.6632868593231, rel=1e-6) and orbit.stable is True
    assert orbit.multipliers.dtype == complex
    plane = van_der_pol.phase(box={"x": (-3, 3), "x'": (-3, 3)})
    assert plane.states == ["x", "x'"]
    assert van_der_pol.explore().states == ["x", "x'"]


def test_verify_and_report(tmp_path: Path) -> None:
    model = Model(text="x' = 1; x(0) = 0\nrun 0..1\ncheck x at end = 1 within 1e-9")
    assert model.verify().checks_passed == 1
    Model(text=DAMPED).report(tmp_path / "page.html", "steady")
    assert "<html" in (tmp_path / "page.html").read_text()
    with pytest.warns(ModelWarning):
        Model(text="x' = 1; x(0) = 0\nrun 0..1\ncheck x at end = 2 within 1e-9").verify()


# ---- fits --------------------------------------------------------------------------------------------------


def test_fit_of_random_parameters() -> None:
    rng = np.random.default_rng(3)
    model = Model(text=DAMPED)
    t = np.linspace(0.05, 6, 80)
    for _ in range(3):
        k, c = rng.uniform(2, 9), rng.uniform(0.2, 1)
        fit = model.fit({"t": t, "x": exact(t, k, c) + rng.normal(0, 1e-3, t.size)}, param=["k", "c"])
        assert fit.converged
        # Within six of the deviations that it claims itself.
        np.testing.assert_array_less(np.abs(fit.unknowns.value - [k, c]), 6 * fit.unknowns.deviation)
    model.take(fit)
    assert model.k == fit.values["k"] == fit.unknowns[0].value
    assert fit.deviations["k"] == fit.unknowns[0].deviation


def test_fit_takes_tables_of_all_kinds(tmp_path: Path) -> None:
    model = Model(text=DAMPED)
    run = model.run(k=5)
    found = [model.fit({"t": run.t, "x": run["x"]}, param="k").unknowns.value[0]]
    file = tmp_path / "data.csv"
    file.write_text("t,x\n" + "\n".join(f"{t!r},{x!r}" for t, x in zip(run.t, run["x"])) + "\n")
    found.append(model.fit(file, param="k").unknowns.value[0])
    pytest.importorskip("pandas")
    frame = run.to_pandas()[["x"]]
    found += [model.fit(frame, param="k").unknowns.value[0], model.fit(frame.x, param="k").unknowns.value[0]]
    pytest.importorskip("xarray")
    found.append(model.fit(run.data[["x"]], param="k").unknowns.value[0])
    np.testing.assert_allclose(found, 5, rtol=1e-6)


@pytest.mark.parametrize(
    "data, error, words",
    [
        ((), TypeError, "measurements"),
        (({"x": [1.0]},), ValueError, "column t"),
        (({"t": [0.0, 1.0], "x": [1.0]},), ValueError, "one length"),
        (({"t": [0.0], "x": ["a"]},), ValueError, "a"),
        ((3,), TypeError, "table"),
        (("no_such_file.csv",), FileNotFoundError, "no_such_file"),
    ],
)
def test_no_measurements(data: tuple, error: type, words: str) -> None:
    with pytest.raises(error, match=words):
        Model(text=DAMPED).fit(*data, param="k")


# ---- sweeps ------------------------------------------------------------------------------------------------


def test_sweep_against_single_runs() -> None:
    pytest.importorskip("xarray")
    model = Model(text=DAMPED)
    data = model.sweep({"c": (0.2, 0.8, 3)}, k=[2, 3.5], keep=["x at end", "max(x) as peak"])
    assert data.sizes == {"run": 6} and set(data.coords) == {"run", "c", "k"}
    for i in range(6):
        run = model.run(k=float(data.k[i]), c=float(data.c[i]))
        assert float(data["x at end"][i]) == run["x"][-1]
    assert data.attrs["statistics"][0]["name"] == "x at end"


def test_sweep_takes_what_is_set() -> None:
    pytest.importorskip("xarray")
    model = Model(text=DAMPED)
    model.c, model.states["x"] = 1, 3
    data = model.sweep("k in (2, 3)", until=1, keep="x at 0..1 by 0.5 as path")
    assert data["path"].dims == ("run", "time")
    np.testing.assert_allclose(data["path"][:, 0], 3)
    assert float(data["path"][1, -1]) == pytest.approx(model.run(1, k=3)["x"][-1], rel=1e-8)


def test_failed_runs_of_a_sweep() -> None:
    pytest.importorskip("xarray")
    model = Model(text="param T = 1\nx' = x^2/T; x(0) = 1\nrun 0..2 tol 1e-6")
    with pytest.raises(RunError) as caught:
        model.sweep(T=[1, 5], keep="x at end")
    for data in (caught.value.result, model.sweep(T=[1, 5], keep="x at end", check=False)):
        assert np.isnan(data["x at end"][0]) and float(data["x at end"][1]) == pytest.approx(5 / 3, rel=1e-4)


def test_wrong_sweeps() -> None:
    pytest.importorskip("xarray")
    model = Model(text=DAMPED)
    with pytest.raises(ModelError, match="foo"):
        model.sweep(foo=[1, 2])
    with pytest.raises(ValueError, match="finite"):
        model.sweep(k=[1, math.nan])
    with pytest.raises(TypeError, match="varied by"):
        model.sweep({"k": 3})
    with pytest.raises(ValueError, match="netCDF"):
        model.sweep(k=[1, 2], out="table.csv")


# ---- options, settings, errors -----------------------------------------------------------------------------


def test_what_is_wrong_is_said() -> None:
    model = Model(text=DAMPED)
    with pytest.raises(ModelError, match="did you mean `starts`"):
        model.steady(start=3)
    with pytest.raises(ModelError, match="no method `rk5`"):
        model.converge("rk5")
    with pytest.raises(ModelError, match="no state `q`"):
        model.steady(box={"q": (0, 1)})
    with pytest.raises(TypeError, match="True or False"):
        model.linearize(start=3)
    with pytest.raises(TypeError, match="one name"):
        model.steady(along={"k": (1, 2), "c": (1, 2)})
    with pytest.raises(CommandError, match="frobnicate"):
        model.study("frobnicate")
    with pytest.raises(ModelError, match="`rk4` cannot solve") as caught:
        Model(MODELS / "pendulum_dae.sim").compare("rk4", step=0.1)
    assert caught.value.result.contenders[0].method == "rk4"
    with pytest.warns(ModelWarning, match="`rk4` does not estimate its error"):
        found = Model(MODELS / "pendulum_dae.sim").compare("rk4, radau", tol=1e-6)
    assert found.contenders[1].final_error < 1e-3
    gas = Model(MODELS / "newtons_cradle.sim")
    with pytest.raises(ModelError) as caught:
        gas.steady()
    assert caught.value.code == "E323" and "newtons_cradle.sim:" in str(caught.value) and caught.value.line


def test_settings_that_a_study_cannot_take() -> None:
    model = Model(text="input u = 0\nx' = u - x; x(0) = 0\nrun 0..1")
    model.u = 3
    with pytest.raises(ModelError, match="inputs"):
        model.steady()
    model = Model(text=DAMPED)
    model.states["x"] = 3
    with pytest.raises(ModelError, match="begins where the text says"):
        model.steady()


def test_tables_lie_beside_the_model() -> None:
    model = Model(MODELS / "car.sim")
    assert model.verify().models_passed == 1


def test_the_command_is_found_or_missed(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "--json" in options_of("steady")
    command = command_path()
    monkeypatch.setenv("CONTINUO_COMMAND", "/nowhere/continuo")
    with pytest.raises(CommandError, match="CONTINUO_COMMAND"):
        Model(text=DAMPED).steady()
    monkeypatch.delenv("CONTINUO_COMMAND")
    monkeypatch.setenv("PATH", os.path.dirname(command))
    assert os.path.basename(command_path()) == "continuo"
    monkeypatch.setenv("PATH", "")
    with pytest.raises(CommandError, match="PATH"):
        command_path()


def test_what_starts_the_command_may_talk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "continuo"
    program.write_text(f'#!/bin/sh\necho building >&2\nexec {command_path()} "$@"\n')
    program.chmod(0o755)
    monkeypatch.setenv("CONTINUO_COMMAND", str(program))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert Model(text=DAMPED).linearize().A.shape == (2, 2)


def test_a_command_that_crashes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "continuo"
    program.write_text(
        '#!/bin/sh\n[ "$1" = help ] && echo \'{"options": []}\' && exit\necho oops >&2\nkill -9 $$\n'
    )
    program.chmod(0o755)
    monkeypatch.setenv("CONTINUO_COMMAND", str(program))
    with pytest.raises(CommandError, match="signal 9.*\n*oops"):
        Model(text=DAMPED).steady()


# ---- results -----------------------------------------------------------------------------------------------


def test_answers_as_arrays() -> None:
    assert converted("x", [1, None, 3]).tolist()[0] == 1 and math.isnan(converted("x", [1, None])[1])
    assert converted("eigenvalues", [[1, 2], [3, -4]]).tolist() == [1 + 2j, 3 - 4j]
    assert converted("x", [True, False]) == [True, False] and converted("x", ["a"]) == ["a"]
    assert converted("x", [[1], [1, 2]])[1].tolist() == [1, 2]
    records = converted("points", [{"a": 1, "b": {"c": 2}}, {"a": None, "b": {"c": 3}}])
    assert math.isnan(records.a[1]) and records.b.c.tolist() == [2, 3] and records[0].b.c == 2
    with pytest.raises(AttributeError, match="there are a, b"):
        records.d


def test_results_show_themselves() -> None:
    found = Model(text=DAMPED).steady()
    assert "equilibria" in repr(found) and "<table>" in found._repr_html_()
    assert found.json["layout"] == "continuo.steady/1" and "equilibria" in dir(found)
    with pytest.raises(AttributeError, match="has no `equilibrium`; it has"):
        found.equilibrium
    again = pickle.loads(pickle.dumps(found))
    assert again.json == found.json
    pandas = pytest.importorskip("pandas")
    assert isinstance(found.equilibria.to_pandas(), pandas.DataFrame)


# ---- Ctrl-C ------------------------------------------------------------------------------------------------


def test_ctrl_c_ends_the_child_and_a_sweep_can_be_resumed() -> None:
    pytest.importorskip("xarray")
    script = """
        import os, signal
        from continuo import Interrupted, Model
        model = Model(text="x'' = -x; x(0) = 1; x'(0) = 0\\nrun 0..1000 output 500 method rk4 step 0.002")
        pressed = []
        def press(part):
            if part > 0 and not pressed:
                pressed.append(part)
                os.kill(os.getpid(), signal.SIGINT)
        vary = {"x(0)": "uniform(1, 2)"}
        try:
            model.sweep(vary, runs="256 sobol seed 1", keep="x at end", threads=1, progress=press)
        except KeyboardInterrupt as error:
            assert isinstance(error, Interrupted), error
            assert 0 < error.result.done < 256, error.result
            data = error.result.resume()
            print(data.sizes["run"], int(data["x at end"].isnull().sum()))
    """
    done = subprocess.run(
        [
            sys.executable, "-c", textwrap.dedent(script)
        ], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.stdout.split() == ["256", "0"], done.stderr


def test_progress_of_a_study_may_raise() -> None:
    pytest.importorskip("xarray")
    model = Model(text="x'' = -x; x(0) = 1; x'(0) = 0\nrun 0..4000 output 1000 method rk4 step 0.01")
    parts: list = []

    def watch(part: float) -> None:
        parts.append(part)
        raise LookupError("enough")

    with pytest.raises(LookupError):
        model.sweep({"x(0)": "uniform(1, 2)"}, runs="1024 sobol seed 1", keep="x at end", progress=watch)
    assert 0 <= parts[0] < 1
