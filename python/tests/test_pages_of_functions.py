"""The programs of the pages on tracing and on worlds run as they stand there."""

import importlib.util
import pathlib
import re

import pytest

DOCS = pathlib.Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize("page", ["python_tracing.md", "python_worlds.md"])
def test_the_programs_of_a_page_run(page: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # for the pictures that they make
    can_plot = importlib.util.find_spec("matplotlib") is not None
    monkeypatch.setenv("MPLBACKEND", "Agg")
    blocks = re.findall(r"```python\n(.*?)```", (DOCS / page).read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) >= 3
    names: dict[str, object] = {"__name__": page}
    for block in blocks:
        if "plot(" in block and not can_plot:
            continue
        exec(compile(block, page, "exec"), names)
