# SPDX-License-Identifier: Apache-2.0
"""Shared by the recording tests: a daemon that records, takes in a folder, the independent reader."""
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from furrow_testing import BIN, GUARD, SHARE, SOURCE, Daemon, Table, furrow, spawn

PERFORMANCE = SHARE / "recordings" / "performance.bvh"
RIG = SHARE / "default.rig.json"
INTEROP = SOURCE / "tests" / "mcap_interop"


class Recording(Daemon):
    """A daemon that records to a folder."""

    def __init__(self, folder, *args):
        super().__init__("--no-render", "--record", folder, *args)
        self.folder = pathlib.Path(folder)

    def takes(self):
        return sorted(self.folder.glob("*.mcap"))


def missing_interop():
    """Returns what is missing to run the independent reader; empty if nothing is missing."""
    if shutil.which("node") is None:
        return "node is absent: install what deploy/packages.txt lists"
    if not (INTEROP / "node_modules").exists():
        return "npm's @mcap/core is absent: run deploy/install-deps.sh test"
    return ""


def lines_of(*command):
    result = subprocess.run([*map(str, command)], capture_output=True, timeout=GUARD)
    assert result.returncode == 0, result.stderr.decode()
    return result.stdout.decode().splitlines()


def our_messages(take):
    """Returns one line per message and attachment found by Furrow's reader."""
    return lines_of(BIN / "mcap-dump", take)


def their_messages(take, *options):
    """Like our_messages(), with the independent reader @mcap/core. "--cut": the writer was killed."""
    return lines_of("node", INTEROP / "read.mjs", *options, take)


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def record(self, *play, name="takes", recording=PERFORMANCE):
        """Plays to a recording daemon, stops it cleanly and returns its only take."""
        with Recording(self.root / name) as daemon:
            furrow("play", recording, "--to", daemon.udp, "--subject", "ada", *play, check=0)
        takes = daemon.takes()
        self.assertEqual(len(takes), 1)
        return takes[0]

    def weights(self, take):
        out = self.root / "weights.csv"
        furrow("convert", take, out, "--weights", check=0)
        return Table(out.read_text())

    def count(self, take, what):
        text = furrow("info", take, check=0).stdout.decode()
        return int(re.search(rf"{what} +(\d+)", text).group(1))

    def listen(self, daemon, out, *args):
        """Starts recording and waits until the daemon has answered."""
        recorder = spawn("record", daemon.tcp, "--out", out, *args)
        self.addCleanup(recorder.stderr.close)
        self.addCleanup(recorder.stdout.close)
        self.addCleanup(recorder.kill)
        deadline = time.monotonic() + GUARD
        while not out.exists() and recorder.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        self.assertIsNone(recorder.poll(), "the recorder is running")
        return recorder

    def end(self, recorder):
        """Sends Ctrl-C and returns the standard error."""
        recorder.send_signal(signal.SIGINT)
        recorder.wait(timeout=GUARD)
        words = recorder.stderr.read().decode()
        self.assertEqual(recorder.returncode, 0, words)
        return words

    def kill_in_the_middle(self, recorder, take):
        """Kills the recorder when about one second of data is on the disk."""
        begin = take.stat().st_size
        deadline = time.monotonic() + GUARD
        while take.stat().st_size < begin + 40000 and time.monotonic() < deadline:
            time.sleep(0.05)
        recorder.kill()
        recorder.communicate(timeout=GUARD)

    def what_a_killed_daemon_leaves(self):
        """Returns the take of a daemon that was killed while recording."""
        daemon = Recording(self.root / "killed")
        daemon.__enter__()
        player = spawn("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", "ada", "--loop", "--once")
        take = daemon.takes()[0]
        self.kill_in_the_middle(daemon.process, take)
        player.communicate(timeout=GUARD)
        return take

    def what_a_killed_recorder_leaves(self):
        """Returns the take of a `furrow record` process that was killed."""
        take = self.root / "killed.mcap"
        with Daemon("--no-render") as daemon:
            player = spawn("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", "ada", "--loop")
            self.kill_in_the_middle(self.listen(daemon, take, "--subject", "ada", "--wait"), take)
            player.send_signal(signal.SIGINT)
            player.communicate(timeout=GUARD)
        return take
