#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The system gives the daemon no more memory. That costs requests, not the daemon."""
import http.client
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


@unittest.skipIf(SANITIZED, "sanitizers need address space")
class ScarceMemoryTest(unittest.TestCase):
    def test_lack_of_memory_costs_requests_and_not_the_daemon(self):
        with Daemon("--no-render", "--http", "0", "--play", PERFORMANCE) as daemon:
            port, pid = daemon.ports["http"], daemon.process.pid
            self.assertEqual(get(port, "/readyz")[0], 200)
            watcher = spawn("watch", daemon.udp, "--subject", "performance", "--udp", "--format", "csv")
            watcher.stdout.readline()
            with open(f"/proc/{pid}/status", encoding="utf-8") as status:
                size = 1024 * int(re.search(r"VmData:\s+(\d+) kB", status.read())[1])
            unlimited = resource.prlimit(pid, resource.RLIMIT_DATA, (size, resource.RLIM_INFINITY))

            asked = threading.Event()
            statuses = [[] for _ in range(8)]

            def flood(mine):
                while not asked.is_set():
                    mine.extend(get(port, path)[0] for path in PATHS if not asked.is_set())

            threads = [threading.Thread(target=flood, args=(mine,)) for mine in statuses]
            for thread in threads:
                thread.start()
            deadline = time.monotonic() + GUARD
            used = None
            while not used or min(map(len, statuses)) < 3 * len(PATHS):
                used = figure(port, "furrow_memory_reserve_used_total") or used
                self.assertIsNone(daemon.process.poll(), "the daemon has ended")
                self.assertLess(time.monotonic(), deadline, f"the reserve was not used: {statuses}")
            asked.set()
            for thread in threads:
                thread.join()

            resource.prlimit(pid, resource.RLIMIT_DATA, unlimited)
            for _ in range(100):  # weights go on: the first rows waited in the pipe
                self.assertTrue(watcher.stdout.readline())
            for path in PATHS:
                self.assertEqual(get(port, path)[0], 200, path)
            watcher.kill()
            watcher.communicate()


if __name__ == "__main__":
    unittest.main()
