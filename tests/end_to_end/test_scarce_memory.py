#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The system gives the daemon no more memory. That costs requests, not the daemon."""
import http.client
import json
import re
import resource
import threading
import time
import unittest

from furrow_testing import BIN, GUARD, SHARE, Daemon, spawn

PERFORMANCE = SHARE / "recordings" / "performance.bvh"
PATHS = ["/api/rig", "/api/subjects", "/api/status", "/api/rig.json", "/metrics"]
SANITIZED = "san" in BIN.parent.name


def get(port, path):
    """Returns the status and the body; status 0: no answer."""
    web = http.client.HTTPConnection("127.0.0.1", port, timeout=GUARD)
    try:
        web.request("GET", path)
        answer = web.getresponse()
        return answer.status, answer.read().decode()
    except (OSError, http.client.HTTPException):
        return 0, ""
    finally:
        web.close()


def figure(port, name):
    """A number of /metrics; None: no answer."""
    found = re.search(rf"^{name} (\d+)$", get(port, "/metrics")[1], re.M)
    return int(found[1]) if found else None


def sequence(port):
    """Of the newest pose."""
    return json.loads(get(port, "/api/subjects")[1])["subjects"][0]["sequence"]


@unittest.skipIf(SANITIZED, "sanitizers need address space")
class ScarceMemoryTest(unittest.TestCase):
    def flood(self, daemon):
        """Asks on 8 connections until the daemon has used its reserve or refuses for lack of memory."""
        port = daemon.ports["http"]
        short = threading.Event()

        def ask():
            while not short.is_set():
                # 429: the host asks too often.
                if any(get(port, path)[0] not in (200, 429) for path in PATHS):
                    short.set()

        threads = [threading.Thread(target=ask, daemon=True) for _ in range(8)]
        for thread in threads:
            thread.start()
        deadline = time.monotonic() + GUARD
        try:
            while not short.is_set():
                self.assertIsNone(daemon.process.poll(), "the daemon has ended")
                self.assertLess(time.monotonic(), deadline, "the daemon had enough memory")
                if figure(port, "furrow_memory_reserve_used_total"):
                    short.set()
        finally:
            short.set()
            for thread in threads:
                thread.join(timeout=GUARD)

    def test_lack_of_memory_costs_requests_and_not_the_daemon(self):
        with Daemon("--no-render", "--http", "0", "--play", PERFORMANCE) as daemon:
            port, pid = daemon.ports["http"], daemon.process.pid
            watcher = spawn("watch", daemon.udp, "--subject", "performance", "--udp", "--format", "csv")
            self.addCleanup(watcher.communicate)
            self.addCleanup(watcher.kill)
            watcher.stdout.readline()
            with open(f"/proc/{pid}/status", encoding="utf-8") as status:
                data = 1024 * int(re.search(r"VmData:\s+(\d+) kB", status.read())[1])
            limits = resource.prlimit(pid, resource.RLIMIT_DATA, (data, resource.RLIM_INFINITY))
            self.flood(daemon)
            self.assertIsNone(daemon.process.poll(), "the daemon has ended")
            resource.prlimit(pid, resource.RLIMIT_DATA, limits)

            deadline = time.monotonic() + GUARD
            # The metric is that of the last second.
            while any(get(port, path)[0] != 200 for path in PATHS) or not figure(port, "furrow_memory_reserve_used_total"):
                self.assertLess(time.monotonic(), deadline, "the daemon does not recover, or has used no reserve")
            newest = sequence(port)
            for line in watcher.stdout:  # older rows may wait in the pipe
                frame = line.decode().split(",", 1)[0]
                if frame.isdigit() and int(frame) > newest:
                    break


if __name__ == "__main__":
    unittest.main()
