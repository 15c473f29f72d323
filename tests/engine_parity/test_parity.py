#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The normals that engines draw with an export equal those of the renderer: Blender (Cycles and Eevee) and Godot."""
import json
import pathlib
import shutil
import struct
import tempfile
import unittest

from parity_testing import GLB, SIZE, GlbMeshes, Parity, export, run

HERE = pathlib.Path(__file__).resolve().parent


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


def needs(*programs):
    """Skips a test whose programs are not installed."""
    missing = [program for program in programs if shutil.which(program) is None]
    return unittest.skipIf(missing, f"not installed: {', '.join(missing)}")


class EngineParity(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.exports = {engine: export(engine, cls.folder / engine) for engine in ("blender", "godot")}
        cls.parity = Parity(cls.folder, cls.exports["blender"])

    def job(self, engine, **content):
        """Writes what the engine's script reads. Returns the path."""
        path = self.folder / f"{engine}.json"
        skin = [m["name"] for m in self.exports[engine]["materials"] if m["surface"] == "skin"]
        path.write_text(json.dumps({"wrinkles": str(self.folder / engine / "wrinkles.json"), "materials": skin,
                                    "camera": self.parity.camera, "size": SIZE, **content}))
        return path

    @needs("blender")
    def test_blender(self):
        engines = {"CYCLES": 16, "BLENDER_EEVEE": 1}
        pictures = [{"engine": engine, "samples": samples, "weights": weights, "set": key,
                     "file": str(self.folder / f"{engine}_{key}.png")}
                    for engine, samples in engines.items() for key, weights in self.parity.sets.items()]
        job = self.job("blender", glb=str(GLB), nodes=str(self.folder / "blender"), pictures=pictures)
        run(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", HERE / "blender_normals.py",
             "--", job])
        for engine in engines:
            self.parity.compare(self, engine.lower(), {p["set"]: p["file"] for p in pictures if p["engine"] == engine})

    @needs("godot3-runner", "xvfb-run")
    def test_godot(self):
        """godot3-runner draws under a virtual X server."""
        skin = {m["name"] for m in self.exports["godot"]["materials"] if m["surface"] == "skin"}
        glb = GlbMeshes(GLB.read_bytes(), skin)
        meshes = []
        for i, primitive in enumerate(glb.primitives):
            path = self.folder / f"{i}.mesh"
            vertices, indices = write_mesh(glb, primitive, path)
            meshes.append({"file": str(path), "vertices": vertices, "indices": indices,
                           "material": glb.json["materials"][primitive["material"]]["name"]})
        pictures = {key: str(self.folder / f"godot_{key}.png") for key in self.parity.sets}
        project = self.folder / "project"
        shutil.copytree(HERE / "godot", project)
        shutil.copy(self.folder / "godot" / "furrow_material.gd", project)
        job = self.job("godot", script="res://furrow_material.gd", meshes=meshes,
                       pictures=[{"file": pictures[key], "weights": weights} for key, weights in self.parity.sets.items()])
        output = run(["xvfb-run", "-a", "-s", "-screen 0 800x800x24", "godot3-runner", "--path", project,
                      "--audio-driver", "Dummy", "--video-driver", "GLES3", "-s", "normals.gd", job])
        self.assertNotIn("SHADER ERROR", output)
        self.parity.compare(self, "godot", pictures)


if __name__ == "__main__":
    unittest.main()
