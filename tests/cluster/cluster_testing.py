# SPDX-License-Identifier: Apache-2.0
"""Shared by the tests and the measurement of clusters: a NATS server, nodes, a performer and a viewer."""
import contextlib
import json
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
import threading
import time
import urllib.error
import urllib.request

from furrow_testing import GUARD, SHARE, Daemon, free_port, spawn, wait_until

PERFORMANCE = SHARE / "recordings" / "performance.bvh"
NATS = shutil.which("nats-server") or shutil.which("nats-server", path="/usr/sbin")


class NatsServer:
    """A NATS server that keeps its data in memory: a restart empties it."""

    def __init__(self, config=None):
        """`config`: the text of a configuration, for a server with rules of its own."""
        self.port = free_port()
        self.folder = tempfile.TemporaryDirectory()
        self.args = ["-js", "-sd", self.folder.name]
        if config:
            file = pathlib.Path(self.folder.name, "nats.conf")
            file.write_text(config.replace("127.0.0.1:4222", f"127.0.0.1:{self.port}")
                            .replace("/var/lib/nats", self.folder.name))
            self.args = ["-c", str(file)]
        self.process = None
        self.start()

    def start(self):
        """Returns when the server accepts connections."""
        log = pathlib.Path(self.folder.name, "nats.log")
        self.process = subprocess.Popen([NATS, "-a", "127.0.0.1", "-p", str(self.port), "-l", log, *self.args])
        wait_until(lambda: self.process.poll() is not None or self._accepts(), "the NATS server accepts connections")
        assert self.process.poll() is None, log.read_text()

    def _accepts(self):
        with contextlib.suppress(ConnectionRefusedError):
            socket.create_connection(("127.0.0.1", self.port)).close()
            return True

    def kill(self):
        self.process.kill()
        self.process.wait(timeout=GUARD)

    def close(self):
        self.kill()
        self.folder.cleanup()

    @property
    def url(self):
        return f"nats://127.0.0.1:{self.port}"


class Wire:
    """A cable to a port of this computer, which can be cut: connections stay, and nothing arrives."""

    def __init__(self, port):
        self.far = port
        self.whole = threading.Event()
        self.whole.set()
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    @property
    def url(self):
        return f"nats://127.0.0.1:{self.port}"

    def cut(self):
        self.whole.clear()

    def mend(self):
        self.whole.set()

    def close(self):
        self.mend()
        with contextlib.suppress(OSError):
            self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()

    def _accept(self):
        with contextlib.suppress(OSError):
            while True:
                near, _ = self.listener.accept()
                threading.Thread(target=self._join, args=(near,), daemon=True).start()

    def _join(self, near):
        self.whole.wait()
        try:
            far = socket.create_connection(("127.0.0.1", self.far))
        except OSError:
            near.close()
            return
        for end in (near, far):
            end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # a cable holds nothing back
        for one, other in ((near, far), (far, near)):
            threading.Thread(target=self._pass, args=(one, other), daemon=True).start()

    def _pass(self, source, target):
        with contextlib.suppress(OSError):
            while data := source.recv(65536):
                self.whole.wait()
                target.sendall(data)
        for end in (source, target):
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()


class Node(Daemon):
    """One daemon of a cluster."""

    def __init__(self, name, *args, ports=None):
        """`ports`: those of an earlier daemon, which the clients know."""
        super().__init__("--no-render", "--http", "0", "--name", name, *args, ports=ports)
        self.name = name

    def __enter__(self):
        super().__enter__()
        # Nobody reads the log while it runs, and a pipe is small.
        self.log = []
        self.reader = threading.Thread(target=lambda: self.log.extend(self.process.stderr), daemon=True)
        self.reader.start()
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.process.send_signal(signal.SIGTERM)
        self.process.wait(timeout=GUARD)
        self.reader.join(timeout=GUARD)
        self.process.stdout.close()
        self.process.stderr.close()

    def get(self, path, body=None):
        """The status and the JSON of a request; `body`: of a POST."""
        url = f"http://127.0.0.1:{self.ports['http']}{path}"
        data = None if body is None else json.dumps(body).encode()
        headers = {} if body is None else {"Content-Type": "application/json"}
        try:
            with urllib.request.urlopen(urllib.request.Request(url, data, headers), timeout=10) as reply:
                return reply.status, json.load(reply)
        except urllib.error.HTTPError as error:
            with error:
                return error.code, json.load(error)

    def is_ready(self):
        return self.get("/readyz")[0] == 200

    def wait_for_fault(self, words):
        """Waits until /readyz names a fault in these words."""
        answer = None

        def says():
            nonlocal answer
            answer = json.dumps(self.get("/readyz")[1])
            return words in answer

        try:
            wait_until(says, words)
        except AssertionError:
            raise AssertionError(f"expected '{words}' from /readyz, which says {answer}; the log: {self.log}") from None

    def holder(self, subject):
        """The node that serves the subject, as this node knows it, and its epoch; nothing if none does."""
        status, place = self.get(f"/api/place?subject={subject}")
        return (place["node"], place["epoch"]) if status == 200 and place["served"] else None

    def signal(self, number):
        self.process.send_signal(number)


class Program:
    """A `furrow` that runs until it is closed. Threads read what it prints."""

    def __init__(self, process, on_output, on_errors):
        self.process = process
        self.threads = [threading.Thread(target=read, args=(stream,), daemon=True)
                        for read, stream in ((on_output, process.stdout), (on_errors, process.stderr))]
        for thread in self.threads:
            thread.start()

    def close(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=GUARD)
        for thread in self.threads:
            thread.join(timeout=GUARD)
        self.process.stdout.close()
        self.process.stderr.close()


class Viewer(Program):
    """`furrow watch`: the numbers of the frames, and when they arrived."""

    def __init__(self, address, subject, *args):
        self.frames = []  # (time, number)
        self.errors = []
        super().__init__(spawn("watch", address, "--udp", "--subject", subject, "--wait", "--pattern", "brow_l.*",
                               "--format", "csv", *args), self.read, self.errors.extend)

    def read(self, lines):
        for line in lines:
            number = line.split(b",", 1)[0]
            if number.isdigit():
                self.frames.append((time.monotonic(), int(number)))

    def wait_for(self, count):
        """Waits for `count` more frames."""
        before = len(self.frames)
        wait_until(lambda: len(self.frames) >= before + count, f"{count} more frames: {self.errors[-3:]}")


class Performer(Program):
    """`furrow play`, for ever."""

    def __init__(self, address, subject, *args):
        self.lines = []  # nobody reads them; the pipes stay empty
        super().__init__(spawn("play", PERFORMANCE, "--to", address, "--udp", "--subject", subject, "--loop", *args),
                         self.lines.extend, self.lines.extend)
