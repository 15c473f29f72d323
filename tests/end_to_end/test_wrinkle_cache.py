# SPDX-License-Identifier: Apache-2.0
"""Wrinkles composed once in a texture look like wrinkles composed in every fragment."""
import pathlib
import tempfile
import unittest
import zlib

from furrow_testing import SHARE, furrow, png_size


def pixels(path):
    """Returns the pixels of an RGB PNG, row by row."""
    data = path.read_bytes()
    width, height = png_size(data)
    packed, at = b"", 8
    while at < len(data):
        length = int.from_bytes(data[at:at + 4], "big")
        if data[at + 4:at + 8] == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, stride = zlib.decompress(packed), 3 * width
    assert len(raw) == (stride + 1) * height, "not RGB of 8 bits"
    above, rows = bytes(stride), bytearray()
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left, corner = (row[x - 3], above[x - 3]) if x >= 3 else (0, 0)
            guess = left + above[x] - corner
            nearest = min((left, above[x], corner), key=lambda value: abs(guess - value))
            row[x] = (row[x] + (0, left, above[x], (left + above[x]) // 2, nearest)[kind]) & 255
        rows += row
        above = row
    return rows


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
            return pixels(sorted(folder.glob("*.png"))[-1]), composed

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
