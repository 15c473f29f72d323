#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The normals of Blender's node group equal those of the renderer, in Cycles and in Eevee."""
import json
import pathlib
import shutil
import sys
import tempfile
import unittest

from parity_testing import GLB, SIZE, Parity, export, run

HERE = pathlib.Path(__file__).resolve().parent


class BlenderParity(unittest.TestCase):
    def test_normals(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            wrinkles = export("blender", folder / "export")
            parity = Parity(folder, wrinkles)
            pictures = [{"engine": engine, "samples": samples, "weights": weights, "set": key,
                         "file": str(folder / f"{engine}_{key}.png")}
                        for engine, samples in (("CYCLES", 16), ("BLENDER_EEVEE", 1))
                        for key, weights in parity.sets.items()]
            job = {"glb": str(GLB), "nodes": str(folder / "export"), "wrinkles": str(folder / "export" / "wrinkles.json"),
                   "materials": [m["name"] for m in wrinkles["materials"] if m["surface"] == "skin"],
                   "camera": parity.camera, "size": SIZE, "pictures": pictures}
            (folder / "job.json").write_text(json.dumps(job))
            run(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                 HERE / "blender_normals.py", "--", folder / "job.json"])
            for engine in ("CYCLES", "BLENDER_EEVEE"):
                parity.compare(self, engine.lower(), {p["set"]: p["file"] for p in pictures if p["engine"] == engine})


if __name__ == "__main__":
    if shutil.which("blender") is None:
        sys.exit(77)
    unittest.main()
