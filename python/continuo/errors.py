"""What is raised and warned of."""

from __future__ import annotations

import json
from typing import Any, Optional

Message = dict[str, Any]


class ContinuoError(Exception):
    """Something is wrong with a model, or with what was asked of it.

    Parameters
    ----------
    text : str
        All that is to be said, as the command prints it: each message with its line of the model.
    messages : list of dict, optional
        The same as data: ``code``, ``severity``, ``message``, ``label``, ``help``, ``file``, ``line``,
        ``column``, ... (the layout of ``continuo --json``).
    result : optional
        What was computed nevertheless.

    Attributes
    ----------
    code : str
        Of the first error, such as ``"E210"``; ``continuo explain E210`` says more. Empty where it has none.
    line, column : int or None
        Where it is in the text, from 1.
    hint : str
        How to mend it; may be empty.
    messages : list of dict
    result : object or None
    """

    def __init__(self, text: str, messages: Optional[list[Message]] = None, result: Any = None) -> None:
        super().__init__(text)
        self.messages: list[Message] = list(messages or [])
        self.result = result
        first: Message = next((one for one in self.messages if one.get("severity") == "error"), {})
        self.code: str = first.get("code", "")
        self.line: Optional[int] = first.get("line")
        self.column: Optional[int] = first.get("column")
        self.hint: str = first.get("help", "")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.messages, self.result)


class ModelError(ContinuoError, ValueError):
    """The text of a model contains an error, or what was asked does not fit the model."""


class RunError(ContinuoError, RuntimeError):
    """A computation failed, or ended before its end. ``run`` has what was computed until then."""

    @property
    def run(self) -> Any:
        """The rows until the failure, or None."""
        return self.result


class CommandError(ContinuoError, RuntimeError):
    """The command ``continuo`` is not found, or ended otherwise than it should."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C has ended a computation. What was computed until then is kept.

    Attributes
    ----------
    result : object or None
        What was computed, of the type that the function would have returned; None where there was nothing
        yet.
    """

    def __init__(self, message: str = "interrupted", result: Any = None) -> None:
        super().__init__(message)
        self.result = result

    @property
    def run(self) -> Any:
        """The same, of the run of a model."""
        return self.result

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.result)


class ModelWarning(UserWarning):
    """What the command would print as a warning; a check of the model that does not hold."""


def parsed(messages: Optional[tuple[str, str]]) -> tuple[str, list[Message]]:
    """The text of messages from C++, and their data."""
    if messages is None:
        return "", []
    text, data = messages
    return text.rstrip("\n"), json.loads(data)
