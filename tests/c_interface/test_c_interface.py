"""continuo.h by ctypes: models loaded, run and stepped, errors as values, functions integrated, misuse
refused."""

import ctypes
import math
import pathlib
import random
import re
import shutil
import subprocess
import threading
import time

import pytest
from library import (
    COLUMNS, DEFAULT, ENDED, ERROR, EVENTS, FAILED, FUNCTION, MISUSE, OK, PARAMETERS, ROWS, STATES,
    Model, integrate, library,
)  # fmt: skip

ROOT = pathlib.Path(__file__).parents[2]
SPRING = """
param k = 4 [N/m], m = 1 [kg]
x'' = -k/m*x
x(0) = 1 [m];  x'(0) = 0 [m/s]
output F = -k*x
run 0..10 [s] output 0.5 method dop853 tol 1e-10
"""
BALL = """
h'' = -10
h(0) = 5;  h'(0) = 0
when h falls through 0 { h' := -0.5*h'; mark "bounce"; stop after 5 }
run 0..100
"""


def test_a_run_and_what_it_is_called():
    model = Model(SPRING)
    assert model.loaded == OK
    assert [(model.name(STATES, i), model.unit(STATES, i)) for i in range(model.count(STATES))] == [
        ("x", "m"), ("x'", "m/s")]  # fmt: skip
    assert [model.name(PARAMETERS, i) for i in range(model.count(PARAMETERS))] == ["k", "m"]
    assert model.unit(PARAMETERS, 0) == "N/m"
    assert model.count(ROWS) == model.count(COLUMNS) == 0
    assert model.run(DEFAULT) == OK
    assert model.outcome()
    assert [model.name(COLUMNS, i) for i in range(model.count(COLUMNS))] == ["t", "x", "x'", "F"]
    t, x, force = model.column("t"), model.column("x"), model.column("F")
    assert len(t) == model.count(ROWS) == 21
    assert t == [0.5 * i for i in range(21)]
    for time_, place, pull in zip(t, x, force):
        assert abs(place - math.cos(2 * time_)) < 1e-8
        assert pull == -4 * place
    rows = (ctypes.c_double * (21 * 4))()
    assert model.read_rows(rows, len(rows)) == OK
    assert rows[4:8] == [t[1], x[1], model.column("x'")[1], force[1]]


def test_parameters_initial_values_and_options():
    model = Model(SPRING)
    value = ctypes.c_double()
    assert model.set_parameter("k", 9.0) == OK
    assert model.get_parameter("k", ctypes.byref(value)) == OK and value.value == 9
    assert model.set_initial("x", 2.0) == OK
    assert model.set_option("output", 0.25) == OK
    assert model.set_method("tsitouras5") == OK and model.set_option("rtol", 1e-11) == OK
    assert model.run(3.0) == OK
    t, x = model.column("t"), model.column("x")
    assert t[-1] == 3 and len(t) == 13
    assert all(abs(b - 2 * math.cos(3 * a)) < 1e-7 for a, b in zip(t, x))
    assert model.set_option("output", DEFAULT) == OK and model.set_method(None) == OK
    assert model.run(DEFAULT) == OK and model.count(ROWS) == 21


def test_errors_have_code_place_and_hint():
    model = Model("x'' = -k*x\nx(0) = 1;  x'(0) = 0\nrun 0..1\n")
    assert model.loaded == ERROR
    assert model.error_code() == "E210"
    assert (model.error_line(), model.error_column()) == (1, 8)
    assert "test:1:8" in model.error_message() and model.error_hint()
    assert model.run(DEFAULT) == MISUSE and "errors" in model.error_message()
    missing = Model(path="/no/such/file.sim")
    assert missing.loaded == ERROR and missing.error_message()


def test_a_run_that_fails_can_be_read():
    model = Model("x' = x^2; x(0) = 1\nrun 0..2")
    assert model.run(DEFAULT) == FAILED
    assert model.error_code().startswith("E3")
    assert abs(model.column("t")[-1] - 1) < 1e-6


def test_what_cannot_be_run_says_why():
    model = Model(SPRING)
    assert model.set_method("no_method") == OK
    assert model.run(DEFAULT) == ERROR and model.error_code() == "E330"
    assert model.set_method(None) == OK and model.set_option("rtol", -1.0) == OK
    assert model.run(DEFAULT) == ERROR and model.error_message()
    assert model.set_option("rtol", DEFAULT) == OK and model.run(DEFAULT) == OK
    assert model.error_message() == ""


def test_misuse_is_a_value():
    model = Model(SPRING)
    buffer = (ctypes.c_double * 4)()
    value = ctypes.c_double()
    assert model.read_column("x", buffer, 4) == MISUSE
    assert model.set_parameter("q", 1.0) == MISUSE and model.error_code() == "E340"
    assert model.set_parameter(None, 1.0) == MISUSE
    assert model.set_parameter("k", math.nan) == MISUSE
    assert model.get_parameter("k", None) == MISUSE
    assert model.set_initial("q", 1.0) == MISUSE
    assert model.set_option("speed", 1.0) == MISUSE and "rtol" in model.error_hint()
    assert model.set_option("max_steps", 0.5) == MISUSE
    assert model.advance(1.0) == MISUSE
    assert model.get_state(buffer, 2) == MISUSE and model.put(1.0, 2.0) == MISUSE
    assert model.event(0, None, None) == MISUSE
    assert math.isnan(model.time())
    assert model.run(DEFAULT) == OK
    assert model.read_column("nothing", buffer, 21) == MISUSE
    assert model.read_column("x", buffer, 4) == MISUSE and "21" in model.error_message()
    assert model.read_column("x", None, 21) == MISUSE
    assert model.name(STATES, 7) == model.name(99, 0) == model.unit(ROWS, 0) == ""
    assert model.count(99) == model.count(-1) == 0
    null = ctypes.c_void_p()
    assert library.continuo_run(null, 1.0) == library.continuo_start(null) == MISUSE
    assert library.continuo_get_parameter(null, b"k", ctypes.byref(value)) == MISUSE
    assert b"NULL" in library.continuo_error_message(null)
    assert library.continuo_count(null, STATES) == 0 and library.continuo_name(null, STATES, 0) == b""
    library.continuo_free(null)
    library.continuo_interrupt(null)
    assert library.continuo_load(b"x.sim", None) == MISUSE
    handle = ctypes.c_void_p()
    assert library.continuo_load_text(None, None, ctypes.byref(handle)) == MISUSE
    library.continuo_free(handle)


def test_random_bytes_as_a_model():
    source = random.Random(5)
    for _ in range(200):
        text = "".join(source.choice("xyt'=+-*/(){}[]0123 \n\"ruwhen") for _ in range(60))
        model = Model(text)
        if model.loaded != OK:
            assert model.error_message()


def test_events_of_a_run():
    model = Model(BALL)
    assert model.run(DEFAULT) == OK
    times = [t for t, _ in model.events()]
    # Up at 5 m/s after the first second, then for half of the time before.
    assert all(abs(a - b) < 1e-9 for a, b in zip(times, [1, 2, 2.5, 2.75, 2.875]))
    assert [name for _, name in model.events()] == ["bounce"] * 5


def ball_at(t):
    """Height and speed of the ball of BALL."""
    begin, up = 0.0, 0.0
    if t < 1:
        return 5 - 5 * t * t, -10 * t
    begin, up, length = 1.0, 5.0, 1.0
    while t >= begin + length:
        begin, up, length = begin + length, up / 2, length / 2
    s = t - begin
    return up * s - 5 * s * s, up - 10 * s


def test_a_motion_step_by_step():
    model = Model(BALL)
    assert model.start() == OK and model.time() == 0 and model.state() == [5, 0]
    for i in range(1, 28):
        t = 0.1 * i
        assert model.advance(t) == OK
        assert model.time() == t
        assert all(abs(a - b) < 1e-6 for a, b in zip(model.state(), ball_at(t))), t
        assert len(model.events()) == sum(t >= landing for landing in (1, 2, 2.5))
    assert model.advance(2.0) == MISUSE
    assert model.advance(5.0) == ENDED
    assert abs(model.time() - 2.875) < 1e-9 and len(model.events()) == 5


def test_parameters_and_states_changed_on_the_way():
    model = Model(
        "param g = 10\nh'' = -g\nh(0) = 5;  h'(0) = 0\nwhen h falls through 0 { h' := -h' }\nrun 0..1"
    )
    assert model.start() == OK
    assert model.advance(0.9) == OK  # whose step may have gone beyond the landing at 1
    height, speed = model.state()
    assert model.set_parameter("g", 0.0) == OK
    assert model.advance(0.91) == OK
    assert abs(model.state()[0] - (height + 0.01 * speed)) < 1e-9 and model.state()[1] == speed
    assert model.put(1.0, 0.0) == OK and model.set_parameter("g", 2.0) == OK
    assert model.advance(2.41) == OK  # it lands at 1.91 with 2 m/s
    assert abs(model.state()[0] - (2 * 0.5 - 0.25)) < 1e-6 and abs(model.state()[1] - 1) < 1e-6
    assert len(model.events()) == 1
    assert model.advance(100.0) == OK  # beyond the end of the run of the model
    assert model.put(math.nan, 0.0) == MISUSE and model.put(1.0) == MISUSE


@pytest.mark.parametrize("seed", range(5))
def test_stepping_is_the_run(seed):
    source = random.Random(seed)
    model = Model(path=str(ROOT / "models" / "pendulum.sim"))
    assert model.loaded == OK, model.error_message()
    assert model.set_option("rtol", 1e-11) == OK and model.set_option("from", DEFAULT) == OK
    assert model.run(DEFAULT) == OK
    t, x = model.column("t"), model.column(model.name(STATES, 0))
    picked = sorted(source.sample(range(len(t)), 20))
    assert model.start() == OK
    for i in picked:
        assert model.advance(t[i]) == OK
        assert abs(model.state()[0] - x[i]) < 1e-7


def test_bodies_run_as_a_whole_only():
    path = str(next(p for p in sorted((ROOT / "models").glob("*.sim")) if "world {" in p.read_text()))
    model = Model(path=path)
    assert model.start() == ERROR and "step by step" in model.error_message()


def test_threads_have_models_of_their_own():
    failures = []

    def work(k):
        model = Model(SPRING)
        model.set_parameter("k", k)
        for _ in range(20):
            if model.run(DEFAULT) != OK or abs(model.column("x")[-1] - math.cos(math.sqrt(k) * 10)) > 1e-7:
                failures.append(k)

    threads = [threading.Thread(target=work, args=(float(k),)) for k in range(1, 9)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures


def test_a_run_is_interrupted_from_another_thread():
    model = Model("x'' = -x; x(0) = 1; x'(0) = 0\nrun 0..1e9 output 1e8 tol 1e-10")
    model.set_option("max_steps", 1e12)
    codes = []
    thread = threading.Thread(target=lambda: codes.append(model.run(DEFAULT)))
    thread.start()
    time.sleep(0.2)
    model.interrupt()
    thread.join(5)
    assert codes == [FAILED] and model.outcome()


def test_functions_of_other_languages():
    times = [0.0, 0.5, 3.0, 10.0]
    for method in (None, "dop853", "radau5", "bdf", "tsitouras5"):
        code, rows, message = integrate(lambda t, y: [y[1], -y[0]], [1.0, 0.0], times, method, 1e-9, 1e-12)
        assert code == OK and message, message
        for t, row in zip(times, rows):
            assert abs(row[0] - math.cos(t)) < 1e-6 and abs(row[1] + math.sin(t)) < 1e-6
    code, rows, _ = integrate(lambda t, y: [-y[0]], [1.0], [2.0, 1.0, 0.0])
    assert code == OK and abs(rows[-1][0] - math.exp(2)) < 1e-4
    assert integrate(lambda t, y: [1.0], [4.0], [1.0])[:2] == (OK, [[4.0]])


def test_functions_that_refuse_or_fail():
    code, rows, message = integrate(
        lambda t, y: [1.0] if t < 0.5 else None, [0.0], [0.0, 0.2, 1.0], "rk4", 1e-6
    )
    assert code != OK
    code, rows, message = integrate(lambda t, y: [1.0] if t < 0.5 else None, [0.0], [0.0, 0.2, 1.0], "dop853")
    assert code == FAILED and "f has ended" in message and math.isnan(rows[2][0])
    code, rows, message = integrate(lambda t, y: [y[0] ** 2], [1.0], [0.0, 0.5, 2.0])
    assert code == FAILED and abs(rows[1][0] - 2) < 1e-4 and math.isnan(rows[2][0]) and message
    code, rows, message = integrate(lambda t, y: [math.nan], [1.0], [0.0, 1.0])
    assert code == FAILED and math.isnan(rows[1][0])


def test_wrong_integrations():
    for y0, times, words in [
        ([1.0], [], "no time"),
        ([], [0.0], "no equation"),
        ([math.nan], [0.0, 1.0], "y0[0]"),
        ([1.0], [0.0, math.inf], "times[1]"),
        ([1.0], [0.0, 1.0, 1.0], "times[2]"),
        ([1.0], [1.0, 0.0, 0.5], "times[2]"),
    ]:
        code, _, message = integrate(lambda t, y: y, y0, times)
        assert code == MISUSE and words in message, message
    code, _, message = integrate(lambda t, y: y, [1.0], [0.0, 1.0], "no_method")
    assert code == MISUSE and "no_method" in message
    for rtol in (-1.0, math.nan):
        code, _, message = integrate(lambda t, y: y, [1.0], [0.0, 1.0], "dop853", rtol)
        assert code != OK and message
    assert library.continuo_integrate(FUNCTION(), None, 1, None, None, 1, None, 0, 0, None, None, 0) == MISUSE


def compile_and_run(compiler, folder, source):
    program = folder / "program"
    subprocess.run(
        [*compiler, "-Wall", "-Wextra", "-Werror", "-pedantic", f"-I{ROOT}", str(source), "-o", str(program),
         library._name, "-lm", f"-Wl,-rpath,{pathlib.Path(library._name).resolve().parent}"],
        check=True,
    )  # fmt: skip
    return subprocess.run([program], check=True, capture_output=True, text=True).stdout


@pytest.mark.parametrize("compiler", ["gcc -std=c99", "gcc -std=c11", "g++ -std=c++17"])
def test_a_program_in_c(compiler, tmp_path):
    words = compiler.split()
    source = ROOT / "tests/c_interface/program.c"
    if words[0] == "g++":
        source = tmp_path / "program.cpp"
        source.write_text((ROOT / "tests/c_interface/program.c").read_text())
    output = "5 m, -10 m/s\n0 0\n1.000000 -0.000000\n0.540302 -0.841471\n"
    assert compile_and_run(words, tmp_path, source) == output


def test_the_programs_of_the_page(tmp_path):
    page = (ROOT / "docs/c_interface.md").read_text()
    programs = re.findall(r"```c\n(.*?)```\n\n```output\n(.*?)```", page, re.DOTALL)
    assert len(programs) == 2
    for text, output in programs:
        source = tmp_path / "page.c"
        source.write_text(text)
        assert compile_and_run(["gcc", "-std=c99"], tmp_path, source) == output
    (in_python,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    exec(compile(in_python.replace('"libcontinuo.so"', repr(library._name)), "c_interface.md", "exec"), {})


@pytest.mark.skipif(not (shutil.which("mkoctfile") and shutil.which("octave-cli")), reason="GNU Octave is not installed")
def test_the_page_in_octave(tmp_path):
    page = (ROOT / "docs/c_interface.md").read_text()
    (text,) = re.findall(r"```c file=continuo_column.c\n(.*?)```", page, re.DOTALL)
    (tmp_path / "continuo_column.c").write_text(text)
    library_folder = pathlib.Path(library._name).parent
    subprocess.run(["mkoctfile", "--mex", "-Wall", "-Werror", f"-I{ROOT}", "continuo_column.c", f"-L{library_folder}",
                    "-lcontinuo", f"-Wl,-rpath,{library_folder}"], cwd=tmp_path, check=True, timeout=100)  # fmt: skip
    (tmp_path / "ball.sim").write_text("h'' = -9.81\nh(0) = 10;  h'(0) = 0\nrun 0..5 output 0.01\n")
    (tmp_path / "wrong.sim").write_text("h'' = -9.81*k\nh(0) = 10;  h'(0) = 0\nrun 0..5\n")
    (program,) = re.findall(r"```matlab\n(h = .*?)```", page, re.DOTALL)
    program += r"""
    printf('%d\n', rows(h));
    for wrong = {{'wrong.sim', 'h', 1}, {'ball.sim', 'z', 1}, {'none.sim', 'h', 1}, {1}}
      try, continuo_column(wrong{1}{:}); catch error, printf('%s\n', strtok(error.message, "\n")); end
    end"""
    run = subprocess.run(["octave-cli", "--no-init-file", "--quiet", "--eval", program], cwd=tmp_path, check=True,
                         capture_output=True, text=True, timeout=60)  # fmt: skip
    end, count, *messages = run.stdout.splitlines()
    assert float(end) == 5.095 and count == "101"  # 10 - 9.81/2
    assert "E210" in messages[0] and "z" in messages[1] and "none.sim" in messages[2] and "usage" in messages[3]
