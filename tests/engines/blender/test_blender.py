#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The Blender add-on in Blender, in background."""
import pathlib
import shutil
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from engine_testing import ENGINES, FRAMES, LIBRARY, RATE, EngineTest, main, need  # pylint: disable=wrong-import-position


class BlenderTest(EngineTest):
    def test_two_subjects_on_two_objects(self):
        blender = need("blender")
        scripts = pathlib.Path(tempfile.mkdtemp(prefix="furrow-blender-"))
        self.addCleanup(shutil.rmtree, scripts)
        shutil.copytree(ENGINES / "blender" / "furrow", scripts / "addons" / "furrow",
                        ignore=shutil.ignore_patterns("__pycache__"))
        program = self.check_plugin(
            lambda daemon: [blender, "-b", "--factory-startup", "--python-exit-code", "3", "--python", HERE / "client.py",
                            "--", f"furrow://127.0.0.1:{daemon.ports['udp']}", LIBRARY, FRAMES],
            env={"BLENDER_USER_SCRIPTS": str(scripts)}, phone="cam")
        received = program.wait_for("received")
        for line in received["status"]:
            # A shape key, an Attribute node and a driver read a weight each.
            self.assertRegex(line, r"^\d+ ms old, 0 missed, 3 of \d\d+ names in use$")
        self.assertGreater(received["moved"], 0.1)
        for low, high in received["seen"].values():
            self.assertGreater(high - low, 0.2, "the performance raises and lowers the brows")
        for take in program.wait_for("recorded")["channels"].values():
            # The scene has 24 frames per second.
            self.assertAlmostEqual(take["span"], (take["points"] - 1) / RATE * 24, delta=1.0)
            self.assertGreater(take["values"][1] - take["values"][0], 0.2)
        self.assertRegex(program.wait_for("lost")["status"], "^connection lost, trying again")
        program.wait_for("end")


if __name__ == "__main__":
    main()
