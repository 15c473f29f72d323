#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The Unreal plug-in's sources, compiled against stand-ins for Unreal, with the real library and daemon."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from engine_testing import ENGINES, FRAMES, GUARD, LIBRARY, SOURCE, EngineTest, main  # pylint: disable=wrong-import-position

MODULE = ENGINES / "unreal" / "Source" / "FurrowLiveLink"
SHADERS_MODULE = ENGINES / "unreal" / "Source" / "FurrowShaders"
COMPILER = [os.environ.get("CXX", "c++"), "-std=c++17", "-Wall", "-Wextra", "-Werror", "-I", HERE / "stand_ins"]


class UnrealTest(EngineTest):
    def test_two_subjects(self):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="furrow-unreal-"))
        self.addCleanup(shutil.rmtree, folder)
        program = folder / "program"
        done = subprocess.run(
            [*COMPILER, "-I", MODULE / "Public", "-I", MODULE / "Private", "-I", SOURCE / "client" / "c" / "include", HERE / "program.cpp",
             *sorted(MODULE.glob("Private/*.cpp")), "-o", program, "-L", LIBRARY, "-lfurrow", "-pthread"],
            capture_output=True, text=True, timeout=GUARD, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.check_plugin(
            lambda daemon: [program, f"furrow://127.0.0.1:{daemon.ports['udp']}?subject=ada&subject=bob&subject=cam", FRAMES],
            env={"LD_LIBRARY_PATH": str(LIBRARY)}, phone="cam").wait_for("end")

    def test_exported_shaders_are_found(self):
        """Custom nodes include /Plugin/Furrow/..., which Unreal knows only if a module maps it before the engine starts."""
        folder = pathlib.Path(tempfile.mkdtemp(prefix="furrow-unreal-"))
        self.addCleanup(shutil.rmtree, folder)
        program = folder / "program"
        done = subprocess.run([*COMPILER, HERE / "shaders_program.cpp", *sorted(SHADERS_MODULE.glob("Private/*.cpp")), "-o", program],
                              capture_output=True, text=True, timeout=GUARD, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        out = subprocess.run([program], capture_output=True, text=True, timeout=GUARD, check=True).stdout
        self.assertEqual(out, "/Plugin/Furrow = ../../../Project/Plugins/Furrow/Shaders\n")
        self.assertTrue((ENGINES / "unreal" / "Shaders" / "FurrowWrinkles.ush").exists())

    def test_the_source_stays_small(self):
        lines = sum(len(path.read_text().splitlines()) for path in MODULE.rglob("FurrowLiveLinkSource.*"))
        self.assertLessEqual(lines, 150)

    def test_the_description(self):
        plugin = json.loads((ENGINES / "unreal" / "Furrow.uplugin").read_text())
        self.assertEqual(plugin["FileVersion"], 3)
        self.assertEqual([(m["Name"], m["Type"], m["LoadingPhase"]) for m in plugin["Modules"]],
                         [("FurrowLiveLink", "Runtime", "Default"), ("FurrowShaders", "Runtime", "PostConfigInit")])
        self.assertIn({"Name": "LiveLink", "Enabled": True}, plugin["Plugins"])
        for path in MODULE.parent.rglob("*.[ch]*"):
            self.assertTrue(path.read_text().startswith("// SPDX-License-Identifier"), path)


if __name__ == "__main__":
    main()
