#!/usr/bin/env python3
"""The client of docs/protocol.md against `continuo view`: client_test.py COMMAND SOURCE_FOLDER."""
import base64
import http.client
import json
import math
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from urllib.parse import urlsplit

command, root = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(root, "docs"))
from protocol_client import Frame, View  # noqa: E402


class Viewed:
    """`continuo view` of a model, ended by Ctrl-C."""

    def __init__(self, model, *options):
        path = os.path.join(root, "models", model)
        self.process = subprocess.Popen([command, "view", path, "--no-open", *options], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith("http://"), self.process.stderr.read()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.said = self.process.communicate(timeout=20)[1]
        assert self.process.returncode == 0, self.said


def state(message):
    return isinstance(message, dict) and message["say"] == "state"


def rows_of(view, wanted, seconds=10):
    """The first row that is as wanted."""
    found = []

    def has(message):
        if isinstance(message, Frame):
            found.extend(row for row in message.rows if wanted(row))
        return bool(found)

    view.until(has, seconds)
    return found[0]


class Protocol(unittest.TestCase):
    def test_moves_and_obeys(self):
        with Viewed("spring_pendulum.sim") as viewed:
            view = View(viewed.address, origin="http://" + urlsplit(viewed.address).netloc)
            model = view.until(lambda m: isinstance(m, dict) and m["say"] == "model")
            self.assertEqual(model["name"], "SpringPendulum")
            self.assertEqual(model["columns"][-1]["kind"], "distance")
            self.assertTrue(any(item["drag"] for item in model["drawing"]))
            self.assertIn("pendulum", [other["name"] for other in model["gallery"]])
            first = view.until(lambda m: isinstance(m, Frame) and m.t > 0)  # it plays as soon as somebody looks
            self.assertTrue(all(math.isfinite(value) for value in first.scene))
            ball = next(i for i, item in enumerate(model["drawing"]) if item["drag"])
            view.say("drag", item=ball, to=[1.5, -2])
            held = rows_of(view, lambda row: abs(row["x"] - 1.5) < 1e-5 and abs(row["y"] + 2) < 1e-5)
            self.assertEqual(held["x'"], 0)
            view.say("release")
            view.say("pause")
            view.until(lambda m: state(m) and not m["playing"])
            view.say("seek", t=0)
            view.until(lambda m: isinstance(m, Frame) and m.looking_back)
            view.say("set", parameter="k", value=20)
            after = view.until(lambda m: state(m) and m["parameters"]["k"] == 20)
            self.assertEqual(after["undo"], 1)
            view.say("ghost", name="explicit_euler", step=0.02)
            view.say("play")
            view.until(lambda m: isinstance(m, Frame) and m.ghost_scene is not None)
            view.say("check", id=7, text="x'' = -k*x\nx(0) = 1; x'(0) = 0\nrun 0..1\n")
            checked = view.until(lambda m: isinstance(m, dict) and m["say"] == "checked")
            self.assertEqual(checked["id"], 7)
            self.assertEqual((checked["diagnostics"][0]["line"], checked["diagnostics"][0]["column"]), (1, 8))
            view.say("open", model="bouncing_ball")
            opened = view.until(lambda m: isinstance(m, dict) and m["say"] == "model")
            self.assertEqual(opened["name"], "BouncingBall")
            self.assertFalse(opened["saveable"])
            view.say("until_event")
            event = view.until(lambda m: isinstance(m, dict) and m["say"] == "event")
            self.assertAlmostEqual(event["t"], 10 / 7, 9)
            view.close()

    def test_keeps_time(self):
        with Viewed("pendulum.sim") as viewed:
            view = View(viewed.address)
            end = view.until(lambda m: isinstance(m, Frame) and m.t > 0.2)
            off = []
            for _ in range(10):  # where the machine is too busy the motion slows down: it keeps time when it can
                begin, wall = end, time.monotonic()
                end = view.until(lambda m: isinstance(m, Frame) and m.t > begin.t + 1)
                off.append(end.t - begin.t - (time.monotonic() - wall))
                if abs(off[-1]) < 0.1:  # two pictures of 17 ms, and what keeps a process waiting
                    break
            self.assertLess(min(map(abs, off)), 0.1)
            view.close()

    def test_serves_its_page_to_those_who_know(self):
        with Viewed("pendulum.sim", "--page", os.path.join(root, "docs", "protocol.md")) as viewed:
            parts = urlsplit(viewed.address)

            def get(target, **headers):
                connection = http.client.HTTPConnection(parts.hostname, parts.port, timeout=10)
                connection.request("GET", target, headers=headers)
                answer = connection.getresponse()
                return answer.status, answer.read(), answer.headers

            status, page, _ = get("/?" + parts.query)
            self.assertEqual(status, 200)
            with open(os.path.join(root, "docs", "protocol.md"), "rb") as file:
                self.assertEqual(page, file.read())
            self.assertEqual(get("/?" + parts.query, **{"Accept-Encoding": "gzip"})[2]["Content-Encoding"], "gzip")
            for target in ("/", "/?token=0", "/live"):
                self.assertIn(get(target)[0], (403, 404), target)
            self.assertEqual(get("/?" + parts.query, Origin="http://evil.example")[0], 403)
            self.assertEqual(get("/../../etc/passwd?" + parts.query)[0], 404)
            with self.assertRaises(ConnectionError):
                View(viewed.address, origin="http://evil.example")
        self.assertEqual(viewed.said.count("another page"), 1)

    def test_the_address_can_be_chosen(self):
        with Viewed("pendulum.sim", "--listen", "127.0.0.2", "--paused") as viewed:
            self.assertTrue(viewed.address.startswith("http://127.0.0.2:"))
            view = View(viewed.address)
            self.assertFalse(view.until(state)["playing"])
            view.close()
            port = urlsplit(viewed.address).port
            taken = subprocess.run([command, "view", os.path.join(root, "models", "pendulum.sim"), "--no-open",
                                    "--listen", "127.0.0.2", "--port", str(port)], capture_output=True, text=True,
                                   timeout=20)
            self.assertEqual(taken.returncode, 1)
            self.assertIn("Address already in use", taken.stderr)

    def test_what_cannot_be_shown_is_refused(self):
        refused = subprocess.run([command, "view", os.path.join(root, "models", "blasius.sim"), "--no-open"],
                                 capture_output=True, text=True, timeout=20)
        self.assertEqual(refused.returncode, 1)
        self.assertIn("E321", refused.stderr)

    def test_a_page_that_replays(self):
        with tempfile.TemporaryDirectory() as folder:
            page, out = os.path.join(folder, "page.html"), os.path.join(folder, "out.html")
            with open(page, "w") as file:
                file.write("<html><!--recording--></html>")
            subprocess.run([command, "view", os.path.join(root, "models", "bouncing_ball.sim"), "--page", page, "--export",
                            out, "--until", "3", "--fps", "20", "--set", "h0=5"], check=True, timeout=60)
            with open(out) as file:
                text = file.read()
        start, end = "<html><script type=\"application/json\" id=\"recording\">", "</script></html>"
        self.assertTrue(text.startswith(start) and text.endswith(end))
        self.assertNotIn("<", text[len(start):-len(end)])
        recording = json.loads(text[len(start):-len(end)])
        data, frames = base64.b64decode(recording["frames"]), []
        while data:
            length, = struct.unpack_from("<I", data)
            frames.append(Frame(data[4:4 + length], recording["model"]))
            data = data[4 + length:]
        self.assertEqual(frames[0].rows[0]["h"], 5)
        self.assertAlmostEqual(frames[-1].t, 3, delta=0.051)
        self.assertGreater(len(frames), 55)
        times = [t for frame in frames for t in frame.row_t]
        self.assertEqual(times, sorted(times))
        self.assertAlmostEqual(recording["events"][0]["t"], math.sqrt(2 * 5 / 9.8), 9)

    def test_pictures_without_a_browser(self):
        with tempfile.TemporaryDirectory() as folder:
            for model in ("spring_pendulum", "car", "mass_spring_damper"):
                out = os.path.join(folder, model)
                subprocess.run([command, "view", os.path.join(root, "models", model + ".sim"), "--record", out, "--until",
                                "1", "--fps", "4"], check=True, timeout=60)
                self.assertIn(len(os.listdir(out)), (5, 6))
                with open(os.path.join(out, "00003.png"), "rb") as file:
                    self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")

    def test_malformed_texts_are_answered_then_shown_out(self):
        with Viewed("pendulum.sim", "--paused") as viewed:
            view = View(viewed.address)
            view.say("nonsense")
            answer = view.until(lambda m: isinstance(m, dict) and m["say"] == "message")
            self.assertEqual(answer["severity"], "error")
            view.say("seek")
            self.assertIn("needs t", view.until(lambda m: isinstance(m, dict) and m["say"] == "message")["text"])
            for _ in range(120):
                try:
                    view.send(1, b"{")
                except OSError:
                    break
            self.assertIsNone(view.until(lambda m: False))
            View(viewed.address).close()  # others are let in


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1, warnings="ignore")
