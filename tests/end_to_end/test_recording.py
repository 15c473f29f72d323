#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recordings contain all poses and weights, survive a killed process, and replay to the same weights."""
import os
import pty
import re
import resource
import signal
import struct
import subprocess
import time
import unittest

from furrow_testing import BIN, GUARD, SHARE, Daemon, furrow, solve, spawn, worst_difference
from recording_testing import PERFORMANCE, RIG, FolderTest, Recording
from tracker_packets import livelink_face
from wire_testing import Phone

HAPPINESS = SHARE / "recordings" / "happiness.bvh"


class RecordTest(FolderTest):
    def test_a_take_contains_every_pose_and_the_sent_weights(self):
        take = self.record("--speed", 4)
        solved = solve(PERFORMANCE, "--rig", RIG)
        recorded = self.weights(take)
        self.assertEqual(recorded.rows.keys(), solved.rows.keys())
        worst, _ = worst_difference(recorded, solved)
        self.assertLess(worst, 1e-3)
        self.assertIn("complete", furrow("info", take, check=0).stdout.decode())

    def test_the_timecode_of_a_phone_is_recorded_converted_and_played_again(self):
        # 29.97 frames per second, around the numbers that drop-frame timecode leaves out.
        frames = range(1796, 1804)
        with Recording(self.root / "phone", "--livelink-face", "0") as daemon:
            phone = Phone(daemon)
            for frame in frames:
                before = phone.poses()
                phone.socket.sendto(livelink_face("phone", frame, {"JawOpen": frame % 7 / 7}, (30000, 1001)), phone.target)
                phone.await_pose(before)
            subject = phone.api.get("/api/subjects")["subjects"][0]
            source = phone.api.get("/api/sources")["subjects"][0]
            phone.close()
        self.assertEqual(subject["timecode"], "00:01:00;05")
        self.assertAlmostEqual(subject["timecode_rate_hz"], 29.97, 2)
        self.assertEqual(source["timecode"], "00:01:00;05")
        expected = ["00:00:59;26", "00:00:59;27", "00:00:59;28", "00:00:59;29",
                    "00:01:00;02", "00:01:00;03", "00:01:00;04", "00:01:00;05"]
        self.assertEqual(self.timecodes(daemon.takes()[0]), expected)
        with Recording(self.root / "again") as again:
            furrow("play", daemon.takes()[0], "--to", again.tcp, "--tcp", "--speed", 4, check=0)
        self.assertEqual(self.timecodes(again.takes()[0]), expected)

    def timecodes(self, take):
        """The last column of the weights of a take."""
        out = self.root / "timecodes.csv"
        furrow("convert", take, out, "--weights", check=0)
        header, *rows = out.read_text().splitlines()
        self.assertEqual(header.split(",")[-1], "timecode")
        return [row.split(",")[-1] for row in rows]

    def test_a_replay_gives_exactly_the_recorded_weights(self):
        first = self.record("--speed", 4, "--quantise")
        with Recording(self.root / "again") as daemon:
            # Another speed gives the same weights, because the capture times are those of the recording.
            played = furrow("play", first, "--to", daemon.tcp, "--tcp", "--speed", 8, check=0)
        self.assertRegex(played.stderr.decode(), r"\d+ poses; pacing error [\d.]+ ms on average")
        again = daemon.takes()[0]
        self.assertEqual(self.weights(first).rows, self.weights(again).rows)
        self.assertIn("subject     ada:", furrow("info", again, check=0).stdout.decode())

    def test_a_session_with_several_subjects_replays_together(self):
        both = {}
        with Recording(self.root / "first") as daemon:
            ada = spawn("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", "ada", "--speed", 2)
            # Bob joins while ada is playing.
            furrow("watch", daemon.tcp, "--subject", "ada", "--wait", "--frames", 30, check=0)
            furrow("play", HAPPINESS, "--to", daemon.udp, "--subject", "bob", "--speed", 4, check=0)
            ada.communicate(timeout=GUARD)
        first = daemon.takes()[0]
        with Recording(self.root / "again") as daemon:
            played = furrow("play", first, "--to", daemon.tcp, "--tcp", "--speed", 4, check=0)
        self.assertIn("of 2 subjects", played.stderr.decode())
        again = daemon.takes()[0]
        for name in ("ada", "bob"):
            both[name] = self.weights(f"{first}#{name}")
            self.assertGreater(len(both[name].rows), 100)
            self.assertEqual(both[name].rows, self.weights(f"{again}#{name}").rows)
        self.assertNotEqual(both["ada"].rows, both["bob"].rows)
        nobody = furrow("info", f"{first}#eve", check=3)
        self.assertIn("subjects: ada, bob", nobody.stderr.decode())
        renamed = furrow("play", first, "--to", daemon.tcp, "--subject", "eve", check=3)
        self.assertIn("ada, bob", renamed.stderr.decode())

    def test_from_plays_a_part_and_a_loop_continues_the_numbers(self):
        take = self.record("--speed", 8)
        total = self.count(take, "poses")
        with Recording(self.root / "part") as daemon:
            furrow("play", take, "--to", daemon.tcp, "--tcp", "--from", 1, "--speed", 8, check=0)
        self.assertLess(self.count(daemon.takes()[0], "poses"), total)
        with Recording(self.root / "loop") as daemon:
            player = spawn("play", take, "--to", daemon.tcp, "--tcp", "--loop", "--speed", 50)
            watcher = furrow("watch", daemon.tcp, "--subject", "ada", "--wait", "--format", "csv",
                             "--frames", 2 * total, check=0)
            player.send_signal(signal.SIGINT)
            player.communicate(timeout=GUARD)
        frames = [int(row.split(",")[0]) for row in watcher.stdout.decode().splitlines()[1:]]
        self.assertEqual(frames, sorted(set(frames)), "the numbers continue")
        self.assertGreater(frames[-1], total)
        result = furrow("play", take, "--to", "127.0.0.1:9", "--from", 1e6, check=3)
        self.assertIn("ends after", result.stderr.decode())

    def test_a_killed_daemon_leaves_whole_chunks_that_replay_to_equal_weights(self):
        solved = solve(PERFORMANCE, "--rig", RIG)
        take = self.what_a_killed_daemon_leaves()
        info = furrow("info", take, check=0)
        self.assertIn("cut short", info.stdout.decode())
        self.assertNotIn("damaged", info.stdout.decode())
        recorded = self.weights(take)
        self.assertGreater(len(recorded.rows), 0)
        # Every pose has its weights, except possibly the last one.
        self.assertIn(self.count(take, "poses") - len(recorded.rows), (0, 1))
        self.assertEqual(sorted(recorded.rows), list(range(len(recorded.rows))), "no gap")
        worst, frames = worst_difference(recorded, solved)
        self.assertGreater(frames, 0)
        self.assertLess(worst, 1e-3)
        with Recording(self.root / "again") as second:
            furrow("play", take, "--to", second.tcp, "--tcp", "--speed", 8, check=0)
        again = self.weights(second.takes()[0])
        self.assertEqual({frame: again.rows[frame] for frame in recorded.rows}, recorded.rows)

    def test_rotation_loses_nothing_and_every_file_is_complete(self):
        solved = solve(PERFORMANCE, "--rig", RIG)
        with Recording(self.root / "parts", "--record-rotate-seconds", 0.5) as daemon:
            furrow("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", "ada", check=0)
        takes = daemon.takes()
        self.assertGreater(len(takes), 2)
        rows = {}
        for take in takes:
            text = furrow("info", take, check=0).stdout.decode()
            self.assertIn("complete", text)
            if not re.search(r"weights +[1-9]", text):
                continue  # before the first pose or after the last one: only decaying weights
            for frame, row in self.weights(take).rows.items():
                self.assertNotIn(frame, rows, "no pose is in two files")
                rows[frame] = row
        self.assertEqual(rows.keys(), solved.rows.keys())

    def test_a_full_disk_pauses_the_recording_but_not_the_daemon(self):
        # Room for the rig, which is the first thing in a take, and for some of the poses.
        room = len(RIG.read_bytes()) + 100_000

        def small_files():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (room, room))

        folder = self.root / "full"
        process = subprocess.Popen([BIN / "furrowd", "--tcp", "0", "--udp", "0", "--no-render", "--record", folder],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=small_files)
        self.addCleanup(process.kill)
        port = re.search(r"tcp=[^ ]*:(\d+)", process.stdout.readline().decode()).group(1)
        address = f"127.0.0.1:{port}"
        for _ in range(2):  # the daemon still serves poses
            furrow("play", PERFORMANCE, "--to", address, "--tcp", "--subject", "ada", "--speed", 8, check=0)
        process.send_signal(signal.SIGTERM)
        _, stderr = process.communicate(timeout=GUARD)
        self.assertEqual(process.returncode, 0)
        self.assertIn("recording paused", stderr.decode())
        takes = sorted(folder.glob("*.mcap"))  # a second one if the daemon has found room meanwhile
        for take in takes:
            self.assertLessEqual(take.stat().st_size, room)
        self.assertGreater(self.count(takes[0], "poses"), 0)

    def test_a_folder_that_cannot_be_created_is_reported_at_the_start(self):
        (self.root / "file").write_text("")
        result = subprocess.run([BIN / "furrowd", "--no-render", "--tcp", "0", "--udp", "0", "--record",
                                 self.root / "file" / "takes"], capture_output=True, timeout=GUARD)
        self.assertEqual(result.returncode, 1)
        self.assertIn("cannot create the folder", result.stderr.decode())


class RemoteRecordTest(FolderTest):
    """`furrow record HOST` records over the network."""

    def test_it_receives_every_pose_and_weight_and_they_replay_exactly(self):
        take = self.root / "take.mcap"
        with Daemon("--no-render") as daemon:
            recorder = self.listen(daemon, take, "--subject", "ada", "--wait", "--rig", RIG)
            furrow("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", "ada", "--speed", 8, "--quantise",
                   check=0)
            # `play` ends after the subject has left, so the last pose has arrived.
            words = self.end(recorder)
        solved = solve(PERFORMANCE, "--rig", RIG)
        self.assertIn(f"{len(solved.rows)} poses", words)
        self.assertNotIn("missing", words)
        recorded = self.weights(take)
        self.assertEqual(recorded.rows.keys(), solved.rows.keys())
        worst, _ = worst_difference(recorded, solved)
        self.assertLess(worst, 1e-3)
        # Solve the recorded poses, then play them again.
        worst, frames = worst_difference(solve(take, "--rig", RIG), recorded)
        self.assertEqual(frames, len(solved.rows))
        self.assertLess(worst, 2e-6)
        again = self.root / "again.mcap"
        with Daemon("--no-render") as daemon:
            recorder = self.listen(daemon, again, "--subject", "ada", "--wait")
            furrow("play", take, "--to", daemon.tcp, "--tcp", "--speed", 8, check=0)
            self.end(recorder)
        self.assertEqual(self.weights(again).rows, recorded.rows)

    def test_a_killed_recorder_leaves_whole_chunks(self):
        take = self.what_a_killed_recorder_leaves()
        self.assertIn("cut short", furrow("info", take, check=0).stdout.decode())
        recorded = self.weights(take)
        frames = sorted(recorded.rows)
        self.assertGreater(len(frames), 10)
        self.assertEqual(frames, list(range(frames[0], frames[-1] + 1)), "no gap")
        self.assertIn(self.count(take, "poses") - len(frames), (0, 1))

    def test_several_subjects_rotation_and_duration(self):
        take = self.root / "several.mcap"
        with Daemon("--no-render") as daemon:
            recorder = self.listen(daemon, take, "--subject", "ada", "--subject", "bob", "--wait",
                                   "--rotate-seconds", 0.4)
            for name in ("ada", "bob"):
                furrow("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", name, "--speed", 4, check=0)
            self.end(recorder)
            late = furrow("record", daemon.tcp, "--out", self.root / "late.mcap", "--subject", "eve",
                          "--wait", "--duration", 0.3, check=1)
        self.assertIn("no subject connected; no file was written", late.stderr.decode())
        self.assertFalse((self.root / "late.mcap").exists())
        takes = sorted(self.root.glob("several*.mcap"))
        self.assertGreater(len(takes), 2)
        self.assertIn(self.root / "several_2.mcap", takes)
        poses = {"ada": 0, "bob": 0}
        for part in takes:
            text = furrow("info", part, check=0).stdout.decode()
            self.assertIn("complete", text)
            for name, _, count in re.findall(r"subject +(\w+):(.*\n)*? +poses +(\d+)", text):
                poses[name] += int(count)
        self.assertEqual(set(poses.values()), {len(solve(PERFORMANCE, "--rig", RIG).rows)})

    def test_without_names_it_records_all_subjects_until_the_last_one_leaves(self):
        take = self.root / "everybody.mcap"
        with Daemon("--no-render") as daemon:
            ada = spawn("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", "ada", "--loop")
            furrow("watch", daemon.tcp, "--subject", "ada", "--wait", "--frames", 1, check=0)
            recorder = self.listen(daemon, take)
            furrow("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", "bob", "--speed", 4, check=0)
            self.assertIsNone(recorder.poll(), "ada is still connected")
            ada.send_signal(signal.SIGINT)
            ada.communicate(timeout=GUARD)
            recorder.wait(timeout=GUARD)
            self.assertEqual(recorder.returncode, 0)
            self.assertIn("of ada, bob in", recorder.stderr.read().decode())
            nobody = furrow("record", daemon.tcp, "--out", self.root / "none.mcap", check=1)
            self.assertIn("no subject is connected", nobody.stderr.decode())
            self.assertFalse((self.root / "none.mcap").exists())
        text = furrow("info", take, check=0).stdout.decode()
        poses = {name: int(count) for name, _, count in re.findall(r"subject +(\w+):(.*\n)*? +poses +(\d+)", text)}
        self.assertEqual(poses.keys(), {"ada", "bob"})
        self.assertGreater(min(poses.values()), 0)
        # A late subject may lose its first poses; from the subscription on there is no gap.
        frames = sorted(self.weights(f"{take}#bob").rows)
        self.assertEqual(frames, list(range(frames[0], len(solve(PERFORMANCE, "--rig", RIG).rows))))

    def test_impossible_requests_are_reported_at_the_start(self):
        there = self.root / "there.mcap"
        there.write_text("mine")
        result = furrow("record", "127.0.0.1:9", "--out", there, check=1)
        self.assertIn("already exists", result.stderr.decode())
        self.assertEqual(there.read_text(), "mine")
        furrow("record", "127.0.0.1:9", "--out", self.root / "none.mcap", check=4)
        result = furrow("record", "127.0.0.1:9", "--out", self.root / "take", check=2)
        self.assertIn("FILE.mcap", result.stderr.decode())
        with Daemon("--no-render") as daemon:
            result = furrow("record", daemon.tcp, "--out", self.root / "none.mcap", "--subject", "eve", check=1)
            nobody = furrow("record", daemon.tcp, "--out", self.root / "none.mcap", "--wait", "--duration", 0.2, check=1)
        self.assertIn("no subject 'eve'", result.stderr.decode())
        self.assertIn("no subject connected", nobody.stderr.decode())
        self.assertFalse((self.root / "none.mcap").exists(), "no file is written if there is nothing to record")


class ConvertTest(FolderTest):
    def test_recordings_convert_to_takes_and_back(self):
        take = self.root / "made.mcap"
        furrow("convert", PERFORMANCE, take, check=0)
        solved = solve(PERFORMANCE, "--rig", RIG)
        worst, frames = worst_difference(solve(take, "--rig", RIG), solved)
        self.assertEqual(frames, len(solved.rows))
        self.assertLess(worst, 1e-5)
        for extension in ("bvh", "glb"):
            back = self.root / f"back.{extension}"
            furrow("convert", take, back, check=0)
            worst, frames = worst_difference(solve(back, "--rig", RIG), solved)
            self.assertEqual(frames, len(solved.rows))
            self.assertLess(worst, 2e-3)

    def test_a_command_must_name_one_of_several_subjects(self):
        with Recording(self.root / "two") as daemon:
            for name in ("ada", "bob"):
                furrow("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", name, "--speed", 8, check=0)
        take = daemon.takes()[0]
        result = furrow("solve", take, "--rig", RIG, check=3)
        self.assertIn("ada, bob", result.stderr.decode())
        one = solve(f"{take}#bob", "--rig", RIG)
        self.assertEqual(one.rows.keys(), solve(PERFORMANCE, "--rig", RIG).rows.keys())
        self.assertEqual(furrow("solve", f"{take}#eve", "--rig", RIG).returncode, 3)

    def test_convert_never_overwrites_its_input_or_a_take(self):
        take = self.root / "take.mcap"
        furrow("convert", PERFORMANCE, take, check=0)
        other = self.root / "other.mcap"
        furrow("convert", PERFORMANCE, other, check=0)
        copy = self.root / "copy.bvh"
        copy.write_bytes(PERFORMANCE.read_bytes())
        link = self.root / "link.glb.bvh"
        link.symlink_to(copy)
        subject = re.search(r"subject +(\w+):", furrow("info", take, check=0).stdout.decode()).group(1)
        before = {path: path.read_bytes() for path in (take, other, copy)}
        for args, code, says in (((take, take, "--weights"), 3, "as .csv"),
                                 ((f"{take}#{subject}", other, "--weights"), 3, "as .csv"),
                                 ((copy, copy), 3, "over itself"),
                                 ((copy, link), 3, "over itself"),
                                 ((f"{take}#{subject}", take), 3, "over itself"),
                                 ((copy, take), 1, "take.mcap"),
                                 ((copy, self.root / "new.mcap#ada"), 3, "without a subject"),
                                 ((copy, self.root / "new.vrma"), 3, ".glb, .csv or .mcap")):
            with self.subTest(args):
                self.assertIn(says, furrow("convert", *args, check=code).stderr.decode())
        self.assertEqual({path: path.read_bytes() for path in before}, before)
        self.assertEqual([*self.root.glob("new*")], [])


def mcap_of_another_program(topics):
    """An MCAP file without chunks, index and statistics. `topics`: the number of messages by topic."""
    def text(value):
        return struct.pack("<I", len(value)) + value.encode()

    def record(opcode, content):
        return struct.pack("<BQ", opcode, len(content)) + content

    magic = b"\x89MCAP0\r\n"
    data = magic + record(1, text("ros2") + text("libmcap 1.4"))
    for channel, (topic, count) in enumerate(topics.items(), 1):
        data += record(4, struct.pack("<HH", channel, 0) + text(topic) + text("json") + struct.pack("<I", 0))
        for i in range(count):
            data += record(5, struct.pack("<HIQQ", channel, i, i * 10**8, i * 10**8) + b"{}")
    return data + record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)) + magic


class ReadingTest(FolderTest):
    def test_info_counts_the_messages_of_other_programs(self):
        take = self.root / "robot.mcap"
        take.write_bytes(mcap_of_another_program({"/imu": 11, "/tf": 3}))
        result = furrow("info", take, check=0)
        text = result.stdout.decode()
        self.assertRegex(text, r"messages +14 in 1\.000 s")
        self.assertIn("/imu: 11 messages, encoding json", text)
        self.assertIn("/tf: 3 messages, encoding json", text)
        self.assertNotIn("damaged", text)
        self.assertEqual(result.stderr, b"")

    def test_progress_is_shown_on_a_terminal_and_not_in_a_pipe(self):
        take = self.root / "made.mcap"
        furrow("convert", PERFORMANCE, take, check=0)
        for command in (["info", take], ["solve", take, "--rig", RIG],
                        ["convert", take, self.root / "back.bvh"]):
            with self.subTest(command[0]):
                self.assertNotIn(b"reading", furrow(*command, check=0).stderr)
                shown = self.on_a_terminal(*command)
                self.assertRegex(shown, r"\rreading \[#* *\] +\d+%")
                self.assertIn("\r\x1b[K", shown, "the bar is erased")

    def test_the_summary_of_play_is_on_its_own_line(self):
        with Daemon("--no-render") as daemon:
            shown = self.on_a_terminal("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--speed", 20)
        self.assertRegex(shown, r"\rplaying \[#+ *\] +\d+%")
        self.assertRegex(shown, r"\x1b\[Kfurrow: \d+ poses; pacing")

    def on_a_terminal(self, *command):
        """Runs a command with a terminal as standard error and returns what it writes there."""
        ours, terminal = pty.openpty()
        self.addCleanup(os.close, ours)
        process = subprocess.Popen([BIN / "furrow", *map(str, command)], stdout=subprocess.DEVNULL, stderr=terminal)
        os.close(terminal)
        shown = b""
        try:
            while part := os.read(ours, 65536):
                shown += part
        except OSError:  # the terminal reports its closed end as an error
            pass
        self.assertEqual(process.wait(timeout=GUARD), 0)
        return shown.decode()


if __name__ == "__main__":
    unittest.main()
