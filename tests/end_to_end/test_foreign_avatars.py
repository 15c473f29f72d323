#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""An avatar as others make them: parts with 52 shapes each, unknown names, compressed and quantised by gltfpack.

fixtures/make_avatar.py made it. One command gives it a face that folds where its shapes move it.
"""
import json
import pathlib
import tempfile
import unittest

from furrow_testing import Table, furrow
from tracker_packets import livelink_csv

DONE = 0
AVATAR = pathlib.Path(__file__).resolve().parent / "fixtures" / "avatar.glb"
HELD = 30  # frames that each expression is held, for the filter
EXPRESSIONS = {  # ARKit's shapes, and the weights that they raise above 0.5
    "neutral": ({}, set()),
    "surprise": ({"BrowInnerUp": 1, "BrowOuterUpLeft": 1, "BrowOuterUpRight": 1, "EyeWideLeft": 1, "EyeWideRight": 1},
                 {"brow_l.stretch", "brow_r.stretch", "glabella.stretch", "eye_l.stretch", "eye_r.stretch"}),
    "anger": ({"BrowDownLeft": 1, "BrowDownRight": 1}, {"brow_l.squash", "brow_r.squash", "glabella.squash"}),
    "sneer": ({"NoseSneerLeft": 1, "NoseSneerRight": 1},
              {"nose.squash", "glabella.squash", "mouth_l.squash", "mouth_r.squash"}),
    "wink": ({"CheekSquintLeft": 1}, {"eye_l.squash"}),
    "smile": ({"MouthSmileLeft": 1, "MouthSmileRight": 1}, {"mouth_l.squash", "mouth_r.squash"}),
    "frown": ({"MouthFrownLeft": 1, "MouthFrownRight": 1}, {"mouth_l.stretch", "mouth_r.stretch"}),
    "pucker": ({"MouthPucker": 1}, {"mouth_l.squash", "mouth_r.squash"})}


def csv():
    """Live Link Face's CSV: each expression in turn."""
    names = sorted({name for shapes, _ in EXPRESSIONS.values() for name in shapes})
    return livelink_csv([shapes for shapes, _ in EXPRESSIONS.values() for _ in range(HELD)], names)


class ForeignAvatarTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = pathlib.Path(folder.name)
        cls.package = cls.root / "package.glb"
        cls.take = cls.root / "take.csv"
        cls.take.write_text(csv())
        cls.log = furrow("character", "import", AVATAR, "--texture-size", 256, "--out", cls.package, check=DONE).stderr.decode()

    def test_the_import_finds_the_face(self):
        self.assertIn("shape map 'arkit': 51 of 51 blend shapes", self.log)
        self.assertIn("tongueOut", self.log)  # the only shape that moves nothing
        self.assertNotIn("warning", self.log)
        rig = json.loads(self.package.with_suffix(".rig.json").read_text())
        self.assertEqual([r["name"] for r in rig["regions"]],
                         ["brow_l", "brow_r", "glabella", "nose", "eye_l", "eye_r", "mouth_l", "mouth_r"])

    def test_the_package_passes_its_check(self):
        report = json.loads(furrow("character", "check", self.package, "--json", check=DONE).stdout)
        self.assertEqual([f for f in report["findings"] if f["severity"] != "note"], [])

    def test_weights_follow_the_stream(self):
        solved = Table(furrow("solve", self.take, "--rig", self.package.with_suffix(".rig.json"), "--allow-missing",
                              check=DONE).stdout.decode())
        weights = [name for name in solved.names if "." in name]
        for i, (expression, (_, raised)) in enumerate(EXPRESSIONS.items()):
            frame = (i + 1) * HELD - 1
            found = {name for name in weights if solved.column(name)[frame] > 0.5}
            self.assertEqual(found, raised, expression)

    def test_only_expressions_fold(self):
        def picture(frame, wrinkles):
            out = self.root / f"{frame}_{wrinkles}"
            furrow("render", self.take, "--character", self.package, "--wrinkles", wrinkles, "--size", "200x200", "--frames",
                   f"{frame}:{frame}", "--out", out, check=DONE)
            return (out / f"{frame:06}.png").read_bytes()
        self.assertEqual(picture(HELD - 1, "on"), picture(HELD - 1, "off"))
        self.assertNotEqual(picture(2 * HELD - 1, "on"), picture(2 * HELD - 1, "off"))


if __name__ == "__main__":
    unittest.main()
