#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The Godot 3 add-on in Godot, without a display."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from engine_testing import ENGINES, FRAMES, GUARD, RATE, EngineTest, Program, main, need  # pylint: disable=wrong-import-position


class GodotTest(EngineTest):
    def project(self, script):
        """A project with the add-on and a script. Returns its folder."""
        folder = pathlib.Path(tempfile.mkdtemp(prefix="furrow-godot-"))
        self.addCleanup(shutil.rmtree, folder)
        shutil.copytree(ENGINES / "godot" / "addons", folder / "addons")
        for name in ("project.godot", script):
            shutil.copy(HERE / name, folder)
        return folder

    def test_the_editor_loads_the_plugin(self):
        project = self.project("client.gd")
        done = subprocess.run([need("godot3-server"), "--path", project, "--editor", "--quit"], capture_output=True, text=True,
                              timeout=GUARD, check=False, env={**os.environ, "HOME": str(project)})
        output = done.stdout + done.stderr
        self.assertNotRegex(output, "SCRIPT ERROR|failed to load|Removing from enabled", output)
        self.assertIn('enabled=PoolStringArray( "furrow" )', (project / "project.godot").read_text())

    def test_hostile_messages_are_ignored(self):
        project = self.project("hostile.gd")
        program = Program([need("godot3-server"), "--path", project, "-s", "hostile.gd"], {"HOME": str(project)})
        self.addCleanup(program.stop)
        seen = program.wait_for("hostile")
        self.assertEqual(program.finish(), 0)
        self.assertEqual((seen["before_names"], seen["strange"], seen["good"]), (0, 0, 1))
        self.assertEqual((seen["subjects"], seen["missed"]), (256, 1))
        self.assertEqual(seen["timecodes"], ["10:00:00;02", "", ""])
        self.assertTrue(seen["too_many"].startswith("not connected: 65 subjects"), seen["too_many"])
        self.assertNotRegex(program.text, "FAILED|SCRIPT ERROR")

    def test_weights_reach_shaders(self):
        command = [need("xvfb-run"), "-a", need("godot3-runner"), "--audio-driver", "Dummy"]
        project = self.project("shaders.gd")
        program = Program([*command, "--path", project, "-s", "shaders.gd"], {"HOME": str(project)})
        self.addCleanup(program.stop)
        self.assertEqual(program.wait_for("shader"), {"event": "shader", "value": 0.75, "covered": 1})
        self.assertEqual(program.finish(), 0)

    def test_two_subjects_on_two_meshes(self):
        godot = need("godot3-server")
        project = self.project("client.gd")
        program = self.check_plugin(
            lambda daemon: [godot, "--path", project, "-s", "client.gd", f"127.0.0.1:{daemon.ports['http']}", FRAMES],
            env={"HOME": str(project), "XDG_DATA_HOME": str(project / "data")})
        self.assertNotIn("SCRIPT ERROR", program.text)
        self.assertNotIn("freed or unreferenced", program.text)
        received = program.wait_for("received")
        # The blend shape uses a weight. The server keeps no shaders.
        self.assertRegex(received["status"], r"^ada: \d+ ms old, 0 missed, 1 of \d\d+ names in use$")
        self.assertGreater(received["shape"], 0.2, "the performance raises the brows")
        self.assertGreater(received["receiver"], 10)
        take = program.wait_for("recorded")
        self.assertGreaterEqual(take["keys"], FRAMES)
        self.assertAlmostEqual(take["length"], (take["keys"] - 1) / RATE, delta=0.05)
        self.assertAlmostEqual(take["played"], take["recorded"], delta=1e-4)
        self.assertGreater(take["played"], 0.2)
        self.assertRegex(program.wait_for("lost")["status"], "^connection lost, trying again")
        program.wait_for("end")


if __name__ == "__main__":
    main()
