#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures TLS beside plain TCP: the time from a pose to its weights, and the daemon's processor time per pose.

    tls_stream.py BIN [--rounds N] [--poses N]

Two daemons run, one with a certificate. Rounds alternate between them, so both meet the same company on the machine.
Prints one row per way, the medians and ranges over the rounds, and then the ratios of the medians. BIN: the folder with
furrowd and bench_tls_client.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

import two_ways

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from processes import cpu_seconds  # pylint: disable=wrong-import-position

FIGURES = {"p50": "p50 (us)", "p99": "p99 (us)", "cpu": "CPU of the daemon (us per pose)", "client": "CPU of the client (us per pose)"}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--poses", type=int, default=30_000, help="per round")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        measure(options, pathlib.Path(folder))


def start(options, config, *arguments):
    daemon = subprocess.Popen([options.bin / "furrowd", "--config", config, "--rig", "arkit", "--no-render", "--no-http", "--tcp", "0", "--udp", "0", *arguments],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return daemon, re.search(r"tcp=\S*?:(\d+)", daemon.stdout.readline()).group(1)


def measure(options, folder):
    certificate, key = folder / "crt", folder / "key"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "1", "-subj",
                    "/CN=bench", "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", key, "-out", certificate],
                   check=True, capture_output=True)
    config = folder / "furrow.toml"
    # One client that waits for nothing but its weights sends more than a peer may send by default.
    config.write_text("[limits]\npackets_per_second = 1e6\n")
    daemons = {"plain": start(options, config), "TLS": start(options, config, "--tls-certificate", certificate, "--tls-key", key)}
    found = {way: [] for way in daemons}
    try:
        for _ in range(options.rounds):
            for way, (daemon, port) in daemons.items():
                before = cpu_seconds(daemon.pid)
                arguments = [certificate] if way == "TLS" else []
                run = subprocess.run([options.bin / "bench_tls_client", port, str(options.poses), *arguments], check=True,
                                     capture_output=True, text=True)
                p50, p99, client = map(float, run.stdout.split())
                cpu = 1e6 * (cpu_seconds(daemon.pid) - before) / options.poses
                found[way].append({"p50": p50, "p99": p99, "cpu": cpu, "client": client})
    finally:
        for daemon, _ in daemons.values():
            daemon.terminate()
            daemon.wait()
    two_ways.print_table(FIGURES, found)
    two_ways.print_ratios(FIGURES, found, "TLS", "plain")


if __name__ == "__main__":
    main()
