# SPDX-License-Identifier: Apache-2.0
"""The programs of a measurement on a bad network: a daemon whose log is read, clients whose lines are timed."""
import dataclasses
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from processes import resident_kib  # pylint: disable=wrong-import-position

# A bad network: lost, late, early and repeated datagrams, and up to 50 ms of jitter.
FAULTS = ("--loss", "0.1", "--reorder", "0.2", "--duplicate", "0.05", "--jitter", "50")


def recording_of(folder):
    return pathlib.Path(folder).parent / "share" / "furrow" / "recordings" / "performance.bvh"


class Lines:
    """The lines that a stream prints, each with its time.monotonic(). A thread reads them."""

    def __init__(self, stream):
        self.lines = []
        self._thread = threading.Thread(target=self._read, args=(stream,), daemon=True)
        self._thread.start()

    def _read(self, stream):
        for line in stream:
            self.lines.append((time.monotonic(), line.rstrip("\n")))

    def count(self, words, until=float("inf")):
        return sum(words in line for at, line in list(self.lines) if at <= until)

    def last(self, words):
        """The time of the last line with `words`; None: there is none."""
        return max((at for at, line in list(self.lines) if words in line), default=None)

    def first_after(self, moment):
        """The time of the first line after `moment`; None: there is none yet."""
        return next((at for at, _ in list(self.lines) if at > moment), None)

    def newest(self):
        return self.lines[-1][0] if self.lines else None


class Daemon:
    """A furrowd on free ports, or on those of an earlier one."""

    def __init__(self, folder, *flags, ports=None, setup=None):
        ports = ports or {"tcp": 0, "udp": 0}
        listen = [word for name, port in ports.items() for word in (f"--{name}", str(port))]
        if "http" not in ports:
            listen.append("--no-http")
        self.process = subprocess.Popen([pathlib.Path(folder) / "furrowd", *listen, *map(str, flags)], text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=setup)
        ready = ""
        self.ready_at = None
        while not ready.startswith("furrowd ready"):
            ready = self.process.stdout.readline()
            if ready == "":
                raise RuntimeError(self.process.stderr.read())
        self.ready_at = time.monotonic()
        self.draws = "render=on" in ready
        self.ports = {name: int(port) for name, port in re.findall(r"(\w+)=[^ ]*?:(\d+)", ready)}
        self.log = Lines(self.process.stderr)
        self.out = Lines(self.process.stdout)

    def host(self, name="udp"):
        return f"127.0.0.1:{self.ports[name]}"

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=30)


class Stalls:
    """Moments at which this process did not run, because the machine was busy or paused. A thread sleeps and looks."""

    PERIOD = 0.05
    LONG = 0.3  # s; shorter ones are usual

    def __init__(self):
        self.found = []  # (end, length)
        threading.Thread(target=self._watch, daemon=True).start()

    def _watch(self):
        while True:
            began = time.monotonic()
            time.sleep(self.PERIOD)
            late = time.monotonic() - began - self.PERIOD
            if late > self.LONG:
                self.found.append((began + self.PERIOD + late, late))

    def since(self, moment):
        return any(end >= moment for end, _ in list(self.found))


def make_certificate(folder):
    """A certificate for localhost and 127.0.0.1 that signs itself: its file and that of its key. None: no openssl."""
    certificate, key = pathlib.Path(folder) / "daemon.crt", pathlib.Path(folder) / "daemon.key"
    command = ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2",
               "-subj", "/CN=furrow", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1", "-keyout", key, "-out", certificate]
    try:
        subprocess.run(command, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return certificate, key


@dataclasses.dataclass
class Usage:
    """What a process takes: resident memory in KiB, and open files."""
    resident_kib: int
    files: int


def heap_in_use(host):
    """The KiB of a daemon's heap that are in use, as its /metrics states them; None: no answer."""
    try:
        with urllib.request.urlopen(f"http://{host}/metrics", timeout=2) as answer:
            found = re.search(r"^furrow_heap_used_bytes (\S+)", answer.read().decode(), re.M)
    except OSError:
        return None
    return float(found.group(1)) / 1024 if found else None


def usage_of(pid):
    return Usage(resident_kib(pid), len(os.listdir(f"/proc/{pid}/fd")))
