#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A performance by joints on a face of blend shapes: the shapes and the wrinkles follow."""
import pathlib
import subprocess
import tempfile
import unittest

from furrow_testing import BIN, GUARD, SHARE, Daemon, Table, finish, furrow, solve, spawn_watch, worst_difference

DONE = 0
ANGER = SHARE / "recordings" / "anger.bvh"


class JointedFacesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.avatar = pathlib.Path(folder.name) / "avatar.glb"
        subprocess.run([BIN / "furrow-make-character", "--out", cls.avatar, "--face", "blend-shapes",
                        "--level", "0", "--texture-size", "256"], check=True, timeout=GUARD)

    def test_wrinkles_are_those_of_the_jointed_face(self):
        jointed = solve(ANGER, "--rig", SHARE / "default.rig.json", "--no-filter")
        shaped = solve(ANGER, "--rig", self.avatar, "--no-filter")
        for name in ("glabella.squash", "brow_l.squash", "brow_r.squash"):
            with self.subTest(name):
                wanted, found = max(jointed.column(name).values()), max(shaped.column(name).values())
                self.assertGreater(wanted, 0.4)
                self.assertGreater(found, 0.6 * wanted)
        self.assertLess(max(shaped.column("brow_l.stretch").values()), 0.2)  # nothing raises the brow

    def test_explain_names_the_shapes(self):
        text = furrow("rig", "explain", self.avatar, ANGER, "--frame", 60, check=DONE).stdout.decode()
        self.assertIn("browDownLeft", text)

    def test_the_daemon_agrees_with_and_without_pictures(self):
        expected = solve(ANGER, "--rig", self.avatar)
        for args in (("--no-render",), ()):
            with self.subTest(args), Daemon("--character", self.avatar, *args) as daemon:
                watcher = spawn_watch(daemon.tcp, "ada")
                furrow("play", ANGER, "--to", daemon.tcp, "--tcp", "--subject", "ada", "--speed", 8, check=DONE)
                seen = Table(finish(watcher)[1].decode())
                worst, frames = worst_difference(seen, expected)
                self.assertGreater(frames, 0)
                self.assertLess(worst, 1e-3)


if __name__ == "__main__":
    unittest.main()
