#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs two daemons in all kinds of trouble at once and prints one page of figures.

    soak.py BIN [--hours H] [--no-pictures]          bench/soak.sh runs it

The first daemon lives for the whole run and may open 160 files. `furrow load` sends it 40 subjects in turns of 30 s: calm, and
with 10% loss, 20% reordering, 5% duplicates, 50 ms of jitter, capture clocks that jump by 3 s, and viewers that stall, read
slowly, and come and go. During the trouble, 400 TCP connections at a time exceed its open files, clients ask the web server
and do not read, viewers of pictures stop reading at the web port and at the TCP port, and its recording fills a disk of
160 MB, from which the oldest files are deleted now and then. One viewer reads its small pictures all the time.

The second daemon is killed or ended every 15 s and comes back 2 s later. Its publishers and viewers reach it through
`furrow chaos` with the same faults, one viewer over TLS. Stale viewers are counted once per life of the daemon: those whose
newest weights are older than 2 s, 2 s after the daemon came back, unless the machine itself stood still since then.

The system's clock is not stepped: that would need root rights, and every program of the machine would notice.
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

from programs import FAULTS, Daemon, Lines, Stalls, Usage, heap_in_use, make_certificate, recording_of, usage_of

MAX_FILES = 160
DISK_MB = 160
TURN_SECONDS = 30
LIFE_SECONDS = 15
STALE_SECONDS = 2.0
DRAIN_SECONDS = 2.0  # the default of limits.drain_seconds
MOST_MIB_PER_HOUR = 1.0
TROUBLE = (*FAULTS, "--clock-step", "3", "--clock-every", "7", "--stalled", "3", "--slow", "2", "--churn", "2")
# Small pictures, so that a software renderer leaves the processor to the weights.
MJPEG = b"GET /mjpeg?subject=load-000000&width=64&height=64&rate=4 HTTP/1.1\r\nHost: localhost\r\n\r\n"


class Samples:
    """Memory and open files of a daemon, once per second, and all of them in calm turns."""

    def __init__(self, daemon):
        self.pid = daemon.process.pid
        self.web = daemon.host("http")
        self.rows = []
        self.heap = []  # KiB in use, with their times
        self.peak = usage_of(self.pid)

    def take(self, calm):
        usage = usage_of(self.pid)
        self.peak = Usage(max(usage.resident_kib, self.peak.resident_kib), max(usage.files, self.peak.files))
        if not calm:
            return
        self.rows.append((time.monotonic(), usage.resident_kib, usage.files))
        in_use = heap_in_use(self.web) if len(self.rows) % 5 == 0 else None
        if in_use is not None:
            self.heap.append((time.monotonic(), in_use))

    @staticmethod
    def slope_per_hour(rows, column=1):
        """The least-squares slope after the first fifth, which warms up."""
        rows = rows[len(rows) // 5:]
        if len(rows) < 3:
            return float("nan")
        at = [row[0] for row in rows]
        return 3600 * statistics.linear_regression(at, [row[column] for row in rows]).slope


class Soak:
    def __init__(self, folder, seconds, scratch, pictures):
        self.folder = folder
        self.wants_pictures = pictures
        self.end = time.monotonic() + seconds
        self.scratch = scratch
        self.disk = scratch / "disk"
        self.disk.mkdir()
        self.has_disk = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK_MB}m", "none", str(self.disk)],
                                       capture_output=True).returncode == 0
        self.runs = {"calm": [], "trouble": []}
        self.failures = []
        self.stalls = Stalls()
        self.pictures = {"calm": 0, "trouble": 0}
        self.picture_gap = 0.0
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
        self.daemon = Daemon(self.folder, *record, *(() if self.wants_pictures else ("--no-render",)), ports={"tcp": 0, "udp": 0, "http": 0},
                             setup=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (MAX_FILES, MAX_FILES)))
        self.samples = Samples(self.daemon)
        threads = [threading.Thread(target=self.guarded, args=(part,), daemon=True)
                   for part in (self.load, self.exhaust_files, self.stall_web, self.free_disk, self.restart,
                                *((self.watch_pictures, self.stall_pictures) if self.daemon.draws else ()))]
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

    def watch_pictures(self):
        """A viewer that reads at once, and connects again if the daemon has no place for it."""
        newest = None
        while not self.over():
            viewer = self.connect(self.daemon.ports["http"])
            if viewer is None:
                time.sleep(0.5)
                continue
            with viewer:
                viewer.settimeout(1)
                viewer.sendall(MJPEG)
                while not self.over():
                    try:
                        data = viewer.recv(65536)
                    except TimeoutError:
                        continue
                    except OSError:
                        break
                    if not data:
                        break
                    now = time.monotonic()
                    count = data.count(b"Content-Type: image/jpeg")
                    if count == 0:
                        continue
                    self.pictures["trouble" if self.troubled.is_set() else "calm"] += count
                    if newest is not None and not self.stalls.since(newest):
                        self.picture_gap = max(self.picture_gap, now - newest)
                    newest = now

    def stall_pictures(self):
        """Viewers that ask for pictures and stop reading: at the web port, and at the TCP port."""
        frames = [self.folder / "furrow", "frames", self.daemon.host("tcp"), "--subject", "load-000001", "--wait", "--size", "64x64",
                  "--out", "-"]
        while not self.over():
            if not self.troubled.wait(timeout=1):
                continue
            held = list(filter(None, (self.connect(self.daemon.ports["http"]) for _ in range(6))))
            # Nobody reads their output, so they stop reading as soon as the pipe is full.
            programs = [subprocess.Popen(frames, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) for _ in range(2)]
            for viewer in held:
                viewer.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
                try:
                    viewer.sendall(MJPEG)
                except OSError:
                    pass
            time.sleep(12)
            for viewer in held:
                viewer.close()
            for program in programs:
                program.kill()
                program.wait()
                program.stdout.close()

    def free_disk(self):
        while self.has_disk and not self.over():
            time.sleep(60)
            takes = sorted((self.disk / "takes").glob("*.mcap"), key=lambda path: path.stat().st_mtime)
            for take in takes[:-1]:
                take.unlink()

    def restart(self):
        tls = make_certificate(self.scratch)
        flags = ("--no-render", *(("--tls-certificate", tls[0], "--tls-key", tls[1]) if tls else ()))
        daemon = Daemon(self.folder, *flags)
        ports = {name: daemon.ports[name] for name in ("tcp", "udp")}
        chaos = subprocess.Popen([self.folder / "furrow", "chaos", "--listen", "0", "--to", daemon.host(), "--to-tcp", str(ports["tcp"]),
                                  *FAULTS], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        hosts = dict(word.split("=") for word in chaos.stdout.readline().split() if "=" in word)
        host = hosts["udp"]
        players = [subprocess.Popen(
            [self.folder / "furrow", "play", recording_of(self.folder), "--to", host, "--subject", f"player-{i}", "--loop"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for i in range(5)]
        watched = [f"furrow://{host}?subject=player-{i}&transport=udp" for i in range(5)]
        if tls:
            watched[0] = f"furrow://{hosts['tcp']}?subject=player-0&tls-authority={tls[0]}"
        viewers = [subprocess.Popen([self.folder / "furrow", "watch", address, "--wait", "--pattern", "brow_l.*", "--format", "csv"],
                                    stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) for address in watched]
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
                daemon = Daemon(self.folder, *flags, ports=ports)
        finally:
            for process in (*viewers, *players, chaos):
                process.kill()
                process.wait()
            daemon.kill()

    def watch_life(self, lines, ready_at):
        back = [None] * len(lines)
        stale = set()
        while time.monotonic() < ready_at + LIFE_SECONDS and not self.over():
            time.sleep(0.05)
            now = time.monotonic()
            back = [at or line.first_after(ready_at) for at, line in zip(back, lines)]
            if now > ready_at + STALE_SECONDS and not self.stalls.since(max(ready_at, now - STALE_SECONDS)):
                stale |= {i for i, line in enumerate(lines) if (line.newest() or 0) < now - STALE_SECONDS}
        self.stale += len(stale)
        self.returns += [at - ready_at for at in back if at is not None]

    def page(self, hours):
        log = self.daemon.log
        lines = [f"soak of {hours:g} h: {len(self.runs['calm'])} calm and {len(self.runs['trouble'])} troubled turns of "
                 f"{TURN_SECONDS} s, 40 subjects at 60 Hz"]
        for kind, runs in self.runs.items():
            if not runs:
                continue
            total = {key: sum(run[key] for run in runs) for key in ("expected", "received", "wrong", "unchecked", "aged")}
            p50 = statistics.median(run["latency_us"]["p50"] for run in runs) / 1000
            p99 = max(run["latency_us"]["p99"] for run in runs) / 1000
            lines.append(f"{kind:8}: lost {100 - 100 * total['received'] / total['expected']:.2f}% of {total['expected']:,}, wrong "
                         f"{total['wrong']}, unchecked {total['unchecked']}, decayed {total['aged']}, p50 {p50:.2f} ms, worst p99 {p99:.1f} ms")
        memory = [row[1] for row in self.samples.rows]
        files = [row[2] for row in self.samples.rows]
        lines += [
            f"memory  : {memory[-1] / 1024:.1f} MiB at the end, {self.samples.peak.resident_kib / 1024:.1f} MiB at most, slope in calm turns "
            f"{Samples.slope_per_hour(self.samples.rows) / 1024:+.2f} MiB/h",
            f"heap    : {self.samples.heap[-1][1] / 1024 if self.samples.heap else float('nan'):.1f} MiB in use at the end, slope in calm turns "
            f"{Samples.slope_per_hour(self.samples.heap) / 1024:+.2f} MiB/h",
            f"pictures: {self.pictures['calm']} in calm and {self.pictures['trouble']} in troubled turns, {self.picture_gap:.1f} s apart at most"
            if self.daemon.draws else "pictures: none (no renderer)",
            f"stalls  : {len(self.stalls.found)} of this machine, {max((length for _, length in self.stalls.found), default=0.0):.1f} s at most",
            f"files   : {files[-1]} open at the end, {self.samples.peak.files} at most of {MAX_FILES}, slope in calm turns {Samples.slope_per_hour(self.samples.rows, 2):+.1f} per hour",
            f"disk    : {'recording paused ' + str(log.count('recording paused')) + ' and resumed ' + str(log.count('recording again')) + ' times' if self.has_disk else 'not limited (no right to mount)'}",
            f"restarts: {self.kills}, every second one by SIGKILL; weights again after {statistics.median(self.returns):.2f} s, "
            f"{max(self.returns):.2f} s at most; stale {self.stale} of {len(self.returns)}" if self.returns else "restarts: none",
            f"ends    : {max(self.ends):.2f} s at most after SIGTERM",
            f"failed  : {len(self.failures)}{''.join(chr(10) + '  ' + failure for failure in self.failures)}",
            f"missed  : {', '.join(self.missed(hours)) or 'nothing'}",
        ]
        return "\n".join(lines)

    def missed(self, hours):
        """What the run has shown to be worse than docs/LOAD.md promises."""
        slope = Samples.slope_per_hour(self.samples.rows) / 1024
        checks = {
            "a program failed": bool(self.failures),
            "wrong weights": any(run["wrong"] for runs in self.runs.values() for run in runs),
            "stale weights": self.stale > 0,
            "weights later than 1 s after a restart": bool(self.returns) and max(self.returns) > 1.0,
            "an end after drain_seconds": bool(self.ends) and max(self.ends) > DRAIN_SECONDS,
            "memory that grows": hours >= 1 and slope > MOST_MIB_PER_HOUR,
        }
        return [name for name, is_missed in checks.items() if is_missed]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--hours", type=float, default=1.0)
    parser.add_argument("--no-pictures", action="store_true", help="no renderer, whose memory hides that of the daemon")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        soak = Soak(options.bin.resolve(), options.hours * 3600, pathlib.Path(scratch), not options.no_pictures)
        try:
            soak.run()
        finally:
            if soak.has_disk:
                subprocess.run(["umount", "-l", str(soak.disk)], capture_output=True)
        print(soak.page(options.hours))
    sys.exit(1 if soak.missed(options.hours) else 0)


if __name__ == "__main__":
    main()
