"""The progress of a run as a line of text."""

from __future__ import annotations

import sys
from typing import Callable


def _show(t: float, part: float) -> None:
    done = round(40 * min(max(part, 0.0), 1.0))
    end = "\n" if part >= 1 else ""
    print(f"\r[{'#' * done}{'.' * (40 - done)}] {part:5.1%}  t = {t:.6g} ", end=end, file=sys.stderr, flush=True)


def progress_function(progress: object) -> Callable[[float, float], object] | None:
    """Give the function that a run calls: that of the user, or a bar on stderr for True."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return _show
    if callable(progress):
        return progress
    raise TypeError(f"`progress` must be True or a function of (t, part), and is {progress!r}")
