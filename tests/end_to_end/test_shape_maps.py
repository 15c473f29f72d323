#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recordings whose blend shapes have other names than those of the rig."""
import pathlib
import tempfile
import unittest

from furrow_testing import furrow
from tracker_packets import livelink_csv

DONE, BAD_INPUT = 0, 3
ARKIT = ["browInnerUp", "mouthSmileLeft", "mouthSmileRight", "jawOpen", "browDownLeft", "browDownRight"]
CC4 = ["Brow_Raise_Inner_L", "Mouth_Smile_L", "Mouth_Smile_R", "Jaw_Open", "Brow_Drop_L", "Brow_Drop_R"]
PRESETS = ["Joy", "Angry", "Sorrow", "A", "Blink", "Fun"]


def csv(names):
    """Live Link Face's CSV: two frames; the shapes rise from 0 to a tenth of their place in the list."""
    return livelink_csv([{}, {name: round(0.1 * (i + 1), 1) for i, name in enumerate(names)}], names)


class ShapeMapsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def recording(self, names):
        path = self.root / f"{names[0]}.csv"
        path.write_text(csv(names))
        return path

    def solve(self, path, *options):
        return furrow("solve", path, "--rig", "arkit", "--allow-missing", "--no-filter", *options, check=DONE)

    def test_new_names_give_the_same_weights(self):
        own = self.solve(self.recording(ARKIT))
        other = self.solve(self.recording(CC4))
        self.assertNotIn("shape map", own.stderr.decode())
        self.assertIn("shape map 'cc4' to 'arkit': 6 of 48 blend shapes", other.stderr.decode())
        self.assertEqual(own.stdout, other.stdout)
        self.assertNotIn(b",1.000000", own.stdout.splitlines()[1])

    def test_presets_make_wrinkles(self):
        result = self.solve(self.recording(PRESETS))
        self.assertIn("shape map 'vrm0' to 'arkit'", result.stderr.decode())
        names, rest, raised = result.stdout.decode().splitlines()
        at = names.split(",").index("brow_l.stretch")  # Sorrow raises the inner brow
        self.assertEqual(float(rest.split(",")[at]), 0.0)
        self.assertGreater(float(raised.split(",")[at]), 0.02)

    def test_a_chosen_map_must_exist(self):
        message = furrow("solve", self.recording(PRESETS), "--rig", "arkit", "--shape-map", "nobody",
                         check=BAD_INPUT).stderr.decode()
        self.assertIn("nobody: no such file, and no shipped map of this name", message)

    def test_info_names_the_vocabulary(self):
        text = furrow("info", self.recording(PRESETS), check=DONE).stdout.decode()
        self.assertIn("'vrm0' knows 6 of 6 blend shapes", text)
        text = furrow("info", self.recording(["hat", "scarf", "glove"]), check=DONE).stdout.decode()
        self.assertIn("none fits", text)

    def test_a_proposal_is_a_valid_map_that_works(self):
        path = self.recording(PRESETS + ["hat"])
        mine = self.root / "mine.json"
        text = furrow("shape-map", "propose", path, "--out", mine, check=DONE).stdout.decode()
        self.assertIn("7 shapes, 6 with a formula", text)
        text = furrow("shape-map", "check", mine, check=DONE).stdout.decode()
        self.assertIn("shape map 'mine'", text)
        self.assertNotIn("warning", text)
        self.assertIn("shape map 'mine' to 'arkit'", self.solve(path, "--shape-map", mine).stderr.decode())

    def test_check_accepts_the_shipped_maps_and_names_faults(self):
        for name in ("arkit", "vrm0", "metahuman", "facs"):
            self.assertNotIn("warning", furrow("shape-map", "check", name, check=DONE).stdout.decode())
        bad = self.root / "bad.json"
        bad.write_text('{"version": 1, "name": "bad", "shapes": {"grin": "mouthSmirk"}}')
        message = furrow("shape-map", "check", bad, check=BAD_INPUT).stderr.decode()
        self.assertIn("'mouthSmirk' is not a blend shape of ARKit", message)


if __name__ == "__main__":
    unittest.main()
