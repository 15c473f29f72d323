#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""FBX and Collada files as recordings: the poses against forward kinematics of the file's own properties."""
import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import unittest
import urllib.request
import zlib

from body_testing import VRM, Body, kick
from fbx_testing import Fbx, Glb, worst_difference
from fbx_writing import List, Long, Scene, node, to_ascii, to_binary
from furrow_testing import BIN, GUARD, Daemon, furrow, solve, worst_difference as weight_difference

DONE, FAILED, BAD_INPUT = 0, 1, 3
RATE = 30
SANITIZED = "san" in BIN.parent.name


def baked(function, frames=13):
    """One key per frame for each axis of function(seconds)."""
    keys = [(f / RATE, function(f / RATE)) for f in range(frames)]
    return {axis: [(t, v[i]) for t, v in keys] for i, axis in enumerate("XYZ")}


def swing(x, y, z):
    return baked(lambda t: (x * math.sin(9 * t), y * math.sin(7 * t), z * math.cos(5 * t)))


def mixamo_like():
    """Pre-rotations on most joints, centimetres, a joint that is never moved, two takes and blend shapes."""
    scene = Scene()
    scene.model("mixamorig:Hips", T=(0, 100, 2), PreRotation=(0.7, 0, 0))
    scene.model("mixamorig:Spine", "mixamorig:Hips", T=(0, 10, -1), PreRotation=(-9, 0.5, 3), S=(1.1, 1.1, 1.1))
    scene.model("mixamorig:Head", "mixamorig:Spine", T=(0, 40, 0), R=(5, 0, 0))
    scene.model("mixamorig:HeadTop_End", "mixamorig:Head", T=(0, 20, 0))
    scene.model("mixamorig:LeftUpLeg", "mixamorig:Hips", T=(9, -6, 0), PreRotation=(2, 1, -178))
    scene.model("mixamorig:LeftLeg", "mixamorig:LeftUpLeg", T=(0, 43, 0), PreRotation=(-11, 0, 0.5), R=(1, 2, 3))
    shapes = scene.face("mixamorig:Head", ("browInnerUp", "jawOpen"))
    move = ("mixamorig:Hips", "Lcl Translation", baked(lambda t: (40 * t, 100 + 3 * math.sin(20 * t), 2)))
    scene.take("walk", [move, ("mixamorig:Hips", "Lcl Rotation", swing(8, 170, 5)),
                        ("mixamorig:Spine", "Lcl Rotation", swing(20, 9, -15)),
                        ("mixamorig:LeftUpLeg", "Lcl Rotation", swing(40, 20, 10)),
                        ("mixamorig:LeftLeg", "Lcl Rotation", swing(-60, 1, 2)),
                        (shapes["jawOpen"], "DeformPercent", {"DeformPercent": [(0, 0), (0.2, 80), (0.4, 20)]})])
    scene.take("mixamo.com", [move, ("mixamorig:Spine", "Lcl Rotation", swing(-5, 30, 4))])
    return scene


def pivots():
    """What Maya and 3ds Max write: every pivot and offset, other rotation orders, Z up, inches."""
    scene = Scene(UpAxis=2, FrontAxis=1, FrontAxisSign=-1, UnitScaleFactor=2.54)
    every = dict(RotationOffset=(1, 2, 3), RotationPivot=(4, -1, 2), ScalingOffset=(0.5, 0, 1), ScalingPivot=(1, 1, -2),
                 PreRotation=(10, 20, 30), PostRotation=(-15, 25, 5))
    scene.model("root", T=(0, 0, 40), R=(0, 0, 90), order=4)
    scene.model("arm", "root", T=(10, 0, 5), R=(1, 2, 3), S=(2, 2, 2), order=1, **every)
    scene.model("hand", "arm", T=(0, 12, 0), order=5, PreRotation=(0, 90, 0), PostRotation=(40, -10, 60))
    scene.model("finger", "hand", T=(0, 3, 0), order=2, GeometricTranslation=(5, 5, 5))
    scene.model("still", "arm", T=(0, 5, 0), order=3, **every)
    scene.take("Take 001", [("root", "Lcl Rotation", swing(10, 20, 60)), ("arm", "Lcl Rotation", swing(70, 30, 20)),
                            # Only X moves; Y and Z stay where the joint is.
                            ("arm", "Lcl Translation", {"X": baked(lambda t: (10 + t, 0, 0))["X"]}),
                            ("hand", "Lcl Rotation", swing(50, 40, 80)), ("finger", "Lcl Rotation", swing(30, 5, 5))])
    return scene


COLLADA = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
  <library_animations><animation id="hip_matrix">
    <source id="in"><float_array id="in_a" count="2">0 0.5</float_array><technique_common>
      <accessor source="#in_a" count="2"><param name="TIME" type="float"/></accessor></technique_common></source>
    <source id="out"><float_array id="out_a" count="32">
      1 0 0 0 0 1 0 0 0 0 1 100 0 0 0 1   0 -1 0 30 1 0 0 0 0 0 1 100 0 0 0 1</float_array><technique_common>
      <accessor source="#out_a" count="2" stride="16"><param name="TRANSFORM" type="float4x4"/></accessor></technique_common></source>
    <source id="how"><Name_array id="how_a" count="2">LINEAR LINEAR</Name_array><technique_common>
      <accessor source="#how_a" count="2"><param name="INTERPOLATION" type="name"/></accessor></technique_common></source>
    <sampler id="s"><input semantic="INPUT" source="#in"/><input semantic="OUTPUT" source="#out"/>
      <input semantic="INTERPOLATION" source="#how"/></sampler>
    <channel source="#s" target="hip/matrix"/>
  </animation></library_animations>
  <library_visual_scenes><visual_scene id="scene">
    <node id="hip" name="hip" sid="hip" type="JOINT"><matrix sid="matrix">1 0 0 0 0 1 0 0 0 0 1 100 0 0 0 1</matrix>
      <node id="spine" name="spine" sid="spine" type="JOINT"><matrix sid="matrix">1 0 0 0 0 1 0 0 0 0 1 50 0 0 0 1</matrix></node>
    </node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
"""


class ForeignRecordings(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def write(self, name, data):
        (self.root / name).write_bytes(data)
        return self.root / name

    def converted(self, file):
        furrow("convert", file, self.root / "out.glb", check=DONE)
        return Glb((self.root / "out.glb").read_bytes())

    def check_poses(self, scene, take=0, frames=13, choice=""):
        for name, data in (("ascii.fbx", to_ascii(scene.nodes())), ("binary.FBX", to_binary(scene.nodes()))):
            with self.subTest(name):
                file = self.write(name, data)
                glb = self.converted(str(file) + choice)
                self.assertEqual(len(glb.times), frames)
                places, axes, compared = worst_difference(Fbx(data), glb, take)
                self.assertLess(places, 1e-5)  # metres
                self.assertLess(axes, 1e-5)
                self.assertGreaterEqual(compared, 5 * frames)

    def test_pre_rotations_units_and_scale(self):
        self.check_poses(mixamo_like())

    def test_pivots_offsets_orders_and_axes(self):
        self.check_poses(pivots())

    def test_each_of_several_takes(self):
        self.check_poses(mixamo_like(), take=1, choice="#1")
        self.check_poses(mixamo_like(), take=1, choice="#mixamo.com")

    def test_takes_are_listed_and_chosen(self):
        file = self.write("two.fbx", to_ascii(mixamo_like().nodes()))
        result = furrow("info", file, check=DONE)
        self.assertIn("animation   0: walk, 0.400 s\n  animation   1: mixamo.com, 0.400 s", result.stdout.decode())
        self.assertIn("reading the first of 0 'walk', 1 'mixamo.com'", result.stderr.decode())
        message = furrow("info", f"{file}#run", check=BAD_INPUT).stderr.decode()
        self.assertIn("two.fbx: the file has no animation 'run' (animations: 0 'walk', 1 'mixamo.com')", message)

    def test_info_takes_a_skeleton_map(self):
        file = self.write("walk.fbx", to_binary(mixamo_like().nodes()))
        for name in ("mixamo", "cmu"):
            output = furrow("info", file, "--skeleton-map", name, check=DONE).stdout.decode()
            self.assertIn(f"skeleton map '{name}'", output)

    def test_blend_shapes(self):
        file = self.write("face.fbx", to_binary(mixamo_like().nodes()))
        shapes = self.converted(file).blend_shapes()
        self.assertEqual(list(shapes), ["jawOpen"])  # the other shape never moves
        for frame, value in ((0, 0), (3, 0.4), (6, 0.8), (9, 0.5), (12, 0.2)):
            self.assertAlmostEqual(shapes["jawOpen"][frame], value, places=4)

    def test_in_betweens_do_not_shift_the_curves(self):
        # A take of a face alone. Each channel has as many shapes as it has in-betweens, and one more.
        scene = Scene()
        channels = scene.face(None, {"jawOpen": {40: 2, 70: 5, 100: 6}, "mouthSmile": {100: 1}, "blink": {50: 3, 100: 4}})
        scene.take("face", [
            (channels["mouthSmile"], "DeformPercent", {"DeformPercent": [(0, 0), (0.2, 80), (0.4, 20)]}),
            (channels["blink"], "DeformPercent", {"DeformPercent": [(0, 0), (0.2, 30), (0.4, 100)]})])
        for data in (to_ascii(scene.nodes()), to_binary(scene.nodes())):
            glb = self.converted(self.write("face.fbx", data))
            self.assertEqual([round(t, 4) for t in glb.times], [0, 0.2, 0.4])
            shapes = {name: [round(v, 4) for v in values] for name, values in glb.blend_shapes().items()}
            self.assertEqual(shapes, {"mouthSmile": [0, 0.8, 0.2], "blink": [0, 0.3, 1]})

    def test_a_take_keeps_its_span(self):
        scene = Scene()
        scene.model("hip", T=(0, 100, 0))
        scene.model("spine", "hip", T=(0, 10, 0))
        scene.take("late", [("hip", "Lcl Rotation", swing(10, 20, 30)), ("spine", "Lcl Rotation", swing(40, 20, 30))],
                   start=4 / RATE, stop=8 / RATE)
        data = to_binary(scene.nodes())
        glb = self.converted(self.write("late.fbx", data))
        self.assertEqual(len(glb.times), 5)
        self.assertLess(max(worst_difference(Fbx(data), glb)[:2]), 1e-5)

    def test_a_change_of_sign_adds_no_frames(self):
        # Between 179 and -179 degrees lie 2 degrees, not a whole turn.
        scene = Scene()
        scene.model("hip", T=(0, 100, 0))
        for name in ("a", "b", "c"):
            scene.model(name, "hip", T=(0, 10, 0))
        angles = [150 + 20 * f for f in range(8)]
        wrapped = [(f / RATE, (a + 180) % 360 - 180) for f, a in enumerate(angles)]
        steady = baked(lambda t: (t, 2 * t, 3 * t), 8)
        scene.take("turn", [("hip", "Lcl Rotation", {**steady, "Y": wrapped})] +
                   [(name, "Lcl Rotation", steady) for name in ("a", "b", "c")])
        data = to_binary(scene.nodes())
        glb = self.converted(self.write("turn.fbx", data))
        self.assertEqual(len(glb.times), 8)
        self.assertLess(max(worst_difference(Fbx(data), glb)[:2]), 1e-5)

    def test_collada(self):
        glb = self.converted(self.write("hip.dae", COLLADA.encode()))
        self.assertEqual([round(t, 5) for t in glb.times], [0, 0.5])
        for frame, hip, spine in ((0, (0, 1, 0), (0, 1.5, 0)), (1, (0.3, 1, 0), (0.3, 1.5, 0))):
            matrices = glb.model_space(frame)
            for name, place in (("hip", hip), ("spine", spine)):
                for axis in range(3):
                    self.assertAlmostEqual(matrices[name][axis][3], place[axis], places=5)
        # Z is up in the file: its X axis turns to its Y axis, which is -Z here.
        self.assertAlmostEqual(glb.model_space(1)["hip"][2][0], -1, places=5)

    def test_a_gltf_is_read_in_its_own_folder(self):
        Body(VRM, moves=kick()).save(self.root / "walking.gltf")  # with its buffer beside it
        for name in ("walking.gltf", "./walking.gltf", str(self.root / "walking.gltf")):
            result = subprocess.run([BIN / "furrow", "info", name], cwd=self.root, capture_output=True, timeout=GUARD)
            self.assertEqual(result.returncode, DONE, result.stderr.decode())
            self.assertIn("frames      5 in 1.000 s", result.stdout.decode())

    def test_the_content_decides_the_format(self):
        expected = furrow("info", self.write("a.fbx", to_binary(pivots().nodes())), check=DONE).stdout.splitlines()[1:]
        for name in ("a.glb", "a.bvh", "a.download", "a"):
            found = furrow("info", self.write(name, to_binary(pivots().nodes())), check=DONE).stdout.splitlines()[1:]
            self.assertEqual(found, expected, name)

    def test_weights_equal_those_of_the_converted_clip(self):
        file = self.write("walk.fbx", to_binary(mixamo_like().nodes()))
        furrow("convert", file, self.root / "walk.glb", check=DONE)
        rig = ("--rig", "default", "--allow-missing")
        difference, frames = weight_difference(solve(file, *rig), solve(self.root / "walk.glb", *rig))
        self.assertEqual((difference, frames), (0, 13))

    def test_the_daemon_plays_it(self):
        file = self.write("walk.fbx", to_binary(mixamo_like().nodes()))
        with Daemon("--no-render", "--http", "0", "--play", f"{file}#mixamo.com") as daemon:
            with urllib.request.urlopen(f"http://127.0.0.1:{daemon.ports['http']}/api/playback", timeout=GUARD) as reply:
                state = json.load(reply)
        self.assertEqual((state["subject"], state["frames"]), ("walk", 13))

    def test_damaged_files_give_one_message(self):
        good = to_binary(mixamo_like().nodes())
        cases = {"empty.fbx": b"", "cut.fbx": good[:len(good) // 2], "head.fbx": good[:27], "noise.fbx": os.urandom(5000),
                 "text.fbx": b"; FBX 7.4.0\nObjects: {", "cut.dae": COLLADA.encode()[:900], "none.dae": b"<COLLADA/>",
                 "still.fbx": to_ascii(Scene().nodes())}
        for name, data in cases.items():
            message = furrow("info", self.write(name, data), check=BAD_INPUT).stderr.decode()
            self.assertRegex(message, rf"^furrow: \S*{name}: ", name)
            self.assertEqual(message.count("\n"), 1, message)

    def test_every_cut_of_a_file_ends_well(self):
        good = to_binary(pivots().nodes())
        for size in range(100, len(good), len(good) // 17):
            result = furrow("info", self.write("cut.fbx", good[:size]))
            self.assertIn(result.returncode, (DONE, BAD_INPUT), result.stderr)

    @unittest.skipIf(SANITIZED, "memory is not limited under sanitizers")
    def test_a_bomb_meets_the_limit_on_memory(self):
        nodes = Scene().nodes()
        count = 300 << 20
        nodes[3][2].append(node("Geometry", Long(1), "Geometry::bomb", "Mesh", [node("Vertices", List("d", [0.0]))]))
        data = to_binary(nodes)
        packed = zlib.compressobj(9)
        content = b"".join(packed.compress(bytes(8 << 20)) for _ in range(count * 8 >> 23)) + packed.flush()
        small = zlib.compress(struct.pack("<d", 0.0))
        at = data.index(b"d" + struct.pack("<III", 1, 1, len(small)))
        grown = data[:at] + b"d" + struct.pack("<III", count, 1, len(content)) + content + data[at + 13 + len(small):]
        message = furrow("info", self.write("bomb.fbx", grown), check=BAD_INPUT).stderr.decode()
        self.assertRegex(message, r"bomb\.fbx: (converting the file takes more than 1024 MiB of memory|is not readable)")

    def test_a_missing_helper_program_is_named(self):
        (self.root / "bin").mkdir()
        shutil.copy(BIN / "furrow", self.root / "bin" / "furrow")
        file = self.write("walk.fbx", to_binary(mixamo_like().nodes()))
        result = subprocess.run([self.root / "bin" / "furrow", "info", file], capture_output=True, timeout=GUARD)
        self.assertNotEqual(result.returncode, DONE)
        self.assertIn("the program furrow-assimp is missing", result.stderr.decode())
        self.assertIn("the program furrow-assimp is missing", result.stderr.decode())


if __name__ == "__main__":
    unittest.main()
