"""The notebooks run from their first cell to their last, and are kept without outputs."""

import json
import os
import shutil
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Iterator

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
for package in ("ipykernel", "matplotlib", "pandas", "xarray"):
    pytest.importorskip(package)

NOTEBOOKS = sorted((Path(__file__).resolve().parents[1] / "notebooks").glob("*.ipynb"))
HAS_COMMAND = (os.environ.get("CONTINUO_COMMAND") or shutil.which("continuo")) is not None


@pytest.fixture(scope="module")
def executions() -> Iterator[dict[Path, "Future[object]"]]:
    """All of them at the same time: a kernel takes seconds to begin."""

    def execute(path: Path) -> object:
        return nbclient.NotebookClient(
            nbformat.read(path, as_version=4), timeout=100, kernel_name="python3"
        ).execute()

    with ThreadPoolExecutor(len(NOTEBOOKS)) as pool:
        yield {path: pool.submit(execute, path) for path in NOTEBOOKS}


@pytest.mark.skipif(not HAS_COMMAND, reason="the command continuo is not there")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_runs(executions: dict[Path, "Future[object]"], path: Path) -> None:
    executions[path].result()


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_is_kept_without_outputs(path: Path) -> None:
    for cell in json.loads(path.read_text())["cells"]:
        assert not cell.get("outputs") and cell.get("execution_count") is None
