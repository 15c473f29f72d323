#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs docs/examples/watch_weights.cpp against a daemon: run_example.py PROGRAM."""
import subprocess
import sys

import documents


def main(program):
    recording = documents.programs().resolve().parent / "share" / "furrow" / "recordings" / "performance.bvh"
    with documents.Daemon("--no-render") as daemon, documents.Performer(daemon, recording, "demo"):
        done = subprocess.run([program, "127.0.0.1", str(daemon.ports["udp"]), "3"], capture_output=True, text=True,
                              timeout=documents.TIMEOUT, check=False)
    lines = done.stdout.splitlines()
    problems = [] if done.returncode == 0 else [f"exit code {done.returncode}: {done.stderr}"]
    problems += [] if lines else ["it printed nothing"]
    problems += [f"unexpected weight: {line}" for line in lines if not line.startswith(("brow_", "mouth_"))]
    return documents.report(problems, "example for engines")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
