"""How far a long computation is: a line in a terminal, a bar in a notebook."""

from __future__ import annotations

import sys
import time
from typing import Any, Callable, Optional, Union

PATIENCE = 0.5  # seconds; what is shorter shows nothing
PAUSE = 0.1

ProgressOption = Union[None, bool, Callable[..., object]]


def in_notebook() -> bool:
    """Whether results are shown by Jupyter."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return type(shell).__name__ == "ZMQInteractiveShell"


def is_watched() -> bool:
    """Whether somebody sees a progress bar: in a notebook, or on a terminal."""
    if in_notebook():
        return True
    try:
        return sys.stderr is not None and sys.stderr.isatty()
    except ValueError:  # it is closed
        return False


def duration(seconds: float) -> str:
    """As people read it: "4 s", "2 min"."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


class ProgressBar:
    """Shows the part that is done, from half a second on, and is gone at the end.

    Call it with the part that is done, 0 to 1, as the last argument.
    """

    def __init__(self, what: str = "") -> None:
        self._what = what
        self._begin = time.monotonic()
        self._next = self._begin + PATIENCE
        self._display: Any = None
        self._is_shown = False

    def __call__(self, *place_and_part: float) -> None:
        part, now = place_and_part[-1], time.monotonic()
        if now < self._next:
            return
        self._next = now + PAUSE
        part = min(max(part, 0.0), 1.0)
        left = f", {duration((now - self._begin) * (1 - part) / part)} left" if part > 0 else ""
        self._show(part, f"{100 * part:.0f} %{left}")

    def close(self) -> None:
        """Takes it away."""
        if self._is_shown and self._display is not None:
            self._display.update(_html(""))
        elif self._is_shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)
        self._is_shown = False

    def _show(self, part: float, text: str) -> None:
        if in_notebook():
            bar = _html(
                f'<progress value="{part:.4f}" max="1" style="width:20em"></progress> {self._what} {text}'
            )
            if self._display is None:
                from IPython.display import display

                self._display = display(bar, display_id=True)
            else:
                self._display.update(bar)
        else:
            filled = round(30 * part)
            line = f"\r\033[K{self._what} [{'#' * filled}{'-' * (30 - filled)}] {text}"
            print(line, end="", file=sys.stderr, flush=True)
        self._is_shown = True


def _html(text: str) -> Any:
    from IPython.display import HTML

    return HTML(text)


def watcher(
    progress: ProgressOption, what: str
) -> tuple[Optional[Callable[..., object]], Callable[[], None]]:
    """What is to be called with the part that is done as its last argument, or None; what is to be called at
    the end.

    Parameters
    ----------
    progress : callable, bool or None
        True shows a bar, None shows one where somebody watches.
    what : str
        Stands beside the bar.
    """
    if callable(progress):
        return progress, lambda: None
    if progress not in (True, False, None):
        raise TypeError(f"progress is a function, True, False or None, not {progress!r}")
    if progress is False or (progress is None and not is_watched()):
        return None, lambda: None
    bar = ProgressBar(what)
    return bar, bar.close


def progress_function(progress: object) -> Optional[Callable[[float, float], object]]:
    """What a run of solve_ivp calls with t and the part that is done: the user's function, or a bar for
    True."""
    if progress is None or progress is False:
        return None
    if progress is True:
        bar = ProgressBar("solve_ivp")

        def show(_: float, part: float) -> None:
            bar(part)
            if part >= 1:
                bar.close()

        return show
    if callable(progress):
        return progress
    raise TypeError(f"`progress` must be True or a function of (t, part), and is {progress!r}")
