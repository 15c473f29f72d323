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
import pathlib
import shlex
import subprocess
import tempfile

from programs import FAULTS, Daemon, recording_of

# Name, flags of furrowd, flags of furrow load, wanted share of the weights in percent.
ROWS = (
    ("1 subject", "", "--subjects 1", 58),
    ("40 subjects", "", "--subjects 40", 58),
    ("40 subjects, fragments", "", "--subjects 40 --floats", 50),
    ("1 subject, buffer", "--jitter-buffer 60", "--subjects 1", 76),
    ("40 subjects, buffer", "--jitter-buffer 60", "--subjects 40", 76),
)


def measure(folder, seconds, daemon_flags, load_flags):
    daemon = Daemon(folder, "--no-render", *shlex.split(daemon_flags))
    try:
        with tempfile.TemporaryDirectory() as scratch:
            report = pathlib.Path(scratch, "report.json")
            command = [pathlib.Path(folder) / "furrow", "load", daemon.host(), recording_of(folder), "--rate", 60,
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
        run, silent = measure(options.bin, options.seconds, daemon_flags, load_flags)
        share = 100 * run["received"] / run["expected"]
        print(f"| {name} | `{daemon_flags}` | `{load_flags}` | {wanted}% | {share:.1f}% ({run['received']:,} of "
              f"{run['expected']:,}) | {run['wrong']} | {run['unchecked']} | {silent} | "
              f"{run['latency_us']['p50'] / 1000:.0f} |", flush=True)


if __name__ == "__main__":
    main()
