#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`furrow bake` writes maps, a rig that names them and a report, or one clear error and no files."""
import json
import pathlib
import re
import signal
import struct
import subprocess
import tempfile
import time
import unittest
import zlib

from furrow_testing import BIN, GUARD, SHARE, commands, finish, furrow, needs_shared, solve, spawn

DONE, FAILED, USAGE, BAD_INPUT = range(4)
CELLS = 12
SIDE = 0.12  # metres


def sheet(uv=lambda s, t: (s, t), weights=lambda t: (1 - t, t), extra_triangles=()):
    """Returns a square of skin with joint `root` at the bottom and `tip` at the top: named mesh arrays."""
    lines = [(x / CELLS, y / CELLS) for y in range(CELLS + 1) for x in range(CELLS + 1)]
    at = lambda x, y: y * (CELLS + 1) + x
    triangles = []
    for y in range(CELLS):
        for x in range(CELLS):
            triangles += [(at(x, y), at(x + 1, y), at(x, y + 1)),
                          (at(x + 1, y), at(x + 1, y + 1), at(x, y + 1))]
    return {"POSITION": ("VEC3", 5126, "3f", [(SIDE * s, SIDE * t, 0.0) for s, t in lines]),
            "NORMAL": ("VEC3", 5126, "3f", [(0.0, 0.0, 1.0)] * len(lines)),
            "TEXCOORD_0": ("VEC2", 5126, "2f", [uv(s, 1 - t) for s, t in lines]),
            "JOINTS_0": ("VEC4", 5123, "4H", [(0, 1, 0, 0)] * len(lines)),
            "WEIGHTS_0": ("VEC4", 5126, "4f", [(*weights(t), 0.0, 0.0) for _, t in lines]),
            "indices": ("SCALAR", 5125, "3I", triangles + list(extra_triangles))}


def glb(mesh, lie=0, material="skin"):
    """Returns the sheet as a .glb with `tip` at the distance SIDE above `root`."""
    binary, views, accessors, places = b"", [], [], {}
    inverse_bind = [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -y, 0, 1) for y in (0.0, SIDE)]
    arrays = dict(mesh, matrices=("MAT4", 5126, "16f", inverse_bind))
    for name, (kind, component, layout, rows) in arrays.items():
        data = b"".join(struct.pack("<" + layout, *row) for row in rows)
        count = len(rows) * (3 if name == "indices" else 1)
        places[name] = len(accessors)
        accessor = {"bufferView": len(views), "componentType": component, "count": count, "type": kind}
        if name == "POSITION":
            accessor |= {"min": [min(r[i] for r in rows) for i in range(3)],
                         "max": [max(r[i] for r in rows) for i in range(3)]}
        accessors.append(accessor)
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data) + lie})
        binary += data
    attributes = {name: place for name, place in places.items() if name.isupper()}
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2]}],
        "nodes": [{"name": "root", "children": [1]}, {"name": "tip", "translation": [0, SIDE, 0]},
                  {"name": "sheet", "mesh": 0, "skin": 0}],
        "skins": [{"joints": [0, 1], "inverseBindMatrices": places["matrices"]}],
        "materials": [{"name": material}],
        "meshes": [{"name": "sheet", "primitives": [
            {"attributes": attributes, "indices": places["indices"], "material": 0}]}],
        "buffers": [{"byteLength": len(binary)}], "bufferViews": views, "accessors": accessors}).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body


def png(width, height, rows=b""):
    """Returns an RGBA8 PNG. Without rows the header declares more pixels than the file contains."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


WHITE = png(2, 2, b"\0" + b"\xff" * 8 + b"\0" + b"\xff" * 8)


def rig(down=-0.3 * SIDE, joint="tip", map_name="squash"):
    """Returns a rig with a pose that compresses the sheet by `down` metres."""
    return {"name": "sheet",
            "reference_poses": [{"name": "pressed", "joints": [{"joint": joint, "translation": [0, down, 0]}]}],
            "drivers": [{"name": "press", "pose": {"points": [{"joint": joint, "kind": "origin"}],
                                                   "values": [{"name": "squash", "reference_pose": "pressed"}]}}],
            "regions": [{"name": "all", "mask": {"texture": "mask.png"},
                         "feeds": [{"map": map_name, "sources": [{"from": "press.squash"}]}]}],
            "wrinkle_maps": [{"name": map_name, "surface": "skin"}]}


class BakeCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.out = self.root / "out"

    def package(self, mesh=None, rig_json=None, lie=0, mask=WHITE):
        """Writes a character with its rig and mask beside it."""
        path = self.root / "sheet.glb"
        path.write_bytes(glb(mesh or sheet(), lie))
        (self.root / "sheet.rig.json").write_text(json.dumps(rig_json or rig()))
        (self.root / "mask.png").write_bytes(mask)
        return path

    def bake(self, *args, size=64, check=DONE):
        return furrow("bake", *args, "--out", self.out, "--size", size, check=check)

    def refuse(self, code, *args, says):
        """The bake must fail with a message that contains each of `says`, and write no files."""
        before = sorted(p.name for p in self.root.iterdir())
        message = self.bake(*args, check=code).stderr.decode()
        for text in says:
            self.assertIn(text, message)
        self.assertLessEqual(message.count("\n"), 2, message)
        self.assertEqual(sorted(p.name for p in self.root.iterdir()), before)
        return message


class ClothTest(BakeCase):
    def test_fabrics_fold_in_their_own_way(self):
        cloth = rig()
        cloth["wrinkle_maps"][0]["surface"] = "cloth"
        heights = {}
        for fabric in ("denim", "jersey", "all=jersey"):
            package = self.package(rig_json=cloth)
            package.write_bytes(glb(sheet(), material="cloth"))
            self.out = self.root / fabric
            text = self.bake(package, "--fabric", fabric).stderr.decode()
            self.assertRegex(text, r"squash on cloth: [1-9]\d*% folded")
            heights[fabric] = (self.out / "squash_height.png").read_bytes()
        self.assertNotEqual(heights["denim"], heights["jersey"])
        self.assertEqual(heights["all=jersey"], heights["jersey"])
        package.write_bytes(glb(sheet(), material="cloth"))
        self.out = self.root / "tight"
        self.bake(package, "--ease", 0)
        self.assertNotEqual((self.out / "squash_height.png").read_bytes(), heights["jersey"])


class BadInputTest(BakeCase):
    def test_no_uvs(self):
        mesh = sheet()
        del mesh["TEXCOORD_0"]
        self.refuse(BAD_INPUT, self.package(mesh), says=["sheet.glb: mesh 'sheet'", "no UVs", "unwrap"])

    def test_vertices_without_skin(self):
        loose = sheet(weights=lambda t: (0.0, 0.0) if t > 0.9 else (1 - t, t))
        self.refuse(BAD_INPUT, self.package(loose), says=["sheet.glb", "skin weights", "sum to 0"])

    def test_pose_equal_to_rest(self):
        self.refuse(BAD_INPUT, self.package(rig_json=rig(down=0.0)),
                    says=["sheet.rig.json: regions[0].feeds[0].sources[0]", "'pressed' equals the rest pose"])

    def test_unknown_joint(self):
        self.refuse(BAD_INPUT, self.package(rig_json=rig(joint="top")), says=["sheet.rig.json", "'top'"])

    def test_no_rig(self):
        package = self.package()
        package.with_suffix(".rig.json").unlink()
        self.refuse(BAD_INPUT, package, says=["no wrinkle rig", "--rig"])

    def test_unknown_map(self):
        self.refuse(BAD_INPUT, self.package(), "--map", "folds", says=["no wrinkle map 'folds'", "squash"])

    def test_map_on_a_missing_surface(self):
        cloth = rig()
        cloth["wrinkle_maps"][0]["surface"] = "cloth"
        package = self.package(rig_json=cloth)
        self.refuse(BAD_INPUT, package, says=["is drawn on cloth", "no mesh is cloth"])
        self.assertIn(b"[rig-surface]", furrow("character", "check", package, check=BAD_INPUT).stdout)

    def test_maps_on_missing_surfaces_are_left_out(self):
        both = rig()
        both["wrinkle_maps"].append({"name": "folds", "surface": "cloth"})
        both["regions"][0]["feeds"].append({"map": "folds", "sources": [{"from": "press.squash"}]})
        package = self.package(rig_json=both)
        self.assertIn(b"warning: wrinkle map 'folds' is drawn on cloth",
                      furrow("character", "check", package, check=DONE).stdout)
        result = furrow("bake", package, "--out", self.out, "--size", 64, check=DONE)
        self.assertIn("'folds' is drawn on cloth, but no mesh is cloth; the map is left out", result.stderr.decode())
        self.assertFalse(list(self.out.glob("folds*")))
        self.assertTrue((self.out / "squash_height.png").exists())
        self.refuse(BAD_INPUT, package, "--map", "folds", says=["no mesh is cloth"])

    def test_fabrics_and_regions_that_do_not_exist(self):
        package = self.package()
        message = furrow("bake", package, "--out", self.out, "--fabric", "silk", check=USAGE).stderr.decode()
        self.assertIn("unknown fabric 'silk'", message)
        self.assertIn("denim", message)
        self.refuse(BAD_INPUT, package, "--fabric", "neck=denim", says=["no region 'neck'", "--fabric"])
        self.refuse(BAD_INPUT, package, "--fabric", "all=denim", says=["no region 'all' that folds cloth"])

    def test_sizes_out_of_range(self):
        package = self.package()
        for size in (0, 63, 4097, 1 << 20, 1 << 40, -1):
            self.assertEqual(furrow("bake", package, "--out", self.out, "--size", size).returncode, USAGE)
        self.assertFalse(self.out.exists())

    def test_huge_texture(self):
        self.refuse(BAD_INPUT, self.package(mask=png(32767, 32767)), says=["mask.png", "32767 x 32767"])

    def test_gltf_that_lies_about_its_buffers(self):
        self.refuse(BAD_INPUT, self.package(lie=1 << 20), says=["sheet.glb"])

    def test_no_such_file(self):
        self.refuse(BAD_INPUT, self.root / "nobody.glb", says=["nobody.glb"])

    def test_strokes(self):
        strokes = self.root / "s.json"
        good = '{"strokes": [\n{"name": "a", "maps": ["squash"],\n"points": [[0, 0, 0], [0.1, 0, 0]]}]}'
        for old, new, says in (("squash", "folds", ["s.json:2: strokes[0].maps[0]", "'folds'"]),
                               ("points", "pionts", ["s.json:3: strokes[0].pionts", "unknown field"]),
                               ("[0.1, 0, 0]", "[100000, 0, 0]", ["s.json:3: strokes[0].points[1]", "metres"]),
                               ("}]}", "}]", ["s.json"])):
            strokes.write_text(good.replace(old, new))
            self.refuse(BAD_INPUT, self.package(), "--strokes", strokes, says=says)

    def test_folder_that_cannot_be_written(self):
        package = self.package()
        self.out.write_text("in the way")
        self.refuse(FAILED, package, says=[str(self.out), "not a folder"])
        result = furrow("bake", package, "--out", "/proc/furrow/out", check=FAILED)
        self.assertIn("/proc/furrow", result.stderr.decode())

    def test_interrupt_leaves_nothing(self):
        package = self.package()
        process = spawn("bake", package, "--out", self.out, "--size", 4096)
        for _ in range(600):  # until the bake has created its temporary folder
            if any(p.name.startswith(".out.") for p in self.root.iterdir()) or process.poll() is not None:
                break
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        code, _, message = finish(process)
        self.assertEqual(code, FAILED, message)
        self.assertIn("nothing was written", message)
        self.assertEqual(sorted(p.name for p in self.root.iterdir()), ["mask.png", "sheet.glb", "sheet.rig.json"])


class SheetTest(BakeCase):
    def test_mirrored_halves_are_baked_with_a_warning(self):
        mirrored = sheet(uv=lambda s, t: (min(s, 1 - s), t))
        message = self.bake(self.package(mirrored)).stderr.decode()
        self.assertIn("mesh 'sheet': UVs overlap on", message)
        self.assertIn("squash on skin", message)

    def test_writes_maps_a_rig_and_a_report(self):
        message = self.bake(self.package()).stderr.decode()
        self.assertIn("squash on skin", message)
        names = sorted(str(p.relative_to(self.out)) for p in self.out.rglob("*") if p.is_file())
        self.assertEqual(names, ["mask.png", "report.html", "report/squash_height.png", "report/squash_lit.png",
                                 "report/squash_masks.png", "sheet.rig.json", "squash_cavity.png",
                                 "squash_colour.png", "squash_derivative.png", "squash_height.png",
                                 "suggested_masks_skin_0.png"])
        baked = json.loads((self.out / "sheet.rig.json").read_text())
        entry = baked["wrinkle_maps"][0]
        self.assertEqual(entry["derivative"], "squash_derivative.png")
        self.assertEqual(entry["height"], "squash_height.png")
        self.assertEqual(entry["cavity"], "squash_cavity.png")
        self.assertEqual(entry["colour"], "squash_colour.png")
        self.assertGreater(entry["derivative_scale"], 0.0)
        self.assertGreater(entry["height_mm"], 0.0)
        furrow("rig", "check", self.out / "sheet.rig.json", check=DONE)
        report = (self.out / "report.html").read_text()
        for text in ("squash", "compression", "report/squash_lit.png"):
            self.assertIn(text, report)

    def test_threads_do_not_change_a_byte(self):
        package = self.package()
        seen = []
        for threads in (1, 3):
            self.bake(package, "--threads", threads)
            seen.append([(self.out / f).read_bytes() for f in ("squash_derivative.png", "squash_height.png")])
        self.assertEqual(*seen)

    def test_depth_scales_and_zero_is_flat(self):
        package = self.package()
        heights = []
        for depth in ("1", "0.5", "0"):
            self.bake(package, "--depth", depth, "--format", "exr")
            report = (self.out / "report.html").read_text()
            heights.append(float(report.split("<td>valleys</td><td>")[1].split()[0]))
        self.assertGreater(heights[0], 0.05)
        self.assertAlmostEqual(heights[1], heights[0] / 2, delta=0.02)
        self.assertEqual(heights[2], 0.0)

    def test_exr_holds_floats(self):
        self.bake(self.package(), "--format", "exr")
        entry = json.loads((self.out / "sheet.rig.json").read_text())["wrinkle_maps"][0]
        self.assertEqual(entry["derivative"], "squash_derivative.exr")
        self.assertEqual((self.out / "squash_derivative.exr").read_bytes()[:4], b"\x76\x2f\x31\x01")
        again = ["--rig", self.out / "sheet.rig.json", "--out", self.root / "again", "--size", 64]
        furrow("bake", self.root / "sheet.glb", *again, check=DONE)  # the baked rig can be read

    def test_suggested_masks_go_into_the_rig_when_asked(self):
        package = self.package()
        self.bake(package)
        mask = lambda: json.loads((self.out / "sheet.rig.json").read_text())["regions"][0]["mask"]["texture"]
        self.assertEqual(mask(), "mask.png")
        self.bake(package, "--masks")
        self.assertEqual(mask(), "masks_skin_0.png")

    def test_an_edited_mask_survives_another_bake(self):
        package = self.package()
        self.bake(package, "--masks")
        edited = self.out / "masks_skin_0.png"
        edited.write_bytes(WHITE)
        again = self.root / "again"
        furrow("bake", package, "--rig", self.out / "sheet.rig.json", "--out", again, "--size", 64, check=DONE)
        self.assertEqual((again / "masks_skin_0.png").read_bytes(), WHITE)
        baked = json.loads((again / "sheet.rig.json").read_text())
        self.assertEqual(baked["regions"][0]["mask"]["texture"], "masks_skin_0.png")
        self.assertTrue((again / "suggested_masks_skin_0.png").exists())

    def test_the_source_rig_is_not_overwritten(self):
        package = self.package()
        mine = (self.root / "sheet.rig.json").read_bytes()
        result = furrow("bake", package, "--out", self.root, "--size", 64, check=BAD_INPUT)
        self.assertIn("would replace the rig it is made from", result.stderr.decode())
        self.assertEqual((self.root / "sheet.rig.json").read_bytes(), mine)
        self.assertEqual(sorted(p.name for p in self.root.iterdir()), ["mask.png", "sheet.glb", "sheet.rig.json"])

    def test_other_files_of_the_folder_stay(self):
        self.out.mkdir()
        (self.out / "notes.txt").write_text("mine")
        self.bake(self.package())
        self.assertEqual((self.out / "notes.txt").read_text(), "mine")
        self.assertTrue((self.out / "report" / "squash_lit.png").exists())
        self.assertEqual([p.name for p in self.root.iterdir() if p.name.startswith(".")], [])

    def test_triangles_without_area_are_counted_and_skipped(self):
        package = self.package(sheet(extra_triangles=[(0, 1, 2), (5, 5, 5)]))
        self.assertIn("2 triangles of the skin have no area", self.bake(package).stderr.decode())

    def test_a_stroke_folds_what_no_pose_does(self):
        still = rig(down=0.1 * SIDE)  # a stretch, which makes no folds
        strokes = self.root / "s.json"
        strokes.write_text(json.dumps({"strokes": [
            {"name": "a", "maps": ["squash"], "depth_mm": 1, "width_mm": 4,
             "points": [[0.02, 0.06, 0], [0.1, 0.06, 0]]}]}))
        flat = self.bake(self.package(rig_json=still)).stderr.decode()
        self.assertIn("0% folded", flat)
        folded = self.bake(self.package(rig_json=still), "--strokes", strokes).stderr.decode()
        self.assertNotIn(" 0% folded", folded)


class CharactersTest(BakeCase):
    def picture(self, character, *args):
        """Returns the picture of `furrow render --pose squash`."""
        shots = self.root / "shots"
        furrow("render", "--character", character, "--pose", "squash", "--out", shots, "--size", "96x96", *args,
               check=DONE)
        return (shots / "000000.png").read_bytes()

    def test_default_character(self):
        character = SHARE / "default.glb"
        message = self.bake(character, size=256).stderr.decode()
        for name in ("stretch on skin", "squash on skin", "folds on cloth"):
            self.assertIn(name, message)
        baked = self.out / "default.rig.json"
        self.assertNotEqual(self.picture(character, "--rig", baked),
                            self.picture(character, "--rig", baked, "--wrinkles", "off"))

    def test_commands_of_the_manual(self):
        for name in ("default.glb", "default.rig.json"):
            (self.root / name.replace("default", "face")).symlink_to(SHARE / name)
            (self.root / name).symlink_to(SHARE / name)
        seen = 0
        for words in (*commands("docs/BAKE.md"), *commands("docs/RIG.md")):
            small = ["--size", "128"] if words[1] == "bake" else []
            result = subprocess.run([BIN / words[0], *words[1:], *small], cwd=self.root, capture_output=True,
                                    timeout=GUARD)
            self.assertEqual(result.returncode, DONE, (words, result.stderr.decode()))
            seen += 1
        self.assertEqual(seen, 3)

    def test_patch_becomes_a_driver(self):
        patch = furrow("rig", "patch", SHARE / "default.glb", "--name", "forehead", "--region", "brow_l",
                       "--radius", "10", check=DONE)
        rig_json = json.loads(re.sub(r"^\s*//.*$", "", (SHARE / "default.rig.json").read_text(), flags=re.M))
        rig_json["drivers"].append(json.loads(patch.stdout))
        rig_json["regions"][0]["feeds"][0]["sources"].append({"from": "forehead.along"})
        pasted = self.root / "pasted.rig.json"
        pasted.write_text(json.dumps(rig_json))
        recording = SHARE / "recordings" / "performance.bvh"
        table = solve(recording, "--rig", pasted, "--drivers")
        along = table.column("forehead.along")
        self.assertLess(along[0], 0.05)
        self.assertGreater(max(along.values()), 0.1)
        furrow("rig", "explain", pasted, recording, "--frame", "0", check=DONE)

    def test_patch_errors(self):
        glb_path = SHARE / "default.glb"
        for words, says in ((["--joint", "nobody"], "no joint 'nobody'"), (["--around", "9,9,9"], "the nearest is at"),
                            (["--joint", "jaw", "--mesh", "tail"], "no mesh 'tail'"),
                            (["--region", "tail"], "no region 'tail'"),
                            (["--joint", "zygomaticus_l", "--direction", "0,0,0"], "direction")):
            result = furrow("rig", "patch", glb_path, *words, check=BAD_INPUT)
            self.assertIn(says, result.stderr.decode())
        for words in ([], ["--around", "1,2"], ["--joint", "jaw", "--region", "nose"]):
            furrow("rig", "patch", glb_path, *words, check=USAGE)

    def test_makehuman(self):
        folder = needs_shared("makehuman")
        character = self.root / "makehuman.glb"
        furrow("character", "import", folder, "--out", character, check=DONE)
        message = self.bake(character, size=256).stderr.decode()
        self.assertIn("squash on skin", message)
        self.assertTrue((self.out / "makehuman.rig.json").exists())


if __name__ == "__main__":
    unittest.main()
