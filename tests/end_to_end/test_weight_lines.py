#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Weights as JSON: lines over HTTP, messages over a WebSocket, and the lines of `furrow watch`."""
import base64
import hashlib
import http.client
import json
import os
import re
import socket
import struct
import unittest

from furrow_testing import GUARD, SHARE, Daemon, finish, furrow, spawn

PERFORMANCE = SHARE / "recordings" / "performance.bvh"
RATE = 240
FRAMES = 120
ALIVE = {"type": "alive"}


def as_float(value):
    """The nearest 32-bit float."""
    return struct.unpack("f", struct.pack("f", value))[0]


class Lines:
    """A plain GET of /weights."""

    def __init__(self, port, query=""):
        self.connection = http.client.HTTPConnection("127.0.0.1", port, timeout=GUARD)
        self.connection.request("GET", "/weights" + query)
        self.reply = self.connection.getresponse()

    def next_of_all(self):
        line = self.reply.readline()
        return json.loads(line) if line else None

    def next(self):
        """The next object that says something; a slow machine may be silent for long."""
        while (line := self.next_of_all()) == ALIVE:
            pass
        return line

    def close(self):
        self.reply.close()
        self.connection.close()


class WebSocket:
    """As much of RFC 6455 as a reader of short text messages needs. Uses nothing of Furrow."""

    def __init__(self, port, query=""):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=GUARD)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(f"GET /weights{query} HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
                            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        self.file = self.socket.makefile("rb")
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += self.file.read(1)
        accept = base64.b64encode(hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest())
        assert b" 101 " in head and accept in head, head

    def frame(self):
        """Returns the opcode and the payload of the next frame."""
        first, length = self.file.read(2)
        if length == 126:
            length = struct.unpack(">H", self.file.read(2))[0]
        elif length == 127:
            length = struct.unpack(">Q", self.file.read(8))[0]
        return first & 15, self.file.read(length)

    def next_of_all(self):
        """The next JSON message; the close code if the daemon closes."""
        while True:
            opcode, payload = self.frame()
            if opcode == 1:
                return json.loads(payload)
            if opcode == 8:
                return struct.unpack(">H", payload[:2])[0]
            assert opcode in (9, 10), "only text, pings, pongs and close frames"

    next = Lines.next

    def send(self, opcode, payload):
        self.socket.sendall(bytes([0x80 | opcode, 0x80 | len(payload)]) + bytes(4) + payload)

    def close(self):
        self.file.close()
        self.socket.close()


class WeightLinesTest(unittest.TestCase):
    def play(self, daemon, subject):
        player = spawn("play", PERFORMANCE, "--to", daemon.udp, "--subject", subject, "--rate", RATE, "--loop")
        self.addCleanup(player.stdout.close)
        self.addCleanup(player.stderr.close)
        self.addCleanup(player.wait, timeout=GUARD)
        self.addCleanup(player.terminate)
        return player

    def client(self, kind, daemon, query=""):
        client = kind(daemon.ports["http"], query)
        self.addCleanup(client.close)
        return client

    def test_two_subjects_frame_by_frame(self):
        for kind in (Lines, WebSocket):
            with self.subTest(kind.__name__), Daemon("--no-render", "--http", 0) as daemon:
                client = self.client(kind, daemon, "?subject=ada&subject=bob&pattern=brow_*&every=true")
                self.assertEqual([client.next(), client.next()],
                                 [{"type": "waiting", "subject": "ada"}, {"type": "waiting", "subject": "bob"}])
                self.play(daemon, "ada")
                self.play(daemon, "bob")
                names, last, frames = {}, {}, {"ada": 0, "bob": 0}
                while min(frames.values()) < FRAMES:
                    line = client.next()
                    subject = line["subject"]
                    if line["type"] == "names":
                        names[subject] = line["names"]
                        self.assertTrue(all(name.startswith("brow_") for name in line["names"]))
                        continue
                    self.assertEqual(set(line), {"type", "subject", "sequence", "time_us", "age_ms", "values"})
                    self.assertEqual(len(line["values"]), len(names[subject]), "names come first")
                    self.assertTrue(all(0 <= value <= 1 for value in line["values"]))
                    self.assertEqual(line["sequence"], last.get(subject, line["sequence"] - 1) + 1, "no frame is lost")
                    last[subject] = line["sequence"]
                    frames[subject] += 1
                daemon.process.terminate()
                lines = []
                while lines[-1:] != [{"type": "bye"}]:
                    lines.append(client.next())
                self.assertEqual(client.next(), None if kind is Lines else 1001)

    def test_a_subject_that_leaves_and_a_rate(self):
        with Daemon("--no-render", "--http", 0) as daemon:
            client = self.client(WebSocket, daemon, "?rate=20")
            self.assertEqual(client.next(), {"type": "waiting", "subject": ""})
            client.send(1, b"anything")  # clients need not send; what they send is ignored
            client.send(9, b"ping")
            player = self.play(daemon, "ada")
            self.assertEqual(client.next()["subject"], "ada")
            first = client.next()
            for _ in range(10):
                line = client.next()
            self.assertGreater(line["sequence"] - first["sequence"], 10 * RATE / 20 * 0.7, "frames are skipped")
            player.terminate()
            while line["type"] != "gone":
                line = client.next()
            self.assertEqual(line, {"type": "gone", "subject": "ada"})
            client.send(8, struct.pack(">H", 1000))
            self.assertEqual(client.next(), 1000)

    def test_silence_is_filled(self):
        with Daemon("--no-render", "--http", 0) as daemon:
            for kind in (Lines, WebSocket):
                with self.subTest(kind.__name__):
                    client = self.client(kind, daemon, "?alive=0.1&subject=" + kind.__name__)
                    self.assertEqual([client.next_of_all() for _ in range(4)],
                                     [{"type": "waiting", "subject": kind.__name__}, ALIVE, ALIVE, ALIVE])
                    self.play(daemon, kind.__name__)
                    self.assertEqual(client.next()["type"], "names")

    def test_errors(self):
        with Daemon("--no-render", "--http", 0) as daemon:
            self.play(daemon, "ada")
            furrow("watch", daemon.tcp, "--wait", "--frames", 1, check=0)
            line = self.client(Lines, daemon, "?pattern=xyz").next()
            self.assertEqual((line["type"], line["subject"]), ("error", ""))
            self.assertIn("matches no weight", line["message"])
            for query, field in (("?rate=x", "rate"), ("?alive=0", "alive"), ("?nonsense=1", "nonsense")):
                reply = self.client(Lines, daemon, query)
                self.assertEqual(reply.reply.status, 400)
                self.assertEqual(json.loads(reply.reply.read())["error"]["field"], field)
            connection = http.client.HTTPConnection("127.0.0.1", daemon.ports["http"], timeout=GUARD)
            self.addCleanup(connection.close)
            for method, path, headers, status in (("POST", "/weights", {}, 405), ("HEAD", "/weights", {}, 200),
                                                  ("GET", "/weights", {"Origin": "http://evil.example"}, 403)):
                connection.request(method, path, headers=headers)
                reply = connection.getresponse()
                self.assertEqual(reply.status, status, (method, path))
                reply.read()

    def test_watch_prints_the_shortest_numbers(self):
        with Daemon("--no-render", "--http", 0) as daemon:
            self.play(daemon, "ada")
            watcher = spawn("watch", daemon.tcp, "--subject", "ada", "--wait", "--format", "jsonl", "--frames", 200)
            code, out, _ = finish(watcher)
            self.assertEqual(code, 0)
            numbers = set()
            for line in out.decode().splitlines():
                row = json.loads(line)
                self.assertEqual(list(row), ["frame", "time", "weights"])
                numbers.update(re.findall(r":([\d.e-]+)", line.split('"weights"')[1]))
            self.assertGreater(len(numbers), 100)
            for text in numbers:
                self.assertLessEqual(len(text.split("e")[0].replace("0.", "").strip("0")), 10, text)
                digits = len(re.sub(r"e.*|\D", "", text).lstrip("0"))
                if digits > 1:  # one digit fewer is another float
                    shorter = float(f"{float(text):.{digits - 2}e}")
                    self.assertNotEqual(as_float(shorter), as_float(float(text)), text)


if __name__ == "__main__":
    unittest.main()
