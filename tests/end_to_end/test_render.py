#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`furrow render`: settings that round-trip, and machines without OpenGL."""
import os
import pathlib
import subprocess
import tempfile
import unittest

from furrow_testing import BIN, GUARD, SHARE, Daemon, Table, finish, furrow, solve, spawn_watch, worst_difference

ANGER = SHARE / "recordings" / "anger.bvh"
NO_DRIVER = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"}


class RenderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def draw(self, name, *args):
        out = self.root / name
        furrow("render", ANGER, "--out", out, "--frames", "30:30", "--size", "128x128", *args, check=0)
        return [picture.read_bytes() for picture in out.iterdir()]

    def test_printed_settings_draw_the_same_picture(self):
        look = self.root / "look.toml"
        look.write_bytes(furrow("render", "--print-settings", check=0).stdout)
        self.assertEqual(self.draw("as_printed", "--settings", look, "--shading", "skin"),
                         self.draw("by_default", "--shading", "skin"))

    def test_an_invalid_value_is_wrong_usage_and_lists_the_valid_ones(self):
        for args, says in ((("--set", "view=foo"), "mask_texture"), (("--view", "foo"), "mask_texture"),
                           (("--camera", "foo"), "three_quarter"), (("--set", "foo.bar=1"), "--print-settings"),
                           (("--set", "lights.keys=1,1,1"), "lights.key"), (("--set", "bloom.strength=nan"), "[0,")):
            with self.subTest(args):
                result = furrow("render", ANGER, "--out", self.root / "none", *args, check=2)
                self.assertIn(says, result.stderr.decode())
                self.assertFalse((self.root / "none").exists())

    def test_a_character_without_its_rig_is_drawn_and_the_warning_names_the_rig(self):
        alone = self.root / "alone.glb"
        alone.write_bytes((SHARE / "default.glb").read_bytes())
        out = self.root / "out"
        result = furrow("render", ANGER, "--character", alone, "--out", out, "--frames", "30:30", "--size", "64x64",
                        check=0)
        self.assertIn(f"no rig {self.root / 'alone.rig.json'}", result.stderr.decode())
        self.assertEqual(len(list(out.iterdir())), 1)
        with_rig = furrow("render", ANGER, "--character", alone, "--rig", "default", "--out", out, "--frames", "30:30",
                          "--size", "64x64", check=0)
        self.assertNotIn("without wrinkles", with_rig.stderr.decode())

    def test_without_opengl_the_daemon_still_serves_weights(self):
        result = furrow("render", ANGER, "--out", self.root / "none", env=NO_DRIVER, check=1)
        self.assertIn("no EGL driver", result.stderr.decode())
        required = subprocess.run([BIN / "furrowd", "--tcp", "0", "--udp", "0", "--require-render"],
                                  env={**os.environ, **NO_DRIVER}, capture_output=True, timeout=GUARD)
        self.assertEqual(required.returncode, 1, required.stderr.decode())
        with Daemon(env=NO_DRIVER) as daemon:
            self.assertIn("render=off", daemon.ready)
            watcher = spawn_watch(daemon.tcp, "ada")
            furrow("play", ANGER, "--to", daemon.tcp, "--tcp", "--subject", "ada", "--speed", 8, check=0)
            seen = Table(finish(watcher)[1].decode())
        worst, frames = worst_difference(seen, solve(ANGER, "--rig", SHARE / "default.rig.json"))
        self.assertGreater(frames, 0)
        self.assertLess(worst, 1e-3)


if __name__ == "__main__":
    unittest.main()
