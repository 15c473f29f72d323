# SPDX-License-Identifier: Apache-2.0
"""Shared by the tests of engine plug-ins: a daemon with two performers, which is killed and restarted while the plug-in
runs in its engine.

A plug-in's program prints one JSON object per event, each on a line after EVENT. It needs these events:
  {"event": "received", "runs": {"ada": 1000, "bob": 1000}}   that many frames without a gap
  {"event": "lost"}                                          the connection was lost
  {"event": "again"}                                         weights of both subjects after the loss
and then ends with exit code 0. Programs may print further events and anything else.
"""
import concurrent.futures
import json
import os
import pathlib
import selectors
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "end_to_end"))
# pylint: disable=wrong-import-position
from furrow_testing import BIN, GUARD, SHARE, SOURCE, Daemon, furrow, spawn
from tracker_packets import livelink_csv

EVENT = "furrow-test: "
FRAMES = 1000
SUBJECTS = ("ada", "bob")
RATE = 240  # poses per second, so that 1,000 frames take about 4 s
LIBRARY = BIN.parent / "lib"
ENGINES = SOURCE / "client" / "engines"
PERFORMANCE = SHARE / "recordings" / "performance.bvh"
SKIPPED = 77


class Killed(Daemon):
    """A daemon that is killed at the end of the with-block."""

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate(timeout=GUARD)


class Program:
    """The plug-in in its engine. Reads its events."""

    def __init__(self, command, env=None, cwd=None):
        self.process = subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, env={**os.environ, **(env or {})}, cwd=cwd)
        os.set_blocking(self.process.stdout.fileno(), False)
        self.text, self.events, self.times = "", [], {}

    def read(self):
        """Takes what has arrived. Returns False at the end of the output."""
        data = self.process.stdout.read()
        if data is None:
            return True
        self.text += data.decode(errors="replace")
        *lines, _ = self.text.split("\n")
        events = [json.loads(line.split(EVENT, 1)[1]) for line in lines if EVENT in line]
        for event in events[len(self.events):]:
            self.times[event["event"]] = time.monotonic()
        self.events = events
        return bool(data)

    def wait_for(self, name):
        """Waits for an event and returns it."""
        deadline = time.monotonic() + GUARD
        with selectors.DefaultSelector() as selector:
            selector.register(self.process.stdout, selectors.EVENT_READ)
            while True:
                for event in self.events:
                    if event["event"] == name:
                        return event
                assert time.monotonic() < deadline, f"no event '{name}':\n{self.text[-3000:]}"
                selector.select(timeout=1)
                assert self.read(), f"the program ended before the event '{name}':\n{self.text[-3000:]}"

    def finish(self):
        """Waits for the end and returns the exit code."""
        with selectors.DefaultSelector() as selector:
            selector.register(self.process.stdout, selectors.EVENT_READ)
            while self.read():
                selector.select(timeout=GUARD)
        return self.process.wait(timeout=GUARD)

    def stop(self):
        self.process.kill()
        self.process.wait(timeout=GUARD)
        self.process.stdout.close()


class EngineTest(unittest.TestCase):
    """A plug-in receives, survives a restart of the daemon, and ends cleanly."""

    def start_performer(self, *args):
        performer = spawn("play", *args, "--loop")
        self.addCleanup(performer.stdout.close)
        self.addCleanup(performer.stderr.close)
        self.addCleanup(performer.wait, timeout=GUARD)
        self.addCleanup(performer.send_signal, signal.SIGINT)

    def start_performers(self, daemon):
        for subject in SUBJECTS:
            self.start_performer(PERFORMANCE, "--to", daemon.udp, "--subject", subject, "--rate", RATE)

    def start_phone(self, daemon, subject):
        """Plays a second of a face tracker again and again, with timecodes from 10:00:00:00 at 60 frames per second."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name) / "phone.csv"
        path.write_text(livelink_csv([{"JawOpen": frame / 60} for frame in range(60)], hour=10))
        self.start_performer(path, "--to", daemon.udp, "--subject", subject)

    def time_of_weights(self, daemon):
        """Starts a plain client for each subject. Returns a function that waits for their weights and returns the time of
        the later ones."""
        def watch(subject):
            furrow("watch", daemon.tcp, "--subject", subject, "--wait", "--frames", 1, check=0)
            return time.monotonic()

        pool = concurrent.futures.ThreadPoolExecutor()
        self.addCleanup(pool.shutdown)
        times = [pool.submit(watch, subject) for subject in SUBJECTS]
        return lambda: max(one.result(timeout=GUARD) for one in times)

    def check_plugin(self, make_command, env=None, cwd=None, daemon_args=(), phone=""):
        """Runs the plug-in through the whole story. `make_command(daemon)` returns its command line. `phone`: a third
        performer, whose poses have timecodes. Returns the Program."""
        with Killed("--no-render", "--http", "0", *daemon_args) as daemon:
            self.start_performers(daemon)
            if phone:
                self.start_phone(daemon, phone)
            program = Program(make_command(daemon), env, cwd)
            self.addCleanup(program.stop)
            received = program.wait_for("received")
            self.assertEqual(set(received["runs"]), set(SUBJECTS))
            for subject, count in received["runs"].items():
                self.assertGreaterEqual(count, FRAMES, subject)
        program.wait_for("lost")
        with Daemon("--no-render", "--http", daemon.ports["http"], *daemon_args, ports=daemon.ports) as back:
            returned = time.monotonic()
            with_plain_client = self.time_of_weights(back)
            program.wait_for("again")
            delay = program.times["again"] - returned
            print(f"{self.id()}: weights again {delay:.2f} s after the daemon's return", file=sys.stderr)
            # On a busy machine the performers themselves may return late; a plain client shows when they are back.
            self.assertLess(program.times["again"] - max(returned, with_plain_client()), 1.0)
            self.assertEqual(program.finish(), 0, program.text[-3000:])
        return program


def need(program):
    """Returns the path of a program, or skips the test."""
    found = subprocess.run(["which", program], capture_output=True, text=True, check=False).stdout.strip()
    if not found:
        raise unittest.SkipTest(f"{program} is not installed (deploy/install-deps.sh all)")
    return found


def main():
    if os.environ.get("FURROW_SANITIZE"):
        print("SKIPPED: an ordinary program cannot load a library that was built with sanitizers")
        sys.exit(SKIPPED)
    result = unittest.main(exit=False).result
    sys.exit(1 if not result.wasSuccessful() else SKIPPED if len(result.skipped) == result.testsRun else 0)

