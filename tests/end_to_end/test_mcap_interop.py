#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The independent reader @mcap/core (npm) and Furrow's reader agree on every message."""
import subprocess
import sys
import unittest

from furrow_testing import GUARD, Daemon, furrow
from recording_testing import (INTEROP, PERFORMANCE, RIG, FolderTest, missing_interop, our_messages,
                               their_messages)


class InteropTest(FolderTest):
    def test_it_reads_our_takes(self):
        take = self.record("--speed", 8)
        ours, theirs = our_messages(take), their_messages(take)
        self.assertGreater(len(ours), 100)
        self.assertEqual(sorted(ours), sorted(theirs))
        self.assertTrue(any(line.startswith("attachment rig.json") for line in theirs))
        self.assertTrue(any(line.startswith("/raw/udp ") for line in theirs))

    def test_it_reads_what_record_writes(self):
        take = self.root / "take.mcap"
        with Daemon("--no-render") as daemon:
            recorder = self.listen(daemon, take, "--subject", "ada", "--wait", "--rig", RIG)
            furrow("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", "ada", "--speed", 8, check=0)
            self.end(recorder)
        theirs = their_messages(take)
        self.assertEqual(sorted(our_messages(take)), sorted(theirs))
        for name in ("rig.json", "ada.skeleton"):
            self.assertTrue(any(line.startswith(f"attachment {name}") for line in theirs), name)

    def test_we_read_its_files(self):
        take = self.record("--speed", 8)
        for compression in ("none", "zstd", "lz4"):
            with self.subTest(compression):
                copy = self.root / f"{compression}.mcap"
                subprocess.run(["node", INTEROP / "write.mjs", take, copy, compression], check=True, timeout=GUARD)
                self.assertEqual(sorted(our_messages(copy)),
                                 sorted(line for line in our_messages(take) if not line.startswith("attachment")))
                self.assertEqual(self.weights(copy).rows, self.weights(take).rows)

    def agree_on_what_is_left(self, take):
        ours, theirs = our_messages(take), their_messages(take, "--cut")
        self.assertGreater(sum("/weights" in line for line in ours), 10)
        self.assertEqual(sorted(ours), sorted(theirs))

    def test_it_finds_the_same_messages_after_a_killed_daemon(self):
        self.agree_on_what_is_left(self.what_a_killed_daemon_leaves())

    def test_it_finds_the_same_messages_after_a_killed_recorder(self):
        self.agree_on_what_is_left(self.what_a_killed_recorder_leaves())


if __name__ == "__main__":
    if missing_interop():
        print(f"SKIPPED: {missing_interop()}")
        sys.exit(77)  # SKIP_RETURN_CODE in CMakeLists.txt
    unittest.main()
