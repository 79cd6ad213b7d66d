"""The live view of a model in a notebook: its sliders and the model's parameters are the same."""

from __future__ import annotations

import atexit
import html
import json
import os
import queue
import signal
import subprocess
import tempfile
import threading
import weakref
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

from .command import command_path
from .errors import CommandError
from .live_client import LiveClient
from .progress_bar import in_notebook

if TYPE_CHECKING:
    from .model import Model

PICTURES = 5  # a second: what this client needs to know the time


class View:
    """A live view: the motion as a drawing, with sliders.

    Where it is the last line of a cell it shows itself there; elsewhere the browser opens it. It needs a
    browser on the same computer. ``close()`` ends it; so does the end of Python.

    Attributes
    ----------
    address : str
        Of its page.
    values : dict
        Its parameters and inputs as they stand now.
    t : float
        The time that it shows.
    state : dict
        All that it says of itself: ``playing``, ``method``, ``ended``, ... (docs/protocol.md).
    """

    def __init__(
        self,
        model: "Model",
        *,
        width: Union[int, str] = "100%",
        height: int = 640,
        timeout: float = 30.0,
        open_browser: Optional[bool] = None,
    ) -> None:
        self._model, self._width, self._height = model, width, height
        self._folder = tempfile.TemporaryDirectory(prefix="continuo-")
        self._text = model.text
        self.state: dict[str, Any] = {}
        self.t = 0.0
        # The parameters that depend on no others, as the text has them.
        self._independent: dict[str, float] = {}
        self._is_of_model = True
        self._changed = threading.Condition()
        opens = not in_notebook() if open_browser is None else open_browser
        self._child = self._begin(opens)
        try:
            self.address = self._address(timeout)
            self._client = LiveClient(self.address, timeout)
            self._client.say("rate", fps=PICTURES)
        except BaseException:
            self._end_child()
            raise
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()
        model._views.add(self)
        _open_views.add(self)
        with self._changed:
            self._changed.wait_for(lambda: bool(self.state), timeout)

    # ---- the child -----------------------------------------------------------------------------------------

    def _begin(self, opens: bool) -> "subprocess.Popen[str]":
        model = self._model
        given, initial = model._resolved_all({}, None)
        if initial:
            raise ValueError(
                "the view begins where the text says; model.reset() gives back its initial values"
            )
        inputs = [one[0] for one in model._part("inputs")]
        settings = [f"--set={name}={value!r}" for name, value in given.items() if name not in inputs]
        arguments = [command_path(), "view", str(self._file()), "--json", *settings]
        if not opens:
            arguments.append("--no-open")
        # Its messages go to a file, which is never full.
        self._messages = open(Path(self._folder.name) / "messages", "w+", encoding="utf-8")
        return subprocess.Popen(
            arguments, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=self._messages, text=True,
            cwd=model._folder, env={**os.environ, "NO_COLOR": "1"}, start_new_session=True,
        )  # fmt: skip

    def _file(self) -> Path:
        """The model's own file where it has this text, so that the page can save it; else one beside which
        there are the tables that the text names."""
        model = self._model
        if model._path is not None:
            own = model._folder / model._path.name
            if own.exists() and own.read_bytes() == model._native.text:
                return own
        file = Path(self._folder.name) / (Path(os.fsdecode(model._source_name)).stem.strip() or "model")
        file = file.with_suffix(".sim")
        file.write_bytes(model._native.text)
        for name in model._native.files():
            link = Path(self._folder.name) / name
            if not os.path.isabs(name) and not link.exists():
                link.parent.mkdir(parents=True, exist_ok=True)
                link.symlink_to(model._folder / name)
        return file

    def _address(self, timeout: float) -> str:
        """The command's answer is its first object; it goes on after it."""
        answers: "queue.Queue[Optional[dict[str, Any]]]" = queue.Queue()
        assert self._child.stdout is not None
        threading.Thread(target=_read_answer, args=(self._child.stdout, answers), daemon=True).start()
        try:
            answer = answers.get(timeout=timeout)
        except queue.Empty:
            raise CommandError(f"the view did not begin in {timeout:g} s") from None
        if answer is None or "address" not in answer:
            self._child.wait(timeout)
            raise CommandError(f"the view could not begin\n{self._said()}".rstrip())
        return str(answer["address"])

    def _said(self) -> str:
        self._messages.seek(0)
        return self._messages.read()

    def _end_child(self) -> None:
        if self._child.poll() is None:
            self._child.send_signal(signal.SIGINT)
            try:
                self._child.wait(3)
            except subprocess.TimeoutExpired:
                self._child.kill()
                self._child.wait()
        self._messages.close()
        self._folder.cleanup()

    # ---- what it says --------------------------------------------------------------------------------------

    def _listen(self) -> None:
        try:
            while (message := self._client.hear()) is not None:
                with self._changed:
                    self._take(message)
                    self._changed.notify_all()
        except (OSError, ValueError):  # the connection has ended
            pass

    def _take(self, message: dict[str, Any]) -> None:
        if message["say"] == "frame":
            self.t = message["t"]
        elif message["say"] == "model":
            # Somebody may have opened another model there, or have changed the text: that is not this model.
            self._is_of_model = message["text"] == self._text
            self._independent = {
                one["name"]: one["file"] for one in message["parameters"] if one["independent"]
            }
        elif message["say"] == "state":
            self.state = message
            self.t = message["t"]
            if self._is_of_model:
                self._give_to_model(message["parameters"])

    def _give_to_model(self, parameters: dict[str, float]) -> None:
        given = self._model._given
        for name, value in parameters.items():
            if name not in self._independent:
                continue
            if value != given.get(name, self._independent[name]):
                given[name] = value

    @property
    def values(self) -> dict[str, float]:
        """Its parameters and inputs as they stand now."""
        return {**self.state.get("parameters", {}), **self.state.get("inputs", {})}

    def wait_for(self, name: str, value: float, timeout: float = 10.0) -> bool:
        """Waits until a parameter or an input has this value there; whether it has come to that."""
        with self._changed:
            return self._changed.wait_for(lambda: self.values.get(name) == value, timeout)

    # ---- what can be said to it ----------------------------------------------------------------------------

    def set(self, name: str, value: float) -> None:
        """Sets a parameter or an input, at the time that is shown."""
        if name in self.state.get("inputs", {}):
            self._client.say("input", name=name, value=float(value))
        else:
            self._client.say("set", parameter=name, value=float(value))

    def play(self) -> None:
        """Lets the motion go on."""
        self._client.say("play")

    def pause(self) -> None:
        """Stops it."""
        self._client.say("pause")

    def reset(self) -> None:
        """Begins anew."""
        self._client.say("reset")

    def seek(self, t: float) -> None:
        """Shows an instant of its past."""
        self._client.say("seek", t=float(t))

    @property
    def closed(self) -> bool:
        """Whether it has ended."""
        return self._child.poll() is not None

    def close(self) -> None:
        """Ends it."""
        _open_views.discard(self)
        self._model._views.discard(self)
        self._client.close()
        self._end_child()

    def __enter__(self) -> "View":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<View of {self._model.name}: {'closed' if self.closed else self.address}>"

    def _repr_html_(self) -> str:
        if self.closed:
            return html.escape(repr(self))
        return (
            f'<iframe src="{html.escape(self.address)}" width="{self._width}" height="{self._height}" '
            'style="border:0" allow="fullscreen"></iframe>'
        )


_open_views: "weakref.WeakSet[View]" = weakref.WeakSet()


@atexit.register
def _close_all() -> None:
    for view in list(_open_views):
        view.close()


def _read_answer(stream: Any, answers: "queue.Queue[Optional[dict[str, Any]]]") -> None:
    text = ""
    for line in stream:
        text += line
        try:
            answers.put(json.loads(text))
            break
        except ValueError:  # it is not whole yet
            continue
    else:
        answers.put(None)
    for _ in stream:  # what comes later is read, so that the command never waits for us
        pass
