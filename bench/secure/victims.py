# SPDX-License-Identifier: Apache-2.0
"""A daemon that is attacked, and what its users notice."""
import contextlib
import http.client
import json
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench/report"))
from attackers import DEADLINE, attackers  # pylint: disable=wrong-import-position
from processes import resident_kib  # pylint: disable=wrong-import-position


class Daemon:
    def __init__(self, bin_folder, *arguments):
        self.bin = bin_folder
        self.process = subprocess.Popen([bin_folder / "furrowd", "--tcp", "0", "--udp", "0", "--http", "0", *arguments],
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        ready = self.process.stdout.readline()
        self.ports = {name: int(port) for name, port in re.findall(r"(\w+)=\S*?:(\d+)", ready)}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def mebibytes(self):
        return resident_kib(self.process.pid) / 1024

    def fetch(self, path):
        """Returns the status and the body; status 0: no answer."""
        with contextlib.suppress(OSError, http.client.HTTPException):
            web = http.client.HTTPConnection("127.0.0.1", self.ports["http"], timeout=DEADLINE)
            with contextlib.closing(web):
                web.request("GET", path)
                answer = web.getresponse()
                return answer.status, answer.read()
        return 0, b""

    def get(self, path):
        """Returns the status and the seconds; status 0: no answer."""
        begun = time.monotonic()
        status, _ = self.fetch(path)
        return status, time.monotonic() - begun

    def metric(self, name):
        found = re.search(rf"^{name} (\S+)$", self.fetch("/metrics")[1].decode(), re.M)
        return found[1] if found else "absent"

    def weights_ms(self, recording, seconds):
        """The p50 and the longest latency of weights, in ms, and the part that was lost."""
        if self.process.poll() is not None:
            raise RuntimeError("the daemon has ended")
        with tempfile.NamedTemporaryFile(suffix=".json") as report:
            subprocess.run([self.bin / "furrow", "load", f"127.0.0.1:{self.ports['udp']}", recording, "--subjects", "20",
                            "--rate", "60", "--duration", str(seconds), "--quantise", "--json", report.name],
                           capture_output=True, check=False)
            run = json.loads(pathlib.Path(report.name).read_text())["run"]
        lost = run["lost"] if "lost" in run else run["tally"]["lost"]
        latency = run["latency_us"]
        return latency["p50"] / 1000, latency["max"] / 1000, lost / max(1, run.get("sent", 20 * 60 * seconds))


def weights_gap_ms(port, subject, seconds):
    """The longest time without a new brow of the tracker() over HTTP, in ms."""
    with socket.create_connection(("127.0.0.1", port), DEADLINE) as web:
        web.sendall(f"GET /weights?subject={subject}&pattern=brow_l.* HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        last, longest, end, text, before = time.monotonic(), 0.0, time.monotonic() + seconds, b"", None
        while (now := time.monotonic()) < end:
            web.settimeout(end - now)
            with contextlib.suppress(TimeoutError):
                text += web.recv(1 << 16)
            *lines, text = text.split(b"\n")
            for line in lines:
                values = json.loads(line).get("values", []) if line.startswith(b"{") else []
                # Of the tracker, and not of whoever forges frames: see forged_mocap().
                if 0.0 < max(values, default=0.0) < 0.3 and values != before:
                    now, before = time.monotonic(), values
                    longest, last = max(longest, now - last), now
    return 1000 * max(longest, time.monotonic() - last)


class Table:
    def __init__(self, options):
        self.options = options
        print("| attack | victim | without | with | memory |\n|---|---|---|---|---|")

    def row(self, attack, victim, without, with_it, growth=None):
        print(f"| {attack} | {victim} | {without} | {with_it} | {'' if growth is None else f'{growth:+.0f} MiB'} |", flush=True)

    def weights(self, attack, daemon, *calls):
        before, longest_before, _ = daemon.weights_ms(self.options.recording, self.options.seconds)
        memory = daemon.mebibytes()
        with attackers(*calls):
            during, longest, lost = daemon.weights_ms(self.options.recording, self.options.seconds)
            growth = daemon.mebibytes() - memory
        self.row(attack, "weights, p50 (longest)", f"{before:.2f} ms ({longest_before:.0f} ms)",
                 f"{during:.2f} ms ({longest:.0f} ms), {100 * lost:.1f}% lost", growth)
