#!/usr/bin/env python3
"""A client of Continuo's live view in the standard library of Python alone: docs/protocol.md as a program.

    continuo view models/pendulum.sim --no-open      prints an address
    python3 docs/protocol_client.py ADDRESS          prints what moves for two seconds
"""
import base64
import hashlib
import json
import math
import os
import socket
import struct
import sys
import time
from urllib.parse import parse_qs, urlsplit


class View:
    """A socket of a live view: `say` commands, `hear` texts (as dict) and frames (as Frame)."""

    def __init__(self, address, origin=None, timeout=10, own=False):
        parts = urlsplit(address)
        token = parse_qs(parts.query)["token"][0]
        self.socket = socket.create_connection((parts.hostname, parts.port), timeout)
        self.waiting = b""
        self.model = None
        key = base64.b64encode(os.urandom(16)).decode()
        lines = [f"GET /live?token={token}{'&own' if own else ''} HTTP/1.1", f"Host: {parts.netloc}", "Upgrade: websocket",
                 "Connection: Upgrade", f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13"]
        if origin:
            lines.append(f"Origin: {origin}")
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += self._take(1)
        status = head.split(b"\r\n")[0].decode()
        if " 101 " not in status:
            raise ConnectionError(status)
        proof = hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()  # RFC 6455, 4.2.2
        assert base64.b64encode(proof) in head

    def _take(self, count):
        while len(self.waiting) < count:
            part = self.socket.recv(1 << 16)
            if not part:
                raise ConnectionError("the server has gone")
            self.waiting += part
        taken, self.waiting = self.waiting[:count], self.waiting[count:]
        return taken

    def send(self, opcode, payload):
        """One message; a client hides its bytes behind a mask (RFC 6455, 5.3)."""
        mask = os.urandom(4)
        size = len(payload)
        length = (bytes([0x80 | size]) if size < 126 else
                  b"\xfe" + struct.pack(">H", size) if size < 65536 else b"\xff" + struct.pack(">Q", size))
        masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))
        self.socket.sendall(bytes([0x80 | opcode]) + length + mask + masked)

    def say(self, what, **parts):
        self.send(1, json.dumps({"do": what, **parts}).encode())

    def hear(self):
        """The next message: a dict, or a Frame; None where the server said goodbye."""
        while True:
            first, second = self._take(2)
            size = second & 127
            if size == 126:
                size, = struct.unpack(">H", self._take(2))
            elif size == 127:
                size, = struct.unpack(">Q", self._take(8))
            payload = self._take(size)
            opcode = first & 15
            if opcode == 1:
                text = json.loads(payload)
                if text["say"] == "model":
                    self.model = text
                return text
            if opcode == 2:
                return Frame(payload, self.model)
            if opcode == 8:
                return None
            if opcode == 9:
                self.send(10, payload)  # a ping wants its pong

    def until(self, wanted, seconds=10):
        """Hears until wanted(message) is true, and returns that message."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            message = self.hear()
            if message is None or wanted(message):
                return message
        raise TimeoutError("that was not said in time")

    def close(self):
        self.socket.close()


class Frame:
    """One binary message, taken apart."""

    def __init__(self, data, model):
        self.size = len(data)
        kind, self.run, flags, rows = struct.unpack_from("<4I", data)
        assert kind == 1
        self.t, self.reached, self.target = struct.unpack_from("<3d", data, 16)
        self.rewound, self.looking_back = bool(flags & 1), bool(flags & 16)
        at = 40

        def numbers(letter, count):
            nonlocal at
            values = struct.unpack_from(f"<{count}{letter}", data, at)
            at += struct.calcsize(f"<{count}{letter}")
            return values

        columns, scene = len(model["columns"]), model["scene_count"]
        self.row_t = numbers("d", rows)
        flat = numbers("f", rows * columns)
        self.rows = [dict(zip((column["name"] for column in model["columns"]), flat[i * columns:(i + 1) * columns]))
                     for i in range(rows)]
        self.scene = numbers("f", scene)
        self.ghost_rows = self.ghost_scene = self.position = self.orientation = None
        self.ghost_position = self.ghost_orientation = self.path = self.ghost_path = None
        if flags & 2:
            self.ghost_rows, self.ghost_scene = numbers("f", rows * columns), numbers("f", scene)
        if flags & 4:
            dimension = model["bodies"]["dimension"]
            count, = numbers("I", 1)
            self.position = numbers("f", count * dimension)
            if flags & 8:
                self.orientation = numbers("f", count * (1 if dimension == 2 else 4))
            if flags & 32:
                self.ghost_position = numbers("f", count * dimension)
                if flags & 8:
                    self.ghost_orientation = numbers("f", count * (1 if dimension == 2 else 4))
        if flags & 64:
            self.path = numbers("f", rows * model["path_count"])
            if flags & 2:
                self.ghost_path = numbers("f", rows * model["path_count"])
        assert at <= len(data), "the frame says of itself how long it is"  # more: of a later version


def main():
    view = View(sys.argv[1])
    view.say("play")
    end = time.monotonic() + 2
    while time.monotonic() < end:
        message = view.hear()
        if isinstance(message, Frame) and message.rows:
            values = ", ".join(f"{name} = {value:.4g}" for name, value in message.rows[-1].items()
                               if not math.isnan(value))
            print(f"t = {message.t:.3f}: {values}")
        elif isinstance(message, dict) and message["say"] in ("event", "message"):
            print(message)


if __name__ == "__main__":
    main()
