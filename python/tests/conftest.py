"""Lets the tests find the package and the command of the build also where pytest is started in ``python/``: the package
beside the tests has no compiled part."""

import os
import sys
from pathlib import Path

SOURCES = Path(__file__).resolve().parents[1]
BUILT = SOURCES.parent / "build"

sys.path[:] = [entry for entry in sys.path if Path(entry or ".").resolve() != SOURCES]
if Path.cwd() == SOURCES:
    os.chdir(SOURCES.parent)  # Python looks into the working directory first, in the programs that tests start as well
if "PYTHONPATH" not in os.environ and (BUILT / "python" / "continuo").exists():
    sys.path.insert(0, str(BUILT / "python"))
    os.environ["PYTHONPATH"] = sys.path[0]
    if (BUILT / "continuo").exists():
        os.environ.setdefault("CONTINUO_COMMAND", str(BUILT / "continuo"))
