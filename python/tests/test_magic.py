"""Models in the cells of a notebook."""

from typing import Any, Iterator

import numpy as np
import pytest

from continuo import Model

pytest.importorskip("IPython")

from IPython.core.completer import provisionalcompleter  # noqa: E402
from IPython.core.interactiveshell import InteractiveShell  # noqa: E402  # where it is there
from IPython.utils.capture import capture_output  # noqa: E402


@pytest.fixture
def shell() -> Iterator[Any]:
    shell = InteractiveShell.instance()
    shell.run_line_magic("load_ext", "continuo")
    yield shell
    shell.run_line_magic("unload_ext", "continuo")
    InteractiveShell.clear_instance()


def test_a_cell_is_a_model(shell: Any) -> None:
    done = shell.run_cell("%%sim ball\nh' = -3*h\nh(0) = 1\nrun 0..1 tol 1e-9\n")
    assert done.success and isinstance(shell.user_ns["ball"], Model)
    assert done.result is shell.user_ns["ball"]
    assert shell.run_cell("ball.run()['h'][-1]").result == pytest.approx(np.exp(-3), rel=1e-7)
    shell.run_cell("%%sim\nx' = 1\nx(0) = 0\nrun 0..1")
    assert shell.user_ns["model"].run().final["x"] == pytest.approx(1)


def test_an_error_is_the_text_of_the_command(shell: Any) -> None:
    shell.user_ns["ball"] = "kept"
    with capture_output() as captured:
        done = shell.run_cell("%%sim ball\nh' = -k*h\nh(0) = 1\nrun 0..1\n")
    assert not done.success and shell.user_ns["ball"] == "kept"
    for words in ("error[E210]", "--> ball:1:7", "declare it"):
        assert words in captured.stderr
    with capture_output() as captured:
        assert not shell.run_cell("%%sim two words\nx' = 1\n").success
    assert "takes a name" in captured.stderr


def test_names_complete(shell: Any) -> None:
    shell.run_cell("%%sim spring\nparam stiffness = 2\nx' = -stiffness*x\nx(0) = 1\nrun 0..1\n")
    shell.run_cell("run = spring.run()")
    for text, wanted in (("spring.stif", "stiffness"), ("spring.parameters['", "stiffness"), ("run['", "x")):
        with provisionalcompleter():
            found = [one.text for one in shell.Completer.completions(text, len(text))]
        assert any(wanted in one for one in found), (text, found)


def test_results_show_themselves(shell: Any) -> None:
    model = Model(text="param k = 2 [1/s]  # decay\nx' = -k*x\nx(0) = 1 [m]\nrun 0..1 [s]")
    for one in (model, model.parameters, model.states, model.run()):
        data, _ = shell.display_formatter.format(one)
        assert "<table>" in data["text/html"] and data["text/plain"]
