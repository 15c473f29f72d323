# SPDX-License-Identifier: Apache-2.0
"""Normals as an engine draws them, against `furrow render --view normal` from the same camera.

The character rests; only its wrinkle weights change. So the renderer gets a rig in which each weight follows a blend
shape, and `--pose` sets them.
"""
import json
import math
import os
import pathlib
import re
import struct
import subprocess
import sys

SOURCE = pathlib.Path(os.environ["FURROW_SOURCE"])
BIN = pathlib.Path(os.environ["FURROW_BIN"])
sys.path.insert(0, str(SOURCE / "tests" / "end_to_end"))
from furrow_testing import furrow, png_rows  # noqa: E402

SHARE = BIN.parent / "share" / "furrow"
GLB = SHARE / "default.glb"
SIZE = 640
CAMERA = "face"
MAX_RMSE = 3.0  # of 255
# The folds must change the picture by more than this, or the comparison proves nothing.
MIN_CHANGE = 2 * MAX_RMSE
KEEP = os.environ.get("FURROW_PARITY_PICTURES")  # a folder that receives the pictures, for the documents


def weight_sets(names):
    """Three sets of weights of the face: name -> value."""
    return {
        "squash": {n: 1.0 for n in names if n.endswith(".squash")},
        "stretch": {n: 1.0 for n in names if n.endswith(".stretch")},
        "mixed": {"brow_l.squash": 0.8, "glabella.squash": 0.6, "brow_r.stretch": 1.0, "nose.squash": 0.5,
                  "eye_r.squash": 0.9, "mouth_l.squash": 1.0, "mouth_r.stretch": 0.7},
    }


def export(engine, folder, *options):
    furrow("export", GLB, "--for", engine, "--out", folder, *options, check=0)
    return json.loads((folder / "wrinkles.json").read_text())


def shape_rig(path, wrinkles):
    """Writes the default rig with a blend shape w<index> for each weight of the face."""
    text = (SHARE / "default.rig.json").read_text()
    rig = json.loads(re.sub(r"(?m)(^|\s)//.*$", "", text))
    face = [w for w in wrinkles["weights"] if w["region"] in FACE_REGIONS]
    regions = []
    for region in rig["regions"]:
        own = [w for w in face if w["region"] == region["name"]]
        if own:
            regions.append({"name": region["name"], "mask": region["mask"], "modulation": "linear", "feeds": [
                {"map": w["name"].split(".")[1], "sources": [{"from": f"w{w['index']}.value"}]} for w in own]})
    drivers = [{"name": f"w{w['index']}", "blend_shape": {"blend_shape": f"w{w['index']}"}} for w in face]
    path.write_text(json.dumps({"name": "parity", "anchor": rig["anchor"], "drivers": drivers, "regions": regions,
                                "wrinkle_maps": rig["wrinkle_maps"], "filter": {"enabled": False}}))


FACE_REGIONS = {"brow_l", "brow_r", "glabella", "nose", "eye_l", "eye_r", "mouth_l", "mouth_r"}


def reference(folder, rig, pose, view="normal"):
    """The renderer's picture, one sample per pixel: rows of pixels."""
    furrow("render", "--character", GLB, "--rig", rig, "--pose", pose, "--out", folder, "--view", view, "--camera", CAMERA,
           "--size", f"{SIZE}x{SIZE}", "--set", "anti_aliasing.samples=1", "--set", "anti_aliasing.fxaa=off", check=0)
    return (folder / "000000.png").read_bytes()


def pose_of(weights, wrinkles):
    index = {w["name"]: w["index"] for w in wrinkles["weights"]}
    return ",".join(f"w{index[name]}={value}" for name, value in weights.items()) or "neutral"


def skin_pixels(rows):
    """The pixels of the view `material` that show skin, without those beside something else."""
    skin = [[p[0] > 2 * max(p[1], p[2]) and p[0] > 40 for p in row] for row in rows]
    return [[all(skin[j][i] for j in range(max(y - 2, 0), min(y + 3, SIZE)) for i in range(max(x - 2, 0), min(x + 3, SIZE)))
             for x in range(SIZE)] for y in range(SIZE)]


def rmse(a, b, inside):
    total = count = 0
    for row_a, row_b, row in zip(a, b, inside):
        for p, q, is_in in zip(row_a, row_b, row):
            if is_in:
                total += sum((x - y) ** 2 for x, y in zip(p[:3], q[:3]))
                count += 3
    assert count > 0.1 * 3 * SIZE * SIZE, "no face in the picture"
    return math.sqrt(total / count)


class Parity:
    """Pictures of the renderer, drawn once, and the comparison with those of an engine."""

    def __init__(self, folder, wrinkles):
        self.folder = folder
        self.wrinkles = wrinkles
        self.sets = weight_sets([w["name"] for w in wrinkles["weights"]])
        rig = folder / "parity.rig.json"
        shape_rig(rig, wrinkles)
        self.camera = next(c for c in wrinkles["cameras"] if c["name"] == CAMERA)
        self.inside = skin_pixels(png_rows(reference(folder / "material", rig, "neutral", "material")))
        self.neutral = png_rows(reference(folder / "neutral", rig, "neutral"))
        self.expected = {name: reference(folder / name, rig, pose_of(weights, wrinkles))
                         for name, weights in self.sets.items()}

    def compare(self, test, engine, pictures):
        """`pictures`: the engine's PNG files by the name of the set of weights."""
        for name, expected in self.expected.items():
            with test.subTest(engine=engine, weights=name):
                actual = pathlib.Path(pictures[name]).read_bytes()
                if KEEP:
                    keep = pathlib.Path(KEEP)
                    (keep / f"{engine}_{name}.png").write_bytes(actual)
                    (keep / f"furrow_{name}.png").write_bytes(expected)
                rows = png_rows(expected)
                error = rmse(rows, png_rows(actual), self.inside)
                change = rmse(rows, self.neutral, self.inside)
                print(f"{engine}, {name}: {error:.2f}/255 (the folds change the picture by {change:.1f}/255)")
                test.assertLessEqual(error, MAX_RMSE)
                test.assertGreater(change, MIN_CHANGE)


def run(command, **options):
    """Runs an engine and returns what it prints, which is shown if it fails."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=600, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command[0]} ended with {done.returncode}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout + done.stderr


class GlbMeshes:
    """The rest pose of the meshes of a .glb whose material has one of `materials`."""

    def __init__(self, data, materials):
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + length])
        self.bin = data[20 + length + 8:]
        self.primitives = [p for mesh in self.json["meshes"] for p in mesh["primitives"]
                           if self.json["materials"][p["material"]]["name"] in materials]

    def numbers(self, index):
        """The numbers of an accessor, one after another."""
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        code, size = {5126: ("f", 4), 5125: ("I", 4), 5123: ("H", 2), 5121: ("B", 1)}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", size * width)
        assert stride == size * width, "interleaved"
        return struct.unpack_from(f"<{accessor['count'] * width}{code}", self.bin, start)
