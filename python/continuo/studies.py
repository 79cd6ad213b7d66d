"""Studies of a model: the verbs of the command that study models, as methods."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterable, Mapping, Optional, Sequence, Union

from .command import Answer, options_of, run_command
from .errors import Interrupted, ModelError, RunError
from .measurements import measurement_file
from .optional import needed
from .progress_bar import ProgressOption, in_notebook, watcher
from .run_options import warn
from .study_options import arguments_of, dashed, joined, told_apart
from .study_result import FitResult, LinearModel, StudyResult
from .sweeps import UnfinishedSweep, dataset_of, is_several, sentences_of

if TYPE_CHECKING:
    from . import _continuo

Names = Union[str, Sequence[str]]
Bounds = Mapping[str, Union[str, tuple[Optional[float], Optional[float]]]]

_STANDARD_INPUT = "standard input"  # how the command calls the model that it is handed over
_KINDS: dict[str, type[StudyResult]] = {"fit": FitResult, "linearize": LinearModel}


class Studies:
    """What can be studied of a model, by the command ``continuo`` (see ``continuo.command.command_path``).

    Every study takes the model as it stands: its text, and the parameters that were set. Keywords that are no
    options of the study are parameters: ``model.steady(k=3)``. All options of a verb can be given by their
    names on the command line, with ``_`` for ``-``: ``model.fit(data, one_deviation=True)``; ``None`` leaves
    an option out. A list stands for names or numbers separated by commas, a tuple of two numbers for a range,
    a mapping for ``NAME=VALUE``: ``along={"k": (1, 5)}``.

    Studies raise ModelError and RunError as runs do, and Interrupted after Ctrl-C, with ``result`` where
    there was one. They show how far they are where somebody watches (``progress=False``: never).
    """

    if TYPE_CHECKING:
        _folder: Path
        _native: _continuo.Model
        _source_name: bytes
        _initial: dict[str, float]

        def _resolved_all(
            self,
            values: Mapping[str, Any],
            more: Optional[Mapping[str, Any]] = None,
            options: Iterable[str] = (),
        ) -> tuple[dict[str, float], dict[str, float]]: ...

        def _part(self, name: str, native: Optional[_continuo.Model] = None) -> Any: ...

        def _settable(self) -> list[str]: ...

    # ---- the mechanism -------------------------------------------------------------------------------------

    def study(
        self,
        verb: str,
        *positional: str,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> StudyResult:
        """Any verb of the command that takes a model.

        Parameters
        ----------
        verb : str
            Such as ``"steady"``.
        *positional : str
            What stands behind the model on the command line.
        set : mapping, optional
            Parameters by names that are no keywords of Python.
        progress : callable, bool or None
            Called with the part that is done, 0 to 1; True shows a bar, None shows one where somebody
            watches.
        **options
            Options of the verb, and parameters of the model.

        Returns
        -------
        StudyResult
        """
        declared = options_of(verb)
        asked, values = told_apart(declared, options)
        given = self._settings_as_options(declared, verb, values, set)
        with tempfile.TemporaryDirectory(prefix="continuo-") as folder:
            picture = None
            if in_notebook() and "--plot" in declared and "plot" not in asked:
                picture = Path(folder) / "picture.svg"
                asked["plot"] = str(picture)
            arguments = [*given, *arguments_of(verb, declared, asked)]
            if "--model" in declared:
                arguments = [*positional, "--model=-", *arguments]
            else:
                arguments = ["-", *positional, *arguments]
            answer = self._answer([verb, *arguments], progress)
            svg = picture.read_text() if picture is not None and picture.exists() else None
        return self._result(verb, answer, svg)

    def _settings_as_options(
        self,
        declared: Mapping[str, Any],
        verb: str,
        values: Mapping[str, Any],
        more: Optional[Mapping[str, Any]],
    ) -> list[str]:
        """The parameters that are set, these, and initial values, as options."""
        options = [name.strip("-").replace("-", "_") for name in declared]
        given, initial = self._resolved_all(values, more, options)
        inputs = [one[0] for one in self._part("inputs") if one[0] in given]
        if inputs:
            raise ModelError(
                f"`{verb}` takes inputs as the text has them; write the value of `{inputs[0]}` there"
            )
        takes_initial = declared.get("--initial", {}).get("value") == "NAME=VALUE"
        if initial and not takes_initial:
            name = next(iter(initial))
            raise ModelError(
                f"`{verb}` begins where the text says; write `{name}(0) = {initial[name]:g}` there"
            )
        if given and "--set" not in declared:
            raise ModelError(
                f"`{verb}` takes parameters as the text has them; model.reset() gives these back"
            )
        return [f"--set={name}={value!r}" for name, value in given.items()] + [
            f"--initial={name}={value!r}" for name, value in initial.items()
        ]

    def _answer(self, arguments: list[str], progress: ProgressOption) -> Answer:
        tell, close = watcher(progress, arguments[0])
        try:
            return run_command(arguments, self._native.text, self._folder, tell)
        finally:
            close()

    def _result(self, verb: str, answer: Answer, svg: Optional[str] = None) -> StudyResult:
        """The result, or the exception that stands for what went wrong."""
        source = os.fsdecode(self._source_name)
        text = answer.text.replace(_STANDARD_INPUT, source)
        for message in answer.messages:
            for key in ("file", "message"):
                if key in message:
                    message[key] = message[key].replace(_STANDARD_INPUT, source)
        kind = _KINDS.get(verb, StudyResult)
        result = None if answer.failed else kind(verb, answer.json, svg)
        if answer.was_interrupted:
            raise Interrupted(f"`{verb}` was interrupted", result) from None
        if result is None:
            raise (RunError if answer.exit == 3 else ModelError)(text, answer.messages)
        if not answer.messages:
            text = ""  # what else stands on standard error is of whoever starts the command, not of the model
        text = text or "\n".join(_problems_in(answer.json))
        # Of several methods one may not suit the model: what the others gave is a result.
        if answer.exit == 3 or (answer.exit == 1 and not _has_good_parts(answer.json)):
            text = text or f"`{verb}` did not come to its end"
            raise (RunError if answer.exit == 3 else ModelError)(text, answer.messages, result)
        warn(text)
        return result

    # ---- many runs -----------------------------------------------------------------------------------------

    def sweep(
        self,
        vary: Union[Names, Mapping[str, Any], None] = None,
        *,
        runs: Union[str, int, None] = None,
        keep: Optional[Names] = None,
        until: Optional[float] = None,
        method: Optional[str] = None,
        tol: Union[float, Mapping[str, float], None] = None,
        step: Optional[float] = None,
        threads: Optional[int] = None,
        out: Union[str, "os.PathLike[str]", None] = None,
        check: bool = True,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> Any:
        """Runs the model many times, on all cores.

        Parameters
        ----------
        vary : mapping or str or list of str, optional
            What is varied, beside what the text's ``sweep`` says. A mapping from names to arrays or lists of
            values, to ``(low, high, count)``, or to words such as ``"normal(0.5, 0.1)"``; or whole sentences,
            such as ``"k from 1 to 10 count 50"``. Parameters, inputs and initial values of states that are
            varied by arrays may be keywords: ``k=[1, 2, 5]``.
        runs : str or int, optional
            How many: ``"10000 sobol seed 7"``; without it every combination of the values, or what the text
            says.
        keep : str or list of str, optional
            What is kept of each run: ``"x at end, max(abs(x)) as peak"``.
        until, method, tol, step
            As for ``Model.run``.
        threads : int, optional
            How many threads make runs; one for each core without it.
        out : path, optional
            Where the netCDF file (.nc) stays; without it there is none. With ``resume=True`` a sweep that was
            interrupted goes on there.
        check : bool
            Whether it is an error where runs did not reach their end. With False they are rows like the
            others, without values; ``outcome`` tells them.

        Returns
        -------
        xarray.Dataset
            Dimension ``run``, and those of series; what was varied is a coordinate; ``attrs["statistics"]``
            has the mean, deviation and quantiles of what was kept, as in the JSON of the command.

        Raises
        ------
        RunError
            Runs failed; ``error.result`` is the Dataset of all.
        Interrupted
            ``result`` is an UnfinishedSweep: ``error.result.resume()`` makes the runs that are missing.
        """
        needed("xarray", "model.sweep()")
        sentences = self._sentences_of(vary)
        arrays = [name for name, value in options.items() if is_several(value) and f"--{dashed(name)}" not in
                  options_of("sweep")]  # fmt: skip
        sentences += self._sentences_of({name: options.pop(name) for name in arrays})
        options.update(until=until, method=method, tol=tol, step=step, threads=threads)
        options.update(keep=joined(keep, ", "), runs=None if runs is None else str(runs))
        declared = options_of("sweep")
        asked, values = told_apart(declared, options)
        given, held = self._settings_of_sweep(declared, values, set)
        asked["vary"] = sentences + held
        folder = tempfile.TemporaryDirectory(prefix="continuo-")
        table = Path(os.path.abspath(os.fsdecode(out))) if out is not None else Path(folder.name) / "sweep.nc"
        if table.suffix != ".nc":
            raise ValueError(f"out is the name of a netCDF file, such as sweep.nc, not {table.name}")
        asked["out"] = str(table)
        arguments = ["sweep", "-", *given, *arguments_of("sweep", declared, asked)]
        return self._made_sweep(arguments, table, folder, check, progress)

    def _settings_of_sweep(
        self, declared: Mapping[str, Any], values: Mapping[str, Any], more: Optional[Mapping[str, Any]]
    ) -> tuple[list[str], list[str]]:
        """Parameters as options; inputs and initial values as what is varied over one value."""
        given, initial = self._resolved_all(
            values, more, [name.strip("-").replace("-", "_") for name in declared]
        )
        inputs = frozenset(one[0] for one in self._part("inputs"))
        settings = [f"--set={name}={value!r}" for name, value in given.items() if name not in inputs]
        held = {name: [value] for name, value in given.items() if name in inputs}
        return settings, self._sentences_of({**held, **{name: [value] for name, value in initial.items()}})

    def _sentences_of(self, vary: Any) -> list[str]:
        """What is varied, in the words of the language; a state by where it begins."""
        if not isinstance(vary, Mapping):
            return sentences_of(vary)
        start = self._native.span[0] or 0.0
        settable = frozenset(self._settable())

        def begins(name: str) -> bool:
            return name not in settable and bool(self._native.states_named(name))

        return sentences_of({f"{name}({start:g})" if begins(name) else name: vary[name] for name in vary})

    def _made_sweep(
        self,
        arguments: list[str],
        table: Path,
        folder: "tempfile.TemporaryDirectory[str]",
        check: bool,
        progress: ProgressOption,
    ) -> Any:
        answer = self._answer(arguments, progress)
        if answer.was_interrupted:
            again = arguments if "--resume" in arguments else [*arguments, "--resume"]
            rest = UnfinishedSweep(
                lambda: self._made_sweep(again, table, folder, check, progress),
                answer.json.get("done", 0), answer.json.get("runs", 0),
            )  # fmt: skip
            raise Interrupted(
                "the sweep was interrupted; error.result.resume() makes the runs that are missing", rest
            )
        data = dataset_of(table, answer)
        if data is not None and data.attrs.get("title") == _STANDARD_INPUT:
            data.attrs["title"] = os.fsdecode(self._source_name)
        if data is not None and answer.exit == 3 and not check:
            return data
        try:
            self._result("sweep", answer)
        except RunError as error:
            error.result = data
            raise
        return data

    def fit(
        self,
        *data: Any,
        param: Optional[Names] = None,
        initial: Optional[Names] = None,
        bounds: Optional[Bounds] = None,
        sigma: Optional[Mapping[str, Any]] = None,
        log: Optional[Names] = None,
        prior: Optional[Mapping[str, str]] = None,
        loss: Optional[str] = None,
        column: Optional[Mapping[str, str]] = None,
        starts: Optional[int] = None,
        profile: bool = False,
        tol: Union[float, Mapping[str, float], None] = None,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> FitResult:
        """Finds parameters and initial values from measurements.

        Parameters
        ----------
        *data : DataFrame, Dataset, mapping of arrays, or path
            Measurements: a column ``t`` (or the index or coordinate of this name), and columns named like
            states or outputs. NaN stands for what was not measured. Several are several experiments.
        param : str or list of str, optional
            The unknown parameters.
        initial : str or list of str, optional
            States whose initial values are unknown.
        bounds : mapping, optional
            Ranges of the search, in place of those in the text: ``{"k": (1, 20)}``; None leaves an end open.
        sigma : mapping, optional
            The deviation of the measurements of a column: a number, ``"5%"``, or a column that has them.
        log : str or list of str, optional
            Unknowns that are searched in their logarithm.
        prior : mapping, optional
            What is known before: ``{"k": "normal(4, 0.5)"}``.
        loss : str, optional
            ``"squares"``, or against outliers ``"huber"``, ``"soft_l1"``, ``"cauchy"``, ``"tukey"``.
        column : mapping, optional
            Which quantity a column is, where its name does not say: ``{"position": "x"}``.
        starts : int, optional
            How many points the search starts from.
        profile : bool
            Whether intervals are computed from the profile likelihood as well.
        tol : float or mapping, optional
            The relative tolerance of the runs.

        Returns
        -------
        FitResult
            ``values``, ``deviations``, ``correlations``, ``converged``, ``doubts``, ...
        """
        if not data:
            raise TypeError("fit takes measurements: model.fit(data, param=[\"k\"])")
        options.update(
            param=param, initial=initial, bounds=bounds, sigma=sigma, log=log, prior=prior, loss=loss
        )
        options.update(column=column, starts=starts, profile=profile, tol=tol)
        with tempfile.TemporaryDirectory(prefix="continuo-") as folder:
            files = [measurement_file(one, Path(folder) / f"data{i + 1}.csv") for i, one in enumerate(data)]
            result = self.study("fit", *files, set=set, progress=progress, **options)
        assert isinstance(result, FitResult)
        return result

    def take(self, fit: FitResult) -> None:
        """Sets the parameters and initial values that a fit has found, for the runs to come."""
        for name, value in fit.values.items():
            self._set(name, value)

    if TYPE_CHECKING:

        def _set(self, name: str, value: Any) -> None: ...

    # ---- methods -------------------------------------------------------------------------------------------

    def converge(
        self,
        methods: Optional[Names] = None,
        *,
        most_steps: Optional[int] = None,
        tol: Optional[Iterable[float]] = None,
        until: Optional[float] = None,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> StudyResult:
        """Measures the order of methods on this model, and the limit that rounding sets.

        Parameters
        ----------
        methods : str or list of str, optional
            The methods; without them the model's own.
        most_steps : int, optional
            The number of steps of the finest run.
        tol : list of float, optional
            Measures the error against these tolerances, in place of steps.
        until : float, optional
            The end of the runs.

        Returns
        -------
        StudyResult
            ``methods``, of each its ``method``, ``nominal_order``, the measured ``order`` in ``global``,
            ``local`` and ``energy``, and ``points`` (``step``, and the errors there).
        """
        options.update(methods=methods, most_steps=most_steps, tol=tol, until=until)
        return self.study("converge", set=set, progress=progress, **options)

    def compare(
        self,
        methods: Optional[Names] = None,
        *,
        step: Optional[Iterable[float]] = None,
        tol: Optional[Iterable[float]] = None,
        until: Optional[float] = None,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> StudyResult:
        """Compares the error and the cost of methods, steps and tolerances on this model.

        Parameters
        ----------
        methods : str or list of str, optional
            The methods.
        step, tol : list of float, optional
            Fixed steps, and tolerances, each for every method that takes it.
        until : float, optional
            The end of the runs.

        Returns
        -------
        StudyResult
            ``contenders``, of each its errors over time and its cost; ``reference``.
        """
        options.update(methods=methods, step=step, tol=tol, until=until)
        return self.study("compare", set=set, progress=progress, **options)

    def stability(
        self,
        methods: Names,
        *,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> StudyResult:
        """The regions of stability of methods, and the largest stable step for this model.

        Parameters
        ----------
        methods : str or list of str
            The methods.

        Returns
        -------
        StudyResult
            ``methods``, of each ``real_axis_to``, ``imaginary_axis_to``, and ``largest`` with the ``step``
            above which it is unstable for the ``eigenvalue``.
        """
        return self.study(
            "stability", (joined(methods, ",") or "").replace(" ", ""), set=set, progress=progress, **options
        )

    # ---- equations -----------------------------------------------------------------------------------------

    def steady(
        self,
        *,
        mode: Optional[str] = None,
        box: Optional[Bounds] = None,
        starts: Optional[int] = None,
        along: Optional[Bounds] = None,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> StudyResult:
        """The equilibria of the model and their stability, and how they move along a parameter.

        Parameters
        ----------
        mode : str, optional
            The mode whose equations are used.
        box : mapping, optional
            Where they are searched, for single states: ``{"x": (0, 5)}``.
        starts : int, optional
            How many points the search starts from.
        along : mapping, optional
            A parameter along which each equilibrium is followed: ``{"k": (1, 5)}``. ``and_`` names a second
            one.

        Returns
        -------
        StudyResult
            ``equilibria``, of each ``x`` in the order of ``states``, ``eigenvalues``, ``stability``; with
            ``along`` the branches.
        """
        options.update(mode=mode, box=box, starts=starts, along=along)
        return self.study("steady", set=set, progress=progress, **options)

    def linearize(
        self,
        at: Optional[Mapping[str, float]] = None,
        *,
        start: bool = False,
        mode: Optional[str] = None,
        time: Optional[float] = None,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> LinearModel:
        """The model linearized about a point, and its modes of motion.

        Parameters
        ----------
        at : mapping, optional
            The point, as values of single states; the others have their initial values.
        start : bool
            Whether it is the initial state in place of an equilibrium near it.
        mode : str, optional
            The mode whose equations are used.
        time : float, optional
            The time, where the equations depend on it.

        Returns
        -------
        LinearModel
            ``A``, ``B``, ``C``, ``D``, ``states``, ``inputs``, ``outputs``, ``modes``; ``to_control()``.
        """
        options.update(at=at, start=start, mode=mode, time=time)
        result = self.study("linearize", set=set, progress=progress, **options)
        assert isinstance(result, LinearModel)
        return result

    def sensitivities(
        self,
        param: Optional[Names] = None,
        initial: Optional[Names] = None,
        *,
        of: Optional[str] = None,
        until: Optional[float] = None,
        output: Optional[float] = None,
        tol: Union[float, Mapping[str, float], None] = None,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> StudyResult:
        """Derivatives of the motion by parameters and initial values.

        Parameters
        ----------
        param : str or list of str, optional
            The parameters.
        initial : str or list of str, optional
            States whose initial values are varied.
        of : {"motion", "events", "period", "equilibrium"}, optional
            What is differentiated.
        until, output, tol
            As for ``Model.run``.

        Returns
        -------
        StudyResult
            ``by`` (names), ``states``; ``rows.t`` has shape (n,), ``rows.x`` (n, states), ``rows.by`` (n, by,
            states).
        """
        options.update(param=param, initial=initial, of=of, until=until, output=output, tol=tol)
        return self.study("sense", set=set, progress=progress, **options)

    # ---- long motions --------------------------------------------------------------------------------------

    def orbit(
        self,
        *,
        period: Optional[float] = None,
        settle: Optional[float] = None,
        along: Optional[Bounds] = None,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> StudyResult:
        """A periodic orbit and its stability, and how it moves along a parameter.

        Parameters
        ----------
        period : float, optional
            Of the forcing, where it cannot be determined from the text.
        settle : float, optional
            Time for transients to decay.
        along : mapping, optional
            A parameter along which it is followed: ``{"k": (1, 5)}``.

        Returns
        -------
        StudyResult
            ``period``, ``x`` (a point of it), ``min``, ``max``, ``multipliers``, ``stable``; with ``along``
            branches.
        """
        options.update(period=period, settle=settle, along=along)
        return self.study("orbit", set=set, progress=progress, **options)

    def section(
        self,
        plane: Mapping[str, float],
        *,
        settle: Optional[float] = None,
        duration: Optional[float] = None,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> StudyResult:
        """A Poincare section: the states where the motion crosses a plane upwards.

        Parameters
        ----------
        plane : mapping
            The plane: ``{"x": 0}``.
        settle, duration : float, optional
            Time before the section, and of it.
        """
        options.update(section=plane, settle=settle, duration=duration)
        return self.study("orbit", set=set, progress=progress, **options)

    def lyapunov(
        self,
        *,
        settle: Optional[float] = None,
        duration: Optional[float] = None,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> StudyResult:
        """The Lyapunov exponents: how fast neighbouring motions part.

        Parameters
        ----------
        settle, duration : float, optional
            Time before they are measured, and in which they are.

        Returns
        -------
        StudyResult
            ``exponents`` in falling order, ``spread`` of each, ``averaged`` (the time).
        """
        options.update(settle=settle, duration=duration, lyapunov=True)
        return self.study("orbit", set=set, progress=progress, **options)

    def phase(
        self,
        *,
        box: Optional[Bounds] = None,
        spread: Optional[int] = None,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> StudyResult:
        """The phase plane of a model with two states: equilibria, nullclines, separatrices, motions.

        Parameters
        ----------
        box : mapping, optional
            The region: ``{"x": (-2, 2), "y": (-1, 1)}``.
        spread : int, optional
            The number of motions.
        """
        options.update(box=box, spread=spread)
        return self.study("phase", set=set, progress=progress, **options)

    def explore(
        self,
        *,
        starts: Optional[int] = None,
        set: Optional[Mapping[str, Any]] = None,
        progress: ProgressOption = None,
        **options: Any,
    ) -> StudyResult:
        """An overview: a run, equilibria, orbits, and what the parameters do.

        Parameters
        ----------
        starts : int, optional
            How many points the search for equilibria starts from.
        """
        options.update(starts=starts)
        return self.study("explore", set=set, progress=progress, **options)

    def verify(self, *, progress: ProgressOption = None) -> StudyResult:
        """Runs the model as its text has it, and tests its checks.

        Returns
        -------
        StudyResult
            ``checks_passed``, ``checks_found``, ``models`` with each check.

        Warns
        -----
        ModelWarning
            A check does not hold.
        """
        answer = self._answer(["verify", "-"], progress)
        result = self._result("verify", answer)
        failed = [one for model in answer.json["models"] for one in model["checks"] if not one["passed"]]
        warn("\n".join(f"{one['check']} does not hold{_found(one)}" for one in failed))
        return result

    def report(
        self,
        out: Union[str, "os.PathLike[str]"],
        with_: Union[str, Sequence[str]] = (),
        *,
        progress: ProgressOption = None,
    ) -> StudyResult:
        """Writes a page with the model as its text has it, its run, and studies.

        Parameters
        ----------
        out : path
            The page, .html.
        with_ : str or list of str
            Studies as on the command line: ``"steady --along k=1..5"``.
        """
        studies = [with_] if isinstance(with_, str) else list(with_)
        arguments = ["report", "-", f"--out={os.path.abspath(os.fsdecode(out))}"]
        return self._result(
            "report", self._answer(arguments + [f"--with={one}" for one in studies], progress)
        )


def _problems_in(answer: Any) -> list[str]:
    """What the parts of an answer say of themselves, each once."""
    parts = answer.values() if isinstance(answer, dict) else answer if isinstance(answer, list) else []
    own = [answer["problem"]] if isinstance(answer, dict) and answer.get("problem") else []
    return list(dict.fromkeys(own + [problem for part in parts for problem in _problems_in(part)]))


def _has_good_parts(answer: Mapping[str, Any]) -> bool:
    lists = [value for key, value in answer.items() if isinstance(value, list) and key != "messages"]
    return any(isinstance(part, dict) and "problem" not in part for parts in lists for part in parts)


def _found(check: Mapping[str, Any]) -> str:
    return f": it is {check['value']}" if "value" in check else f": {check['message']}"
