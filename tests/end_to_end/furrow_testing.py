# SPDX-License-Identifier: Apache-2.0
"""Shared by the end-to-end tests: running the programs, a daemon on free ports, tables of weights."""
import contextlib
import csv
import io
import os
import pathlib
import random
import re
import shlex
import signal
import socket
import subprocess
import threading
import time
import unittest
import zlib

BIN = pathlib.Path(os.environ["FURROW_BIN"])
SOURCE = pathlib.Path(os.environ["FURROW_SOURCE"])
SHARED = pathlib.Path(os.environ.get("FURROW_SHARED_DATA", "/nonexistent"))
SHARE = BIN.parent / "share" / "furrow"
GUARD = 300  # seconds; only a failing test takes this long


def needs_shared(*parts):
    """Returns a file of the shared data, or skips the test."""
    path = SHARED.joinpath(*parts)
    if not path.exists():
        raise unittest.SkipTest(f"{path} is missing")
    return path


def free_port(kind=socket.SOCK_STREAM):
    """A port for a program that cannot choose one itself. The system gives ports below 32,768 to nobody. Other tests leave it
    alone until this process ends, because it holds the port 12,000 below (as tests/browser/elsewhere.test.mjs does)."""
    while True:
        port = random.randrange(20_000, 32_000)
        with (contextlib.suppress(OSError), socket.socket() as guard,
              socket.socket(socket.AF_INET, kind) as probe):
            guard.bind(("127.0.0.1", port - 12_000))
            probe.bind(("127.0.0.1", port))
            guard.detach()  # stays open
            return port


def commands(document):
    """Yields the command lines in the fenced blocks of a document as lists of words, without comments."""
    text = (SOURCE / document).read_text()
    for block in re.findall(r"^```\w*\n(.*?)^```", text, re.M | re.S):
        for line in block.splitlines():
            if re.match(r"furrowd?( |$)", line):
                yield shlex.split(line, comments=True)


def furrow(*args, env=None, check=None, stdin=None):
    """Runs `furrow` and waits for its end. `check`: the required exit code."""
    result = subprocess.run([BIN / "furrow", *map(str, args)], capture_output=True, timeout=GUARD,
                            env={**os.environ, **(env or {})}, input=stdin)
    if check is not None:
        assert result.returncode == check, (args, result.returncode, result.stderr.decode())
    return result


def spawn(*args, env=None):
    """Starts `furrow` in the background."""
    return subprocess.Popen([BIN / "furrow", *map(str, args)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, env={**os.environ, **(env or {})})


def spawn_watch(daemon_address, subject, *args):
    """Starts `furrow watch` and waits for its subscription, so that it receives everything played later."""
    watcher = spawn("watch", daemon_address, "--subject", subject, "--wait", "--format", "csv", *args)
    line = watcher.stderr.readline().decode()
    assert "waiting" in line, line
    return watcher


class Table:
    """Weights read from CSV: their names, and rows by frame."""

    def __init__(self, text):
        rows = list(csv.reader(io.StringIO(text)))
        self.names = rows[0][2:]
        self.rows = {int(row[0]): [float(x) for x in row[2:]] for row in rows[1:]}
        self.times = {int(row[0]): float(row[1]) for row in rows[1:]}

    def column(self, name):
        index = self.names.index(name)
        return {frame: row[index] for frame, row in self.rows.items()}


def solve(*args, env=None):
    return Table(furrow("solve", *args, env=env, check=0).stdout.decode())


def worst_difference(a, b):
    """Returns the largest difference over the common frames, and the number of common frames."""
    assert a.names == b.names, (a.names[:3], b.names[:3])
    common = sorted(a.rows.keys() & b.rows.keys())
    worst = max((abs(x - y) for f in common for x, y in zip(a.rows[f], b.rows[f])), default=None)
    return worst, len(common)


class Daemon:
    """Runs furrowd on free ports in a with-block. SIGTERM ends it, and it must exit with 0."""

    def __init__(self, *args, env=None, ports=None):
        """`ports`: those of an earlier daemon, to take its place."""
        tcp, udp = (ports["tcp"], ports["udp"]) if ports else (0, 0)
        self.args = [BIN / "furrowd", "--tcp", str(tcp), "--udp", str(udp), *map(str, args)]
        self.env = {**os.environ, **(env or {})}
        self.expect = 0

    def __enter__(self):
        self.process = subprocess.Popen(self.args, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=self.env)
        self.ready = self.process.stdout.readline().decode()
        if not self.ready.startswith("furrowd ready"):
            self.process.kill()
            raise AssertionError(f"no ready line: {self.ready!r} {self.process.stderr.read().decode()}")
        self.ports = {name: int(port) for name, port in re.findall(r"(\w+)=[^ ]*?:(\d+)", self.ready)}
        self.tcp = f"127.0.0.1:{self.ports['tcp']}"
        self.udp = f"127.0.0.1:{self.ports['udp']}"
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        _, stderr = self.process.communicate(timeout=GUARD)
        self.stderr = stderr.decode()
        if self.process.returncode != self.expect:
            raise AssertionError(f"furrowd exited {self.process.returncode}: {self.stderr[-2000:]}")


def finish(process):
    """Waits for a spawned program and returns its exit code, stdout and stderr."""
    out, err = process.communicate(timeout=GUARD)
    return process.returncode, out, err.decode()


def wait_until(condition, what):
    """Calls `condition` until it is true, and returns its value."""
    deadline = time.monotonic() + GUARD
    pause = threading.Event()
    while time.monotonic() < deadline:
        value = condition()
        if value:
            return value
        pause.wait(0.05)
    raise AssertionError(f"this never happened: {what}")


def jpeg_size(data):
    """Returns the width and height from a JPEG's frame header. Fails if `data` is not a JPEG."""
    assert data[:2] == b"\xff\xd8" and data[-2:] == b"\xff\xd9", "not a whole JPEG"
    at = 2
    while True:
        assert data[at] == 0xFF
        marker, length = data[at + 1], int.from_bytes(data[at + 2:at + 4], "big")
        if 0xC0 <= marker <= 0xC3:
            return (int.from_bytes(data[at + 7:at + 9], "big"), int.from_bytes(data[at + 5:at + 7], "big"))
        at += 2 + length


def png_size(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG"
    return int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")


def png_rows(data):
    """Decodes a PNG of 8 bits per channel, as Furrow writes them: rows of pixels, each a tuple of channels."""
    width, height = png_size(data)
    assert data[24] == 8 and data[28] == 0, "not 8 bits, or interlaced"
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[data[25]]
    packed, at = b"", 8
    while at < len(data):
        length = int.from_bytes(data[at:at + 4], "big")
        if data[at + 4:at + 8] == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, stride, rows = zlib.decompress(packed), width * channels, []
    above = bytearray(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left = row[i - channels] if i >= channels else 0
            corner = above[i - channels] if i >= channels else 0
            p = left + above[i] - corner
            paeth = min((abs(p - left), 0, left), (abs(p - above[i]), 1, above[i]), (abs(p - corner), 2, corner))[2]
            row[i] = (row[i] + (0, left, above[i], (left + above[i]) // 2, paeth)[kind]) & 255
        rows.append([tuple(row[i:i + channels]) for i in range(0, stride, channels)])
        above = row
    return rows


def png_channels(data):
    """The channels of all pixels of png_rows(), one after another."""
    return [channel for row in png_rows(data) for pixel in row for channel in pixel]


def differing_share(a, b):
    """The share of the channels of two PNGs that are more than 8 of 255 apart."""
    one, two = png_channels(a), png_channels(b)
    assert len(one) == len(two)
    return sum(abs(x - y) > 8 for x, y in zip(one, two)) / len(one)


def picture_difference(a, b):
    """The mean difference of two pictures of png_rows() over all channels, 0 to 255."""
    pairs = [(x, y) for row_a, row_b in zip(a, b) for p, q in zip(row_a, row_b) for x, y in zip(p, q)]
    return sum(abs(x - y) for x, y in pairs) / len(pairs)


def make_certificate(folder):
    """A certificate for localhost and 127.0.0.1 that signs itself; the files of it and of its key."""
    certificate, key = pathlib.Path(folder) / "furrow.crt", pathlib.Path(folder) / "furrow.key"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2",
                    "-subj", "/CN=furrow", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1", "-keyout", key, "-out",
                    certificate], check=True, capture_output=True)
    return certificate, key


# What a viewer noticed. Frames are (time of arrival, number).


def repetitions(frames):
    """How many numbers of frames came again."""
    return len(frames) - len({number for _, number in frames})


def missing(frames):
    """How many numbers are missing between the first and the last frame."""
    numbers = {number for _, number in frames}
    return max(numbers) - min(numbers) + 1 - len(numbers) if numbers else 0


def reorderings(frames):
    """How often a frame came after a later one. Decaying frames repeat a number."""
    return sum(b < a for (_, a), (_, b) in zip(frames, frames[1:]))
