#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recordings that Blender exported, against what Blender itself shows (fixtures/make_recordings.py)."""
import json
import pathlib
import tempfile
import unittest

from fbx_testing import Glb, axes
from furrow_testing import furrow

DONE = 0
FIXTURES = pathlib.Path(__file__).resolve().parent / "fixtures"
EXPECTED = json.loads((FIXTURES / "expected.json").read_text())


def turn(now, before):
    """The rotation from one matrix to another, as rows. Scales do not count."""
    return [[sum(a[r] * b[c] for a, b in zip(axes(now), axes(before))) for c in range(3)] for r in range(3)]


class BlenderRecordings(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def check(self, name, take, choice="", shapes=()):
        self.compare(f"{FIXTURES / name}{choice}", EXPECTED[name][take], {}, shapes)

    def compare(self, file, frames, bones, shapes=()):
        """Compares a take with Blender's view. `bones`: Blender's name -> the file's, if it differs.

        The files keep other rest poses, so turns are compared with those of the first frame.
        """
        glb = self.converted(file)
        self.assertEqual(len(glb.times), len(frames))
        first = glb.model_space(0)
        for i, frame in enumerate(frames):
            self.assertAlmostEqual(glb.times[i], i / 30, places=4)
            posed = glb.model_space(i)
            for bone, head in frame["heads"].items():
                found = bones.get(bone, bone)
                for axis in range(3):
                    self.assertAlmostEqual(posed[found][axis][3], head[axis], delta=2e-5, msg=(bone, i))
                turned = turn(posed[found], first[found])
                expected = turn(frame["turns"][bone], frames[0]["turns"][bone])
                for r in range(3):
                    for c in range(3):
                        self.assertAlmostEqual(turned[r][c], expected[r][c], delta=2e-4, msg=(bone, i))
        values = glb.blend_shapes()
        for shape in shapes:
            for i, frame in enumerate(frames):
                self.assertAlmostEqual(values[shape][i], frame["shapes"][shape], delta=1e-4, msg=(shape, i))
        self.assertEqual(set(values), set(shapes))

    def converted(self, file):
        furrow("convert", file, self.root / "out.glb", check=DONE)
        return Glb((self.root / "out.glb").read_bytes())

    def test_fbx_with_two_takes_and_shapes(self):
        for take in ("nod", "turn"):
            with self.subTest(take):
                self.check("takes.fbx", take, "#" + take, shapes=("jawOpen", "mouthSmile_L", "browInnerUp"))

    def test_gltf_with_two_takes_and_morph_animation(self):
        for take in ("nod", "turn"):
            with self.subTest(take):
                self.check("takes.glb", take, "#" + take, shapes=("jawOpen", "mouthSmile_L", "browInnerUp"))

    def test_collada(self):
        self.check("turn.dae", "turn")

    def test_collada_with_equal_names(self):
        # Then nodes have their ids.
        bones = list(EXPECTED["turn.dae"]["turn"][0]["heads"])
        text = (FIXTURES / "turn.dae").read_text()
        (self.root / "equal.dae").write_text(text.replace('name="Rig" type="NODE"', 'name="hips" type="NODE"'))
        self.compare(self.root / "equal.dae", EXPECTED["turn.dae"]["turn"],
                     {bone: "Rig_" + bone.replace(".", "_") for bone in bones})


if __name__ == "__main__":
    unittest.main()
