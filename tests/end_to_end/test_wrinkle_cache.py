# SPDX-License-Identifier: Apache-2.0
"""Wrinkles composed once in a texture look like wrinkles composed in every fragment."""
import pathlib
import tempfile
import unittest

from furrow_testing import SHARE, furrow, png_channels


def hold(recording, frame, path):
    """Writes a recording that repeats one frame of another: a held pose is composed at any picture size."""
    lines = (SHARE / "recordings" / recording).read_text().splitlines()
    motion = next(i for i, line in enumerate(lines) if line.startswith("Frames:"))
    pose = lines[motion + 2 + frame]
    path.write_text("\n".join([*lines[:motion], "Frames: 2", lines[motion + 1], pose, pose, ""]))


class WrinkleCacheTest(unittest.TestCase):
    def picture(self, recording, frame, camera, *settings):
        """Returns a picture, and whether wrinkles were composed in a texture for it."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            hold(recording, frame, folder / "held.bvh")
            sets = [word for setting in ("mask_mode=dynamic", *settings) for word in ("--set", setting)]
            result = furrow("render", folder / "held.bvh", "--out", folder, "--size", "320x320", "--camera", camera,
                            "--view", "normal", "--timings", *sets, check=0)
            composed = b"wrinkles" in result.stdout + result.stderr
            return png_channels(sorted(folder.glob("*.png"))[-1].read_bytes()), composed

    def compare(self, *what):
        cached, composed = self.picture(*what)
        whole, other = self.picture(*what, "wrinkle_maps.cache=off")
        bare, _ = self.picture(*what, "wrinkles=off")
        self.assertTrue(composed)
        self.assertFalse(other)
        apart = [abs(a - b) for a, b in zip(cached, whole)]
        wrinkles = [abs(a - b) for a, b in zip(whole, bare)]
        self.assertGreater(sum(wrinkles) / len(wrinkles), 0.05)
        self.assertLess(sum(apart), 0.1 * sum(wrinkles))
        self.assertLess(sum(value > 8 for value in apart) / len(apart), 2e-3)

    def test_clothes_of_a_squat(self):
        self.compare("squat.bvh", 60, "body_side")

    def test_a_face(self):
        self.compare("performance.bvh", 300, "face")


if __name__ == "__main__":
    unittest.main()
