"""``%%sim``: a model in a cell of a notebook."""

from __future__ import annotations

import re
from typing import Any

from .errors import ModelError
from .model import Model

_LINE = re.compile(r"\s*([^\W\d]\w*)?\s*$")


def sim(line: str, cell: str) -> Any:
    """Defines a model by the text of the cell: ``%%sim ball`` names it ``ball``; without a name it is
    ``model``.

    The model shows itself as a table. An error in the text is shown as the command prints it, and the name
    keeps what it had.
    """
    from IPython import get_ipython
    from IPython.core.error import UsageError

    matched = _LINE.match(line)
    if matched is None:
        raise UsageError(f"%%sim takes a name for the model, as in `%%sim ball`, not `{line.strip()}`")
    name = matched.group(1) or "model"
    try:
        model = Model(text=cell, name=name)
    except ModelError as error:
        raise UsageError(str(error)) from None
    shell = get_ipython()
    shell.user_ns[name] = model
    return model


def load_ipython_extension(shell: Any) -> None:
    """What ``%load_ext continuo`` does."""
    shell.register_magic_function(sim, magic_kind="cell", magic_name="sim")


def unload_ipython_extension(shell: Any) -> None:
    """Takes the magic away again."""
    shell.magics_manager.magics["cell"].pop("sim", None)
