"""Times of two programs that do the same, in turns in one process: the least time of each."""

import time
from collections.abc import Callable
from typing import Any


def least_times(*programs: Callable[[], Any], seconds: float = 0.6) -> list[float]:
    """The least time in seconds of one call of each, called in turns for so many seconds in all each: that of the
    processor, which other programs do not lengthen."""
    least = [float("inf")] * len(programs)
    begin = time.perf_counter()
    while time.perf_counter() - begin < seconds * len(programs):
        for i, program in enumerate(programs):
            start = time.thread_time()
            program()
            least[i] = min(least[i], time.thread_time() - start)
    return least


def versions() -> str:
    """The versions of what is compared."""
    import platform

    import numpy
    import scipy

    import continuo

    return (f"continuo {continuo.__version__}, SciPy {scipy.__version__}, NumPy {numpy.__version__}, "
            f"Python {platform.python_version()}, {platform.machine()}")
