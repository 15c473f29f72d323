#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""furrow export, and furrow rig check --export, with the shipped character and rigs."""
import json
import pathlib
import tempfile
import unittest

from furrow_testing import SHARE, furrow, png_size

# Its pictures do not exist.
BARE_RIG = """{"name": "bare", "drivers": [{"name": "frown", "blend_shape": {"blend_shape": "browDownLeft"}}],
  "regions": [{"name": "brow", "mask": {"texture": "no_mask", "channel": "r"},
               "feeds": [{"map": "squash", "sources": [{"from": "frown.value"}]}]}],
  "wrinkle_maps": [{"name": "squash", "normal": "no_normal"}]}"""
DONE, WRONG_USAGE, BAD_INPUT, FAILED = 0, 2, 3, 1


class Export(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def error(self, code, *args):
        return furrow("export", *args, check=code).stderr.decode()

    def test_default_character(self):
        out = self.root / "face"
        furrow("export", "--for", "unreal", "--out", out, check=DONE)
        wrinkles = json.loads((out / "wrinkles.json").read_text())
        self.assertEqual((wrinkles["engine"], wrinkles["normals"]), ("unreal", {"green": "down", "bits": 8}))
        weights = [w["name"] for w in wrinkles["weights"]]
        solved = furrow("solve", SHARE / "recordings" / "walk.bvh", "--rig", "default", check=DONE).stdout.decode()
        self.assertEqual(weights, solved.splitlines()[0].split(",")[2:])  # the order of the stream
        self.assertTrue(all(w["map"] is not None for w in wrinkles["weights"]))
        files = [f for m in wrinkles["maps"] for f in (m["normal"], m["height"])] + [m["file"] for m in wrinkles["masks"]]
        for name in files:
            self.assertGreaterEqual(min(png_size((out / name).read_bytes())), 512, name)
        # Three maps of one joint, each with its angles.
        knee = [w["drivers"]["angles"] for w in wrinkles["weights"] if w["region"] == "knee_l_inner"]
        self.assertEqual(len(knee), 3)
        self.assertEqual(wrinkles["weights"][1]["names"]["metahuman"],
                         ["head_wm2_normal_head_wm2_browsDown_L", "head_cm2_color_head_wm2_browsDown_L"])

    def test_derivative_maps_come_beside_the_normal_maps(self):
        out = self.root / "face"
        furrow("export", "--derivatives", "--out", out, check=DONE)
        wrinkles = json.loads((out / "wrinkles.json").read_text())
        self.assertEqual(wrinkles["derivatives"], {"green": "up", "bits": 16})
        for of, normal, derivative in [(m, "normal", "derivative") for m in wrinkles["maps"]] + [
                (m, "base_normal", "base_derivative") for m in wrinkles["materials"]]:
            self.assertEqual(png_size((out / of[normal]).read_bytes()), png_size((out / of[derivative]).read_bytes()))
            self.assertGreater(of[derivative + "_scale"], 0.1)
        self.assertIn("## Derivative maps", (out / "README.md").read_text())

    def test_wrong_use_says_what_is_valid(self):
        self.assertIn("'maya' is not one of", self.error(WRONG_USAGE, "--for", "maya", "--out", self.root / "a"))
        self.assertIn("--out is required", self.error(WRONG_USAGE, "--for", "unity"))
        self.assertIn("'12' is not one of 8|16", self.error(WRONG_USAGE, "--bits", "12", "--out", self.root / "a"))

    def test_bad_input_leaves_nothing_behind(self):
        out = self.root / "out"
        self.assertIn("missing.glb", self.error(BAD_INPUT, self.root / "missing.glb", "--out", out))
        rig = self.root / "bare.json"
        rig.write_text(BARE_RIG)
        message = self.error(BAD_INPUT, "default", "--rig", rig, "--out", out)  # a shipped name
        self.assertIn("no wrinkle weight can be drawn; map 'squash' has no picture", message)
        self.assertIn("furrow bake", message)
        self.assertEqual(list(self.root.iterdir()), [rig])

    def test_a_foreign_readme_stays(self):
        out = self.root / "project"
        out.mkdir()
        (out / "README.md").write_text("mine")
        message = self.error(BAD_INPUT, "--out", out)
        self.assertIn("the folder has a README.md", message)
        self.assertIn("--out", message)
        self.assertEqual([path.read_text() for path in out.iterdir()], ["mine"])
        (out / "wrinkles.json").write_text("{}")  # an earlier export is replaced
        furrow("export", "--out", out, check=DONE)
        self.assertIn("# Wrinkles for", (out / "README.md").read_text())

    def test_unwritable_folder(self):
        (self.root / "file").write_text("")
        self.assertIn("file", self.error(FAILED, "--out", self.root / "file" / "out"))

    def test_rig_check_lists_what_a_profile_covers(self):
        text = furrow("rig", "check", "arkit", "--export", "metahuman", check=DONE).stdout.decode()
        self.assertIn("head_wm2_normal_head_wm2_browsDown_L <- brow_l.squash", text)
        self.assertIn("names without a weight:\n", text)
        self.assertIn("weights without a name:\n", text)

    def test_rig_check_takes_files_and_refuses_unknown_profiles(self):
        profile = self.root / "own.json"
        profile.write_text('{"version": 1, "name": "own", "names": {"Frown": "brow_l.squash"}}')
        text = furrow("rig", "check", "arkit", "--export", profile, check=DONE).stdout.decode()
        self.assertIn("export profile 'own': 1 of 1 name covered", text)
        message = furrow("rig", "check", "arkit", "--export", "maya", check=BAD_INPUT).stderr.decode()
        self.assertIn("there is no export profile 'maya'", message)
        self.assertIn("arkit, character_creator, metahuman", message)


if __name__ == "__main__":
    unittest.main()
