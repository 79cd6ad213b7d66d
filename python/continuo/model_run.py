"""The run of a model: its rows, events, checks and cost."""

from __future__ import annotations

import html
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
from numpy.typing import NDArray

from .optional import needed
from .panels import Panel, Series, panels_of, svg_of
from .values import Value, did_you_mean, table_html

if TYPE_CHECKING:
    from ._continuo import ModelRun

Array = NDArray[np.float64]

MOST_SHOWN = 8  # values in a notebook's table


@dataclass(frozen=True)
class Outcome:
    """How a run ended. It is true where the run came to its end, or an event stopped it as the model says.

    ``str(outcome)`` is one sentence. ``t`` and ``h`` are the time and the step of the last attempt, ``error``
    its estimate in units of the tolerance, ``component`` the worst of it; ``limit_time`` is that of
    accumulating events.
    """

    ending: str
    success: bool
    message: str
    t: float
    h: float
    error: float
    component: str
    event: str
    limit_time: float
    hint: str

    def __bool__(self) -> bool:
        return self.success

    def __str__(self) -> str:
        return self.message

    @property
    def interrupted(self) -> bool:
        """Whether somebody ended it."""
        return self.ending == "interrupted"

    @property
    def stopped_by_event(self) -> bool:
        """Whether an event ended it, as the model says."""
        return self.ending == "stopped by event"


@dataclass(frozen=True)
class Check:
    """The verdict on a ``check`` of the model. It is true where it holds; ``message`` says why not."""

    text: str
    passed: bool
    evaluated: bool
    value: float
    expected: float
    tolerance: float
    unit: str
    message: str

    def __bool__(self) -> bool:
        return self.passed


@dataclass(frozen=True)
class EnergyBalance:
    """The sum of the energies at the start and at the end; ``drift`` is the largest difference from the
    start, as a part of that where ``relative``, else in ``unit``."""

    first: float
    last: float
    drift: float
    unit: str
    relative: bool


@dataclass(frozen=True)
class ErrorEstimate:
    """The true error of the states by a second, stricter run: at the end, and the largest of all rows.

    Both arrays have one number per state; they are empty where there is no estimate, and ``message`` says
    why.
    """

    at_end: Array
    largest: Array
    message: str


class Run:
    """What a run of a model leaves.

    Rows are those that the model's ``run`` statement asks for. An event that changes the state stands as two
    rows of equal time, before and after it. Arrays are views of the rows and cannot be written into; copy
    them to change them.

    Attributes
    ----------
    t : ndarray, shape (n,)
        The times of the rows, in the model's unit of time.
    outcome : Outcome
    checks : list of Check
    energy : EnergyBalance or None
    method : str
    statistics : dict
        Steps, rejected steps, evaluations, ..., and the seconds that it took.
    messages : list of dict
        Warnings.
    """

    _PARTS = (
        "table", "columns", "states", "total_energy", "energy_unit", "events", "outcome", "statistics",
        "checks", "energy", "plan", "lets", "plots", "layout", "error_estimate", "manifest",
    )  # fmt: skip

    def __init__(
        self, native: "ModelRun", name: str, as_written: bool, messages: Optional[list[dict[str, Any]]] = None
    ) -> None:
        self._native: Optional[ModelRun] = native
        self._known: dict[str, Any] = {}
        self.model_name = name
        self.as_written = as_written
        self.messages = list(messages or [])

    # ---- what C++ knows, asked for once --------------------------------------------------------------------

    def _part(self, name: str) -> Any:
        if name not in self._known:
            self._known[name] = getattr(self._native, name)()
        return self._known[name]

    def __getstate__(self) -> dict[str, Any]:
        for name in self._PARTS:
            self._part(name)
        self._known["summary"] = self.summary()
        state = dict(self.__dict__)
        state["_native"] = None
        return state

    # ---- rows ----------------------------------------------------------------------------------------------

    @property
    def table(self) -> Array:
        """All rows, shape (n, columns): t, states, outputs, energies, in the order of ``columns``."""
        table: Array = self._part("table")
        return table

    @property
    def columns(self) -> list[str]:
        """The names of the columns of ``table``."""
        return [name for name, _ in self._part("columns")]

    @property
    def units(self) -> dict[str, str]:
        """The unit of each column; empty for none."""
        return dict(self._part("columns"))

    @property
    def states(self) -> list[str]:
        """The names of the states."""
        return self.columns[1 : 1 + self._part("states")]

    @property
    def t(self) -> Array:
        """The times of the rows, shape (n,)."""
        return self.table[:, 0]

    @property
    def y(self) -> Array:
        """The states as in SciPy's results, shape (states, n)."""
        return self.table[:, 1 : 1 + self._part("states")].T

    def __len__(self) -> int:
        return int(self.table.shape[0])

    def __getitem__(self, name: str) -> Array:
        """Values at every row, by name.

        Parameters
        ----------
        name : str
            A state (``"h'"``), an output, an energy or a ``let`` of the model; ``"energy"`` for the sum of
            the energies; a family (``"u"``, of u[1], u[2], ...); of a world ``"position"``, ``"velocity"``,
            ...

        Returns
        -------
        ndarray, shape (n,)
            Of a family (n, members), of bodies (n, bodies, components).

        Raises
        ------
        KeyError
            Where the run has nothing of this name; the message has the nearest names.
        """
        if not isinstance(name, str):
            raise TypeError(f"run[...] takes the name of a quantity, such as run[\"x\"], not {name!r}")
        columns = self.columns
        if name in columns:
            return self.table[:, columns.index(name)]
        lets: dict[str, Array] = self._part("lets")
        if name in lets:
            return lets[name]
        for variable, dimensions, _, (places, _) in self._part("layout")[2]:
            if variable == name and places is not None:
                return self._variable(dimensions, places)
        raise KeyError(f"the run has no `{name}`; {did_you_mean(name, self.keys())}".rstrip("; "))

    def __contains__(self, name: object) -> bool:
        return name in self.keys()

    def keys(self) -> list[str]:
        """All names that ``run[...]`` knows."""
        families = [variable for variable, _, _, (places, _) in self._part("layout")[2] if places is not None]
        return list(
            dict.fromkeys(self.columns + [n for n in families if n != "time"] + list(self._part("lets")))
        )

    def _ipython_key_completions_(self) -> list[str]:
        return self.keys()

    def _variable(self, dimensions: list[str], places: list[int]) -> Array:
        """A variable of the netCDF layout: its columns, in the shape of its dimensions."""
        sizes = self._part("layout")[1]
        table, energy = self.table, self._part("total_energy")
        if places == [table.shape[1]]:
            return np.asarray(energy)
        shape = [len(self)] + [sizes[dimension] for dimension in dimensions[1:]]
        if len(places) == 1:
            return table[:, places[0]].reshape(shape)
        return table[:, places].reshape(shape)

    @property
    def final(self) -> dict[str, Value]:
        """The values of the last row, with their units."""
        return {name: Value(self.table[-1, i], unit) for i, (name, unit) in enumerate(self._part("columns"))}

    @property
    def data(self) -> Any:
        """The rows as an ``xarray.Dataset``, laid out as the netCDF file of ``continuo run -o``.

        The dimension is ``time``, in which the instant of an event stands twice, before and after it.
        Families and the bodies of a world are arrays; units and long names are attributes.
        """
        xarray = needed("xarray", "run.data")
        attributes, _, variables = self._part("layout")
        data: dict[str, Any] = {}
        coordinates: dict[str, Any] = {}
        for name, dimensions, of_variable, (places, values) in variables:
            array = np.asarray(values) if places is None else self._variable(dimensions, places)
            target = coordinates if dimensions == [name] or name in dimensions else data
            target[name] = (dimensions, array, of_variable)
        of_run = dict(attributes, outcome=self.outcome.message, method=self.method)
        return xarray.Dataset(data, coordinates, of_run)

    def to_pandas(self) -> Any:
        """The rows as a ``pandas.DataFrame`` over t; its ``attrs["units"]`` has the units."""
        pandas = needed("pandas", "run.to_pandas()")
        frame = pandas.DataFrame(
            self.table[:, 1:], index=pandas.Index(self.t, name="t"), columns=self.columns[1:]
        )
        frame.attrs["units"] = self.units
        return frame

    # ---- events --------------------------------------------------------------------------------------------

    @property
    def events(self) -> Any:
        """The events as a ``pandas.DataFrame``, a row for each: ``t``, ``event`` (as the model writes it),
        ``mark`` where some have one, ``impulse`` where bodies met, then ``before x`` and ``after x`` of each
        state."""
        pandas = needed("pandas", "run.events")
        names, marks, times, impulses, with_states, before, after = self._part("events")
        columns: dict[str, Any] = {"t": times, "event": names}
        if any(marks):
            columns["mark"] = marks
        if np.isfinite(impulses).any():
            columns["impulse"] = impulses
        states = self.states
        for side, values in (("before", before), ("after", after)):
            if with_states:
                full = np.full((len(names), len(states)), np.nan)
                full[with_states] = values.reshape(len(with_states), len(states))
                columns.update({f"{side} {state}": full[:, i] for i, state in enumerate(states)})
        return pandas.DataFrame(columns)

    def times_of(self, event: str = "") -> Array:
        """The times of the events whose name or mark begins with this text; of all without one."""
        names, marks, times, *_ = self._part("events")
        chosen = [i for i in range(len(names)) if names[i].startswith(event) or marks[i].startswith(event)]
        return np.asarray(times)[chosen]

    # ---- how it went ---------------------------------------------------------------------------------------

    @property
    def outcome(self) -> Outcome:
        """How it ended."""
        return Outcome(**self._part("outcome"))

    @property
    def success(self) -> bool:
        """Whether it came to its end, or an event stopped it as the model says."""
        return self.outcome.success

    @property
    def checks(self) -> list[Check]:
        """The verdicts on the model's checks. They are meant for the model as it is written
        (``as_written``)."""
        return [Check(**check) for check in self._part("checks")]

    @property
    def energy(self) -> Optional[EnergyBalance]:
        """What became of the sum of the energies; None where the model declares none."""
        energy = self._part("energy")
        return EnergyBalance(**energy) if energy else None

    @property
    def error(self) -> Optional[ErrorEstimate]:
        """The estimate of the true error, where ``estimate_error=True`` asked for it."""
        error = self._part("error_estimate")
        return ErrorEstimate(**error) if error else None

    @property
    def method(self) -> str:
        """The integration method."""
        return str(self._part("plan")["method"])

    @property
    def plan(self) -> dict[str, Any]:
        """What was done: the method and why this one, tolerances or the step, the start and the end."""
        return dict(self._part("plan"))

    @property
    def statistics(self) -> dict[str, Any]:
        """The cost: steps, rejected steps, evaluations, ..., seconds."""
        return dict(self._part("statistics"))

    @property
    def manifest(self) -> dict[str, Any]:
        """All that determines the run, with the text of the model and a hash: equal hashes, equal results."""
        manifest: dict[str, Any] = json.loads(self._part("manifest"))
        return manifest

    def summary(self) -> str:
        """The run in a few lines, as ``continuo run`` prints it."""
        if "summary" not in self._known:
            assert self._native is not None
            self._known["summary"] = self._native.summary(self.as_written)
        return str(self._known["summary"])

    # ---- pictures ------------------------------------------------------------------------------------------

    def _series(self, name: str) -> Series:
        unit = self.units.get(name, "")
        if name == "energy" and name not in self.columns:
            unit = self._part("energy_unit")
        values = self[name]
        if values.ndim > 1:
            raise ValueError(
                f"`{name}` has the shape {values.shape}: plot its members, or run.data[\"{name}\"].plot()"
            )
        return Series(name, unit, values)

    def panels(self, *names: str, against: Optional[str] = None) -> list[Panel]:
        """Curves as panels: those of the model's ``plot`` statements, or of these names."""
        if not names:
            if against is not None:
                names = tuple(self.states)
            else:
                return panels_of(self._part("plots"))
        return panels_of([(self._series(against or "t"), [self._series(name) for name in names])])

    def plot(
        self, *names: str, against: Optional[str] = None, ax: Any = None, events: bool = False, **style: Any
    ) -> Any:
        """Draws with matplotlib.

        Parameters
        ----------
        *names : str
            What to draw, as for ``run[...]``; without any what the model's ``plot`` statements say, else its
            states.
        against : str, optional
            What stands at the horizontal axis; t without it.
        ax : matplotlib.axes.Axes, optional
            Where to draw; all curves then share it. Without it each unit has axes of its own, one below the
            other.
        events : bool
            Whether a thin line marks the time of each event.
        **style
            Handed to ``Axes.plot``.

        Returns
        -------
        matplotlib.axes.Axes, or an array of them where there are several.
        """
        pyplot = needed("matplotlib.pyplot", "run.plot()")
        panels = self.panels(*names, against=against)
        if ax is None:
            height = max(2.4 * len(panels), 3.2)
            _, axes = pyplot.subplots(
                len(panels), 1, squeeze=False, figsize=(6.4, height), layout="constrained"
            )
            all_axes = list(axes[:, 0])
        else:
            all_axes = [ax] * len(panels)
        for panel, axis in zip(panels, all_axes):
            for curve in panel.curves:
                axis.plot(panel.against.values, curve.values, **{"label": curve.label, **style})
            axis.set_xlabel(panel.against.label)
            if ax is None or not axis.get_ylabel():
                axis.set_ylabel(panel.label)
            if len(panel.curves) > 1 or ax is not None:
                axis.legend()
            if events and panel.against.name == "t":
                for t in self.times_of():
                    axis.axvline(t, linewidth=0.5, color="0.7")
        return all_axes[0] if len(panels) == 1 or ax is not None else np.array(all_axes)

    def __repr__(self) -> str:
        events = len(self._part("events")[0])
        return f"<Run of {self.model_name}: {self.outcome}; {len(self)} rows, {events} events, {self.method}>"

    def __str__(self) -> str:
        return self.summary()

    def _repr_html_(self) -> str:
        shown = self._part("columns")[: 1 + MOST_SHOWN]
        rows = [[name, f"{self.table[-1, i]:.8g}", unit] for i, (name, unit) in enumerate(shown) if len(self)]
        parts = [f"<div><b>{html.escape(self.model_name)}</b>: {html.escape(str(self.outcome))}</div>"]
        failed = [check.message for check in self.checks if not check] if self.as_written else []
        parts += [f'<div style="color:#b00">{html.escape(message)}</div>' for message in failed]
        more = f", {len(self.states)} states" if len(self.states) > MOST_SHOWN else ""
        events = len(self._part("events")[0])
        note = f"{len(self)} rows{more}, {events} events, {self.method}, {self.statistics['steps']} steps"
        if self.energy is not None:
            unit = "" if self.energy.relative else " " + self.energy.unit
            note += f", energy drift {self.energy.drift:.3g}{unit}"
        parts.append(f"<div>{html.escape(note)}</div>")
        parts.append(table_html(["at the end", "value", "unit"], rows))
        if len(self) > 1:
            parts.append(svg_of(self.panels()[:4]))
        return "".join(parts)
