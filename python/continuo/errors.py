"""Exceptions of the package."""

from __future__ import annotations

from typing import Any


class Interrupted(KeyboardInterrupt):
    """Ctrl-C has ended a run. What was computed until then is kept.

    Attributes
    ----------
    result : object
        The result of the run up to the interruption, of the type that the function would have returned.
    """

    def __init__(self, message: str = "interrupted", result: Any = None) -> None:
        super().__init__(message)
        self.result = result
