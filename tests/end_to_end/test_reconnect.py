#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A daemon is killed and restarted: clients come back by themselves, and --once keeps the old behaviour."""
import os
import pathlib
import re
import selectors
import signal
import tempfile
import time
import unittest

from furrow_testing import GUARD, SHARE, Daemon, finish, furrow, spawn

PERFORMANCE = SHARE / "recordings" / "performance.bvh"
SHORT = ("--pattern", "brow_l.*", "--format", "csv")  # rows that never fill a pipe
LOST = "the connection was lost; trying again until Ctrl-C"


class Output:
    """What a running program has printed so far. Reads never block beyond GUARD."""

    def __init__(self, stream):
        self.stream = stream
        self.text = ""
        os.set_blocking(stream.fileno(), False)

    def take(self):
        """Everything that has arrived since the last call."""
        data = self.stream.read() or b""
        self.text += data.decode()
        return data.decode()

    def wait_for(self, condition):
        """Reads until `condition`, a function of the whole text, holds."""
        deadline = time.monotonic() + GUARD
        with selectors.DefaultSelector() as selector:
            selector.register(self.stream, selectors.EVENT_READ)
            while not condition(self.text):
                assert time.monotonic() < deadline, f"nothing more came: {self.text[-500:]}"
                selector.select(timeout=1)
                self.take()
        return self.text


def rows_after(output, count):
    """Waits for `count` more lines than the program has printed so far."""
    output.take()
    before = output.text.count("\n")
    output.wait_for(lambda text: text.count("\n") >= before + count)


class Killed(Daemon):
    """A daemon that is killed at the end of the with-block."""

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate(timeout=GUARD)


class ReconnectTest(unittest.TestCase):
    def start(self, *args):
        process = spawn(*args)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        return process

    def end(self, process):
        """Sends Ctrl-C; returns the exit code and the rest of standard error."""
        process.send_signal(signal.SIGINT)
        process.wait(timeout=GUARD)
        return process.returncode, (process.stderr.read() or b"").decode()

    def test_watch_and_play_survive_a_restart(self):
        for path in ("--udp", "--tcp"):
            with self.subTest(path):
                with Killed("--no-render") as daemon:
                    host = daemon.udp if path == "--udp" else daemon.tcp
                    player = self.start("play", PERFORMANCE, "--to", host, path, "--subject", "ada", "--loop")
                    watcher = self.start("watch", host, path, "--subject", "ada", "--wait", *SHORT)
                    rows, notes = Output(watcher.stdout), Output(watcher.stderr)
                    rows_after(rows, 5)
                notes.wait_for(lambda text: LOST in text)
                rows.take()
                with Daemon("--no-render", ports=daemon.ports):
                    rows_after(rows, 20)
                    notes.wait_for(lambda text: "connected again" in text)
                    code, _ = self.end(watcher)
                    self.assertEqual(code, 0)
                    code, words = self.end(player)
                    self.assertEqual(code, 0, words)
                    self.assertRegex(words, r"there was no connection for \d+ of \d+ poses")
                    self.assertIn(LOST, words)
                    self.assertIn("connected again", words)

    def test_a_subscription_without_wait_waits_after_a_restart(self):
        with Killed("--no-render") as daemon:
            player = self.start("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", "ada", "--loop", "--once")
            furrow("watch", daemon.tcp, "--subject", "ada", "--wait", "--frames", 1, check=0)
            watcher = self.start("watch", daemon.tcp, "--subject", "ada", *SHORT)
            rows, notes = Output(watcher.stdout), Output(watcher.stderr)
            rows_after(rows, 2)
        self.assertEqual(player.wait(timeout=GUARD), 4)
        notes.wait_for(lambda text: LOST in text)
        with Daemon("--no-render", ports=daemon.ports) as daemon:
            # The watcher is back before its subject.
            notes.wait_for(lambda text: "waiting for the subject" in text)
            furrow("play", PERFORMANCE, "--to", daemon.udp, "--subject", "ada", "--speed", 8, check=0)
            self.assertEqual(watcher.wait(timeout=GUARD), 0)
        self.assertIn("the subject left", notes.wait_for(lambda text: "left" in text))

    def test_a_recording_goes_on_after_a_restart(self):
        with tempfile.TemporaryDirectory() as folder:
            take = pathlib.Path(folder, "take.mcap")
            with Killed("--no-render") as daemon:
                player = self.start("play", PERFORMANCE, "--to", daemon.udp, "--subject", "ada", "--loop")
                watcher = self.start("watch", daemon.tcp, "--subject", "ada", "--wait", *SHORT)
                rows = Output(watcher.stdout)
                rows_after(rows, 2)
                recorder = self.start("record", daemon.tcp, "--out", take)
                notes = Output(recorder.stderr)
                rows_after(rows, 5)
            notes.wait_for(lambda text: LOST in text)
            rows.take()
            with Daemon("--no-render", ports=daemon.ports):
                notes.wait_for(lambda text: "connected again" in text)
                rows_after(rows, 10)
                last = int(rows.text.splitlines()[-1].split(",")[0])
                self.end(player)  # the only subject leaves, which ends the recording
                self.assertEqual(recorder.wait(timeout=GUARD), 0)
                self.assertEqual(watcher.wait(timeout=GUARD), 0)
            self.assertRegex(notes.wait_for(lambda text: "take.mcap" in text), r"\d+ poses and \d+ weights of ada in")
            weights = pathlib.Path(folder, "weights.csv")
            furrow("convert", take, weights, "--weights", check=0)
            recorded = [int(line.split(",")[0]) for line in weights.read_text().splitlines()[1:]]
            # Poses from both daemons, with a gap between them: the publisher numbers them without a break.
            self.assertIn(last, recorded)
            gaps = [b - a for a, b in zip(recorded, recorded[1:])]
            self.assertGreater(max(gaps), 1, "the daemon was away for some poses")

    def test_pictures_go_on_after_a_restart(self):
        with tempfile.TemporaryDirectory() as folder:
            pictures = pathlib.Path(folder)

            def names():
                return {path.name for path in pictures.glob("*.jpg")}

            def wait_for_more(than):
                deadline = time.monotonic() + GUARD
                while len(names() - than) < 2:
                    self.assertLess(time.monotonic(), deadline, "no more pictures came")
                    time.sleep(0.05)

            with Killed() as daemon:
                player = self.start("play", PERFORMANCE, "--to", daemon.udp, "--subject", "ada", "--loop")
                watcher = self.start("frames", daemon.tcp, "--subject", "ada", "--wait", "--out", pictures, "--size",
                                     "64x64", "--rate", 5)
                wait_for_more(set())
            Output(watcher.stderr).wait_for(lambda text: LOST in text)
            before = names()
            with Daemon(ports=daemon.ports):
                wait_for_more(before)
                self.assertEqual(self.end(watcher)[0], 0)
                self.assertEqual(self.end(player)[0], 0)

    def test_once_ends_with_the_connection(self):
        for path in ("--udp", "--tcp"):
            with self.subTest(path):
                with Killed("--no-render") as daemon:
                    host = daemon.udp if path == "--udp" else daemon.tcp
                    player = self.start("play", PERFORMANCE, "--to", host, path, "--subject", "ada", "--loop", "--once")
                    watcher = self.start("watch", host, path, "--subject", "ada", "--wait", "--once")
                    rows_after(Output(watcher.stdout), 5)
                for process in (player, watcher):
                    os.set_blocking(process.stdout.fileno(), True)
                    self.assertEqual(finish(process)[0], 4, path)

    def test_a_daemon_that_was_never_there_is_an_error(self):
        for path in ("--udp", "--tcp"):
            result = furrow("watch", "127.0.0.1:9", path, check=4)
            self.assertIn("is furrowd running there?", result.stderr.decode())


class AddressTest(unittest.TestCase):
    """furrow:// works wherever HOST does."""

    def test_addresses_state_subject_pattern_rate_and_transport(self):
        with Daemon("--no-render") as daemon:
            udp = f"furrow://127.0.0.1:{daemon.ports['udp']}"
            tcp = f"furrow://127.0.0.1:{daemon.ports['tcp']}"
            player = spawn("play", PERFORMANCE, "--to", f"{tcp}?subject=ada&transport=tcp", "--loop")
            self.addCleanup(player.stdout.close)
            self.addCleanup(player.stderr.close)
            self.addCleanup(player.kill)
            query = "subject=ada&pattern=brow_%2a&rate=20"
            for address in (f"{udp}?{query}&transport=udp", f"{tcp}?{query}", f"{tcp}?{query}&transport=tcp"):
                seen = furrow("watch", address, "--wait", "--frames", 3, "--format", "csv", check=0)
                header = seen.stdout.decode().splitlines()[0].split(",")
                self.assertGreater(len(header), 2)
                self.assertTrue(all(name.startswith("brow_") for name in header[2:]), header)
            # An option wins over the address.
            seen = furrow("watch", f"{tcp}?{query}", "--pattern", "mouth_*", "--frames", 1, "--format", "csv", check=0)
            self.assertIn(",mouth_", seen.stdout.decode())
            with tempfile.TemporaryDirectory() as folder:
                take = pathlib.Path(folder, "take.mcap")
                furrow("record", f"{tcp}?subject=ada", "--out", take, "--duration", 0.3, check=0)
                self.assertRegex(furrow("info", take, check=0).stdout.decode(), r"\bada\b")
            furrow("load", udp, PERFORMANCE, "--duration", 0.2, "--subjects", 1, "--late", 60000, "--other-port",
                   daemon.ports["tcp"], check=0)
            player.send_signal(signal.SIGINT)
            self.assertEqual(player.wait(timeout=GUARD), 0)

    def test_wrong_addresses_are_wrong_usage(self):
        for command, address, message in (
                ("watch", "furrow://a?nonsense=1", "use subject, pattern, rate, transport, token or tls"),
                ("watch", "http://a", "use furrow://HOST"),
                ("watch", "furrow://a?key=x", "reserved"),
                ("watch", "furrow://a?token=x&token=x", "token is stated twice"),
                ("watch", "furrow://a?subject=b&subject=c", "a second subject"),
                ("record", "furrow://a?rate=5", "no use for rate"),
                ("frames", "furrow://a?transport=udp", "no use for transport=udp")):
            more = {"watch": [], "record": ["--out", "x.mcap"], "frames": ["--out", "-"]}[command]
            words = furrow(command, address, *more, check=2).stderr.decode()
            self.assertIn(message, words)
            self.assertIsNone(re.search(r"token=x", words), "secrets are not printed")


if __name__ == "__main__":
    unittest.main()
