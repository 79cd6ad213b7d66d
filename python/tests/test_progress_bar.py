"""Progress bars: a line in a terminal, HTML in a notebook, nothing where nobody watches."""

import io
from typing import Any

import pytest

from continuo import progress_bar
from continuo.progress_bar import ProgressBar, watcher


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_line_in_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    monkeypatch.setattr(progress_bar, "PATIENCE", -1)
    monkeypatch.setattr(progress_bar, "PAUSE", -1)
    bar = ProgressBar("Spring")
    bar(3.0, 0.25)
    bar(1.5)  # it may be more than all
    assert "Spring [########----------------------] 25 %" in terminal.getvalue()
    assert "100 %" in terminal.getvalue()
    bar.close()
    assert terminal.getvalue().endswith("\r\033[K")


def test_what_is_short_shows_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    bar = ProgressBar("Spring")
    bar(0.5)
    bar.close()
    assert terminal.getvalue() == ""


def test_a_bar_in_a_notebook(monkeypatch: pytest.MonkeyPatch) -> None:
    display = pytest.importorskip("IPython.display")
    shown: list = []

    class Handle:
        def update(self, one: Any) -> None:
            shown.append(one.data)

    def show(one: Any, display_id: bool) -> Handle:
        shown.append(one.data)
        return Handle()

    monkeypatch.setattr(display, "display", show)
    monkeypatch.setattr(progress_bar, "in_notebook", lambda: True)
    monkeypatch.setattr(progress_bar, "PATIENCE", -1)
    monkeypatch.setattr(progress_bar, "PAUSE", -1)
    bar = ProgressBar("Spring")
    bar(0.5)
    bar(0.75)
    bar.close()
    assert 'value="0.5000"' in shown[0] and 'value="0.7500"' in shown[1] and shown[-1] == ""


def test_who_watches(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stderr", io.StringIO())
    assert watcher(None, "")[0] is None and watcher(False, "")[0] is None
    assert isinstance(watcher(True, "")[0], ProgressBar)
    monkeypatch.setattr("sys.stderr", Terminal())
    assert isinstance(watcher(None, "")[0], ProgressBar)
    monkeypatch.setattr("sys.stderr", None)
    assert watcher(None, "")[0] is None
    assert watcher(print, "")[0] is print
    with pytest.raises(TypeError, match="progress"):
        watcher(3, "")  # type: ignore[arg-type]  # what must be refused
