"""Curves sorted into panels, and a small picture of them as SVG, which needs no library."""

from __future__ import annotations

import html
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

COLORS = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf", "#8c564b", "#e377c2"]
MOST_CURVES = 12  # of a small picture


class Series(NamedTuple):
    """Numbers with a name and a unit."""

    name: str
    unit: str
    values: Array

    @property
    def label(self) -> str:
        """ "h [m]"."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


class Panel(NamedTuple):
    """Curves of one unit over the same axis."""

    against: Series
    curves: list[Series]

    @property
    def label(self) -> str:
        """Of the vertical axis."""
        if len(self.curves) == 1:
            return self.curves[0].label
        unit = self.curves[0].unit
        names = ", ".join(curve.name for curve in self.curves[:4]) + (", ..." if len(self.curves) > 4 else "")
        return f"{names} [{unit}]" if unit else names


def panels_of(plots: list[tuple[Any, list[Any]]]) -> list[Panel]:
    """Curves of one unit share a panel, as in the pictures of the command."""
    panels: list[Panel] = []
    for against, curves in plots:
        of_unit: dict[str, Panel] = {}
        for curve in (Series(*one) for one in curves):
            if curve.unit not in of_unit:
                of_unit[curve.unit] = Panel(Series(*against), [])
                panels.append(of_unit[curve.unit])
            of_unit[curve.unit].curves.append(curve)
    return panels


def svg_of(panels: list[Panel], width: int = 480, height: int = 180) -> str:
    """A picture of the panels, one below the other."""
    parts = [_panel(panel, width, height, i * height) for i, panel in enumerate(panels)]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height * len(parts)}" '
        f'font-family="sans-serif" font-size="11">{"".join(parts)}</svg>'
    )


def _extent(arrays: list[Array]) -> tuple[float, float]:
    """From the lowest to the highest number; of a constant, and of nothing, an extent around it."""
    finite = [array[np.isfinite(array)] for array in arrays]
    finite = [array for array in finite if array.size]
    if not finite:
        return 0.0, 1.0
    low, high = min(float(a.min()) for a in finite), max(float(a.max()) for a in finite)
    if not math.isfinite(high - low):  # beyond the largest number
        return low / 2, high / 2
    if high > low:
        return low, high
    around = abs(high) * 0.1 or 1.0
    return low - around, high + around


def _tick(value: float, extent: float) -> str:
    """Three digits; what is nothing beside the extent is 0."""
    return "0" if abs(value) < 1e-9 * extent else f"{value:.3g}"


def _thinned(x: Array, y: Array, most: int) -> tuple[Array, Array]:
    """Of many points those that a picture shows: in each piece the lowest and the highest one."""
    if x.size <= 4 * most:
        return x, y
    size = x.size // most
    pieces = np.nan_to_num(y[: size * most].reshape(most, size))
    first = np.arange(most) * size
    places = np.sort(
        np.concatenate([first + pieces.argmin(axis=1), first + pieces.argmax(axis=1), [x.size - 1]])
    )
    return x[places], y[places]


def _panel(panel: Panel, width: int, height: int, top: int) -> str:
    curves = panel.curves[:MOST_CURVES]
    left, right, above, below, air = 64, 10, 18, 34, 6
    x_low, x_high = _extent([panel.against.values])
    y_low, y_high = _extent([curve.values for curve in curves])
    x_scale = (width - left - right) / (x_high - x_low)
    y_scale = (height - above - below - 2 * air) / (y_high - y_low)
    bottom = top + height - below
    parts = [
        f'<rect x="{left}" y="{top + above}" width="{width - left - right}" '
        f'height="{height - above - below}" fill="none" stroke="#999"/>'
    ]
    for i, curve in enumerate(curves):
        x, y = _thinned(panel.against.values, curve.values, width)
        points = np.column_stack([left + (x - x_low) * x_scale, bottom - air - (y - y_low) * y_scale])
        points = points[np.isfinite(points).all(axis=1)]
        text = " ".join(f"{px:.1f},{py:.1f}" for px, py in points)
        color = COLORS[i % len(COLORS)]
        parts.append(f'<polyline points="{text}" fill="none" stroke="{color}" stroke-width="1.3"/>')
    legend = "".join(
        f'<tspan fill="{COLORS[i % len(COLORS)]}" dx="6">{html.escape(curve.label)}</tspan>'
        for i, curve in enumerate(curves)
    )
    texts = [
        (left, top + 13, "start", legend),
        (left - 4, bottom - air + 4, "end", _tick(y_low, y_high - y_low)),
        (left - 4, top + above + air + 4, "end", _tick(y_high, y_high - y_low)),
        (left, bottom + 13, "start", _tick(x_low, x_high - x_low)),
        (width - right, bottom + 13, "end", _tick(x_high, x_high - x_low)),
        ((left + width - right) / 2, bottom + 24, "middle", html.escape(panel.against.label)),
    ]
    for x_at, y_at, anchor, inner in texts:
        parts.append(f'<text x="{x_at}" y="{y_at}" text-anchor="{anchor}" fill="#777">{inner}</text>')
    return "".join(parts)
