"""Measurements of any kind as the tables that the command reads."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np


def measurement_file(data: Any, place: Path) -> str:
    """The path of a table of these measurements.

    Parameters
    ----------
    data : path, pandas.DataFrame, xarray.Dataset, Run, or mapping of arrays
        With a column ``t``, or an index or coordinate of this name or ``time``.
    place : path
        Where the table is written, unless data is a path.

    Raises
    ------
    TypeError, ValueError
        It is no table over t; the message says what is missing.
    """
    if isinstance(data, (str, os.PathLike)):
        path = os.path.abspath(os.fsdecode(data))
        if not os.path.exists(path):
            raise FileNotFoundError(f"there is no file of measurements {path}")
        return path
    columns = {name: np.asarray(values, dtype=float) for name, values in _columns_of(data).items()}
    if "t" not in columns:
        raise ValueError(f"measurements have a column t; these have {', '.join(columns)}")
    lengths = {name: values.shape for name, values in columns.items()}
    if any(shape != lengths["t"] or len(shape) != 1 for shape in lengths.values()):
        raise ValueError(f"columns of measurements are of one length; these have the shapes {lengths}")
    names = ["t", *(name for name in columns if name != "t")]
    rows = [",".join(_cell(columns[name][i]) for name in names) for i in range(len(columns["t"]))]
    place.write_text("\n".join([",".join(_quoted(name) for name in names), *rows]) + "\n", encoding="utf-8")
    return str(place)


def _cell(value: float) -> str:
    return "" if np.isnan(value) else repr(float(value))


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"' if any(letter in name for letter in ',"\n') else name


def _columns_of(data: Any) -> dict[str, Any]:
    if isinstance(data, Mapping) and not hasattr(data, "to_dataframe"):
        return {str(name): values for name, values in data.items()}
    if hasattr(data, "to_dataframe"):  # xarray
        data = data.to_dataframe()
    elif hasattr(data, "to_pandas") and hasattr(data, "outcome"):  # a run
        data = data.to_pandas()
    elif hasattr(data, "to_frame") and not hasattr(data, "columns"):  # a series
        data = data.to_frame()
    if not hasattr(data, "columns") or not hasattr(data, "index"):
        raise TypeError(f"measurements are a table with a column t, or a path, not {type(data).__name__}")
    columns = {str(name): data[name].to_numpy() for name in data.columns}
    if "t" not in columns:
        time = columns.pop("time", None)
        index = data.index.to_numpy() if data.index.name in ("t", "time", None) else None
        found = time if time is not None else index
        return {"t": found, **columns} if found is not None else columns
    return columns
