"""A client of the live view (docs/protocol.md): its commands and texts, over a WebSocket (RFC 6455)."""

from __future__ import annotations

import base64
import json
import os
import socket
import struct
import threading
from typing import Any, Optional
from urllib.parse import parse_qs, urlsplit


class LiveClient:
    """A connection to a live view.

    Parameters
    ----------
    address : str
        As ``continuo view`` prints it.
    timeout : float
        Seconds to connect.
    """

    def __init__(self, address: str, timeout: float = 10.0) -> None:
        parts = urlsplit(address)
        token = parse_qs(parts.query)["token"][0]
        self._socket = socket.create_connection((parts.hostname or "127.0.0.1", parts.port or 80), timeout)
        self._waiting = b""
        self._sending = threading.Lock()
        key = base64.b64encode(os.urandom(16)).decode()
        lines = [
            f"GET /live?token={token} HTTP/1.1", f"Host: {parts.netloc}", "Upgrade: websocket",
            "Connection: Upgrade", f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13",
        ]  # fmt: skip
        self._socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += self._take(1)
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise ConnectionError(head.split(b"\r\n")[0].decode())
        self._socket.settimeout(None)

    def _take(self, count: int) -> bytes:
        parts, size = [self._waiting], len(self._waiting)
        while size < count:
            part = self._socket.recv(1 << 16)
            if not part:
                raise ConnectionError("the view has ended")
            parts.append(part)
            size += len(part)
        data = b"".join(parts)
        self._waiting = data[count:]
        return data[:count]

    def _send(self, opcode: int, payload: bytes) -> None:
        """One message; a client hides its bytes behind a mask (RFC 6455, 5.3)."""
        size, mask = len(payload), os.urandom(4)
        if size < 126:
            length = bytes([0x80 | size])
        elif size < 1 << 16:
            length = b"\xfe" + struct.pack(">H", size)
        else:
            length = b"\xff" + struct.pack(">Q", size)
        masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))
        with self._sending:
            self._socket.sendall(bytes([0x80 | opcode]) + length + mask + masked)

    def say(self, what: str, **parts: Any) -> None:
        """Gives a command."""
        self._send(1, json.dumps({"do": what, **parts}).encode())

    def hear(self) -> Optional[dict[str, Any]]:
        """The next text, or the ``t`` of the next picture as ``{"say": "frame", "t": t}``; None at the
        end."""
        while True:
            first, second = self._take(2)
            size = second & 127
            if size == 126:
                (size,) = struct.unpack(">H", self._take(2))
            elif size == 127:
                (size,) = struct.unpack(">Q", self._take(8))
            payload, opcode = self._take(size), first & 15
            if opcode == 1:
                text: dict[str, Any] = json.loads(payload)
                return text
            if opcode == 2:
                return {"say": "frame", "t": struct.unpack_from("<d", payload, 16)[0]}
            if opcode == 8:
                return None
            if opcode == 9:
                self._send(10, payload)

    def close(self) -> None:
        """Ends the connection."""
        try:
            self._socket.shutdown(socket.SHUT_RDWR)
        except OSError:  # it has ended already
            pass
        self._socket.close()
