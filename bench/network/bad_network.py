#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how many weights survive a bad network: the table of docs/LOAD.md.

    bad_network.py BIN [--seconds S] [--rows TEXT]

Each row starts a daemon and runs `furrow load` with 10% loss, 20% reordering, 5% duplicates and up to 50 ms of jitter in
both directions. Prints one row per run: the share of the weights that arrived, those that were wrong or could not be
checked, subjects that the daemon took for silent, and the latency. BIN: the folder with furrow and furrowd.
"""
import argparse
import json
import math
import pathlib
import shlex
import subprocess
import tempfile

from programs import FAULTS, Daemon, recording_of

# Coefficients of a phone, for poses that are small enough to be repeated. 36 of its 61, with both sides, which fold a face.
SIDED = ("EyeBlink", "EyeSquint", "EyeWide", "BrowDown", "BrowOuterUp", "CheekSquint", "NoseSneer", "MouthSmile", "MouthFrown",
         "MouthDimple", "MouthStretch", "MouthPress", "MouthLowerDown", "MouthUpperUp")
MIDDLE = ("BrowInnerUp", "CheekPuff", "JawOpen", "JawForward", "MouthPucker", "MouthFunnel", "MouthShrugUpper", "MouthShrugLower")

# Name, flags of furrowd, flags of furrow load, wanted share of the weights in percent. A row with "phone" sends coefficients
# instead of 81 joints.
ROWS = (
    ("1 subject", "", "--subjects 1", 58),
    ("40 subjects", "", "--subjects 40", 58),
    ("40 subjects, fragments", "", "--subjects 40 --floats", 50),
    ("1 subject, buffer", "--jitter-buffer 60", "--subjects 1", 76),
    ("40 subjects, buffer", "--jitter-buffer 60", "--subjects 40", 76),
    ("1 phone, redundant", "", "--subjects 1 --redundant", 58),
    ("1 phone, buffer, redundant", "--jitter-buffer 60", "--subjects 1 --redundant", 85),
    ("40 phones, buffer, redundant", "--jitter-buffer 60", "--subjects 40 --redundant", 85),
)


def phone_recording(path):
    """Writes six seconds of moving coefficients in Live Link Face's format."""
    names = [stem + side for stem in SIDED for side in ("Left", "Right")] + list(MIDDLE)
    rows = ["Timecode,BlendShapeCount," + ",".join(names)]
    for frame in range(360):
        values = (0.5 - 0.5 * math.cos(2 * math.pi * (frame * (1 + i % 5) / 360 + i / 36)) for i in range(len(names)))
        rows.append(f"00:00:{frame // 60:02}:{frame % 60:02}.000,{len(names)}," + ",".join(f"{v:.4f}" for v in values))
    path.write_text("\n".join(rows) + "\n")
    return path


def measure(folder, seconds, is_phone, daemon_flags, load_flags):
    daemon = Daemon(folder, "--no-render", *shlex.split(daemon_flags))
    try:
        with tempfile.TemporaryDirectory() as scratch:
            report = pathlib.Path(scratch, "report.json")
            recording = phone_recording(pathlib.Path(scratch, "phone.csv")) if is_phone else recording_of(folder)
            command = [pathlib.Path(folder) / "furrow", "load", daemon.host(), recording, "--rate", 60,
                       "--duration", seconds, "--other-port", daemon.ports["tcp"], "--json", report, *FAULTS,
                       *shlex.split(load_flags)]
            result = subprocess.run(list(map(str, command)), capture_output=True, text=True)
            if result.returncode != 0:
                raise SystemExit(result.stderr)
            run = json.loads(report.read_text())["run"]
        # The poses begin after the last offer. Subjects that end are silent afterwards.
        end = daemon.log.last("blend shapes") + seconds
        return run, daemon.log.count("stopped sending", until=end)
    finally:
        daemon.stop()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--rows", default="", help="only rows with this text in their name")
    options = parser.parse_args()
    print("| row | furrowd | furrow load | wanted | received | wrong | unchecked | silent | p50 (ms) |\n" + "|---" * 9 + "|")
    for name, daemon_flags, load_flags, wanted in ROWS:
        if options.rows not in name:
            continue
        run, silent = measure(options.bin, options.seconds, "phone" in name, daemon_flags, load_flags)
        share = 100 * run["received"] / run["expected"]
        print(f"| {name} | `{daemon_flags}` | `{load_flags}` | {wanted}% | {share:.1f}% ({run['received']:,} of "
              f"{run['expected']:,}) | {run['wrong']} | {run['unchecked']} | {silent} | "
              f"{run['latency_us']['p50'] / 1000:.0f} |", flush=True)


if __name__ == "__main__":
    main()
