"""Events of solve_ivp: SciPy's functions with attributes, and Event with an action."""

from __future__ import annotations

from typing import Any, Callable, Iterable, Sequence

Guard = Callable[..., Any]
# guard, direction, stop after so many, action, action at the limit, name: as _continuo.Run takes them.
EventFields = tuple[Guard, float, int, "Guard | None", "Guard | None", str]


class Event:
    """Something that happens where a function of the motion passes through zero.

    Parameters
    ----------
    guard : callable
        ``guard(t, y, *args)``, a number. The event happens where its sign changes.
    action : callable, optional
        ``action(t, y, *args)``, the state after the event, shape (n,), or None where it stays. The run begins anew
        from there. `y` is the state just beyond zero: for a floor not above it.
    direction : float, default 0
        Positive: only where the guard rises through zero; negative: where it falls; 0: both.
    terminal : bool or int, default False
        True: the run ends at the event, after its action; a number: at the event of that number.
    name : str, optional
        In messages; that of the guard where it has one.
    at_limit : callable, optional
        ``at_limit(t, y, *args)``, as `action`, where the times of the event accumulate: a ball that comes to rest.
        Without it the run ends there, with ``status == -1`` and a message that gives the limit.

    Notes
    -----
    A guard is sampled at nine points of each step and at more where these do not resolve it, on the dense output.
    Roots that are nearer to each other than a polynomial of degree eight over a part of a step can show are missed;
    `max_step` makes the parts shorter. At the start of a run a guard of zero is no event: nothing has crossed.
    """

    def __init__(
        self,
        guard: Guard,
        action: Guard | None = None,
        direction: float = 0,
        terminal: bool | int = False,
        name: str | None = None,
        at_limit: Guard | None = None,
    ) -> None:
        for function, what in ((guard, "guard"), (action, "action"), (at_limit, "at_limit")):
            if not callable(function) and not (function is None and what != "guard"):
                raise TypeError(f"`{what}` of an event must be a function of (t, y), and is {function!r}")
        self.guard = guard
        self.action = action
        self.direction = direction
        self.terminal = terminal
        self.name = name
        self.at_limit = at_limit

    def __call__(self, t: float, y: Any, *args: Any) -> Any:
        """Give the guard at (t, y)."""
        return self.guard(t, y, *args)

    def __repr__(self) -> str:
        return f"Event({self.guard!r}, direction={self.direction}, terminal={self.terminal}, name={self.name!r})"


def _stop_after(terminal: Any, name: str) -> int:
    if terminal is None:
        return 0
    try:
        count = int(terminal)
    except (TypeError, ValueError, OverflowError):
        count = -1
    if count < 0 or count != terminal:
        raise ValueError(f"The `terminal` attribute of the event {name} must be a truth value or a positive number.")
    return count


def _direction(event: Any, name: str) -> float:
    try:
        return float(getattr(event, "direction", None) or 0)
    except (TypeError, ValueError):
        raise ValueError(
            f"The `direction` attribute of the event {name} must be a number, and is {event.direction!r}"
        ) from None


def event_fields(events: Any) -> list[EventFields]:
    """Give what a run needs of `events`: one function, an Event, or several of them."""
    if events is None:
        return []
    given: Sequence[Any] | Iterable[Any] = (events,) if callable(events) or not hasattr(events, "__iter__") else events
    fields: list[EventFields] = []
    for i, event in enumerate(given):
        if not callable(event):
            raise TypeError(f"events[{i}] is {event!r}: an event is a function of (t, y) or a continuo.Event")
        named = getattr(event, "name", None) or getattr(getattr(event, "guard", event), "__name__", None)
        name = str(named or f"event {i}")
        direction = _direction(event, name)
        stop_after = _stop_after(getattr(event, "terminal", False), name)
        if isinstance(event, Event):
            fields.append((event.guard, direction, stop_after, event.action, event.at_limit, name))
        else:
            fields.append((event, direction, stop_after, None, None, name))
    return fields
