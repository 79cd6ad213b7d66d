"""Models in the language of Continuo."""

from __future__ import annotations

import difflib
import math
import os
import re
import threading
import warnings
import weakref
from pathlib import Path
from typing import Any, Iterable, Mapping, NamedTuple, Optional, Sequence, Union

from . import _continuo
from .errors import Interrupted, ModelError, ModelWarning, RunError, parsed
from .model_run import Run
from .progress_bar import ProgressOption, watcher
from .right_hand_side import RightHandSide
from .run_options import (
    Tolerance,
    contents,
    count_option,
    number,
    number_or_text,
    put_numbers,
    put_tolerances,
    read_setting,
    text_option,
    warn,
)
from .studies import Studies
from .values import SettableValues, Value, Values, did_you_mean, table_html
from .view import View

_AT_START = re.compile(r"(.+)\(([^()]*)\)$")  # x(0)


class _Setting(NamedTuple):
    """What a name stands for: where a state begins, or a parameter or an input; its own name; the value in
    its unit."""

    is_initial: bool
    name: str
    value: float


class Model(Studies):
    """A model: equations, parameters, events, as a text in the language.

    Parameters
    ----------
    file : str or path, optional
        A file, such as ``"ball.sim"``. Tables that its text names are found beside it.
    text : str, optional
        The text itself, in place of a file. Tables are found in the present folder.
    name : str, optional
        How messages call the text.
    native : {"auto", "always", "fused", "never"}
        Machine code for the equations, with the same results to the bit: as soon as it pays, always, never.

    Raises
    ------
    ModelError
        The text contains an error: ``code``, ``line``, ``column``, ``hint``; its text is what the command
        prints.
    FileNotFoundError
        There is no such file.

    Notes
    -----
    Parameters are attributes: ``model.k`` is a number that knows its unit, ``model.k = 3`` sets it for the
    runs to come, in the unit of its declaration; ``model.k = "3 N/cm"`` converts. ``del
    model.parameters["k"]`` gives it back the value in the text. States begin elsewhere by ``model.states["x"]
    = 2``.

    A model may be run by several threads at once, as long as none of them sets anything. Models can be
    pickled and copied.

    Examples
    --------
    >>> model = Model(text="x'' = -k*x\\nparam k = 4\\nx(0) = 1; x'(0) = 0\\nrun 0..3 tol 1e-9")
    >>> run = model.run(k=1)
    >>> round(run["x"][-1], 6)
    -0.989992
    """

    _native: _continuo.Model
    _given: dict[str, float]  # parameters and inputs that are set
    _initial: dict[str, float]  # states that begin elsewhere
    _mode: str
    _path: Optional[Path]
    _folder: Path
    _source_name: bytes
    _lock: threading.Lock
    _sized: tuple[Any, ...]  # settings that decide sizes, and the model with these
    _parts: dict[str, Any]
    _views: weakref.WeakSet[View]
    _process: int

    def __init__(
        self,
        file: Union[str, "os.PathLike[str]", None] = None,
        *,
        text: Optional[str] = None,
        name: Optional[str] = None,
        native: str = "auto",
    ) -> None:
        if (file is None) == (text is None):
            raise TypeError('Model takes a file, Model("ball.sim"), or a text, Model(text="...")')
        if file is not None:
            path: Optional[Path] = Path(os.fsdecode(file))
            assert path is not None
            source, source_name = contents(path), os.fsencode(path)
            folder = path.absolute().parent
        else:
            assert text is not None
            if not isinstance(text, str):
                raise TypeError(f"text is a str, not {type(text).__name__}")
            path, folder = None, Path.cwd()
            source, source_name = text.encode("utf-8", "surrogatepass"), b"text"
        self._begin(source, name.encode("utf-8", "replace") if name else source_name, native, path, folder)

    def _begin(self, source: bytes, name: bytes, native: str, path: Optional[Path], folder: Path) -> None:
        loaded, messages = _continuo.load_model(name, source, native)
        message_text, data = parsed(messages)
        if loaded is None:
            raise ModelError(message_text or "the text is no model", data)
        warn(message_text)
        for attribute, value in {
            "_native": loaded, "_given": {}, "_initial": {}, "_mode": native, "_path": path,
            "_folder": folder, "_source_name": name, "_lock": threading.Lock(), "_sized": (), "_parts": {},
            "_views": weakref.WeakSet(), "_process": os.getpid(),
        }.items():  # fmt: skip
            object.__setattr__(self, attribute, value)

    def _renew_after_fork(self) -> None:
        """In a forked process the thread that compiles is missing, and may have held a lock: the text is read
        again."""
        if self._process != os.getpid():
            self.__setstate__(self.__getstate__())

    # ---- copies --------------------------------------------------------------------------------------------

    def __getstate__(self) -> dict[str, Any]:
        return {
            "source": self._native.text, "name": self._source_name, "native": self._mode, "path": self._path,
            "folder": self._folder, "given": dict(self._given), "initial": dict(self._initial),
        }  # fmt: skip

    def __setstate__(self, state: dict[str, Any]) -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)  # they were shown when it was read first
            name = state["name"]
            if Path.cwd() != state["folder"]:  # the tables that the text names are there
                name = os.fsencode(state["folder"] / Path(os.fsdecode(name)).name)
            self._begin(state["source"], name, state["native"], state["path"], state["folder"])
        self._given.update(state["given"])
        self._initial.update(state["initial"])

    def copy(self) -> "Model":
        """A model of the same text with the same settings, which can be set apart from this one."""
        other = object.__new__(type(self))
        for attribute, value in self.__dict__.items():
            object.__setattr__(other, attribute, value)
        for attribute, value in {
            "_given": dict(self._given), "_initial": dict(self._initial), "_lock": threading.Lock(),
            "_views": weakref.WeakSet(),
        }.items():  # fmt: skip
            object.__setattr__(other, attribute, value)
        return other

    __copy__ = copy

    def reset(self) -> None:
        """Gives all parameters, inputs and initial values back those in the text."""
        self._given.clear()
        self._initial.clear()

    # ---- as a function -------------------------------------------------------------------------------------

    def right_hand_side(self, native: str = "auto") -> RightHandSide:
        """The function f of y' = f(t, y), with the parameters as they are now: for the solvers, or to be
        called.

        Parameters
        ----------
        native : {'auto', 'always', 'fused', 'never'}
            When the equations become machine code.

        Returns
        -------
        RightHandSide
            y has the states in their order; its parameters are set apart from those of this model.

        Raises
        ------
        ModelError
            Where the model is more than ordinary differential equations: events, modes, algebraic equations,
            bodies.
        """
        # The tables that the text names are there.
        name = self._folder / Path(os.fsdecode(self._source_name)).name
        try:
            f = RightHandSide(self.text, str(name), native)
            f._set_parameters(self._given)
        except ValueError as error:
            raise ModelError(str(error)) from None
        return f

    def __continuo_native__(self, args: Sequence[Any] = ()) -> _continuo.Native:
        """The compiled equations for the solvers: a model stands for its right-hand side."""
        return self.right_hand_side().__continuo_native__(args)

    # ---- what is in it -------------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """Of its ``model`` statement, else of its file."""
        return self._native.name

    @property
    def description(self) -> str:
        """The comment at the top of the text."""
        return self._native.heading

    @property
    def text(self) -> str:
        """The text itself."""
        return self._native.text.decode("utf-8", "replace")

    @property
    def time_unit(self) -> str:
        """The unit of time; empty without units."""
        return self._native.time_unit

    @property
    def events(self) -> list[str]:
        """The events, as the text writes them."""
        return self._native.events()

    def _part(self, name: str, native: Optional[_continuo.Model] = None) -> Any:
        """Lists of names with their units, of the model with the present sizes of families or of this one."""
        native = self._present() if native is None else native
        parts = self._parts
        if parts.get("of") is not native:
            parts = {"of": native}
            object.__setattr__(self, "_parts", parts)
        if name not in parts:
            parts[name] = getattr(native, name)()
        return parts[name]

    def _values_at_start(self) -> tuple[list[float], list[float], list[float]]:
        return self._present().values(self._given)

    def _read_parameters(self) -> dict[str, Value]:
        values = self._values_at_start()[0]
        return {
            name: Value(value, unit, comment, range)
            for (name, unit, comment, range, _), value in zip(self._part("parameters"), values)
        }

    def _read_inputs(self) -> dict[str, Value]:
        values = self._values_at_start()[1]
        return {
            name: Value(value, unit, comment, range)
            for (name, unit, comment, range, _), value in zip(self._part("inputs"), values)
        }

    def _read_states(self) -> dict[str, Value]:
        values = self._values_at_start()[2]
        for name in sorted(self._initial):  # u[3] comes after u, its family
            for place in self._present().states_named(name):
                values[place] = self._initial[name]
        return {
            name: Value(value, unit, "algebraic" if algebraic else "")
            for (name, unit, algebraic, _), value in zip(self._part("states"), values)
        }

    def _read_outputs(self) -> dict[str, Value]:
        return {
            name: Value(math.nan, unit, kind)
            for kind in ("outputs", "energies", "lets")
            for name, unit in self._part(kind)
        }

    @property
    def parameters(self) -> SettableValues:
        """The parameters by name; each can be set for the runs to come. Those that depend on others follow
        these."""
        return SettableValues("parameter", self._read_parameters, self._set, self._forget)

    @property
    def inputs(self) -> SettableValues:
        """The inputs by name, with their values at the start; those without a file can be set."""
        return SettableValues("input", self._read_inputs, self._set, self._forget)

    @property
    def states(self) -> SettableValues:
        """The states by name, with their initial values, which can be set for the runs to come."""
        return SettableValues("state", self._read_states, self._set, self._forget)

    @property
    def outputs(self) -> Values:
        """The outputs, energies and ``let`` quantities by name, with their units. Their values are those of a
        run."""
        return Values("output", self._read_outputs)

    # ---- parameters as attributes --------------------------------------------------------------------------

    def __getattr__(self, name: str) -> Value:
        if not name.startswith("_"):
            for values in (self._read_parameters(), self._read_inputs()):
                if name in values:
                    return values[name]
        raise AttributeError(self._no_attribute(name), name=name, obj=self)

    def __setattr__(self, name: str, value: Any) -> None:
        is_own = name.startswith("_") or hasattr(type(self), name)
        if not is_own and name in self._settable():
            self._set(name, value)
        elif is_own:
            is_parameter = name in self._settable()
            hint = f"; the parameter of this name is model.parameters[{name!r}]" if is_parameter else ""
            raise AttributeError(f"`{name}` of a Model cannot be replaced{hint}", name=name, obj=self)
        else:
            raise AttributeError(self._no_attribute(name), name=name, obj=self)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(name for name in self._settable() if name.isidentifier())]

    def _settable(self) -> list[str]:
        return [one[0] for one in self._part("parameters")] + [one[0] for one in self._part("inputs")]

    def _no_attribute(self, name: str) -> str:
        if name.startswith("_"):
            return f"a Model has no attribute `{name}`"
        if self._native.states_named(name):
            return f"`{name}` is a state: model.states[{name!r}] is where it begins, run[{name!r}] its motion"
        own = [one for one in dir(type(self)) if not one.startswith("_")]
        near = difflib.get_close_matches(name, own, n=2, cutoff=0.75)
        hint = f"did you mean `{near[0]}`?" if near else did_you_mean(name, self._settable())
        return f"the model has no parameter `{name}`; {hint}".rstrip("; ")

    # ---- settings ------------------------------------------------------------------------------------------

    def _set(self, name: str, value: Any) -> None:
        setting = self._resolved(name, value, self._present())
        (self._initial if setting.is_initial else self._given)[setting.name] = setting.value
        for view in list(self._views):
            if not setting.is_initial and not view.closed:
                view.set(setting.name, setting.value)

    def _forget(self, name: str) -> None:
        self._given.pop(name, None)
        self._initial.pop(name, None)

    def _resolved(
        self, name: str, value: Any, native: _continuo.Model, options: Iterable[str] = ()
    ) -> _Setting:
        """What a name stands for. `options`: names that may have been meant besides."""
        parameters: dict[str, Any] = {one[0]: one for one in self._part("parameters", native)}
        if name in parameters:
            given, low_high = number_or_text(name, value), parameters[name][3]
            if isinstance(given, float) and (low_high is None or low_high[0] <= given <= low_high[1]):
                return _Setting(False, name, given)
            return _Setting(False, name, read_setting(native.read_parameter, name, given))
        inputs = {one[0]: one for one in self._part("inputs", native)}
        if name in inputs:
            given = number_or_text(name, value)
            if inputs[name][4]:
                raise ModelError(f"the input `{name}` follows a file: the text says which")
            if not isinstance(given, float):
                raise ModelError(f"the input `{name}` is set by a number, in {inputs[name][1] or 'no unit'}")
            return _Setting(False, name, given)
        state = name
        at_start = _AT_START.match(name)
        if at_start and not native.states_named(name):
            state = at_start.group(1).strip()
            self._check_start(name, at_start.group(2))
        if native.states_named(state):
            given = number_or_text(name, value)
            return _Setting(True, state, read_setting(native.read_initial, state, given))
        names = [*parameters, *inputs, *(one[0] for one in self._part("states", native)[:1000]), *options]
        raise ModelError(
            f"the model has no parameter, input or state `{name}`; {did_you_mean(name, names)}".rstrip("; ")
        )

    def _check_start(self, name: str, time: str) -> None:
        start = self._native.span[0] or 0.0
        try:
            is_start = float(time) == start
        except ValueError:
            is_start = False
        if not is_start:
            raise ModelError(f"`{name}` cannot be set: the run begins at t = {start:g}")

    def _resolved_all(
        self, values: Mapping[str, Any], more: Optional[Mapping[str, Any]] = None, options: Iterable[str] = ()
    ) -> tuple[dict[str, float], dict[str, float]]:
        """Parameters with inputs, and initial values: those that are set, then these."""
        self._renew_after_fork()
        given, initial = dict(self._given), dict(self._initial)
        structural = self._structural_names()
        both = [*values.items(), *(more or {}).items()]
        # Those that decide sizes come first: they decide which other names there are.
        for decides_size in (True, False):
            native = self._present(given)
            for name, value in both:
                if not isinstance(name, str):
                    raise TypeError(f"set is a mapping from names, not from {name!r}")
                if (name in structural) == decides_size:
                    setting = self._resolved(name, value, native, options)
                    (initial if setting.is_initial else given)[setting.name] = setting.value
        return given, initial

    def _present(self, given: Optional[Mapping[str, float]] = None) -> _continuo.Model:
        """The model with families of the size that the settings decide; the last one is kept."""
        values = self._given if given is None else given
        if not values:
            return self._native
        structural = self._structural_names()
        sizes = tuple(sorted((name, value) for name, value in values.items() if name in structural))
        if not sizes:
            return self._native
        with self._lock:
            if not self._sized or self._sized[0] != sizes:
                loaded, messages = self._native.with_values(dict(sizes))
                text, data = parsed(messages)
                if loaded is None:
                    raise ModelError(text, data)
                object.__setattr__(self, "_sized", (sizes, loaded))
            present: _continuo.Model = self._sized[1]
            return present

    def _structural_names(self) -> frozenset[str]:
        if "_structural" not in self.__dict__:
            names = frozenset(one[0] for one in self._native.parameters() if one[4])
            object.__setattr__(self, "_structural", names)
        return frozenset(self.__dict__["_structural"])

    # ---- runs ----------------------------------------------------------------------------------------------

    def run(
        self,
        until: Optional[float] = None,
        *,
        method: Optional[str] = None,
        tol: Optional[Tolerance] = None,
        rtol: Optional[Tolerance] = None,
        atol: Optional[Tolerance] = None,
        step: Optional[float] = None,
        output: Union[float, str, None] = None,
        max_step: Optional[float] = None,
        max_steps: Optional[int] = None,
        set: Optional[Mapping[str, Any]] = None,
        estimate_error: bool = False,
        check: bool = True,
        progress: ProgressOption = None,
        **values: Any,
    ) -> Run:
        """Runs the model as its ``run`` statement says, with these changes.

        Parameters
        ----------
        until : float, optional
            The end of the run, in the model's unit of time.
        method : str, optional
            The integration method by name; ``continuo methods`` lists them.
        tol, rtol : float or mapping, optional
            The relative tolerance (two names for it), of all states or of single ones by name.
        atol : float or mapping, optional
            The absolute tolerance, in the unit of each state.
        step : float, optional
            A fixed step in place of tolerances.
        output : float or "steps", optional
            A row every so much time, or at every step.
        max_step : float, optional
            The largest step.
        max_steps : int, optional
            The largest number of steps.
        set : mapping, optional
            Values by names that are no keywords of Python: ``set={"x'(0)": 2, "m[3]": 1}``.
        estimate_error : bool
            Whether a second, stricter run estimates the true error (``run.error``).
        check : bool
            Whether a run that does not reach its end raises RunError. With False it is returned, and its
            ``outcome`` is false.
        progress : callable, bool or None
            Called with the time and the part that is done, ``progress(t, part)``, ten times a second; True
            shows a bar, False none; None shows one where somebody watches. What it raises ends the run.
        **values
            Parameters, inputs without a file, and initial values of states by name: ``g=1.62``. Numbers are
            in the unit of the declaration; texts such as ``"3 km/h"`` are converted.

        Returns
        -------
        Run

        Raises
        ------
        ModelError
            What is asked does not fit the model.
        RunError
            The run did not reach its end. ``error.run`` has its rows until then, ``str(error)`` the reason
            and a remedy.
        Interrupted
            Ctrl-C ended the run at once (a KeyboardInterrupt); ``error.run`` has its rows until then.

        Warns
        -----
        ModelWarning
            Warnings of the library, and checks of the model that do not hold in a run of it as it is written.
        """
        self._warn_of_shadowed(values)
        given, initial = self._resolved_all(values, set, _RUN_OPTIONS)
        asked: dict[str, Any] = {"parameters": given, "initial": initial}
        put_numbers(asked, to=until, step=step, max_step=max_step)
        put_tolerances(asked, tol, rtol, atol)
        if method is not None:
            asked["method"] = text_option("method", method)
        if output is not None:
            asked["output_steps" if output == "steps" else "output"] = output == "steps" or number(
                "output", output
            )
        if max_steps is not None:
            asked["max_steps"] = count_option("max_steps", max_steps)
        if estimate_error:
            asked["estimate_error"] = True
        changes = [until, method, tol, rtol, atol, step, max_step, max_steps]
        as_written = not given and not initial and all(change is None for change in changes)
        return self._do_run(asked, as_written, check, progress)

    def _do_run(self, asked: dict[str, Any], as_written: bool, check: bool, progress: ProgressOption) -> Run:
        native = self._present(asked["parameters"])
        tell, close = watcher(progress, self.name)
        try:
            done, messages, raised = native.run(asked, tell)
        finally:
            close()
        text, data = parsed(messages)
        run = Run(done, self.name, as_written, data) if done is not None else None
        if raised is not None:
            if not isinstance(raised, KeyboardInterrupt):
                raise raised
            where = f" at t = {run.t[-1]:g}; its rows until then are in .run" if run else ""
            raise Interrupted(f"the run was interrupted{where}", run) from None
        if run is None:
            asked_wrongly = any(message["code"].startswith(("E32", "E33", "E34")) for message in data)
            raise (ModelError if asked_wrongly else RunError)(text or "there is no run", data)
        if not run.outcome and check:
            raise RunError(text or str(run.outcome), data, run)
        warn(text)
        if as_written:
            warn("\n".join(one.message for one in run.checks if not one))
        return run

    def _warn_of_shadowed(self, values: Mapping[str, Any]) -> None:
        """A parameter may be called like an option, which then gets the value: that is said, not passed
        over."""
        if "_shadowed" not in self.__dict__:
            names = frozenset(name for name in self._settable() if name in _RUN_OPTIONS)
            object.__setattr__(self, "_shadowed", names)
        for name in self.__dict__["_shadowed"]:
            warn(
                f'`{name}` is an option of run(); the parameter of this name is set by set={{"{name}": ...}}'
            )

    # ---- notebooks -----------------------------------------------------------------------------------------

    def view(self, *, width: Union[int, str] = "100%", height: int = 640, timeout: float = 30.0) -> View:
        """The live view: the motion as a drawing with sliders, in the notebook or in the browser.

        A slider moved there changes this model: ``model.k`` follows. ``model.k = 3`` here moves the slider
        there. The view ends with ``view.close()``, or with Python.

        Parameters
        ----------
        width, height : int or str
            Of the frame in the notebook.
        timeout : float
            How many seconds the view may take to begin.

        Returns
        -------
        View
            Shows itself where it is the last line of a cell.
        """
        return View(self, width=width, height=height, timeout=timeout)

    def __repr__(self) -> str:
        parts = [(len(self._part("states")), "state"), (len(self._part("parameters")), "parameter")]
        counts = ", ".join(f"{count} {what}{'' if count == 1 else 's'}" for count, what in parts)
        return f"<Model {self.name}: {counts}>"

    def _repr_html_(self) -> str:
        parameters, states = list(self.parameters.items()), list(self.states.items())
        rows = [[name, f"{float(v):.8g}", v.unit, v.description] for name, v in parameters[:12]]
        rows += [[f"{name}(start)", f"{float(v):.8g}", v.unit, v.description] for name, v in states[:12]]
        return table_html([self.name, "value", "unit", "description"], rows)


_RUN_OPTIONS = frozenset(Model.run.__kwdefaults__) | {"until"}
