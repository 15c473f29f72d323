#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Restarts a daemon while a subject streams and measures what a viewer notices (bench/restart.sh)."""
import pathlib
import signal
import statistics
import sys
import tempfile

from furrow_testing import GUARD, SHARE, furrow, make_certificate, missing, reorderings, repetitions, spawn
from service_manager import ServiceManager, damage
from test_restart import Rows

PERFORMANCE = SHARE / "recordings" / "performance.bvh"
BETWEEN = 30  # frames, about a second


class Stage:
    """A daemon, and the keys, tokens and certificates that some ways need."""

    def __init__(self, folder):
        self.root = pathlib.Path(folder)
        self.keys = self.root / "keys"
        furrow("token", "key", "new", "--key", self.keys, check=0)
        self.token = self.root / "token"
        furrow("token", "new", "--role", "publish,watch", "--for", "1h", "--key", self.keys, "--out", self.token, check=0)
        self.certificate, key = make_certificate(folder)
        strict = ("--security", "required", "--keys", self.keys)
        tls = ("--tls-certificate", self.certificate, "--tls-key", key)
        # The way, options of the daemon and of the clients, the port, and whether the state is of another version.
        self.ways = [("UDP", (), ("--udp",), "udp", False),
                     ("UDP with tokens", strict, ("--token", self.token), "udp", False),
                     ("TCP", (), ("--tcp",), "tcp", False),
                     ("TCP with TLS", tls, ("--tcp", "--tls-authority", self.certificate), "tcp", False),
                     ("UDP, another version of the state", (), ("--udp",), "udp", True),
                     ("UDP with tokens, another version", strict, ("--token", self.token), "udp", True),
                     ("TCP, another version", (), ("--tcp",), "tcp", True)]

    def measure(self, way, restarts, render):
        _, daemon, client, port, refused = way
        args = (*daemon, "--http", "0", *(() if render else ("--no-render",)))
        with ServiceManager(*args) as manager:
            address = getattr(manager, port)
            watcher = spawn("watch", address, "--subject", "ada", "--wait", "--format", "csv", *client)
            rows = Rows(watcher.stdout)
            player = spawn("play", PERFORMANCE, "--to", address, "--subject", "ada", "--loop", *client)
            rows.wait(2 * BETWEEN)
            gaps, waits, kept = [], [], 0
            for _ in range(restarts):
                first = len(rows.times)
                assert manager.end() == 0
                if refused:
                    damage(manager, "version")
                manager.start()
                rows.wait(BETWEEN)
                times = rows.times[first - 1:]
                gaps.append(max(b - a for a, b in zip(times, times[1:])) * 1e3)
                waits.append(next(time for time in times if time > manager.ready_at) - manager.ready_at)
                kept += "resumed 2 peers" in manager.text()
            for process in (watcher, player):
                process.send_signal(signal.SIGINT)
                process.communicate(timeout=GUARD)
            return gaps, waits, list(zip(rows.times, rows.frames())), kept


def main():
    restarts, render = int(sys.argv[1]), "--render" in sys.argv
    print("| Way | Without frames: median, longest | After the new daemon serves: longest | Frames missing | Frames twice | "
          "In the wrong order | Sessions that went on |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        stage = Stage(folder)
        for way in stage.ways:
            gaps, waits, frames, kept = stage.measure(way, restarts, render)
            print(f"| {way[0]} | {statistics.median(gaps):.0f} ms, {max(gaps):.0f} ms | {max(waits) * 1e3:.0f} ms | "
                  f"{missing(frames)} | {repetitions(frames)} | {reorderings(frames)} | {kept} of {restarts} |", flush=True)


if __name__ == "__main__":
    main()
