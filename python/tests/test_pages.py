"""The programs on the pages of the documentation."""

import os
import re
import shutil
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_models_in_python() -> None:
    pytest.importorskip("xarray")
    if (os.environ.get("CONTINUO_COMMAND") or shutil.which("continuo")) is None:
        pytest.skip("the command continuo is not there")
    blocks = re.findall(
        r"```python\n(.*?)```", (DOCS / "python_models.md").read_text(encoding="utf-8"), re.DOTALL
    )
    assert len(blocks) > 5
    names: dict = {}
    for block in blocks:
        exec(compile(block, "python_models.md", "exec"), names)
