"""What a sweep varies, in the words of the language; its table; and a sweep that was interrupted."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any, Callable, Mapping

import numpy as np

from .command import Answer
from .optional import needed
from .study_options import text_of


def is_several(value: Any) -> bool:
    return not isinstance(value, (str, bytes, Mapping)) and np.ndim(value) == 1


def sentences_of(vary: Any) -> list[str]:
    """What is varied, in the words of the language."""
    if vary is None:
        return []
    if isinstance(vary, str):
        return [vary]
    if not isinstance(vary, Mapping):
        return [str(one) for one in vary]
    return [f"{name} {_values_in_words(name, values)}" for name, values in vary.items()]


def _values_in_words(name: str, values: Any) -> str:
    if isinstance(values, str):
        return values
    if isinstance(values, tuple) and len(values) == 3 and isinstance(values[2], int):
        low, high, count = values
        return f"from {text_of(name, low)} to {text_of(name, high)} count {count}"
    if not is_several(values) or len(values) == 0:
        raise TypeError(
            f"`{name}` is varied by an array, by (low, high, count) or by words, not by {values!r}"
        )
    numbers = [text_of(name, value) for value in values]
    if not np.isfinite(np.asarray(values, dtype=float)).all():
        raise ValueError(f"`{name}` is varied by finite numbers")
    return f"in ({', '.join(numbers)})"


def dataset_of(table: Path, answer: Answer) -> Any:
    """The table, in memory; None where there is none."""
    if not table.exists():
        return None
    # SciPy reads classic netCDF without netCDF4.
    engine = "scipy" if importlib.util.find_spec("scipy") else None
    with needed("xarray", "model.sweep()").open_dataset(table, engine=engine) as data:
        loaded = data.load()
    loaded.attrs["statistics"] = answer.json.get("kept")
    return loaded


class UnfinishedSweep:
    """A sweep that was interrupted. The runs that were made are kept as long as this object is.

    Attributes
    ----------
    done, runs : int
        How many were made, of how many.
    """

    def __init__(self, resume: Callable[[], Any], done: int, runs: int) -> None:
        self._resume, self.done, self.runs = resume, done, runs

    def resume(self) -> Any:
        """Makes the runs that are missing, and returns the Dataset of all."""
        return self._resume()

    def __repr__(self) -> str:
        return f"<UnfinishedSweep: {self.done} of {self.runs} runs; resume() makes the others>"
