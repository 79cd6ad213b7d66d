"""Packs what CMake builds as a wheel, for `pip install .` (PEP 517, 660). Needs no package of Python to do so.

A backend of our own instead of scikit-build-core: that would have to be downloaded, and `pip install .` shall work
without a network where the compiler and the libraries are there.
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = ["continuo", "continuo-studies", "continuo_least_squares.so"]


def version() -> str:
    """The version of the project, as CMake has it."""
    found = re.search(r"project\(Continuo VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert found, "CMakeLists.txt names no version"
    return found[1]


def tag() -> str:
    """The Python and the machine that the module is for."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    machine = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{python}-{python}-{machine}"


def metadata() -> str:
    """What the wheel says of itself."""
    return (
        f"Metadata-Version: 2.1\nName: continuo\nVersion: {version()}\nSummary: Simulates continuous systems\n"
        "Requires-Python: >=3.9\nRequires-Dist: numpy\n"
        "Provides-Extra: all\n"
        + "".join(f'Requires-Dist: {name}; extra == "all"\n' for name in ["scipy", "pandas", "xarray", "matplotlib"])
    )


def place_of_build() -> tuple[Path, list[str]]:
    """Where to build, and with which options: beside the command where this is the Python that CMake finds there.

    The Python of a virtual environment is that of the distribution, and its path will be gone one day.
    """
    distribution = Path("/usr/bin/python3")
    ours = f"{sys.version_info.major}.{sys.version_info.minor}"
    if distribution.exists():
        asked = subprocess.run([distribution, "-c", "import sys; print('%d.%d' % sys.version_info[:2])"],
                               capture_output=True, text=True, check=False)
        if asked.stdout.strip() == ours:
            return ROOT / "build", []
    return ROOT / f"build-python{ours}", [f"-DPython_EXECUTABLE={sys.executable}"]


def build() -> Path:
    """Builds the module and the programs for the Python that runs this; the folder of the build."""
    folder, options = place_of_build()
    configure = ["cmake", "-B", str(folder), "-DCONTINUO_PYTHON=ON", *options]
    if not (folder / "build.ninja").exists():
        configure[1:1] = ["--preset", "release", "-DCONTINUO_TESTS=OFF", "-DCMAKE_UNITY_BUILD=ON"]
    targets = ["continuo_python", "continuo", "continuo-studies"]
    for command in (configure, ["cmake", "--build", str(folder), "--target", *targets]):
        try:
            subprocess.run(command, cwd=ROOT, check=True)
        except FileNotFoundError:
            sys.exit("continuo is built by cmake, which is not installed; ./continuo.sh python installs what is missing")
        except subprocess.CalledProcessError:
            sys.exit("continuo could not be built: see above, and docs/dependencies.md for the packages that it needs")
    return folder


class Wheel:
    """A wheel that is being written, with its list of contents."""

    def __init__(self, folder: str) -> None:
        self.name = f"continuo-{version()}-{tag()}.whl"
        self.information = f"continuo-{version()}.dist-info"
        self.records: list[str] = []
        self.archive = zipfile.ZipFile(Path(folder) / self.name, "w", zipfile.ZIP_DEFLATED)

    def add(self, name: str, data: bytes, mode: int = 0o644) -> None:
        """A file of the wheel."""
        entry = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))  # the same bytes whenever it is built
        entry.external_attr = (0o100000 | mode) << 16
        entry.compress_type = zipfile.ZIP_DEFLATED
        self.archive.writestr(entry, data)
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        self.records.append(f"{name},sha256={digest},{len(data)}")

    def close(self) -> str:
        """Writes what wheels say of themselves; the name of the file."""
        tags = f"Wheel-Version: 1.0\nGenerator: continuo\nRoot-Is-Purelib: false\nTag: {tag()}\n"
        self.add(f"{self.information}/METADATA", metadata().encode())
        self.add(f"{self.information}/WHEEL", tags.encode())
        record = f"{self.information}/RECORD"
        self.archive.writestr(record, "\n".join([*self.records, f"{record},,", ""]))
        self.archive.close()
        return self.name


def build_wheel(wheel_directory: str, config_settings: object = None, metadata_directory: object = None) -> str:
    """The package, its extension, and the programs that do its studies."""
    folder = build()
    wheel = Wheel(wheel_directory)
    package = folder / "python" / "continuo"
    for path in sorted(package.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            wheel.add(f"continuo/{path.relative_to(package)}", path.read_bytes())
    for program in PROGRAMS:
        wheel.add(f"continuo/programs/{program}", (folder / program).read_bytes(), 0o755)
    return wheel.close()


def build_editable(wheel_directory: str, config_settings: object = None, metadata_directory: object = None) -> str:
    """A wheel that names the folder of the build, whose package consists of links to the sources."""
    folder = build()
    wheel = Wheel(wheel_directory)
    wheel.add("continuo.pth", f"{folder / 'python'}{os.linesep}".encode())
    return wheel.close()


def build_sdist(sdist_directory: str, config_settings: object = None) -> str:
    """There is none: the repository is the source."""
    raise NotImplementedError("continuo has no source distribution: clone the repository")
