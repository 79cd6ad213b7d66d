"""What runs leave behind: memory, threads that wait, and what Ctrl-C keeps."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from typing import Any

import numpy as np
import pytest
from compiled import address

import continuo
from continuo import Event, Interrupted, _continuo, solve_ivp


def _memory() -> int:
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="the memory of the process is not known")
def test_ten_thousand_solves_and_errors_leak_nothing() -> None:
    def f(t: float, y: Any) -> list[float]:
        return [y[1], -y[0]]

    def fails(t: float, y: Any) -> list[float]:
        if t > 0.1:
            raise ValueError("no")
        return [y[1], -y[0]]

    def wrong(t: float, y: Any) -> Any:
        return [1.0] if t > 0.1 else [1.0, 2.0]

    event = Event(lambda t, y: t - 0.05, lambda t, y: [y[0], -y[1]])

    def once(i: int) -> None:
        solve_ivp(f, (0, 0.2), [1.0, 0.0], dense_output=i % 2 == 0, events=event if i % 3 == 0 else None)
        with pytest.raises(ValueError):
            solve_ivp(fails if i % 2 else wrong, (0, 0.2), [1.0, 0.0], method="RK45" if i % 5 else "BDF")

    for i in range(500):
        once(i)
    before = _memory()
    for i in range(10_000):
        once(i)
    assert _memory() - before < 1_000_000


def test_other_threads_run_during_a_compiled_run() -> None:
    counts = [0]
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            counts[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    lorenz = _continuo.Native(address("lorenz"), size=3)
    try:
        for _ in range(2):
            before = counts[0]
            solve_ivp(lorenz, (0, 10_000), [1.0, 1.0, 1.0], rtol=1e-8)  # longer than a busy machine lets a thread wait
            assert counts[0] > before
    finally:
        done.set()
        thread.join()


def test_threads_get_the_results_of_their_own_runs() -> None:
    def f(t: float, y: Any, rate: float) -> list[float]:
        return [-rate * y[0]]

    expected = [solve_ivp(f, (0, 3), [1.0], args=(k,)).y for k in range(4)]
    wrong: list[int] = []

    def work(k: int) -> None:
        for _ in range(50):
            if (solve_ivp(f, (0, 3), [1.0], args=(k,)).y != expected[k]).any():
                wrong.append(k)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


@pytest.mark.parametrize("kind", ["python", "compiled", "sleeping"])
def test_ctrl_c_ends_a_run_at_once_and_keeps_what_was_computed(kind: str) -> None:
    def f(t: float, y: Any) -> list[float]:
        if kind == "sleeping":
            time.sleep(1e-3)
        return [y[1], -y[0], 0.0]

    fun = _continuo.Native(address("lorenz"), size=3) if kind == "compiled" else f
    timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    begin = time.perf_counter()
    with pytest.raises(KeyboardInterrupt) as info:
        solve_ivp(fun, (0, 1e9), [1.0, 1.0, 1.0], rtol=1e-9)
    assert time.perf_counter() - begin < 20  # without an interrupt it would take an hour
    assert isinstance(info.value, Interrupted)
    result = info.value.result
    assert len(result.t) > 1 and result.y.shape == (3, len(result.t)) and not result.success
    timer.join()


@pytest.mark.parametrize("wait", [0.0, 0.02, 0.2])
@pytest.mark.parametrize("left", ["python", "compiled", "boundary"])
def test_a_run_that_is_left_at_exit_does_not_crash(left: str, wait: float) -> None:
    # The end of the interpreter may find the run in any place, also before its first step: hence several at once, which
    # disturb each other. One in twenty aborted, in an earlier version.
    script = f"""
        import sys, threading
        import numpy as np
        import continuo
        sys.path.insert(0, {os.path.dirname(__file__)!r})
        from compiled import address

        def solve():
            if "{left}" == "python":
                continuo.solve_ivp(lambda t, y: [-y[0]], (0, 1e12), [1.0], max_step=1.0)
            elif "{left}" == "compiled":
                lorenz = continuo._continuo.Native(address("lorenz"), size=3)
                continuo.solve_ivp(lorenz, (0, 1e12), [1.0, 1.0, 1.0], rtol=1e-9)
            else:
                while True:
                    continuo.solve_bvp(lambda x, y: np.array([y[1], -np.exp(y[0])]),
                                       lambda a, b: np.array([a[0], b[0]]), [0, 1], np.zeros((2, 2)), tol=1e-12)

        thread = threading.Thread(target=solve, daemon=True)
        thread.start()
        thread.join({wait})
    """
    command = [sys.executable, "-c", textwrap.dedent(script)]
    running = [subprocess.Popen(command, stderr=subprocess.PIPE, text=True) for _ in range(4)]
    for one in running:
        _, said = one.communicate(timeout=120)
        assert (one.returncode, said) == (0, "")


def test_one_run_in_several_threads_is_refused_not_broken() -> None:
    solver = continuo.DOP853(_continuo.Native(address("lorenz"), size=3), 0, [1.0, 1.0, 1.0], 1e6, rtol=1e-9)
    others: list[Exception] = []

    def work() -> None:
        for _ in range(2000):
            try:
                solver.step()
            except RuntimeError:
                pass
            except Exception as error:
                others.append(error)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not others and solver.status == "running" and np.all(np.isfinite(solver.y))
