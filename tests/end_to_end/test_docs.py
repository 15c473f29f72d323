#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the command lines of the guides: fenced lines that begin with furrow or furrowd. The quick starts run in
tests/docs/check_commands.py."""
import os
import pathlib
import subprocess
import tempfile
import unittest

from furrow_testing import BIN, GUARD, SHARE, SHARED, SOURCE, Daemon, commands, finish, furrow, spawn

PERFORMANCE = SHARE / "recordings" / "performance.bvh"


class DocumentTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in ("take.bvh", "performance.bvh"):
            (self.root / name).symlink_to(PERFORMANCE)
        (self.root / "hero.glb").symlink_to(SHARE / "default.glb")
        (self.root / "smile02.mhpose").symlink_to(SHARED / "makehuman" / "expressions" / "smile02.mhpose")

    def make_avatar(self):
        """Writes avatar.glb: a character of somebody else's, with a face of blend shapes."""
        subprocess.run([BIN / "furrow-make-character", "--out", self.root / "avatar.glb", "--face", "blend-shapes",
                        "--level", "0", "--texture-size", "256"], check=True, timeout=GUARD)

    def run_here(self, words):
        """Runs one command in the test folder; `>` redirects as in a shell."""
        out = None
        if ">" in words:
            at = words.index(">")
            out, words = self.root / words[at + 1], words[:at]
        result = subprocess.run([BIN / words[0], *words[1:]], cwd=self.root, capture_output=True, timeout=GUARD,
                                env={**os.environ, "FURROW_ASSET_PATH": str(SHARED / "makehuman" / "poseunits")})
        self.assertEqual(result.returncode, 0, (words, result.stderr.decode()))
        if out:
            out.write_bytes(result.stdout)
            self.assertGreater(out.stat().st_size, 0)

    def test_import_howto(self):
        if not SHARED.exists():
            self.skipTest(f"{SHARED} is missing")
        self.make_avatar()
        (self.root / "ada.mhm").symlink_to(SOURCE / "tests" / "fuzz" / "seeds" / "mhm" / "save")
        seen = []
        for words in commands("docs/HOWTO-import.md"):
            words = [str(SHARED / "makehuman") if w == "path/to/makehuman" else w for w in words]
            words = [str(SHARED / "performances" / "emotions.bvh") if w == "performance.bvh" else w for w in words]
            if words[1] == "render":
                words += ["--size", "64x64"] + ([] if "--frames" in words else ["--frames", "60"])
            self.run_here(words)
            seen.append(" ".join(words[1:3]))
        self.assertLessEqual({"character check", "character import", "character propose-rig", "rig check"}, set(seen))
        self.assertIn("render", {command.split()[0] for command in seen})

    def test_recording(self):
        furrow("convert", PERFORMANCE, self.root / "plain.mcap", check=0)
        with Daemon("--no-render", "--record", self.root / "takes") as daemon:
            furrow("play", self.root / "plain.mcap", "--to", daemon.udp, "--speed", 4, check=0)
        next((self.root / "takes").glob("*.mcap")).rename(self.root / "take.mcap")
        (self.root / "rig.json").symlink_to(SHARE / "default.rig.json")
        seen = set()
        with Daemon("--no-render") as daemon:
            for words in commands("docs/RECORDING.md"):
                if words[0] == "furrowd":
                    with Daemon(*[self.root / w if w == "takes" else w for w in words[1:]]):
                        continue
                if words[1] == "record":
                    self.record_here(words, daemon)
                else:
                    self.run_here([daemon.udp if w == "localhost" else w for w in words])
                seen.add(words[1])
        self.assertEqual(seen, {"record", "info", "play", "solve", "convert"})

    def test_rendering(self):
        """Draws one small picture per command instead of a whole recording."""
        for name in ("anger.bvh", "happiness.bvh", "sadness.bvh"):
            (self.root / name).symlink_to(SHARE / "recordings" / name)
        (self.root / "share").mkdir()
        (self.root / "share" / "furrow").symlink_to(SHARE)
        several = 0
        for words in commands("docs/RENDERING.md"):
            if "face.glb" in words:
                continue  # needs a bake; test_bake.py covers docs/BAKE.md
            if "--print-settings" not in words:
                at = words.index("--size") if "--size" in words else len(words)
                words[at:at + 2] = ["--size", "64x64"]
                words += ["--frames", "60"]
                several += "--subjects" in words or "sadness.bvh" in words
            self.run_here(words)
            if "frames" in words:
                self.assertTrue((self.root / "frames" / "000060.png").is_file())
        self.assertEqual(several, 2)

    def record_here(self, words, daemon):
        """Records the subjects that the command names, or one subject, for half a second."""
        names = [words[i + 1] for i, word in enumerate(words) if word == "--subject"] or ["zoe"]
        stage = [spawn("play", PERFORMANCE, "--to", daemon.udp, "--loop", "--subject", name) for name in names]
        for player, name in zip(stage, names):
            self.addCleanup(player.kill)
            furrow("watch", daemon.tcp, "--subject", name, "--wait", "--frames", "1", check=0)
        place = {"localhost": daemon.tcp, "take.mcap": f"recorded-{len(list(self.root.glob('recorded-*')))}.mcap",
                 "60": "0.5"}
        words = [place.get(word, word) for word in words]
        self.run_here(words if "--duration" in words else [*words, "--duration", "0.5"])
        for player in stage:
            player.terminate()
            finish(player)


if __name__ == "__main__":
    unittest.main()
