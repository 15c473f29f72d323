#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recordings without some joints of a rig: drawn with a warning, solved with --allow-missing."""
import pathlib
import tempfile
import unittest

from furrow_testing import SHARE, furrow, png_size

DONE, BAD_INPUT = 0, 3
RIG = SHARE / "default.rig.json"
# CMU's skeleton, which has no face: name, parent, offset in inches.
JOINTS = (("Hips", None, (0, 17, 0)), ("LowerBack", "Hips", (0, 0.1, 0)), ("Spine", "LowerBack", (0, 2, 0)),
          ("Spine1", "Spine", (0, 2, 0)), ("Neck", "Spine1", (0, 3, 0)), ("Neck1", "Neck", (0, 1, 0)),
          ("Head", "Neck1", (0, 1.5, 0)),
          *((side + name, side + parent if parent in ("UpLeg", "Leg", "Shoulder", "Arm", "ForeArm") else parent,
             (sign * x, y, z))
            for side, sign in (("Left", 1), ("Right", -1))
            for name, parent, (x, y, z) in (("UpLeg", "Hips", (1.5, -1, 0)), ("Leg", "UpLeg", (0, -7, 0)),
                                            ("Foot", "Leg", (0, -7, 0)), ("Shoulder", "Spine1", (0.5, 2, 0)),
                                            ("Arm", "Shoulder", (2.5, 0, 0)), ("ForeArm", "Arm", (5, 0, 0)),
                                            ("Hand", "ForeArm", (3.5, 0, 0)))))


def bvh(joints):
    """Writes a BVH with two frames in which the second-last joint rotates."""
    lines = ["HIERARCHY"]

    def write(name, offset, root):
        places = "6 Xposition Yposition Zposition" if root else "3"
        lines.extend([("ROOT " if root else "JOINT ") + name, "{", "OFFSET %g %g %g" % offset,
                      f"CHANNELS {places} Zrotation Yrotation Xrotation"])
        children = [(n, o) for n, p, o in joints if p == name]
        for child in children:
            write(*child, False)
        if not children:
            lines.extend(["End Site", "{", "OFFSET 0 1 0", "}"])
        lines.append("}")

    write(joints[0][0], joints[0][2], True)
    channels = 3 + 3 * len(joints)
    still = ["0", "%g" % joints[0][2][1], *["0"] * (channels - 2)]
    turned = still[:-6] + ["30"] + still[-5:]
    return "\n".join([*lines, "MOTION", "Frames: 2", "Frame Time: 0.04", " ".join(still), " ".join(turned), ""])


class ForeignBodiesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.walk = self.root / "walk_of_cmu.bvh"
        self.walk.write_text(bvh(JOINTS))

    def render(self, recording, check):
        return furrow("render", recording, "--camera", "body", "--frames", "1", "--size", "96x96", "--out",
                      self.root / "shots", check=check).stderr.decode()

    def test_a_body_without_a_face_is_drawn(self):
        message = self.render(self.walk, DONE)
        self.assertEqual(png_size((self.root / "shots" / "000001.png").read_bytes()), (96, 96))
        warnings = [line for line in message.splitlines() if "warning" in line]
        self.assertEqual(len(warnings), 1, message)
        self.assertRegex(warnings[0], r"the recording lacks \d+ joints of the rig, and their drivers stay at 0: \w+, .*\.\.\.")

    def test_solve_suggests_allow_missing(self):
        message = furrow("solve", self.walk, "--rig", RIG, check=BAD_INPUT).stderr.decode()
        self.assertIn("--allow-missing", message)
        result = furrow("solve", self.walk, "--rig", RIG, "--allow-missing", check=DONE)
        self.assertIn("the recording lacks", result.stderr.decode())
        self.assertEqual(len(result.stdout.splitlines()), 3)

    def test_a_skeleton_without_known_joints_is_rejected(self):
        box = self.root / "box.bvh"
        box.write_text(bvh((("box", None, (0, 1, 0)), ("lid", "box", (0, 1, 0)))))
        message = self.render(box, BAD_INPUT)
        self.assertIn("the recording and the character have no joint in common", message)
        self.assertIn("--skeleton-map", message)


if __name__ == "__main__":
    unittest.main()
