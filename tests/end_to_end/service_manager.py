# SPDX-License-Identifier: Apache-2.0
"""A small service manager, as systemd is one for furrowd: it hears how the daemon is, keeps descriptors while the daemon
restarts, and passes them to the next one (sd_notify(3), sd_listen_fds(3))."""
import array
import fcntl
import os
import pathlib
import re
import signal
import socket
import tempfile
import threading
import time

from furrow_testing import BIN, GUARD

FIRST_PASSED = 3  # SD_LISTEN_FDS_START
OUT_OF_THE_WAY = 1000  # descriptors from here on do not get into the way of the passed ones


class ServiceManager:
    """Runs furrowd in a with-block, one process after another."""

    def __init__(self, *args, store=1024):
        """`store`: the most descriptors that it keeps."""
        self.store = store
        self.answers = True  # False: like a manager that hangs while the daemon ends
        self.args = [str(arg) for arg in args]
        self.kept = []  # (name, descriptor)
        self.ports = {}
        self.ready_at = None  # time.monotonic()
        self.logs = []  # of the daemons that have ended
        self.process = None

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind(str(self.root / "notify"))
        self.changed = threading.Condition()
        self.ready = False
        self.closed = False
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()
        self.start()
        return self

    def __exit__(self, *_):
        if self.process is not None:
            self.stop()
        self.closed = True
        self.socket.shutdown(socket.SHUT_RDWR)
        self.reader.join(timeout=GUARD)
        self.socket.close()
        self.drop_kept()
        self.folder.cleanup()

    def start(self, *more):
        """Starts a daemon and waits until it serves. `more`: arguments of this one alone."""
        log = self.root / f"log-{len(self.logs)}"
        with self.changed:
            self.ready = False
            passed = self.kept[::-1]  # systemd states no order either
        args = self.args + [str(arg) for arg in more]
        if self.ports:  # clients know them
            args += ["--tcp", str(self.ports["tcp"]), "--udp", str(self.ports["udp"])]
        else:
            args += ["--tcp", "0", "--udp", "0"]
        env = {**os.environ, "NOTIFY_SOCKET": str(self.root / "notify"), "FDSTORE": str(self.store)}
        actions = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0),
                   (os.POSIX_SPAWN_OPEN, 2, str(log), os.O_WRONLY | os.O_CREAT, 0o600)]
        for i, (_, descriptor) in enumerate(passed):
            actions.append((os.POSIX_SPAWN_DUP2, descriptor, FIRST_PASSED + i))
        if passed:
            env["LISTEN_FDS"] = str(len(passed))
            env["LISTEN_FDNAMES"] = ":".join(name for name, _ in passed)
        # The daemon checks that the descriptors are for its own process.
        command = ["/bin/sh", "-c", 'LISTEN_PID=$$ exec "$0" "$@"', str(BIN / "furrowd"), *args]
        self.process = os.posix_spawn(command[0], command, env, file_actions=actions)
        self.log = log
        deadline = time.monotonic() + GUARD
        with self.changed:
            while not self.ready:
                self.changed.wait(timeout=1)
                ended, _ = os.waitpid(self.process, os.WNOHANG)
                if ended or time.monotonic() > deadline:
                    self.process = None if ended else self.process
                    raise AssertionError(f"the daemon does not serve: {log.read_text()[-2000:]}")

    def end(self, number=signal.SIGTERM):
        """Sends a signal and waits until the process has ended. Returns its exit code."""
        os.kill(self.process, number)
        _, status = os.waitpid(self.process, 0)
        self.process = None
        self.logs.append(self.log.read_text())
        return os.waitstatus_to_exitcode(status)

    def stop(self):
        """Like `systemctl stop`: nothing is kept."""
        code = self.end()
        assert code == 0, (code, self.logs[-1][-2000:])
        self.drop_kept()

    def restart(self, *more):
        """Like `systemctl restart`."""
        code = self.end()
        assert code == 0, (code, self.logs[-1][-2000:])
        self.start(*more)

    def drop_kept(self):
        with self.changed:
            for _, descriptor in self.kept:
                os.close(descriptor)
            self.kept.clear()

    def kept_named(self, name):
        return [descriptor for kept, descriptor in self.kept if kept == name]

    def text(self):
        """The log of the present daemon."""
        return self.log.read_text()

    def wait_for_log(self, text):
        """Waits until the log of the present daemon contains `text`."""
        deadline = time.monotonic() + GUARD
        while text not in self.text():
            assert time.monotonic() < deadline, f"no '{text}' in the log: {self.text()[-2000:]}"
            time.sleep(0.01)

    @property
    def tcp(self):
        return f"127.0.0.1:{self.ports['tcp']}"

    @property
    def udp(self):
        return f"127.0.0.1:{self.ports['udp']}"

    def _read(self):
        size = array.array("i").itemsize
        while True:
            data, control, _, _ = self.socket.recvmsg(4096, socket.CMSG_SPACE(253 * size))
            if self.closed:
                return
            descriptors = array.array("i")
            for level, kind, content in control:
                if level == socket.SOL_SOCKET and kind == socket.SCM_RIGHTS:
                    descriptors.frombytes(content[:len(content) - len(content) % size])
            with self.changed:
                self._hear(dict(line.split("=", 1) for line in data.decode().splitlines() if "=" in line), descriptors)
                self.changed.notify_all()

    def _hear(self, words, descriptors):
        name = words.get("FDNAME", "stored")
        if words.get("FDSTORE") == "1":
            for descriptor in descriptors[:max(self.store - len(self.kept), 0)]:
                self.kept.append((name, fcntl.fcntl(descriptor, fcntl.F_DUPFD_CLOEXEC, OUT_OF_THE_WAY)))
        if words.get("FDSTOREREMOVE") == "1":
            for descriptor in self.kept_named(name):
                os.close(descriptor)
            self.kept = [(kept, descriptor) for kept, descriptor in self.kept if kept != name]
        if words.get("BARRIER") == "1" and not self.answers:
            return  # the sender waits until its descriptor is closed
        for descriptor in descriptors:
            os.close(descriptor)
        if words.get("READY") == "1":
            self.ports = {key: int(port) for key, port in re.findall(r"(\w+)=[^ ]*?:(\d+)", words["STATUS"])}
            self.ready_at = time.monotonic()
            self.ready = True


SIZE_SEALS = fcntl.F_SEAL_SHRINK | fcntl.F_SEAL_GROW | fcntl.F_SEAL_SEAL


def damage(manager, how):
    """Replaces the state that a daemon has left by one of another version, a part of it, or one with a wrong bit."""
    (kept,) = manager.kept_named("kept-state")
    content = bytearray(os.pread(kept, os.fstat(kept).st_size, 0))
    if how == "version":
        content[8] += 1  # after the magic
    elif how == "part":
        del content[len(content) // 2:]
    else:
        content[-20] ^= 4
    file = os.memfd_create("state", os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
    os.pwrite(file, content, 0)
    fcntl.fcntl(file, fcntl.F_ADD_SEALS, SIZE_SEALS)
    os.dup2(file, kept, inheritable=False)
    os.close(file)
