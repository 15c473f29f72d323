#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""VMC input from oscsend, Live Link Face input from an encoder in this test, OSC output to oscdump."""
import itertools
import select
import shutil
import socket
import subprocess
import unittest

from furrow_testing import SOURCE, Daemon, Table, finish, free_port, spawn
from tracker_packets import livelink_face

ARKIT = SOURCE / "rig" / "rigs" / "arkit.json"


class ForeignWireTest(unittest.TestCase):
    def row_with(self, watcher, send, wanted):
        """Sends until the watcher has printed a row for which `wanted(table)` is true, and returns the table."""
        lines = [watcher.stdout.readline().decode()]
        self.assertTrue(lines[0].startswith("frame,time"), lines)
        for _ in range(400):
            send()
            line = watcher.stdout.readline().decode()
            self.assertTrue(line, "the watcher ended")
            table = Table(lines[0] + line)
            if wanted({n: table.column(n) for n in table.names}):
                return table
        self.fail("the weights never rose")

    def phone(self, daemon, shapes, frame=0):
        """Returns a function that sends the next frame of a phone after `frame`."""
        out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(out.close)
        frames = itertools.count(frame + 1)
        return lambda: out.sendto(livelink_face("phone", next(frames), shapes), ("127.0.0.1", daemon.ports["livelink_face"]))

    def test_livelink_face_raises_the_right_weights(self):
        with Daemon("--rig", ARKIT, "--livelink-face", "0") as daemon:
            send = self.phone(daemon, {"BrowInnerUp": 1.0, "MouthSmileLeft": 0.9})

            send()
            watcher = spawn("watch", daemon.tcp, "--subject", "phone", "--wait", "--format", "csv")
            self.keep_sending_until_header(watcher, send)
            table = self.row_with(watcher, send, lambda w: max(w["brow_l.stretch"].values()) > 0.3)
            row = {n: list(table.column(n).values())[0] for n in table.names}
            watcher.terminate()
            self.assertEqual(finish(watcher)[0], 0)
        self.assertEqual(len(livelink_face("x" * 13, 1, {})), 319)
        self.assertGreater(row["brow_r.stretch"], 0.3)
        self.assertGreater(max(row["mouth_l.squash"], row["mouth_l.stretch"]), 0.2)
        self.assertLess(max(row["mouth_r.squash"], row["mouth_r.stretch"]), 0.1)
        self.assertLess(row["glabella.squash"], 0.05)

    def test_a_phone_on_the_default_character_lacks_nothing(self):
        # Its rig also reads joints, which a phone has none of.
        with Daemon("--no-render", "--livelink-face", "0") as daemon:
            watcher = spawn("watch", daemon.tcp, "--wait", "--format", "csv")
            send = self.phone(daemon, {"JawOpen": 0.5})

            self.keep_sending_until_header(watcher, send)
            watcher.terminate()
            finish(watcher)
        self.assertIn("phone", daemon.stderr)
        self.assertNotIn("lacks", daemon.stderr)
        self.assertNotIn("missing", daemon.stderr)

    def test_watch_prints_the_timecode_of_a_phone(self):
        with Daemon("--no-render", "--livelink-face", "0") as daemon:
            watcher = spawn("watch", daemon.tcp, "--wait", "--format", "csv", "--timecode")
            send = self.phone(daemon, {"JawOpen": 0.5}, frame=3600)

            self.keep_sending_until_header(watcher, send)
            header = watcher.stdout.readline().decode().strip().split(",")
            send()
            row = watcher.stdout.readline().decode().strip().split(",")
            watcher.terminate()
            finish(watcher)
        self.assertEqual(header[-1], "timecode")
        self.assertEqual(len(row), len(header))
        # A minute at 60 frames per second has passed since midnight.
        self.assertRegex(row[-1], r"^00:01:\d\d:\d\d$")

    def keep_sending_until_header(self, watcher, send):
        """Sends first frames until the subject exists, because early datagrams may be lost."""
        for _ in range(2000):
            send()
            if select.select([watcher.stdout], [], [], 0.02)[0]:
                return
        self.fail("the subject never appeared")

    @unittest.skipUnless(shutil.which("oscsend"), "liblo-tools is not installed")
    def test_oscsend_into_vmc(self):
        with Daemon("--rig", ARKIT, "--vmc", "0") as daemon:
            port = str(daemon.ports["vmc"])

            def send():
                for address, *args in (("/VMC/Ext/OK", "i", "1"),
                                       ("/VMC/Ext/Blend/Val", "sf", "browDownLeft", "1.0"),
                                       ("/VMC/Ext/Blend/Val", "sf", "browDownRight", "1.0"),
                                       ("/VMC/Ext/Blend/Apply",)):
                    subprocess.run(["oscsend", "localhost", port, address, *args], check=True)

            watcher = spawn("watch", daemon.tcp, "--wait", "--format", "csv")
            self.keep_sending_until_header(watcher, send)
            table = self.row_with(watcher, send, lambda w: max(w["glabella.squash"].values()) > 0.3)
            row = {n: list(table.column(n).values())[0] for n in table.names}
            watcher.terminate()
            finish(watcher)
        self.assertLess(row["mouth_l.squash"], 0.05)

    @unittest.skipUnless(shutil.which("oscdump"), "liblo-tools is not installed")
    def test_oscdump_reads_our_osc_output(self):
        port = free_port(socket.SOCK_DGRAM)
        dump = subprocess.Popen(["oscdump", "-L", str(port)], stdout=subprocess.PIPE)
        self.addCleanup(dump.stdout.close)
        self.addCleanup(dump.wait)
        self.addCleanup(dump.kill)
        with Daemon("--rig", ARKIT, "--livelink-face", "0", "--osc-out", f"127.0.0.1:{port}") as daemon:
            out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            for frame in range(2000):
                out.sendto(livelink_face("phone", frame, {"NoseSneerLeft": 1.0}),
                           ("127.0.0.1", daemon.ports["livelink_face"]))
                if select.select([dump.stdout], [], [], 0.02)[0]:
                    break
            lines = [dump.stdout.readline().decode()]
            while "/furrow/phone/frame" not in lines[-1]:
                lines.append(dump.stdout.readline().decode())
                self.assertTrue(lines[-1], "oscdump ended")
        weights = [l for l in lines if "/furrow/phone/" in l and " f " in l]
        self.assertTrue(weights, lines)
        for line in weights:
            self.assertTrue(0.0 <= float(line.split()[-1]) <= 1.0, line)
        # The last message but one of a frame.
        self.assertRegex(lines[-2], r'/furrow/phone/timecode s "00:00:\d\d:\d\d"')


if __name__ == "__main__":
    unittest.main()
