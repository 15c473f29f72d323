#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The Unity package under Mono, with stand-ins for Unity, against the real library and daemon."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE)]
import meta_files  # pylint: disable=wrong-import-position
from engine_testing import ENGINES, FRAMES, GUARD, LIBRARY, RATE, EngineTest, main, need  # pylint: disable=wrong-import-position

PACKAGE = ENGINES / "unity"


class UnityTest(EngineTest):
    @classmethod
    def setUpClass(cls):
        cls.mono = need("mono")
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="furrow-unity-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)

    def compile(self, name, *sources):
        """Compiles for C# 7.2, which Unity 2019.4 has; warnings are errors."""
        out = self.folder / name
        done = subprocess.run([need("mcs"), "-langversion:7.2", "-warn:4", "-warnaserror", f"-out:{out}", *map(str, sources)],
                              capture_output=True, text=True, timeout=GUARD, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return out

    def test_the_core_needs_no_unity(self):
        self.compile("core.dll", "-target:library", *PACKAGE.glob("Runtime/Core/*.cs"))

    def test_two_subjects_on_two_meshes(self):
        sources = sorted(PACKAGE.rglob("*.cs"))
        self.assertGreater(len(sources), 12)
        program = self.check_plugin(
            lambda daemon: [self.mono, self.compile("program.exe", *sources, HERE / "StandIns.cs", HERE / "Program.cs"),
                            f"furrow://127.0.0.1:{daemon.ports['udp']}", FRAMES],
            env={"LD_LIBRARY_PATH": str(LIBRARY)}, phone="cam")
        received = program.wait_for("received")
        # One blend shape and two entries of wrinkles.json use two weights.
        self.assertRegex(received["status"], r"^\d+ ms old, 0 missed, 2 of \d\d+ names in use$")
        self.assertGreater(received["highest"], 0.2, "the performance raises the brows")
        take = program.wait_for("recorded")
        self.assertGreaterEqual(take["keys"], FRAMES)
        self.assertAlmostEqual(take["length"], (take["keys"] - 1) / RATE, delta=0.05)
        program.wait_for("end")

    def test_every_asset_has_its_meta_file(self):
        expected = {meta_files.meta_of(path): meta_files.text_of(path, PACKAGE) for path in meta_files.assets(PACKAGE)}
        self.assertGreater(len(expected), 20)
        found = {path: path.read_text() for path in PACKAGE.rglob("*.meta")}
        self.assertEqual(found, expected, f"run {HERE / 'meta_files.py'} {PACKAGE}, and delete what is left over")
        guids = [text.split("guid: ")[1][:32] for text in found.values()]
        self.assertEqual(len(set(guids)), len(guids))

    def test_unity_finds_its_parts(self):
        package = json.loads((PACKAGE / "package.json").read_text())
        self.assertRegex(package["name"], r"^com(\.\w+)+$")
        for sample in package["samples"]:
            self.assertTrue(any((PACKAGE / sample["path"]).glob("*.cs")))
        assemblies = {}
        for path in PACKAGE.rglob("*.asmdef"):
            assembly = json.loads(path.read_text())
            self.assertEqual(path.stem, assembly["name"])
            assemblies[assembly["name"]] = assembly.get("references", [])
        self.assertEqual(set(assemblies), {"Furrow.Runtime", "Furrow.Editor", "Furrow.Tests"})
        for references in assemblies.values():
            self.assertLessEqual(set(references), set(assemblies))


if __name__ == "__main__":
    main()
