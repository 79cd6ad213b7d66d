"""The live view and the model: a slider moved in one is a value of the other."""

import os
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import Iterator
from urllib.request import urlopen

import pytest

from continuo import CommandError, Model
from continuo.live_client import LiveClient
from continuo.view import View

if (os.environ.get("CONTINUO_COMMAND") or shutil.which("continuo")) is None:
    pytest.skip("the command continuo is not there", allow_module_level=True)

MODELS = Path(__file__).resolve().parents[2] / "models"
TEXT = "param k = 4 in 0..9, w = 2*k\ninput F = 0 in -5..5\nx' = F - w*x; x(0) = 1\nrun 0..5\n"


@pytest.fixture
def view() -> Iterator[View]:
    with View(Model(text=TEXT), open_browser=False) as view:
        yield view


def test_values_go_both_ways(view: View) -> None:
    model = view._model
    assert view.values == {"k": 4, "w": 8, "F": 0}
    page = LiveClient(view.address)  # as the page in the browser does
    page.say("set", parameter="k", value=2.5)
    assert view.wait_for("k", 2.5) and view.values["w"] == 5
    assert model.k == 2.5 and model.w == 5 and "w" not in model._given  # it follows from k
    model.k = 6
    assert view.wait_for("k", 6) and view.values["w"] == 12
    model.F = 3
    assert view.wait_for("F", 3)
    assert model.run(1)["x"][-1] == pytest.approx(3 / 12, rel=1e-3)
    page.say("run", text="param k = 7, q = 1\nx' = k; x(0) = 0\nrun 0..5\n")
    page.say("set", parameter="k", value=8)
    assert view.wait_for("k", 8) and "q" in view.values
    assert model.k == 6  # it is another model there, which does not concern this one
    page.close()


def test_it_plays_and_pauses(view: View) -> None:
    view.play()
    with view._changed:
        assert view._changed.wait_for(lambda: view.t > 0.1, 10)
    view.pause()
    with view._changed:
        assert view._changed.wait_for(lambda: not view.state["playing"], 10)
    view.reset()
    with view._changed:
        assert view._changed.wait_for(lambda: view.t == 0, 10)


def test_it_shows_itself_and_is_closed(view: View) -> None:
    assert f'<iframe src="{view.address}"' in view._repr_html_()
    with urlopen(view.address) as page:
        assert page.status == 200 and "frame-ancestors" not in page.headers["Content-Security-Policy"]
    view.close()
    assert view.closed and "iframe" not in view._repr_html_() and "closed" in repr(view)
    view.close()


def test_it_begins_with_what_is_set() -> None:
    model = Model(text=TEXT)
    model.k = 3
    with View(model, open_browser=False) as view:
        assert view.values["k"] == 3
    with View(Model(MODELS / "car.sim"), open_browser=False) as view:  # its tables lie beside it
        assert view.values


def test_it_says_why_it_cannot_begin() -> None:
    with pytest.raises(CommandError, match="boundary-value problem"):
        View(Model(MODELS / "bratu.sim"), open_browser=False)


def test_it_ends_with_python() -> None:
    script = f"""
        from continuo import Model
        from continuo.view import View
        print(View(Model(text={TEXT!r}), open_browser=False)._child.pid)
    """
    done = subprocess.run(
        [
            sys.executable, "-c", textwrap.dedent(script)
        ], capture_output=True, text=True, timeout=30, check=True
    )
    with pytest.raises(ProcessLookupError):
        os.kill(int(done.stdout), 0)
