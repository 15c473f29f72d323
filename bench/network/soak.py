#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs two daemons in all kinds of trouble at once and prints one page of figures.

    soak.py BIN [--hours H]           bench/soak.sh runs it

The first daemon lives for the whole run and may open 160 files. `furrow load` sends it 40 subjects in turns of 30 s: calm, and
with 10% loss, 20% reordering, 5% duplicates, 50 ms of jitter, viewers that stall, read slowly, and come and go. During the
trouble, 400 TCP connections at a time exceed its open files, clients ask the web server and do not read, and its recording
fills a disk of 160 MB, from which the oldest files are deleted now and then.

The second daemon is killed or ended every 15 s and comes back 2 s later. Its publishers and viewers reach it through
`furrow chaos` with the same faults. A viewer is stale if its newest weights are older than 2 s, 2 s after the daemon came back.

The system's clock is not stepped: that needs root rights.
"""
import argparse
import json
import pathlib
import resource
import socket
import statistics
import subprocess
import sys
import tempfile
import threading
import time

from programs import FAULTS, Daemon, Lines, Usage, recording_of, usage_of

MAX_FILES = 160
DISK_MB = 160
TURN_SECONDS = 30
LIFE_SECONDS = 15
STALE_SECONDS = 2.0
TROUBLE = (*FAULTS, "--stalled", "3", "--slow", "2", "--churn", "2")


class Samples:
    """Memory and open files of a process, once per second, and all of them in calm turns."""

    def __init__(self, pid):
        self.pid = pid
        self.rows = []
        self.peak = usage_of(pid)

    def take(self, calm):
        usage = usage_of(self.pid)
        self.peak = Usage(max(usage.resident_kib, self.peak.resident_kib), max(usage.files, self.peak.files))
        if calm:
            self.rows.append((time.monotonic(), usage.resident_kib, usage.files))

    def slope_per_hour(self, column):
        """The least-squares slope after the first fifth, which warms up."""
        rows = self.rows[len(self.rows) // 5:]
        if len(rows) < 3:
            return float("nan")
        at = [row[0] for row in rows]
        return 3600 * statistics.linear_regression(at, [row[column] for row in rows]).slope


class Soak:
    def __init__(self, folder, seconds, scratch):
        self.folder = folder
        self.end = time.monotonic() + seconds
        self.scratch = scratch
        self.disk = scratch / "disk"
        self.disk.mkdir()
        self.has_disk = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK_MB}m", "none", str(self.disk)],
                                       capture_output=True).returncode == 0
        self.runs = {"calm": [], "trouble": []}
        self.failures = []
        self.stale = 0
        self.returns = []
        self.ends = []
        self.kills = 0
        self.troubled = threading.Event()
        self.calm_since = float("inf")

    def over(self):
        return time.monotonic() >= self.end

    def run(self):
        record = ["--record", self.disk / "takes", "--record-rotate-megabytes", 16] if self.has_disk else []
        self.daemon = Daemon(self.folder, "--no-render", *record, ports={"tcp": 0, "udp": 0, "http": 0},
                             setup=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (MAX_FILES, MAX_FILES)))
        self.samples = Samples(self.daemon.process.pid)
        threads = [threading.Thread(target=self.guarded, args=(part,), daemon=True)
                   for part in (self.load, self.exhaust_files, self.stall_web, self.free_disk, self.restart)]
        for thread in threads:
            thread.start()
        while not self.over():
            time.sleep(1.0)
            # The connections of the trouble before need some seconds to end.
            self.samples.take(calm=time.monotonic() > self.calm_since + 15 and not self.troubled.is_set())
        for thread in threads:
            thread.join(timeout=3 * TURN_SECONDS + 60)
        began = time.monotonic()
        code = self.daemon.stop()
        self.ends.append(time.monotonic() - began)
        if code != 0:
            self.failures.append(f"the daemon ended with {code}")

    def guarded(self, part):
        try:
            part()
        except Exception as error:  # a soak reports what failed, and goes on with the rest
            self.failures.append(f"{part.__name__}: {error}")

    def load(self):
        report = self.scratch / "report.json"
        kind = "calm"
        while not self.over():
            (self.troubled.set if kind == "trouble" else self.troubled.clear)()
            self.calm_since = float("inf") if kind == "trouble" else time.monotonic()
            flags = TROUBLE if kind == "trouble" else ()
            result = subprocess.run(
                [self.folder / "furrow", "load", self.daemon.host(), recording_of(self.folder), "--subjects", "40", "--rate",
                 "60", "--duration", str(TURN_SECONDS), "--other-port", str(self.daemon.ports["tcp"]), "--json", report, *flags],
                capture_output=True, text=True)
            if result.returncode == 0:
                self.runs[kind].append(json.loads(report.read_text())["run"])
            else:
                self.failures.append(f"{kind} turn: {result.stderr.strip().splitlines()[-1]}")
            kind = "calm" if kind == "trouble" else "trouble"
        self.troubled.clear()

    def connect(self, port):
        try:
            return socket.create_connection(("127.0.0.1", port), timeout=1)
        except OSError:
            return None

    def exhaust_files(self):
        while not self.over():
            if not self.troubled.wait(timeout=1):
                continue
            held = [self.connect(self.daemon.ports["tcp"]) for _ in range(400)]
            time.sleep(3)
            for connection in filter(None, held):
                connection.close()
            time.sleep(7)

    def stall_web(self):
        while not self.over():
            if not self.troubled.wait(timeout=1):
                continue
            held = [self.connect(self.daemon.ports["http"]) for _ in range(20)]
            for connection in filter(None, held):
                try:
                    connection.sendall(b"GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n" * 50)
                except OSError:
                    pass
            time.sleep(5)
            for connection in filter(None, held):
                connection.close()

    def free_disk(self):
        while self.has_disk and not self.over():
            time.sleep(60)
            takes = sorted((self.disk / "takes").glob("*.mcap"), key=lambda path: path.stat().st_mtime)
            for take in takes[:-1]:
                take.unlink()

    def restart(self):
        daemon = Daemon(self.folder, "--no-render")
        ports = {name: daemon.ports[name] for name in ("tcp", "udp")}
        chaos = subprocess.Popen([self.folder / "furrow", "chaos", "--listen", "0", "--to", daemon.host(), *FAULTS],
                                 stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        host = chaos.stdout.readline().split("udp=")[1].split()[0]
        players = [subprocess.Popen(
            [self.folder / "furrow", "play", recording_of(self.folder), "--to", host, "--subject", f"player-{i}", "--loop"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for i in range(5)]
        viewers = [subprocess.Popen(
            [self.folder / "furrow", "watch", f"furrow://{host}?subject=player-{i}&transport=udp", "--wait", "--pattern",
             "brow_l.*", "--format", "csv"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) for i in range(5)]
        lines = [Lines(viewer.stdout) for viewer in viewers]
        try:
            while not self.over():
                self.watch_life(lines, daemon.ready_at)
                began = time.monotonic()
                if self.kills % 2 == 0:
                    daemon.kill()
                else:
                    daemon.stop()
                    self.ends.append(time.monotonic() - began)
                self.kills += 1
                time.sleep(2)
                daemon = Daemon(self.folder, "--no-render", ports=ports)
        finally:
            for process in (*viewers, *players, chaos):
                process.kill()
                process.wait()
            daemon.kill()

    def watch_life(self, lines, ready_at):
        back = [None] * len(lines)
        while time.monotonic() < ready_at + LIFE_SECONDS and not self.over():
            time.sleep(0.05)
            now = time.monotonic()
            back = [at or line.first_after(ready_at) for at, line in zip(back, lines)]
            if now > ready_at + STALE_SECONDS:
                self.stale += sum((line.newest() or 0) < now - STALE_SECONDS for line in lines)
        self.returns += [at - ready_at for at in back if at is not None]

    def page(self, hours):
        log = self.daemon.log
        lines = [f"soak of {hours:g} h: {len(self.runs['calm'])} calm and {len(self.runs['trouble'])} troubled turns of "
                 f"{TURN_SECONDS} s, 40 subjects at 60 Hz"]
        for kind, runs in self.runs.items():
            if not runs:
                continue
            total = {key: sum(run[key] for run in runs) for key in ("expected", "received", "wrong", "unchecked")}
            p50 = statistics.median(run["latency_us"]["p50"] for run in runs) / 1000
            p99 = max(run["latency_us"]["p99"] for run in runs) / 1000
            lines.append(f"{kind:8}: lost {100 - 100 * total['received'] / total['expected']:.2f}% of {total['expected']:,}, wrong "
                         f"{total['wrong']}, unchecked {total['unchecked']}, p50 {p50:.2f} ms, worst p99 {p99:.1f} ms")
        memory = [row[1] for row in self.samples.rows]
        files = [row[2] for row in self.samples.rows]
        lines += [
            f"memory  : {memory[-1] / 1024:.1f} MiB at the end, {self.samples.peak.resident_kib / 1024:.1f} MiB at most, slope in calm turns "
            f"{self.samples.slope_per_hour(1) / 1024:+.2f} MiB/h",
            f"files   : {files[-1]} open at the end, {self.samples.peak.files} at most of {MAX_FILES}, slope in calm turns {self.samples.slope_per_hour(2):+.1f} per hour",
            f"disk    : {'recording paused ' + str(log.count('recording paused')) + ' and resumed ' + str(log.count('recording again')) + ' times' if self.has_disk else 'not limited (no right to mount)'}",
            f"restarts: {self.kills}, every second one by SIGKILL; weights again after {statistics.median(self.returns):.2f} s, "
            f"{max(self.returns):.2f} s at most; stale {self.stale}" if self.returns else "restarts: none",
            f"ends    : {max(self.ends):.2f} s at most after SIGTERM",
            f"failed  : {len(self.failures)}{''.join(chr(10) + '  ' + failure for failure in self.failures)}",
        ]
        return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--hours", type=float, default=1.0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        soak = Soak(options.bin.resolve(), options.hours * 3600, pathlib.Path(scratch))
        try:
            soak.run()
        finally:
            if soak.has_disk:
                subprocess.run(["umount", "-l", str(soak.disk)], capture_output=True)
        print(soak.page(options.hours))
    bad = soak.failures or soak.stale or any(run["wrong"] for runs in soak.runs.values() for run in runs)
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
