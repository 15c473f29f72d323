#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures secure UDP beside plain UDP, through one daemon that accepts both.

    secure_udp.py BIN RECORDING [--rounds N] [--seconds S] [--poses N]

Runs of `furrow load` alternate between the two, so both meet the same company on the machine. Prints one row per way: the
median and the range of p50 and p99 of the latency and of the daemon's processor time per pose, and then the ratios of the
medians. BIN: the folder with furrow and furrowd, of a release build.
"""
import argparse
import json
import pathlib
import re
import subprocess
import tempfile

import two_ways

RATE_HZ = 60
FIGURES = {"p50": "p50 (us)", "p99": "p99 (us)", "cpu": "CPU (us per pose)", "lost": "lost"}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("recording")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=4)
    parser.add_argument("--poses", type=int, default=10_000, help="per second")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        measure(options, pathlib.Path(folder))


def measure(options, folder):
    keys, token = folder / "keys", folder / "token"

    def furrow(*arguments):
        return subprocess.run([options.bin / "furrow", *map(str, arguments)], check=True, capture_output=True)

    furrow("token", "key", "new", "--key", keys)
    furrow("token", "new", "--role", "publish,watch", "--for", "1h", "--key", keys, "--out", token)
    daemon = subprocess.Popen([options.bin / "furrowd", "--no-render", "--no-http", "--tcp", "0", "--udp", "0", "--keys", keys],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        port = re.search(r"udp=\S*?:(\d+)", daemon.stdout.readline()).group(1)
        found = {"plain": [], "secure": []}
        for round_number in range(2 * options.rounds):
            way = ("plain", "secure")[round_number % 2]
            report = folder / "report.json"
            furrow("load", f"127.0.0.1:{port}", options.recording, "--subjects", options.poses // RATE_HZ, "--rate", RATE_HZ,
                   "--duration", options.seconds, "--quantise", "--pid", daemon.pid, "--json", report,
                   *(("--token", token) if way == "secure" else ()))
            run = json.loads(report.read_text())["run"]
            found[way].append({"p50": run["latency_us"]["p50"], "p99": run["latency_us"]["p99"],
                               "cpu": run["cpu_us_per_pose"], "lost": run["lost"] if "lost" in run else run["tally"]["lost"]})
    finally:
        daemon.terminate()
        daemon.wait()
    two_ways.print_table(FIGURES, found)
    two_ways.print_ratios(FIGURES, found, "secure", "plain")


if __name__ == "__main__":
    main()
