#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Three daemons share subjects through NATS: placement, redirects, and what happens when a part of it fails."""
import contextlib
import signal
import sys
import tempfile
import unittest

from cluster_testing import NATS, NatsServer, Node, Performer, Viewer, reorderings, wait_until
from furrow_testing import SOURCE, finish, spawn

if NATS is None:
    print("skipped: nats-server is not installed")
    sys.exit(77)


class SampleTest(unittest.TestCase):
    """The user of the sample configuration may do what a node needs."""

    def test_the_rights_of_the_sample_are_enough(self):
        nats = NatsServer((SOURCE / "deploy/nats/nats-server.conf").read_text())
        self.addCleanup(nats.close)
        with tempfile.NamedTemporaryFile("w") as credentials:
            credentials.write("furrow:change-me\n")
            credentials.flush()
            with Node("a", "--cluster", nats.url, "--cluster-credentials", credentials.name) as node:
                wait_until(node.is_ready, "the node is ready")
                performer, viewer = Performer(node.udp, "ada"), Viewer(node.udp, "ada")
                self.addCleanup(performer.close)
                self.addCleanup(viewer.close)
                viewer.wait_for(90)
                self.assertEqual(node.holder("ada")[0], "a")


class ClusterTest(unittest.TestCase):
    def setUp(self):
        self.nats = NatsServer()
        self.addCleanup(self.nats.close)
        self.nodes = {name: self.add_node(name) for name in "abc"}
        for node in self.nodes.values():
            wait_until(node.is_ready, f"node {node.name} is ready")

    def add_node(self, name, *args):
        stack = contextlib.ExitStack()
        node = stack.enter_context(Node(name, "--cluster", self.nats.url, *args))
        self.addCleanup(stack.close)
        return node

    def perform(self, node, subject="ada"):
        performer = Performer(node.udp, subject)
        self.addCleanup(performer.close)
        return performer

    def watch(self, node, subject="ada", *args):
        viewer = Viewer(node.udp, subject, *args)
        self.addCleanup(viewer.close)
        return viewer

    def holder(self, *asked):
        """The holder on which all of these nodes agree, and its epoch."""
        def agreed():
            found = {self.nodes[name].holder("ada") for name in asked or self.nodes}
            return found.pop() if len(found) == 1 else None
        return wait_until(agreed, "all nodes know the holder")

    def test_a_subject_is_placed_and_its_viewers_are_sent_there(self):
        a, b, c = self.nodes.values()
        self.perform(a)
        self.watch(a).wait_for(5)
        self.assertEqual(self.holder()[0], "a")
        status, place = c.get("/api/place?subject=ada")
        self.assertEqual(status, 200)
        self.assertEqual((place["host"], place["tcp"], place["udp"], place["http"], place["token"]),
                         ("127.0.0.1", a.ports["tcp"], a.ports["udp"], a.ports["http"], None))
        # A viewer at the wrong node, one that came before the subject, and one that stays there.
        self.watch(b).wait_for(5)
        early = self.watch(c, "bob")
        self.perform(a, "bob")
        early.wait_for(5)
        code, _, errors = finish(spawn("watch", b.tcp, "--subject", "ada", "--once"))
        self.assertEqual(code, 1)
        self.assertIn("'ada' is served by the node 'a' at 127.0.0.1", errors)
        # A second performer of the subject is sent to its node, where the first one has it.
        code, _, errors = finish(spawn("play", "performance", "--to", b.udp, "--subject", "ada"))
        self.assertEqual(code, 1)
        self.assertIn("another sender is sending 'ada'", errors)
        status, cluster = b.get("/api/cluster")
        self.assertEqual(status, 200)
        self.assertEqual([node["node"] for node in cluster["nodes"]], ["b", "a", "c"])
        self.assertEqual({s["name"]: s["node"] for s in cluster["subjects"]}, {"ada": "a", "bob": "a"})

    def test_a_full_node_sends_performers_away(self):
        full = self.add_node("full", "--config", self.config("[limits]\nmax_subjects = 1\n"))
        self.nodes = {"full": full, **self.nodes}
        wait_until(full.is_ready, "node full is ready")
        self.perform(full, "one")
        self.watch(full, "one").wait_for(3)
        self.perform(full)
        self.watch(full).wait_for(3)
        self.assertIn(self.holder()[0], "abc")

    def config(self, text):
        file = tempfile.NamedTemporaryFile("w", suffix=".toml")
        self.addCleanup(file.close)
        file.write(text)
        file.flush()
        return file.name

    def test_another_node_goes_on_after_kill_9(self):
        self.perform(self.nodes["a"])
        viewer = self.watch(self.nodes["b"])
        viewer.wait_for(20)
        _, epoch = self.holder()
        self.nodes["a"].signal(signal.SIGKILL)
        viewer.wait_for(60)
        name, next_epoch = self.holder("b", "c")
        self.assertIn(name, "bc")
        self.assertGreater(next_epoch, epoch)
        self.assertEqual(reorderings(viewer.frames), 0)

    def test_a_node_that_was_frozen_sends_nothing_more(self):
        a = self.nodes["a"]
        self.perform(a)
        viewer = self.watch(self.nodes["b"])
        viewer.wait_for(20)
        # Stays at the node whatever that says.
        beside = self.watch(a, "ada", "--once")
        beside.wait_for(5)
        _, epoch = self.holder()
        a.signal(signal.SIGSTOP)
        name, next_epoch = wait_until(
            lambda: next((found for found in [self.nodes["b"].holder("ada")] if found and found[0] != "a"), None),
            "another node serves the subject")
        self.assertGreater(next_epoch, epoch)
        viewer.wait_for(20)
        # The poses that wait in the sockets of the frozen node are older than all that follows.
        before = len(beside.frames)
        a.signal(signal.SIGCONT)
        wait_until(lambda: a.is_ready() and a.holder("ada") == (name, next_epoch), "node a runs again")
        viewer.wait_for(60)
        self.assertEqual(len(beside.frames), before, "the node sent frames without a lease")
        self.assertEqual(reorderings(viewer.frames), 0)

    def test_sessions_go_on_without_nats_and_survive_an_emptied_store(self):
        a, b, c = self.nodes.values()
        self.perform(a)
        viewer = self.watch(b)
        viewer.wait_for(20)
        _, epoch = self.holder()
        self.nats.kill()
        for node in self.nodes.values():
            wait_until(lambda: not node.is_ready(), "the node says that nothing is placed")
        status, why = a.get("/readyz")
        self.assertEqual(status, 503)
        self.assertEqual(why["error"]["message"], "the store of the cluster cannot be reached: sessions go on, "
                                                  "and nothing new is placed")
        # Far beyond the time of a lease: 240 frames at 60 per second.
        viewer.wait_for(240)
        code, _, errors = finish(spawn("play", "performance", "--to", b.udp, "--subject", "new"))
        self.assertNotEqual(code, 0)
        self.assertIn("'new' has no place in the cluster: the store of the cluster cannot be reached", errors)
        self.nats.start()
        for node in self.nodes.values():
            wait_until(node.is_ready, "the node places subjects again")
        name, next_epoch = self.holder()
        self.assertEqual(name, "a")
        self.assertGreaterEqual(next_epoch, epoch)
        viewer.wait_for(60)
        self.assertEqual(reorderings(viewer.frames), 0)

    def test_two_daemons_of_one_name_are_noticed(self):
        rival = self.add_node("a")
        message = "another daemon of the cluster has the name 'a'"
        wait_until(lambda: message in str(rival.get("/readyz")), "the second one says what is wrong")


if __name__ == "__main__":
    unittest.main()
