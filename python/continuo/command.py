"""The command ``continuo`` as a child process: it is found, run, watched, and its answer read."""

from __future__ import annotations

import functools
import json
import os
import re
import shutil
import signal
import subprocess
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Optional

from .errors import CommandError, Message

PATIENCE = 10.0  # seconds that an interrupted command gets to write what it has

_PROGRESS = re.compile(r"\r\x1b\[K[^\r\n]*")
_PART = re.compile(r"(\d+) %")


@dataclass
class Answer:
    """What the command gave."""

    json: dict[str, Any]
    text: str  # of standard error
    exit: int
    was_interrupted: bool

    @property
    def failed(self) -> bool:
        """Whether there is no result."""
        return bool(self.json.get("layout", "continuo.failure/1") == "continuo.failure/1")

    @property
    def messages(self) -> list[Message]:
        """The messages as data."""
        return list(self.json.get("messages", []))


def command_path() -> str:
    """The program ``continuo``: that of the environment variable CONTINUO_COMMAND, else the package's own,
    else the one in PATH.

    Raises
    ------
    CommandError
        There is none.
    """
    named = os.environ.get("CONTINUO_COMMAND")
    if named:
        found = shutil.which(named)
        if found is None:
            raise CommandError(f"CONTINUO_COMMAND names {named}, which is no program")
        return found
    own = Path(__file__).resolve().parent / "programs" / "continuo"
    found = str(own) if os.access(own, os.X_OK) else shutil.which("continuo")
    if found is None:
        raise CommandError(
            "studies are made by the command `continuo`, which is not in PATH: install it, or name it by the "
            "environment variable CONTINUO_COMMAND"
        )
    return found


@functools.lru_cache(maxsize=None)
def _options_of(command: str, verb: str) -> dict[str, dict[str, Any]]:
    done = subprocess.run([command, "help", verb, "--json"], capture_output=True, text=True, check=False)
    try:
        declared = json.loads(done.stdout)
        return {name: one for one in declared["options"] for name in one["names"]}
    except (json.JSONDecodeError, KeyError):
        raise CommandError(f"{command} does not know `{verb}`: {done.stderr.strip()}") from None


def options_of(verb: str) -> dict[str, dict[str, Any]]:
    """The options of a verb by their names (``--until``), as the command declares them."""
    return _options_of(command_path(), verb)


class _Reader(threading.Thread):
    """Reads a stream to its end, so that the command never waits for us."""

    def __init__(self, descriptor: int) -> None:
        super().__init__(daemon=True)
        self._descriptor = descriptor
        self.data = bytearray()

    def run(self) -> None:
        try:
            while part := os.read(self._descriptor, 1 << 16):
                self.data += part
        except OSError:  # the other end of a terminal is gone
            pass
        finally:
            os.close(self._descriptor)


def _open_error_stream(is_watched: bool) -> tuple[int, int]:
    """Ours and the command's end. It tells its progress to terminals alone."""
    if is_watched and hasattr(os, "openpty"):
        return os.openpty()
    return os.pipe()


def _feed(stream: Any, data: bytes) -> None:
    try:
        stream.write(data)
        stream.close()
    except OSError:  # it has ended before it has read all
        pass


def run_command(
    arguments: list[str], stdin: bytes, folder: Path, tell: Optional[Callable[[float], object]] = None
) -> Answer:
    """Runs ``continuo ARGUMENTS --json`` in a folder.

    Parameters
    ----------
    tell : callable, optional
        Called with the part that is done, ten times a second. What it raises ends the command.

    Raises
    ------
    CommandError
        The command is not found, or gave no answer.
    """
    ours, theirs = _open_error_stream(tell is not None)
    try:
        child = subprocess.Popen(
            [command_path(), *arguments, "--json"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=theirs, cwd=folder,
            env={**os.environ, "NO_COLOR": "1"},
        )  # fmt: skip
    except BaseException:
        os.close(ours)
        raise
    finally:
        os.close(theirs)
    assert child.stdin is not None and child.stdout is not None
    out, error = _Reader(os.dup(child.stdout.fileno())), _Reader(ours)
    child.stdout.close()
    feeder = threading.Thread(target=_feed, args=(child.stdin, stdin), daemon=True)
    for thread in (out, error, feeder):
        thread.start()
    was_interrupted = False
    try:
        _wait(out, error, tell)
    except KeyboardInterrupt:
        was_interrupted = True
        _interrupt(child, out)
    except BaseException:
        _interrupt(child, out)
        raise
    finally:
        child.wait()
    for thread in (out, error, feeder):
        thread.join()
    text = _PROGRESS.sub("", error.data.decode("utf-8", "replace")).replace("\r\n", "\n").rstrip("\n")
    return _answer_of(arguments, bytes(out.data), text, child.returncode, was_interrupted)


def _wait(out: _Reader, error: _Reader, tell: Optional[Callable[[float], object]]) -> None:
    while out.is_alive():
        out.join(0.1)
        if tell is None or not out.is_alive():
            continue
        parts = _PART.findall(error.data[-200:].decode("utf-8", "replace"))
        if parts:
            tell(int(parts[-1]) / 100)


def _interrupt(child: "subprocess.Popen[bytes]", out: _Reader) -> None:
    """Ends the command, which writes what it has; where it does not end, or somebody insists, it is
    killed."""
    try:
        child.send_signal(signal.SIGINT)
        out.join(PATIENCE)
    except KeyboardInterrupt:
        pass
    if child.poll() is None and out.is_alive():
        child.kill()


def _answer_of(arguments: list[str], out: bytes, text: str, exit: int, was_interrupted: bool) -> Answer:
    try:
        answer = json.loads(out)
    except ValueError:
        if was_interrupted:
            return Answer({}, text, exit, True)
        how = f"was ended by signal {-exit}" if exit < 0 else f"ended with {exit}"
        raise CommandError(
            f"continuo {' '.join(arguments)} {how} and gave no answer\n{text}".rstrip()
        ) from None
    return Answer(answer, text, exit, was_interrupted or exit == 130)
