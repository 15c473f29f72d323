#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The rigs that ship are found by their names, by every program, and pass the check as they are."""
import subprocess
import unittest

from furrow_testing import BIN, GUARD, SOURCE, Daemon, furrow

DONE, BAD_INPUT = 0, 3
NAMES = ("arkit", "cmu", "default", "makehuman")


class ShippedRigsTest(unittest.TestCase):
    def test_all_are_listed_here(self):
        shipped = {path.stem for path in (SOURCE / "rig" / "rigs").glob("*.json")}
        self.assertEqual({name for name in shipped if "." not in name}, set(NAMES))

    def test_each_passes_the_check(self):
        for name in NAMES:
            with self.subTest(name):
                # MakeHuman's poses do not ship; without them the rest of its rig is checked.
                result = furrow("rig", "check", name, env={"FURROW_ASSET_PATH": ""})
                self.assertEqual(result.returncode, DONE, result.stderr.decode())
                self.assertIn("drivers", result.stdout.decode())
                missing = [line for line in result.stderr.decode().splitlines() if "was not found" in line]
                self.assertEqual(len(missing), 1 if name == "makehuman" else 0, result.stderr.decode())

    def test_the_daemon_finds_them_by_name(self):
        for name in ("arkit", "cmu", "default", "arkit.json"):
            with self.subTest(name), Daemon("--no-render", "--rig", name) as daemon:
                self.assertIn("furrowd ready", daemon.ready)
        unknown = subprocess.run([BIN / "furrowd", "--tcp", "0", "--udp", "0", "--no-render", "--rig", "nobody"],
                                 capture_output=True, timeout=GUARD)
        self.assertEqual(unknown.returncode, BAD_INPUT)
        self.assertIn("nobody", unknown.stderr.decode())


if __name__ == "__main__":
    unittest.main()
