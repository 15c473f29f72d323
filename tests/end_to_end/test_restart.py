#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A daemon restarts under a service manager while a stream runs: its clients notice nothing, and where it cannot go on
with their sessions, they come back."""
import signal
import threading
import time
import unittest
import urllib.error
import urllib.request

from furrow_testing import GUARD, SHARE, furrow, make_certificate
from service_manager import ServiceManager, damage
from test_reconnect import LOST, Output
from token_testing import TokenTest

PERFORMANCE = SHARE / "recordings" / "performance.bvh"


class Rows:
    """The rows that `furrow watch --format csv` prints, with the times of their arrival."""

    def __init__(self, stream):
        self.stream = stream
        self.rows = []  # (frame, weights)
        self.times = []
        self.changed = threading.Condition()
        self.thread = threading.Thread(target=self._read, daemon=True)
        self.thread.start()

    def _read(self):
        for line in self.stream:
            now = time.monotonic()
            frame, _, weights = line.decode().split(",", 2)
            if frame != "frame":
                with self.changed:
                    self.rows.append((int(frame), weights))
                    self.times.append(now)
                    self.changed.notify_all()

    def wait(self, count):
        """Waits for `count` more rows than there are."""
        with self.changed:
            goal = len(self.rows) + count
            assert self.changed.wait_for(lambda: len(self.rows) >= goal, timeout=GUARD), "no more rows came"

    def frames(self):
        return [frame for frame, _ in self.rows]

    def largest_gap(self):
        """The longest time without a row, in seconds."""
        return max(b - a for a, b in zip(self.times, self.times[1:]))


class RestartTest(TokenTest):
    def ways(self):
        """Each way to connect: its name, options of the daemon, the address by a manager, and options of a client by
        its role."""
        yield "UDP", (), lambda manager: manager.udp, lambda _: ("--udp",)
        yield "UDP with three shards", ("--threads", "3"), lambda manager: manager.udp, lambda _: ("--udp",)
        yield ("UDP with a token and three shards", ("--threads", "3", *self.strict), lambda manager: manager.udp,
               lambda role: ("--token", self.token(role)))
        yield "UDP with a token", self.strict, lambda manager: manager.udp, lambda role: ("--token", self.token(role))
        yield "TCP", (), lambda manager: manager.tcp, lambda _: ("--tcp",)
        yield ("TCP with a token", self.strict, lambda manager: manager.tcp,
               lambda role: ("--tcp", "--token", self.token(role)))

    def connect(self, address, options, *play):
        """A watcher that waits and a player that begins. Returns both, the rows, and what the watcher reports."""
        watcher = self.start("watch", address, "--subject", "ada", "--wait", "--format", "csv", *options("watch"))
        notes = Output(watcher.stderr)
        notes.wait_for(lambda text: "waiting" in text)
        rows = Rows(watcher.stdout)
        player = self.start("play", PERFORMANCE, "--to", address, "--subject", "ada", *play, *options("publish"))
        return watcher, player, rows, notes

    def test_nothing_is_lost_and_weights_stay_the_same(self):
        for name, more, address, options in self.ways():
            with self.subTest(name):
                tables = []
                for restarts in (0, 3):
                    with ServiceManager("--no-render", "--http", "0", *more) as manager:
                        # The speed does not change the weights: the capture times are those of the recording.
                        speed = 0.5 if restarts else 2
                        _, player, rows, notes = self.connect(address(manager), options, "--speed", speed)
                        for _ in range(restarts):
                            rows.wait(20)
                            manager.restart()
                            self.assertIn("handed 2 peers and 1 subject over to the next daemon", manager.logs[-1])
                            manager.wait_for_log("resumed 2 peers and 1 subject of the former daemon")
                        self.assertEqual(player.wait(timeout=GUARD), 0)
                        notes.wait_for(lambda text: "left" in text)
                        self.assertNotIn(LOST, notes.text)
                        self.assertNotIn("no connection", player.stderr.read().decode())
                        rows.thread.join(timeout=GUARD)
                        tables.append(rows)
                frames = tables[1].frames()
                self.assertEqual(frames, sorted(set(frames)), "none comes twice or in the wrong order")
                # Over TCP, the newest of many frames that wait replaces older ones.
                one, other = dict(tables[0].rows), dict(tables[1].rows)
                common = one.keys() & other.keys()
                self.assertGreater(len(common), 50)
                self.assertEqual({frame: other[frame] for frame in common}, {frame: one[frame] for frame in common})
                if address(manager) == manager.udp:
                    self.assertEqual(one.keys(), other.keys(), "nothing is lost")
                print(f"{name}: {len(other)} and {len(one)} frames, at most {tables[1].largest_gap() * 1e3:.0f} ms without "
                      f"one, {tables[0].largest_gap() * 1e3:.0f} ms without restarts")

    def test_a_state_that_cannot_be_used_is_refused_and_clients_come_back(self):
        reasons = {"version": "have version 2.1, and this daemon reads 1.1", "part": "are damaged", "bit": "are damaged"}
        for name, more, address, options in self.ways():
            with ServiceManager("--no-render", "--http", "0", *more) as manager:
                watcher, player, rows, _ = self.connect(address(manager), options, "--loop")
                rows.wait(5)
                for how, reason in reasons.items():
                    with self.subTest(name, how=how):
                        self.assertEqual(manager.end(), 0)
                        damage(manager, how)
                        manager.start()
                        manager.wait_for_log(f"clients must connect again: the sessions of the former daemon {reason}")
                        self.assertNotIn("resumed", manager.text())
                        rows.wait(20)
                for process in (watcher, player):
                    process.send_signal(signal.SIGINT)
                    self.assertEqual(process.wait(timeout=GUARD), 0)

    def test_a_daemon_that_is_killed_leaves_nothing(self):
        with ServiceManager("--no-render", "--http", "0") as manager:
            _, _, rows, _ = self.connect(manager.udp, lambda _: ("--udp",), "--loop")
            rows.wait(5)
            manager.restart()
            rows.wait(5)
            self.assertEqual(manager.kept, [], "the daemon has taken everything")
            self.assertEqual(manager.end(signal.SIGKILL), -signal.SIGKILL)
            self.assertEqual(manager.kept, [])
            manager.start()
            self.assertNotIn("former daemon", manager.text())
            rows.wait(20)

    def restart_without_a_trace(self, store):
        """A stream goes on after a restart although the daemon leaves nothing in the store. Returns the log of the end."""
        with ServiceManager("--no-render", "--http", "0", store=store) as manager:
            _, _, rows, notes = self.connect(manager.udp, lambda _: ("--udp",), "--loop")
            rows.wait(5)
            self.assertEqual(manager.end(), 0)
            log = manager.logs[-1]
            self.assertEqual(manager.kept, [])
            notes.wait_for(lambda text: LOST in text)
            manager.start()
            rows.wait(20)
        return log

    def test_without_a_store_nothing_is_left(self):
        self.restart_without_a_trace(store=0)

    def test_a_store_without_room_gets_nothing(self):
        self.assertIn("clients must connect again: the service manager keeps too few descriptors",
                      self.restart_without_a_trace(store=3))

    def test_a_manager_that_does_not_answer_gets_nothing(self):
        for name, address, options in (("UDP", lambda manager: manager.udp, ("--udp",)),
                                       ("TCP", lambda manager: manager.tcp, ("--tcp",))):
            with self.subTest(name), ServiceManager("--no-render", "--http", "0") as manager:
                _, _, rows, notes = self.connect(address(manager), lambda _: options, "--loop")
                rows.wait(5)
                manager.answers = False
                self.assertEqual(manager.end(), 0)
                self.assertIn("clients must connect again: the service manager does not keep the sessions", manager.logs[-1])
                self.assertEqual(manager.kept, [], "the daemon has asked to forget everything")
                notes.wait_for(lambda text: LOST in text)  # by a goodbye
                manager.answers = True
                manager.start()
                self.assertNotIn("former daemon", manager.text())
                rows.wait(20)

    def test_clients_beyond_the_store_come_back(self):
        # The state, three listening sockets, and one of two connections.
        with ServiceManager("--no-render", "--http", "0", store=5) as manager:
            _, _, rows, _ = self.connect(manager.tcp, lambda _: ("--tcp",), "--loop")
            rows.wait(5)
            self.assertEqual(manager.end(), 0)
            self.assertIn("handed 1 peer and 1 subject over to the next daemon", manager.logs[-1])
            self.assertEqual(sorted(name for name, _ in manager.kept),
                             ["kept-connection", "kept-http", "kept-state", "kept-tcp", "kept-udp"])
            manager.start()
            manager.wait_for_log("resumed 1 peer and 1 subject of the former daemon")
            rows.wait(20)

    def test_a_token_may_be_valid_for_a_lifetime(self):
        lifetime = "36524d"
        furrow("token", "key", "new", "--key", self.keys, "--for", "36525d", check=0)
        with ServiceManager("--no-render", "--http", "0", *self.strict) as manager:
            _, _, rows, _ = self.connect(manager.tcp, lambda role: ("--tcp", "--token", self.token(role, time=lifetime)),
                                         "--loop")
            rows.wait(5)
            manager.restart()
            manager.wait_for_log("resumed 2 peers and 1 subject of the former daemon")
            rows.wait(20)

    def test_clients_come_back_where_the_configuration_has_changed(self):
        for name, address, options, change in (
                ("shards", lambda manager: manager.udp, ("--udp",), ("--threads", "2")),
                ("security", lambda manager: manager.tcp, ("--tcp", "--token", self.token("publish,watch")),
                 ("--security", "required"))):
            with self.subTest(name), ServiceManager("--no-render", "--http", "0", "--keys", self.keys) as manager:
                _, _, rows, _ = self.connect(address(manager), lambda _: options, "--loop")
                rows.wait(5)
                manager.restart(*change)
                rows.wait(20)

    def test_pictures_come_back_when_the_renderer_has_started(self):
        with ServiceManager("--http", "0") as manager:
            folder = self.root / "pictures"
            _, _, rows, _ = self.connect(manager.udp, lambda _: ("--udp",), "--loop")
            self.start("frames", manager.tcp, "--subject", "ada", "--wait", "--out", folder, "--size", "64x64", "--rate", 5)

            def wait_for_more(than):
                deadline = time.monotonic() + GUARD
                while len(set(folder.glob("*.jpg")) - than) < 2:
                    self.assertLess(time.monotonic(), deadline, "no more pictures came")
                    time.sleep(0.05)

            wait_for_more(set())
            manager.restart()
            manager.wait_for_log("resumed 2 peers and 1 subject of the former daemon")
            rows.wait(5)  # whether or not the renderer has started
            wait_for_more(set(folder.glob("*.jpg")))
            with urllib.request.urlopen(f"http://127.0.0.1:{manager.ports['http']}/readyz", timeout=GUARD) as ready:
                self.assertEqual(ready.status, 200)

    def test_weights_do_not_wait_for_pictures_where_the_sessions_are_refused(self):
        with ServiceManager("--http", "0") as manager:
            _, _, rows, _ = self.connect(manager.udp, lambda _: ("--udp",), "--loop")
            rows.wait(5)
            self.assertEqual(manager.end(), 0)
            damage(manager, "version")
            manager.start()
            rows.wait(20)  # whether or not the renderer has started
            with urllib.request.urlopen(f"http://127.0.0.1:{manager.ports['http']}/readyz", timeout=GUARD) as ready:
                self.assertEqual(ready.status, 200)

    def test_a_renderer_that_fails_after_a_restart_costs_pictures_alone(self):
        with ServiceManager("--http", "0") as manager:
            _, _, rows, _ = self.connect(manager.udp, lambda _: ("--udp",), "--loop")
            rows.wait(5)
            manager.restart("--render-device", "none-of-this-name")
            manager.wait_for_log("cannot render pictures")
            with self.assertRaises(urllib.error.HTTPError) as ready:
                urllib.request.urlopen(f"http://127.0.0.1:{manager.ports['http']}/readyz", timeout=GUARD)
            with ready.exception as reply:
                self.assertEqual(reply.code, 503)
                self.assertIn("no renderer could start: pictures are off, weights go on", reply.read().decode())
            rows.wait(20)

    def test_clients_with_tls_connect_again_and_their_subject_goes_on(self):
        crt, key = make_certificate(self.root)
        with ServiceManager("--no-render", "--http", "0", "--tls-certificate", crt, "--tls-key", key) as manager:
            _, _, rows, notes = self.connect(manager.tcp, lambda _: ("--tcp", "--tls-authority", crt), "--loop")
            rows.wait(20)
            manager.restart()
            manager.wait_for_log("resumed 0 peers and 1 subject of the former daemon")
            rows.wait(20)
            notes.wait_for(lambda text: "connected again" in text)
            print(f"TCP with TLS: at most {rows.largest_gap() * 1e3:.0f} ms without a frame")


if __name__ == "__main__":
    unittest.main()
