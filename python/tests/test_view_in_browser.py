"""The live view in a page of another address, as a notebook is one: a slider moved by hand there is a value
here."""

import base64
import http.server
import json
import os
import shutil
import socket
import subprocess
import tempfile
import threading
import time
from pathlib import Path
from typing import Any, Iterator
from urllib.parse import urlsplit
from urllib.request import urlopen

import pytest

from continuo import Model
from continuo.live_client import LiveClient
from continuo.view import View

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
if BROWSER is None or (os.environ.get("CONTINUO_COMMAND") or shutil.which("continuo")) is None:
    pytest.skip("chromium or the command continuo is not there", allow_module_level=True)

TEXT = "param k = 4 in 0..10\nx' = -k*x; x(0) = 1\nrun 0..5\n"

# The slider of k, and how somebody moves it to seven tenths of its way.
MOVE = """(() => {
  const slider = document.querySelector("input[type=range][aria-label=k]");
  if (!slider) return false;
  slider.value = 0.7 * slider.max;
  slider.dispatchEvent(new Event("input", {bubbles: true}));
  return true;
})()"""


class Tab(LiveClient):
    """A tab or a frame of the browser, by its debugging protocol, whose messages are framed like those of the
    view."""

    def __init__(self, address: str) -> None:
        parts = urlsplit(address)
        self._socket = socket.create_connection((parts.hostname or "", parts.port or 0), 10)
        self._waiting, self._sending, self._number = b"", threading.Lock(), 0
        key = base64.b64encode(os.urandom(16)).decode()
        self._socket.sendall(
            f"GET {parts.path} HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += self._take(1)

    def call(self, method: str, **parameters: Any) -> dict:
        self._number += 1
        self._send(1, json.dumps({"id": self._number, "method": method, "params": parameters}).encode())
        while True:
            message = self.hear()
            assert message is not None
            if message.get("id") == self._number:
                return message["result"]

    def value_of(self, expression: str) -> Any:
        return self.call("Runtime.evaluate", expression=expression)["result"].get("value")


@pytest.fixture
def browser() -> Iterator[str]:
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as home:
        child = subprocess.Popen(
            [str(BROWSER), "--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-port=0",
             f"--user-data-dir={home}", "about:blank"], stderr=subprocess.DEVNULL,
        )  # fmt: skip
        try:
            port = Path(home) / "DevToolsActivePort"
            wait_for(lambda: port.exists() and len(port.read_text().split()) == 2)
            yield f"http://127.0.0.1:{port.read_text().split()[0]}/json"
        finally:
            child.terminate()
            child.wait()


def wait_for(condition: Any, seconds: float = 20) -> Any:
    end = time.monotonic() + seconds
    while not (found := condition()):
        assert time.monotonic() < end, "that did not happen in time"
        time.sleep(0.05)
    return found


def target(browser: str, kind: str) -> Any:
    with urlopen(browser) as answer:
        return next((one["webSocketDebuggerUrl"] for one in json.load(answer) if one["type"] == kind), None)


def test_a_slider_moved_there_is_a_value_here(browser: str, tmp_path: Path) -> None:
    model = Model(text=TEXT)

    class Page(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(f"<html><body>{view._repr_html_()}</body></html>".encode())

        def log_message(self, *_: Any) -> None:
            pass

    with View(model, open_browser=False) as view:
        notebook = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Page)
        threading.Thread(target=notebook.serve_forever, daemon=True).start()
        page = Tab(wait_for(lambda: target(browser, "page")))
        page.call("Page.navigate", url=f"http://localhost:{notebook.server_port}/")
        frame = Tab(wait_for(lambda: target(browser, "iframe")))
        wait_for(lambda: frame.value_of(MOVE))
        assert view.wait_for("k", 7) and model.k == 7
        model.k = 2
        assert view.wait_for("k", 2)
        wait_for(
            lambda: frame.value_of('document.querySelector("input[type=text][aria-label=k]").value') == "2"
        )
        page.close()
        frame.close()
        notebook.shutdown()
