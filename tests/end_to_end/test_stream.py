#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Streams a recording over real sockets: weights equal `furrow solve`, pictures arrive and change."""
import contextlib
import pathlib
import shutil
import signal
import subprocess
import tempfile
import unittest

from furrow_testing import (SHARE, SOURCE, Daemon, Table, finish, furrow, jpeg_size, needs_shared, png_size, solve,
                            spawn, spawn_watch, wait_until, worst_difference)

PERFORMANCE = SHARE / "recordings" / "performance.bvh"
TOLERANCE = 1e-3
# Ready when the character is loaded: pictures for `furrow frames` wait for it, and the performance does not.
DRAWS = ["--require-render"]


class StreamTest(unittest.TestCase):
    def stream(self, recording, daemon, play=(), watch=()):
        """Plays `recording` to `daemon` and returns what `watch` received."""
        watcher = spawn_watch(daemon.udp if "--udp" in watch else daemon.tcp, "ada", *watch)
        target = daemon.tcp if "--tcp" in play else daemon.udp
        furrow("play", recording, "--to", target, "--subject", "ada", *play, check=0)
        code, out, err = finish(watcher)
        self.assertEqual(code, 0, err)
        return Table(out.decode())

    def assert_same(self, seen, solved, tolerance=TOLERANCE):
        worst, frames = worst_difference(seen, solved)
        print(f"{frames} of {len(solved.rows)} frames arrived, worst difference {worst:.2e}")
        self.assertGreater(frames, 0)
        self.assertLess(worst, tolerance)

    def test_default_character_over_udp(self):
        solved = solve(PERFORMANCE, "--rig", SHARE / "default.rig.json")
        with Daemon() as daemon:
            self.assert_same(self.stream(PERFORMANCE, daemon, ["--udp", "--speed", 4, "--floats"]), solved)
            # By default, poses are packed to fit a datagram: 1.5e-4 rad per joint.
            self.assert_same(self.stream(PERFORMANCE, daemon, ["--udp", "--speed", 4]), solved)

    def test_over_tcp_quantised_to_a_udp_subscriber(self):
        solved = solve(PERFORMANCE, "--rig", SHARE / "default.rig.json")
        with Daemon("--no-render") as daemon:
            seen = self.stream(PERFORMANCE, daemon, ["--tcp", "--quantise", "--speed", 4], ["--udp", "--u8"])
            # Half a step of 1/255, plus the effect of 1.5e-4 rad per joint.
            self.assert_same(seen, solved, 1 / 510 + 0.02)

    def test_two_subjects_do_not_mix(self):
        happy, sad = (SHARE / "recordings" / f"{name}.bvh" for name in ("happiness", "sadness"))
        with Daemon("--no-render") as daemon:
            watchers = [spawn_watch(daemon.tcp, s) for s in "ab"]
            players = [spawn("play", file, "--to", daemon.udp, "--subject", s, "--speed", 4)
                       for s, file in zip("ab", (happy, sad))]
            for player in players:
                self.assertEqual(finish(player)[0], 0)
            for watcher, file in zip(watchers, (happy, sad)):
                self.assert_same(Table(finish(watcher)[1].decode()), solve(file, "--rig", SHARE / "default.rig.json"))

    def test_pattern_and_drivers(self):
        with Daemon("--no-render") as daemon:
            seen = self.stream(PERFORMANCE, daemon, ["--speed", 8], ["--pattern", "brow_*,*.folds"])
            self.assertIn("brow_l.squash", seen.names)
            self.assertTrue(all(n.startswith("brow_") or n.endswith(".folds") for n in seen.names), seen.names)
        with Daemon("--no-render") as daemon:
            seen = self.stream(PERFORMANCE, daemon, ["--speed", 8], ["--drivers"])
            self.assert_same(seen, solve(PERFORMANCE, "--rig", SHARE / "default.rig.json", "--drivers"))

    def test_pictures_arrive_and_change_with_the_pose(self):
        with tempfile.TemporaryDirectory() as folder, Daemon(*DRAWS) as daemon:
            jpegs = pathlib.Path(folder, "jpeg")
            pngs = pathlib.Path(folder, "png")
            watchers = [spawn("frames", daemon.tcp, "--subject", "ada", "--wait", "--out", jpegs, "--size", "160x120"),
                        spawn("frames", daemon.tcp, "--subject", "ada", "--wait", "--out", pngs, "--size", "96x96",
                              "--format", "png", "--view", "weights", "--camera", "three_quarter")]
            player = spawn("play", PERFORMANCE, "--to", daemon.udp, "--subject", "ada", "--loop")
            wait_until(lambda: all(out.exists() and len(list(out.iterdir())) > 3 for out in (jpegs, pngs)),
                       "pictures of both watchers")
            player.send_signal(signal.SIGINT)
            finish(player)
            for watcher in watchers:
                code, _, err = finish(watcher)
                self.assertEqual(code, 0, err)
            pictures = [p.read_bytes() for p in sorted(jpegs.iterdir())]
            self.assertEqual({jpeg_size(p) for p in pictures}, {(160, 120)})
            self.assertGreater(len(set(pictures)), 1, "the face never moved")
            self.assertEqual({png_size(p.read_bytes()) for p in pngs.iterdir()}, {(96, 96)})

    @unittest.skipUnless(shutil.which("oiiotool"), "oiiotool is not installed")
    def test_live_pictures_equal_those_of_render(self):
        look = ["--size", "96x96", "--camera", "three_quarter"]
        with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
            settings = pathlib.Path(folder, "look.toml")
            settings.write_text('shading = "diffuse"\n')  # skin has other samples per pixel live
            daemon = stack.enter_context(Daemon(*DRAWS, "--render-settings", settings))
            live, drawn = pathlib.Path(folder, "live"), pathlib.Path(folder, "drawn")
            watcher = spawn("frames", daemon.tcp, "--subject", "ada", "--wait", "--out", live, "--format", "png",
                            "--rate", "2", *look)
            furrow("play", PERFORMANCE, "--to", daemon.udp, "--subject", "ada", check=0)
            self.assertEqual(finish(watcher)[0], 0)
            pictures = sorted(live.iterdir())
            for picture in (pictures[0], pictures[len(pictures) // 2], pictures[-1]):
                furrow("render", PERFORMANCE, "--out", drawn, "--frames", int(picture.stem), *look, check=0)
                # Capture times on the wire are whole microseconds, so the filter may differ in the last digit.
                diff = subprocess.run(["oiiotool", "--fail", "0.02", "--failpercent", "0.5", "--diff", picture,
                                       drawn / picture.name], capture_output=True)
                self.assertEqual(diff.returncode, 0, diff.stdout.decode())

    def test_cmu_body(self):
        recording = needs_shared("cmu", "01_01.bvh")
        rig = SOURCE / "rig" / "rigs" / "cmu.json"
        solved = solve(recording, "--rig", rig)
        with Daemon("--rig", rig) as daemon:
            self.assert_same(self.stream(recording, daemon, ["--speed", 8]), solved)
        knee = solve(recording, "--rig", rig, "--drivers").column("knee_l.flexed")
        self.assertGreater(max(knee.values()), 0.1)
        self.assertLess(min(knee.values()), 0.02)


if __name__ == "__main__":
    unittest.main()
