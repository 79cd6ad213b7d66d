#!/usr/bin/env python3
"""What `continuo view` promises, measured: measure.py COMMAND time|slow|crowd|spheres|all [SECONDS]."""
import os
import random
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(root, "docs"))
from protocol_client import Frame, View  # noqa: E402

command = sys.argv[1]
tick = os.sysconf("SC_CLK_TCK")


class Viewed:
    def __init__(self, text, *options):
        self.file = tempfile.NamedTemporaryFile("w", suffix=".sim")
        self.file.write(text)
        self.file.flush()
        begin = time.monotonic()
        self.process = subprocess.Popen([command, "view", self.file.name, "--no-open", *options],
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.address = self.process.stdout.readline().strip()
        self.seconds_to_address = time.monotonic() - begin

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=30)

    def resident(self):
        """Megabytes."""
        with open(f"/proc/{self.process.pid}/status") as status:
            return next(int(line.split()[1]) for line in status if line.startswith("VmRSS")) / 1024

    def processor_seconds(self):
        """By the names of the threads."""
        used = {}
        folder = f"/proc/{self.process.pid}/task"
        for thread in os.listdir(folder):
            with open(f"{folder}/{thread}/stat") as stat:
                name, rest = stat.read().split("(", 1)[1].rsplit(")", 1)
            fields = rest.split()
            used[name] = used.get(name, 0) + (int(fields[11]) + int(fields[12])) / tick
        return used


circle = "x'' = -x\nx(0) = 1;  x'(0) = 0\nenergy all = 1/2*x'^2 + 1/2*x^2\nrun 0..20 tol 1e-9\n" \
         "draw { ball (x, x') radius 0.1 }\n"
small_steps = "param k = 1\nx'' = -k*x\nx(0) = 1;  x'(0) = 0\nrun 0..10 method rk4 step 1e-5\n"


def real_time(seconds=60):
    with Viewed(circle) as viewed:
        view = View(viewed.address)
        view.until(lambda m: isinstance(m, Frame) and m.t > 0.5)
        offsets, begin = [], time.monotonic()
        while time.monotonic() < begin + seconds:
            message = view.hear()
            if isinstance(message, Frame):
                offsets.append(time.monotonic() - message.t)
        middle = statistics.median(offsets[:60])
        first, last = middle, statistics.median(offsets[-60:])
        apart = sorted(abs(offset - middle) for offset in offsets)
        print(f"time: over {seconds:.0f} s simulated against wall time: apart by {1e3 * (last - first):+.1f} ms at the end; "
              f"of {len(offsets)} frames 99 % within {1e3 * apart[int(0.99 * len(apart))]:.1f} ms, all within "
              f"{1e3 * apart[-1]:.1f} ms; address after {1e3 * viewed.seconds_to_address:.0f} ms")
        view.close()


def slow(seconds=20):
    with Viewed(small_steps) as viewed:
        view = View(viewed.address)
        view.say("speed", value=0)
        end = time.monotonic() + 4
        best = 0
        while time.monotonic() < end:
            message = view.hear()
            best = max(best, message.reached) if isinstance(message, Frame) else best
        view.say("speed", value=10 * best)  # ten times what the machine can do
        end, state, delays, k, last = time.monotonic() + seconds, None, [], 1, None

        def until(seen):
            """Hears until seen(message, rows' times with the one before them)."""
            nonlocal state, last
            while True:
                message, times = view.hear(), ()
                if isinstance(message, Frame) and message.row_t:
                    times, last = (last, *message.row_t), message.row_t[-1]
                elif isinstance(message, dict) and message["say"] == "state":
                    state = message
                if seen(message, times):
                    return

        until(lambda message, times: bool(times))
        while time.monotonic() < end:
            k = 3 - k
            begin = time.monotonic()
            view.say("set", parameter="k", value=k)
            # The row of the change stands at the same t as the one before it.
            until(lambda message, times: any(a == b for a, b in zip(times, times[1:])))
            delays.append(time.monotonic() - begin)
            view.say("ping", id=k)
            until(lambda message, times: isinstance(message, dict) and message["say"] == "pong")
            time.sleep(0.1)
            view.say("ping", id=k)
            until(lambda message, times: isinstance(message, dict) and message["say"] == "pong")
        delays.sort()
        print(f"slow: a model ten times too slow: reached {state['reached'] / state['target']:.3f} of the target, slow: "
              f"{state['slow']}; from a hand to its frame {1e3 * statistics.median(delays):.0f} ms, at most "
              f"{1e3 * delays[-1]:.0f} ms of {len(delays)}")
        view.close()


def crowd(seconds=300):
    with Viewed(circle, "--speed", "1") as viewed:
        watcher, deaf = View(viewed.address), View(viewed.address)  # the latter never reads again
        stop = time.monotonic() + seconds
        joined, failed = [0], []

        def client(seed):
            chance = random.Random(seed)
            while time.monotonic() < stop:
                try:
                    view = View(viewed.address)
                    joined[0] += 1
                    end = min(stop, time.monotonic() + chance.uniform(0.05, 4))
                    while time.monotonic() < end:
                        view.hear()
                    if chance.random() < 0.5:
                        view.say("ping", id=1)
                    view.close()
                except OSError as error:
                    failed.append(str(error))
                time.sleep(chance.uniform(0, 0.5))

        threads = [threading.Thread(target=client, args=(seed,)) for seed in range(20)]
        for thread in threads:
            thread.start()
        settle = time.monotonic() + min(10, seconds / 4)
        first, most, lowest = None, 0, 9.0
        while time.monotonic() < stop:
            message = watcher.hear()
            if time.monotonic() < settle:
                continue
            if first is None:
                first = viewed.resident()
            if isinstance(message, dict) and message["say"] == "state":
                most = max(most, viewed.resident())
                lowest = min(lowest, message["reached"])
        for thread in threads:
            thread.join()
        used = viewed.processor_seconds()
        print(f"crowd: 20 clients for {seconds:.0f} s, {joined[0]} times joined, {len(failed)} turned away: memory "
              f"{first:.1f} MB, at most {most:.1f}, at the end {viewed.resident():.1f}; speed never below {lowest:.3f}; "
              f"processor: " + ", ".join(f"{name} {100 * value / seconds:.1f} %" for name, value in used.items()))
        deaf.close()
        watcher.close()


def spheres(seconds=20):
    with open(os.path.join(root, "bench", "live", "spheres.sim")) as file:
        text = file.read()
    # In slow motion, a step of the physics or two in a second: what is measured is the rest.
    with Viewed(text, "--speed", "0.02") as viewed:
        view = View(viewed.address)
        view.until(lambda m: isinstance(m, Frame) and m.t > 0, 60)
        before, begin, frames, size, reached = viewed.processor_seconds(), time.monotonic(), 0, 0, 0
        while time.monotonic() < begin + seconds:
            message = view.hear()
            if isinstance(message, Frame):
                frames, size, reached = frames + 1, message.size, message.reached
        wall = time.monotonic() - begin
        used = viewed.processor_seconds()
        print(f"spheres: {size / 1e3:.0f} kB a frame, {frames / wall:.1f} frames a second at {reached:.3f} of real time; "
              "processor: " + ", ".join(f"{name} {100 * (used[name] - before.get(name, 0)) / wall:.1f} %" for name in used))
        view.close()


programs = {"time": real_time, "slow": slow, "crowd": crowd, "spheres": spheres}
wanted = programs if sys.argv[2] == "all" else [sys.argv[2]]
for name in wanted:
    programs[name](*[float(argument) for argument in sys.argv[3:4]])
