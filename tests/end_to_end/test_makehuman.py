#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Imports MakeHuman's character and saved people, and plays five expressions to the daemon."""
import json
import math
import pathlib
import struct
import tempfile
import unittest
import zipfile

from furrow_testing import (SOURCE, Daemon, Table, finish, furrow, jpeg_size, needs_shared, solve, spawn,
                            spawn_watch, worst_difference)

FACE = ("brow_l", "brow_r", "glabella", "nose", "eye_l", "eye_r", "mouth_l", "mouth_r")
EXPRESSIONS = ("smile", "anger", "sadness", "disgust", "laugh")  # 120 frames each, with the peak at frame 60


def facial(names):
    return [n for n in names if n.split(".")[0] in FACE]


class MakeHumanTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recording = needs_shared("performances", "emotions.bvh")
        cls.env = {"FURROW_ASSET_PATH": str(needs_shared("makehuman", "poseunits"))}
        cls.rig = SOURCE / "rig" / "rigs" / "makehuman.json"
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.root = pathlib.Path(cls.folder.name)
        cls.package = cls.root / "makehuman.glb"
        furrow("character", "import", needs_shared("makehuman"), "--out", cls.package, check=0)
        cls.solved = solve(cls.recording, "--rig", cls.rig, env=cls.env)

    def test_package_rig_gives_the_weights_of_the_rig_file(self):
        seen = solve(self.recording, "--rig", self.package.with_suffix(".rig.json"))
        self.assertLess(worst_difference(seen, self.solved)[0], 1e-4)

    def test_weights_are_in_range_and_zero_at_neutral(self):
        for values in self.solved.rows.values():
            self.assertTrue(all(0.0 <= v <= 1.0 for v in values))
        for name in facial(self.solved.names):
            self.assertLess(self.solved.column(name)[0], 0.02, name)

    def test_five_expressions_are_five_different_sets_of_weights(self):
        names = facial(self.solved.names)
        self.assertGreaterEqual(len(names), 16)
        heights = []
        for index, expression in enumerate(EXPRESSIONS):
            row = self.solved.rows[120 * index + 60]
            values = [row[self.solved.names.index(n)] for n in names]
            self.assertGreater(max(values), 0.3, f"{expression} leaves the face smooth")
            heights.append(values)
            strongest = sorted(zip(values, names), reverse=True)[:5]
            print(expression + ":", ", ".join(f"{n} {v:.2f}" for v, n in strongest))
        for i in range(5):
            for j in range(i):
                if {EXPRESSIONS[i], EXPRESSIONS[j]} == {"smile", "laugh"}:
                    continue  # too similar: a laugh is a smile with an open jaw
                self.assertGreater(math.dist(heights[i], heights[j]), 0.3, (EXPRESSIONS[i], EXPRESSIONS[j]))

    def test_root_motion_changes_no_facial_weight(self):
        lines = self.recording.read_text().splitlines()
        first = lines.index(next(l for l in lines if l.strip().startswith("Frame Time"))) + 1
        for i in range(first, len(lines)):
            values = lines[i].split()
            if len(values) < 6:
                continue
            t = (i - first) / 30.0
            root = (3 * math.sin(t), 0.5 * t, -2 * t, 40 * math.sin(t), 170 * math.sin(0.3 * t), 25 * math.cos(t))
            lines[i] = " ".join([f"{x:.6f}" for x in root] + values[6:])
        moved = self.root / "moved.bvh"
        moved.write_text("\n".join(lines) + "\n")
        seen = solve(moved, "--rig", self.rig, env=self.env)
        worst = max(abs(seen.column(n)[f] - self.solved.column(n)[f])
                    for n in facial(seen.names) for f in seen.rows)
        print(f"worst difference under a moving root {worst:.2e}")
        self.assertLess(worst, 1e-3)

    def test_live_weights_equal_solve_and_pictures_move(self):
        pictures = self.root / "pictures"

        def play(daemon):
            camera = spawn("frames", daemon.tcp, "--subject", "ada", "--wait", "--out", pictures, "--size", "256x256",
                           "--rate", "5")
            furrow("play", self.recording, "--to", daemon.udp, "--udp", "--subject", "ada", check=0)
            self.assertEqual(finish(camera)[0], 0)
            return list(pictures.iterdir()) if pictures.exists() else []

        with Daemon("--character", self.package) as daemon:
            watcher = spawn_watch(daemon.tcp, "ada")
            drawn = play(daemon)
            code, out, err = finish(watcher)
            self.assertEqual(code, 0, err)
            # On a slow machine, the shaders are compiled after the recording has ended.
            for _ in range(5):
                if len(drawn) > 1:
                    break
                drawn = play(daemon)
        worst, frames = worst_difference(Table(out.decode()), self.solved)
        print(f"{frames} of {len(self.solved.rows)} frames arrived, worst difference {worst:.2e}")
        self.assertGreater(frames, 0)
        self.assertLess(worst, 1e-3)
        files = sorted(pictures.iterdir())
        self.assertTrue(files)
        self.assertEqual({jpeg_size(f.read_bytes()) for f in files}, {(256, 256)})
        self.assertGreater(len({f.read_bytes() for f in files}), 1)

    def test_explain_names_drivers_and_poses(self):
        result = furrow("rig", "explain", self.rig, self.recording, "--frame", 60, env=self.env, check=0)
        text = result.stdout.decode()
        strongest = max(facial(self.solved.names), key=lambda n: self.solved.column(n)[60])
        self.assertIn(strongest, text)


def npy(kind, shape, code, values):
    """The bytes of a .npy file, version 1."""
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}".encode()
    header += b" " * (-(len(header) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + struct.pack(f"<{len(values)}{code}", *values)


def positions(package):
    """All coordinates of a package's first mesh."""
    data = package.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    root = json.loads(data[20:20 + length])
    accessor = root["accessors"][root["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
    view = root["bufferViews"][accessor["bufferView"]]
    stride = view.get("byteStride", 12)
    start = 28 + length + view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return [x for i in range(accessor["count"]) for x in struct.unpack_from("<3f", data, start + i * stride)]


class SavedPersonTest(unittest.TestCase):
    def setUp(self):
        self.data = needs_shared("makehuman", "targets").parent
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.save = self.root / "ada.mhm"
        self.save.write_text((SOURCE / "tests" / "fuzz" / "seeds" / "mhm" / "save").read_text())

    def test_a_save_becomes_a_package_that_passes_the_check(self):
        package = self.root / "ada.glb"
        result = furrow("character", "import", self.save, "--data", self.data, "--out", package, "--texture-size", 256,
                        check=0)
        said = result.stderr.decode()
        self.assertIn("shape: 2 targets", said)
        self.assertIn("clothes 'male_casualsuit01'", said)
        self.assertIn("no targets for minmuscle, maxweight", said)
        self.assertIn("2 modifiers without a target", said)
        self.assertIn("the picture of hair 'short02' is painted", said)
        furrow("character", "check", package, check=0)

    def test_the_data_folder_is_found_beside_the_save(self):
        (self.root / "data").symlink_to(self.data)
        furrow("character", "import", self.save, "--out", self.root / "ada.glb", "--texture-size", 64, check=0)

    # An installed MakeHuman has its targets in one archive of NumPy's.
    def test_packed_targets_give_the_person_of_the_text_files(self):
        packed = self.root / "installed"
        packed.mkdir()
        for path in self.data.iterdir():
            if path.name != "targets":
                (packed / path.name).symlink_to(path)
        with zipfile.ZipFile(packed / "targets.npz", "w", zipfile.ZIP_DEFLATED) as archive:
            for path in sorted((self.data / "targets").rglob("*.target")):
                rows = [line.split() for line in path.read_text().splitlines() if line and line[0] != "#"]
                name = str(path.relative_to(self.data).with_suffix(""))
                index = [int(row[0]) for row in rows]
                vector = [round(1000 * float(x)) for row in rows for x in row[1:]]
                archive.writestr(name + ".index.npy", npy("<u2", f"({len(rows)},)", "H", index))
                archive.writestr(name + ".vector.npy", npy("<i2", f"({len(rows)}, 3)", "h", vector))
        shapes = []
        for data, name in ((self.data, "text.glb"), (packed, "packed.glb")):
            result = furrow("character", "import", self.save, "--data", data, "--out", self.root / name,
                            "--texture-size", 64, check=0)
            self.assertIn("shape: 2 targets", result.stderr.decode())
            shapes.append(positions(self.root / name))
        self.assertEqual(len(shapes[0]), len(shapes[1]))
        worst = max(abs(a - b) for a, b in zip(*shapes))
        print(f"largest distance between packed and text targets: {1000 * worst:.3f} mm")
        self.assertLess(worst, 3e-4)  # two targets, each rounded to 0.1 mm
        furrow("character", "check", self.root / "packed.glb", check=0)
        furrow("bake", self.root / "packed.glb", "--out", self.root / "maps", "--size", 128, check=0)

    def test_skeletons_and_topologies_of_a_save_are_named(self):
        text = self.save.read_text().replace("skeleton default", "skeleton game_engine")
        self.save.write_text(text + "proxy female_generic 17ec5e2b-33a2-4b3a-9bb6-0ce1e8b0b0fe\n")
        result = furrow("character", "import", self.save, "--data", self.data, "--out", self.root / "ada.glb",
                        "--texture-size", 64, check=0)
        said = result.stderr.decode()
        self.assertIn("the skeleton 'game_engine.mhskel' is not imported", said)
        self.assertIn("the topology 'female_generic", said)
        self.assertEqual(said.count("export the person from MakeHuman as FBX or Collada"), 2)

    def test_a_person_without_clothes_has_no_folds_of_cloth(self):
        lines = [line for line in self.save.read_text().splitlines() if not line.startswith("clothes ")]
        self.save.write_text("\n".join(lines) + "\n")
        package = self.root / "ada.glb"
        furrow("character", "import", self.save, "--data", self.data, "--out", package, "--texture-size", 64, check=0)
        self.assertNotIn("folds", package.with_suffix(".rig.json").read_text())
        furrow("character", "check", package, check=0)

    def test_bad_saves_and_folders_are_named(self):
        out = self.root / "ada.glb"
        result = furrow("character", "import", self.save, "--out", out, check=3, env={"FURROW_ASSET_PATH": ""})
        self.assertIn("--data", result.stderr.decode())
        self.save.write_text("version v1.2.0\nmodifier macrodetails/Age much\n")
        result = furrow("character", "import", self.save, "--data", self.data, "--out", out, check=3)
        self.assertIn("ada.mhm:2: 'much' is not a number", result.stderr.decode())
        result = furrow("character", "import", self.data, "--data", self.data, "--out", out, check=3)
        self.assertIn("--data applies to .mhm files only", result.stderr.decode())
        result = furrow("character", "import", self.save, "--clothes", "x", "--out", out, check=3)
        self.assertIn("--clothes does not apply", result.stderr.decode())
        self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main()
