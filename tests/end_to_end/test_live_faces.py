#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Face trackers drive faces of blend shapes and of joints: wrinkles, explanations, captures and pictures."""
import contextlib
import json
import pathlib
import subprocess
import tempfile
import unittest

from furrow_testing import BIN, GUARD, SHARE, Daemon, furrow, picture_difference, png_rows, solve
from tracker_packets import CURVES, livelink_csv, vmc
from wire_testing import Phone, Tracker

DONE = 0
FACE = ("brow_l", "brow_r", "glabella", "nose", "eye_l", "eye_r", "mouth_l", "mouth_r")
# The weights that a shape of the left side, or of both sides, raises.
RAISED = {
    "EyeSquintLeft": {"eye_l.squash"},
    "EyeWideLeft": {"eye_l.stretch"},
    "MouthPucker": {"mouth_l.squash", "mouth_r.squash"},
    "MouthSmileLeft": {"mouth_l.squash", "eye_l.squash"},
    "MouthFrownLeft": {"mouth_l.stretch"},
    "MouthStretchLeft": {"mouth_l.stretch"},
    "MouthShrugLower": {"mouth_l.stretch", "mouth_r.stretch"},
    "MouthUpperUpLeft": {"mouth_l.squash"},
    "BrowDownLeft": {"brow_l.squash", "glabella.squash"},
    "BrowInnerUp": {"brow_l.stretch", "brow_r.stretch", "glabella.stretch"},
    "BrowOuterUpLeft": {"brow_l.stretch"},
    "CheekSquintLeft": {"eye_l.squash"},
    "NoseSneerLeft": {"nose.squash", "glabella.squash", "mouth_l.squash"},
}
RAISED.update({name.replace("Left", "Right"): {weight.replace("_l.", "_r.") for weight in weights}
               for name, weights in RAISED.items() if name.endswith("Left")})

# A rig with a driver that knows two expressions of a phone.
RIG = {
    "name": "expressions",
    "reference_poses": [{"name": name, "shapes": [{"blend_shape": shape}]}
                        for name, shape in (("frown", "browDownLeft"), ("grin", "mouthSmileLeft"))],
    "drivers": [{"name": "face", "pose": {
        "points": [{"kind": "blend_shape", "blend_shape": shape}
                   for shape in ("browDownLeft", "browDownRight", "noseSneerLeft", "noseSneerRight",
                                 "mouthSmileLeft", "mouthSmileRight", "cheekSquintLeft", "cheekSquintRight")],
        "values": [{"name": name, "reference_pose": name} for name in ("frown", "grin")],
        "solve": "nnls"}}],
    "regions": [{"name": region, "mask": {"texture": "mask.png"}, "modulation": "linear",
                 "feeds": [{"map": "squash", "sources": [{"from": f"face.{value}"}]}]}
                for region, value in (("glabella", "frown"), ("mouth", "grin"))],
    "wrinkle_maps": [{"name": "squash"}],
}
FROWN = {"BrowDownLeft": 0.7, "BrowDownRight": 0.6, "NoseSneerLeft": 0.4, "CheekSquintLeft": 0.1}
GRIN = {"MouthSmileLeft": 0.8, "MouthSmileRight": 0.8, "CheekSquintLeft": 0.5, "CheekSquintRight": 0.5}
SMALL = {"width": 96, "height": 96}


def recording(path, frames):
    """Writes a CSV of Live Link Face with the given frames of curves."""
    path.write_text(livelink_csv(frames))
    return path


class LiveFacesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = pathlib.Path(folder.name)
        cls.avatar = cls.root / "avatar.glb"
        subprocess.run([BIN / "furrow-make-character", "--out", cls.avatar, "--face", "blend-shapes",
                        "--level", "0", "--texture-size", "256"], check=True, timeout=GUARD)

    @contextlib.contextmanager
    def phone(self, *args):
        with Daemon("--http", "0", "--livelink-face", "0", *args) as daemon, contextlib.closing(Phone(daemon)) as phone:
            phone.face()  # neutral
            yield phone

    def draw(self, name, *args):
        """Returns the pictures of `furrow render` without wrinkles, which show the surface alone."""
        out = self.root / name
        furrow("render", *args, "--out", out, "--size", "96x96", "--wrinkles", "off", check=DONE)
        return [png_rows(picture.read_bytes()) for picture in sorted(out.iterdir())]

    def test_each_shape_folds_its_region_and_is_named(self):
        with self.phone("--character", self.avatar, "--no-render") as phone:
            names = [weight["name"] for region in phone.api.get("/api/rig")["regions"] if region["name"] in FACE
                     for weight in region["weights"]]
            self.assertEqual(len({name.split(".")[0] for name in names}), len(FACE))
            for curve in CURVES[:52]:
                with self.subTest(curve):
                    phone.face(**{curve: 1.0})
                    raised = set()
                    for name in names:
                        explanation = phone.explain(name)
                        if explanation["result"] < 0.1:
                            self.assertLess(explanation["result"], 0.02, name)
                            continue
                        raised.add(name)
                        shapes = {shape["name"].lower(): shape["coefficient"]
                                  for part in explanation["contributions"] if part["driver_value"] > 0.1
                                  for shape in part["blend_shapes"]}
                        self.assertEqual(shapes, {curve.lower(): 1.0}, name)
                    self.assertEqual(raised, RAISED.get(curve, set()))

    def test_a_phone_captures_reference_poses(self):
        rig = self.root / "expressions.rig.json"
        rig.write_text(json.dumps(RIG))
        with self.phone("--rig", rig, "--no-render") as phone:
            for name, weight, shapes in (("frown", "glabella.squash", FROWN), ("grin", "mouth.squash", GRIN)):
                phone.face(**shapes)
                before = phone.explain(weight)["result"]
                self.assertLess(before, 0.9)
                reply = phone.api.post("/api/capture", {"subject": "phone", "pose": name})
                self.assertFalse(reply["added"])
                self.assertGreater(phone.explain(weight)["result"], 0.999)
            # Each pose alone, then half of both.
            rows = [FROWN, GRIN, {k: 0.5 * (FROWN.get(k, 0) + GRIN.get(k, 0)) for k in {**FROWN, **GRIN}}, {}]
            for shapes, frown, grin in zip(rows, (1, 0, 0.5, 0), (0, 1, 0.5, 0)):
                phone.face(**shapes)
                self.assertAlmostEqual(phone.explain("glabella.squash")["result"], frown, delta=1e-3)
                self.assertAlmostEqual(phone.explain("mouth.squash")["result"], grin, delta=1e-3)
            captured = self.root / "captured.rig.json"
            captured.write_text(json.dumps(phone.api.get("/api/rig.json")))
        furrow("rig", "check", captured, check=DONE)
        take = recording(self.root / "faces.csv", rows)
        weights = solve(take, "--rig", captured, "--no-filter")
        self.assertEqual([round(x, 3) for x in weights.column("glabella.squash").values()], [1, 0, 0.5, 0])
        text = furrow("rig", "explain", captured, take, "--frame", 0, check=DONE).stdout.decode()
        self.assertIn("BrowDownLeft 0.70, browDownRight 0.60".lower(), text.lower())
        # The face of the avatar takes the pose, and half of the pose half as far.
        look = ("--character", self.avatar, "--rig", captured, "--camera", "face")
        neutral, half, full = (self.draw(pose, "--pose", pose, *look)[0] for pose in ("neutral", "grin=0.5", "grin"))
        moved = picture_difference(neutral, full)
        self.assertGreater(moved, 0.5)
        self.assertLess(picture_difference(neutral, half), moved)
        self.assertGreater(picture_difference(neutral, half), 0.2 * moved)

    def test_head_yaw_turns_the_head(self):
        take = recording(self.root / "yaw.csv", [{}, {"HeadYaw": 0.5}, {"HeadYaw": -0.5}])
        # Depths have no light, which would come from one side.
        ahead, left, right = self.draw("yaw", take, "--character", self.avatar, "--view", "depth")
        mirrored = [row[::-1] for row in right]
        self.assertGreater(picture_difference(ahead, left), 4 * picture_difference(mirrored, left))
        with self.phone("--character", self.avatar) as phone:
            still = png_rows(phone.api.snapshot("phone", view="depth", **SMALL))
            phone.face(HeadYaw=0.5)
            turned = png_rows(phone.api.snapshot("phone", view="depth", **SMALL))
        self.assertGreater(picture_difference(still, turned), 0.5 * picture_difference(ahead, left))

    def test_presets_over_vmc_move_the_default_character(self):
        # The tracker sends each face once, and its subject would leave while a busy computer loads the character.
        with Daemon("--http", "0", "--vmc", "0", "--require-render") as daemon, contextlib.closing(Tracker(daemon, "vmc")) as tracker:
            pictures = {}
            for preset in ("Neutral", "Joy", "A", "Blink"):
                values = {name: name == preset for name in ("Joy", "Angry", "Sorrow", "Fun", "A", "Blink")}
                tracker.show(lambda _: vmc(values))
                pictures[preset] = png_rows(tracker.api.snapshot("", wrinkles="off", **SMALL))
        for preset in ("Joy", "A", "Blink"):
            with self.subTest(preset):
                self.assertGreater(picture_difference(pictures["Neutral"], pictures[preset]), 0.1)


if __name__ == "__main__":
    unittest.main()
