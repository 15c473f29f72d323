#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Foreign characters are imported, checked and given a rig; invalid ones give one clear error."""
import json
import pathlib
import struct
import tempfile
import unittest
import zlib

from furrow_testing import SHARE, Table, furrow, needs_shared


def read_glb(path):
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), data[20 + length + 8:]


def write_glb(path, root, binary):
    text = json.dumps(root).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(binary)) + b"BIN\0" + binary
    path.write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks)


class CharacterTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.root = pathlib.Path(cls.folder.name)
        cls.default = SHARE / "default.glb"

    def changed(self, change, name="changed.glb"):
        """Writes the default character after applying `change(root, binary)`."""
        root, binary = read_glb(self.default)
        binary = bytearray(binary)
        change(root, binary)
        path = self.root / name
        write_glb(path, root, bytes(binary))
        return path

    def refused(self, path, *says):
        """Import must exit with 3, print one line that contains `says`, and write no files."""
        out = self.root / "out" / "refused.glb"
        out.parent.mkdir(exist_ok=True)
        result = furrow("character", "import", path, "--out", out, check=3)
        lines = [x for x in result.stderr.decode().splitlines() if not x.startswith(
            ("furrow: note:", "furrow: warning:"))]
        self.assertEqual(len(lines), 1, lines)
        for words in (path.name, *says):
            self.assertIn(words, lines[0])
        self.assertEqual(list(out.parent.iterdir()), [])

    def test_default_character_passes_the_check(self):
        report = json.loads(furrow("character", "check", self.default, "--json", check=0).stdout)
        self.assertEqual(report["skeleton_map"], "default")
        self.assertEqual(report["axes"], "up +Y, facing +Z")
        self.assertFalse([f for f in report["findings"] if f["severity"] == "error"])
        self.assertIn("0 errors", furrow("character", "check", self.default, check=0).stdout.decode())

    def test_shipped_characters_have_names(self):
        for args in (("character", "check", "elder"), ("rig", "check", "elder"), ("rig", "check", "default.glb"),
                     ("character", "propose-rig", "elder", "--out", self.root / "elder.rig.json"),
                     ("solve", SHARE / "recordings" / "anger.bvh", "--rig", "elder")):
            with self.subTest(args):
                furrow(*args, check=0)
        for args in (("render", "--pose", "neutral", "--out", self.root / "none", "--character", "eldr"),
                     ("export", "eldr", "--out", self.root / "none")):
            said = furrow(*args, check=3).stderr.decode()
            self.assertIn("eldr: no such file, and no shipped character of this name (did you mean 'elder'? shipped "
                          "characters: default, elder)", said)

    def test_a_package_is_checked_with_its_rig(self):
        said = furrow("rig", "check", self.default, check=0).stdout.decode()
        self.assertIn("wrinkle weights", said)
        self.assertNotIn("is not a file here", said, "the pictures are in the package")
        alone = self.changed(lambda *_: None, "alone.glb")
        self.assertIn("alone.glb: the character has no wrinkle rig", furrow("rig", "check", alone, check=3).stderr.decode())

    def test_strict_treats_warnings_as_errors(self):
        def forget_names(root, _):
            for node in root["nodes"][:3]:
                del node["name"]
        path = self.changed(forget_names)
        self.assertIn(b"[joint-names]", furrow("character", "check", path, check=0).stdout)
        furrow("character", "check", path, "--strict", check=3)

    def test_imported_default_keeps_its_shape_and_gets_a_rig(self):
        out = self.root / "again.glb"
        furrow("character", "import", self.default, "--out", out, check=0)
        before, after = read_glb(self.default)[0], read_glb(out)[0]
        names = lambda root: {n["name"] for n in root["nodes"] if not n["name"].startswith("mesh:")}
        self.assertEqual(names(before), names(after))
        furrow("rig", "check", out.with_suffix(".rig.json"), check=0)

    def test_proposed_rig_for_cmu_gives_the_weights_of_the_shipped_one(self):
        recording = needs_shared("cmu", "01_01.bvh")
        rig = self.root / "proposed.json"
        furrow("character", "propose-rig", recording, "--out", rig, check=0)
        furrow("rig", "check", rig, "--skeleton", recording, check=0)
        solve = lambda r: Table(furrow("solve", recording, "--rig", r, "--drivers", "--no-filter",
                                       check=0).stdout.decode())
        proposed, shipped = solve(rig), solve("cmu")
        for limb in ("knee_l", "knee_r", "elbow_l", "elbow_r"):
            a, b = proposed.column(f"{limb}.flexed"), shipped.column(f"{limb}.flexed")
            self.assertGreater(max(b.values()), 0.2)
            self.assertLess(max(abs(a[f] - b[f]) for f in b), 0.01, limb)

    def test_rig_check_turns_the_skeleton_as_solve_does(self):
        def lie(line):
            if line.split()[:1] != ["OFFSET"]:
                return line
            x, y, z = map(float, line.split()[1:])
            return f"OFFSET {x} {-z} {y}"
        text = (SHARE / "recordings" / "walk.bvh").read_text()
        recording = self.root / "z-up.bvh"
        recording.write_text("\n".join(map(lie, text.splitlines())) + "\n")
        # The file keeps its axes, so only the match of the joints can turn it. An axis along +Z is across
        # a leg, but not across the leg of a Z-up skeleton.
        rig = self.root / "knee.json"
        rig.write_text(json.dumps({
            "version": 1, "name": "knee",
            "drivers": [{"name": "knee", "hinge": {"parent": "upper_leg_l", "joint": "lower_leg_l",
                                                   "end": "foot_l", "axis": [0, 0, 1]}}],
            "regions": [{"name": "knee", "mask": {"kind": "skinning"},
                         "feeds": [{"map": "folds", "sources": [{"from": "knee.flexed"}]}]}],
            "wrinkle_maps": [{"name": "folds"}]}))
        checked = furrow("rig", "check", rig, "--skeleton", recording, "--up-axis", "y", check=0)
        self.assertIn(b"the rest pose faces -Y, up is +Z", checked.stderr)
        self.assertIn(b"binds to the skeleton", checked.stdout)

    def rig_with_a_bvh_pose(self):
        """A rig of a brow, whose pose is a BVH frame with position channels, and nothing but positions."""
        channels = "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation"
        (self.root / "pose.bvh").write_text(
            f"HIERARCHY\nROOT head\n{{\nOFFSET 0 1 0\n{channels}\n"
            f"JOINT frontalis_inner_l\n{{\nOFFSET 0.02 0.03 0.1\n{channels}\n"
            "End Site\n{\nOFFSET 0 0 0.01\n}\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.1\n"
            "0 1 0 0 0 0 0.02 0.04 0.1 0 0 0\n")
        rig = self.root / "brow.json"
        rig.write_text(json.dumps({
            "version": 1, "name": "brow", "anchor": "head",
            "reference_poses": [{"name": "up", "file": "pose.bvh", "frame": 0}],
            "drivers": [{"name": "brow", "pose": {
                "points": [{"joint": "frontalis_inner_l", "kind": "origin"}],
                "values": [{"name": "up", "reference_pose": "up"}]}}],
            "regions": [{"name": "brow", "mask": {"kind": "skinning"},
                         "feeds": [{"map": "folds", "sources": [{"from": "brow.up"}]}]}],
            "wrinkle_maps": [{"name": "folds"}]}))
        return rig

    def test_bvh_positions_also_concern_the_poses_of_a_rig(self):
        rig = self.rig_with_a_bvh_pose()

        def moves(*options):
            out = self.root / "brow.glb"
            furrow("character", "import", self.default, "--rig", rig, "--out", out, *options, check=0)
            poses = json.loads(out.with_suffix(".rig.json").read_text())["reference_poses"]
            return bool(poses[0].get("joints"))
        self.assertTrue(moves())
        self.assertFalse(moves("--bvh-positions", "offsets"))
        still = "does not move its control points"
        check = lambda *o: furrow("character", "check", self.default, "--rig", rig, *o).stdout.decode()
        self.assertNotIn(still, check())
        self.assertIn(still, check("--bvh-positions", "offsets"))
        patch = ("rig", "patch", self.default, "--rig", rig, "--around", "0,1.566,0.046")
        furrow(*patch, "--bvh-positions", "channels", check=0)
        for command in (patch, ("record", "localhost:1", "--out", self.root / "t.mcap", "--rig", rig)):
            self.assertIn(b"is not one of auto", furrow(*command, "--bvh-positions", "x", check=2).stderr)

    def test_files_with_a_wrong_format(self):
        text = self.root / "text.fbx"
        text.write_text("this is not FBX\n" * 100)
        self.refused(text, "fbx")
        cut = self.root / "cut.glb"
        cut.write_bytes(self.default.read_bytes()[:5000])
        self.refused(cut, "header.length")
        page = self.root / "page.dae"
        page.write_text("<html>")
        self.refused(page, "dae")
        other = self.root / "readme.txt"
        other.write_text("hello")
        self.refused(other, "'.txt'")

    def test_gltf_that_lies_about_its_buffers(self):
        def position(root):
            return root["meshes"][0]["primitives"][0]["attributes"]["POSITION"]

        def longer_buffer(root, _):
            root["buffers"][0]["byteLength"] *= 2

        def view_past_the_end(root, _):
            root["bufferViews"][3]["byteLength"] = 1 << 30

        def huge_count(root, _):
            root["accessors"][position(root)]["count"] = 1 << 31

        def wide_stride(root, _):
            root["bufferViews"][root["accessors"][position(root)]["bufferView"]]["byteStride"] = 252

        def sparse(root, _):
            root["accessors"][position(root)]["sparse"] = {
                "count": 1 << 30, "indices": {"bufferView": 0, "componentType": 5125},
                "values": {"bufferView": 0}}

        for change, words in ((longer_buffer, "buffers[0].byteLength"), (view_past_the_end, "bufferViews[3].byteLength"),
                              (huge_count, "POSITION"), (wide_stride, "POSITION"), (sparse, "POSITION")):
            with self.subTest(change.__name__):
                self.refused(self.changed(change), words)

    def test_meshes_that_cannot_wrinkle(self):
        def no_uvs(root, _):
            for mesh in root["meshes"]:
                del mesh["primitives"][0]["attributes"]["TEXCOORD_0"]

        def unskinned(root, binary):
            accessor = root["accessors"][root["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"]]
            at = root["bufferViews"][accessor["bufferView"]]["byteOffset"]
            binary[at:at + 16] = bytes(16)

        def flat(root, binary):
            accessor = root["accessors"][root["meshes"][0]["primitives"][0]["indices"]]
            at = root["bufferViews"][accessor["bufferView"]]["byteOffset"]
            binary[at:at + 4] = binary[at + 4:at + 8]

        def no_skin(root, _):
            for node in root["nodes"]:
                node.pop("skin", None)

        for change, words in ((unskinned, "1 vertex follows no joint"), (no_skin, "skinned")):
            with self.subTest(change.__name__):
                path = self.changed(change)
                self.refused(path, words)
                furrow("character", "check", path, check=3)
        furrow("character", "import", self.changed(flat), "--out", self.root / "flat.glb", check=0)
        moves = furrow("character", "import", self.changed(no_uvs), "--out", self.root / "no_uvs.glb", check=0)
        self.assertEqual(moves.stderr.decode().count("there are no UVs"), 1)
        self.assertIn("nothing folds", moves.stderr.decode())
        for change in (unskinned,):
            with self.subTest(change.__name__ + " repaired"):
                furrow("character", "import", self.changed(change), "--repair", "--out",
                       self.root / "repaired.glb", check=0)

    def test_options_that_the_input_would_ignore_are_refused(self):
        for options, says in ((("--clothes", "shirt"), "MakeHuman's folder only"),
                              (("--data", self.root), ".mhm files only")):
            message = furrow("character", "import", self.changed(lambda *_: None), "--out", self.root / "none.glb",
                             *options, check=3).stderr.decode()
            self.assertIn(says, message)
            self.assertFalse((self.root / "none.glb").exists())

    def test_an_output_that_cannot_be_written_ends_an_import_at_once(self):
        absent = self.root / "absent"
        for out, code, says in ((self.root / "me.gltf", 2, "me.gltf' does not end with .glb"), (self.root, 2, "does not end with .glb"),
                                (absent / "me.glb", 1, f"{absent / 'me.glb'}: cannot create a file there")):
            # Without notes about the model, which come first in an import.
            message = furrow("character", "import", self.default, "--out", out, check=code).stderr.decode()
            self.assertEqual(message.count("\n"), 1, message)
            self.assertIn(says, message)
        self.assertFalse(absent.exists())

    def test_huge_pictures_are_rejected_before_decoding(self):
        def huge(root, binary):
            view = root["bufferViews"][root["images"][0]["bufferView"]]
            at = view["byteOffset"] + 16  # width and height of a PNG's header
            binary[at:at + 8] = struct.pack(">II", 60000, 60000)
            binary[at + 13:at + 17] = struct.pack(">I", zlib.crc32(bytes(binary[at - 4:at + 13])))
        self.refused(self.changed(huge), "images[0]")

    def test_a_z_up_model_in_centimetres_is_converted(self):
        def lay(root, _):
            root["nodes"].append({"name": "armature", "children": root["scenes"][0]["nodes"],
                                  "rotation": [0.70710678, 0, 0, 0.70710678], "scale": [100, 100, 100]})
            root["scenes"][0]["nodes"] = [len(root["nodes"]) - 1]
        path = self.changed(lay)
        report = json.loads(furrow("character", "check", path, "--json", check=0).stdout)
        codes = {f["code"] for f in report["findings"]}
        self.assertLessEqual({"up-axis", "units"}, codes)
        out = self.root / "stands.glb"
        furrow("character", "import", path, "--out", out, check=0)
        report = json.loads(furrow("character", "check", out, "--json", check=0).stdout)
        self.assertEqual(report["axes"], "up +Y, facing +Z")
        self.assertTrue(1.5 < report["height"] < 2.0, report["height"])


if __name__ == "__main__":
    unittest.main()
