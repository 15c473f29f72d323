#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The normals of Godot's shader equal those of the renderer. godot3-runner draws under a virtual X server."""
import json
import pathlib
import shutil
import struct
import sys
import tempfile
import unittest

from parity_testing import GLB, SIZE, GlbMeshes, Parity, export, run

HERE = pathlib.Path(__file__).resolve().parent
PROGRAMS = ("godot3-runner", "xvfb-run")


def write_mesh(glb, primitive, path):
    """Vertices of 12 floats and indices, as normals.gd reads them. Returns both counts."""
    attributes = primitive["attributes"]
    columns = [(glb.numbers(attributes[name]), width)
               for name, width in (("POSITION", 3), ("NORMAL", 3), ("TANGENT", 4), ("TEXCOORD_0", 2))]
    count = len(columns[0][0]) // 3
    indices = glb.numbers(primitive["indices"])
    with open(path, "wb") as file:
        for i in range(count):
            for values, width in columns:
                file.write(struct.pack(f"<{width}f", *values[i * width:(i + 1) * width]))
        # glTF counts corners against the clock, Godot with it.
        for i in range(0, len(indices), 3):
            file.write(struct.pack("<3I", indices[i], indices[i + 2], indices[i + 1]))
    return count, len(indices)


class GodotParity(unittest.TestCase):
    def test_normals(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            wrinkles = export("godot", folder / "export")
            parity = Parity(folder, wrinkles)
            skin = [m["name"] for m in wrinkles["materials"] if m["surface"] == "skin"]
            glb = GlbMeshes(GLB.read_bytes(), skin)
            meshes = []
            for i, primitive in enumerate(glb.primitives):
                vertices, indices = write_mesh(glb, primitive, folder / f"{i}.mesh")
                meshes.append({"file": str(folder / f"{i}.mesh"), "vertices": vertices, "indices": indices,
                               "material": glb.json["materials"][primitive["material"]]["name"]})
            pictures = {key: str(folder / f"godot_{key}.png") for key in parity.sets}
            project = folder / "project"
            shutil.copytree(HERE / "godot", project)
            shutil.copy(folder / "export" / "furrow_material.gd", project)
            job = {"script": "res://furrow_material.gd", "wrinkles": str(folder / "export" / "wrinkles.json"),
                   "camera": parity.camera, "size": SIZE, "meshes": meshes,
                   "pictures": [{"file": pictures[key], "weights": weights} for key, weights in parity.sets.items()]}
            (folder / "job.json").write_text(json.dumps(job))
            run(["xvfb-run", "-a", "-s", "-screen 0 800x800x24", "godot3-runner", "--path", project, "--audio-driver",
                 "Dummy", "--video-driver", "GLES3", "-s", "normals.gd", folder / "job.json"])
            parity.compare(self, "godot", pictures)


if __name__ == "__main__":
    if any(shutil.which(program) is None for program in PROGRAMS):
        sys.exit(77)
    unittest.main()
