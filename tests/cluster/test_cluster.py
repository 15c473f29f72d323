#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Three daemons share subjects through NATS: placement, redirects, and what happens when a part of it fails."""
import contextlib
import http.client
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import urllib.request

from cluster_testing import NATS, NatsServer, Node, Performer, Viewer, Wire
from furrow_testing import GUARD, SOURCE, finish, furrow, reorderings, repetitions, spawn, wait_until

JS = os.environ.get("FURROW_JS", "")  # the npm packages, built
NODE = shutil.which("node") or shutil.which("nodejs") if pathlib.Path(JS, "furrow", "dist", "node.js").is_file() else None

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


class CredentialsTest(unittest.TestCase):
    """A server that refuses the credentials is named as such, and asked again."""

    def setUp(self):
        self.nats = NatsServer((SOURCE / "deploy/nats/nats-server.conf").read_text())
        self.addCleanup(self.nats.close)
        credentials = self.enterContext(tempfile.NamedTemporaryFile("w"))
        credentials.write("furrow:another\n")
        credentials.flush()
        self.options = "--cluster", self.nats.url, "--cluster-credentials", credentials.name

    def test_refused_credentials_are_named_and_tried_again(self):
        with Node("a", *self.options) as node:
            node.wait_for_fault("refuses the credentials")
            self.nats.kill()
            file = pathlib.Path(self.nats.folder.name, "nats.conf")
            file.write_text(file.read_text().replace("change-me", "another"))
            self.nats.start()
            wait_until(node.is_ready, "the node is ready")

    def test_a_server_that_comes_later_may_refuse_them_too(self):
        self.nats.kill()
        with Node("a", *self.options) as node:
            node.wait_for_fault("cannot be reached")
            self.nats.start()
            node.wait_for_fault("refuses the credentials")


class SecuredTest(unittest.TestCase):
    """Nodes that let nobody in without a token trust each other by their keys."""

    def test_a_drain_needs_the_role_operate_and_moves_the_subjects(self):
        nats = NatsServer()
        self.addCleanup(nats.close)
        with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
            keys = pathlib.Path(folder, "keys")
            furrow("token", "key", "new", "--key", keys, check=0)
            tokens = {role: pathlib.Path(folder, role) for role in ("publish", "watch", "operate")}
            for role, file in tokens.items():
                furrow("token", "new", "--role", role, "--key", keys, "--out", file, check=0)
            a, b = (stack.enter_context(Node(name, "--cluster", nats.url, "--security", "required", "--keys", keys))
                    for name in "ab")
            for node in (a, b):
                wait_until(node.is_ready, "the node is ready")
            performer = Performer(a.udp, "ada", "--token", tokens["publish"])
            self.addCleanup(performer.close)
            viewer = Viewer(a.udp, "ada", "--token", tokens["watch"])
            self.addCleanup(viewer.close)
            viewer.wait_for(20)
            code, _, errors = finish(spawn("drain", a.udp, "--token", tokens["watch"]))
            self.assertEqual(code, 1)
            self.assertIn("not permitted to drain the daemon: a token with the role operate for all subjects is needed; "
                          "the token allows watch", errors)
            code, output, errors = finish(spawn("drain", "--wait", a.udp, "--token", tokens["operate"]))
            self.assertEqual((code, output, errors), (0, b"drained: 1 subject moved\n", ""))
            self.assertEqual(a.process.wait(timeout=GUARD), 0)
            viewer.wait_for(60)
            self.assertEqual((reorderings(viewer.frames), repetitions(viewer.frames)), (0, 0))


class ClusterTest(unittest.TestCase):
    def setUp(self):
        self.nats = NatsServer()
        self.addCleanup(self.nats.close)
        self.nodes = {name: self.add_node(name) for name in "abc"}
        for node in self.nodes.values():
            wait_until(node.is_ready, f"node {node.name} is ready")

    def add_node(self, name, *args, ports=None, store=None):
        stack = contextlib.ExitStack()
        node = stack.enter_context(Node(name, "--cluster", store or self.nats.url, *args, ports=ports))
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

    def ask(self, node, target):
        """The status of a request, and its header fields; follows nothing."""
        connection = http.client.HTTPConnection("127.0.0.1", node.ports["http"], timeout=GUARD)
        self.addCleanup(connection.close)
        connection.request("GET", target)
        reply = connection.getresponse()
        return reply.status, reply.headers

    def test_the_web_sends_its_clients_to_the_right_node(self):
        a, b, _ = self.nodes.values()
        self.perform(a)
        self.watch(a).wait_for(5)
        self.holder()
        web = f"http://127.0.0.1:{a.ports['http']}"
        self.assertEqual(b.get("/api/place?subject=ada")[1]["web"], web)
        self.assertEqual({node["web"] for node in b.get("/api/cluster")[1]["nodes"]},
                         {f"http://127.0.0.1:{node.ports['http']}" for node in self.nodes.values()})
        for path in ("/mjpeg?subject=ada&width=320", "/snapshot.png?subject=ada", "/weights?subject=ada&pattern=brow_l.%2A"):
            status, headers = self.ask(b, path)
            self.assertEqual((status, headers["Location"]), (307, web + path))
        # A client that follows gets the weights of the other node.
        with urllib.request.urlopen(f"http://127.0.0.1:{b.ports['http']}/weights?subject=ada", timeout=GUARD) as lines:
            self.assertEqual(lines.url, f"{web}/weights?subject=ada")
            names, weights = json.loads(lines.readline()), json.loads(lines.readline())
        self.assertEqual((names["type"], weights["type"], weights["subject"]), ("names", "weights", "ada"))
        # No node serves it: the node that was asked answers.
        self.assertEqual(self.ask(b, "/snapshot.png?subject=nobody")[0], 503)

    @unittest.skipIf(NODE is None, "Node is missing")
    def test_a_web_socket_follows_its_subject(self):
        a, b, _ = self.nodes.values()
        self.perform(a)
        self.watch(a).wait_for(5)
        self.holder()
        client = subprocess.Popen([NODE, pathlib.Path(__file__).with_name("follow.mjs"), JS, f"127.0.0.1:{b.ports['http']}"],
                                  stdout=subprocess.PIPE, text=True)
        self.addCleanup(client.stdout.close)
        self.addCleanup(client.wait)
        self.addCleanup(client.kill)
        lines = []
        reader = threading.Thread(target=lambda: lines.extend(iter(client.stdout.readline, "")), daemon=True)
        reader.start()
        wait_until(lambda: len(lines) >= 20, "the client gets weights")
        # The subject moves, and the client goes along.
        self.drain(self.nodes.pop("a"))
        before = len(lines)
        wait_until(lambda: len(lines) >= before + 60, "the client gets more weights")
        sequences = [int(line) for line in lines]
        self.assertEqual(sequences, sorted(set(sequences)))

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

    def test_a_node_that_alone_loses_its_way_to_nats_goes_on(self):
        wire = Wire(self.nats.port)
        self.addCleanup(wire.close)
        self.nodes["d"] = d = self.add_node("d", store=wire.url)
        wait_until(d.is_ready, "node d is ready")
        self.perform(d)
        viewer = self.watch(d)
        viewer.wait_for(20)
        self.assertEqual(self.holder()[0], "d")
        wire.cut()
        wait_until(lambda: not d.is_ready(), "the node says that nothing is placed")
        # Far beyond the time of a lease. The node's calls to NATS wait in vain.
        viewer.wait_for(240)
        wire.mend()
        wait_until(d.is_ready, "the node places subjects again")
        self.assertEqual(self.holder()[0], "d")
        viewer.wait_for(60)
        self.assertEqual(reorderings(viewer.frames), 0)

    def drain(self, node, *args):
        """Drains the node and waits for its end. Returns what the command printed."""
        code, output, errors = finish(spawn("drain", "--wait", *args, node.udp if "--udp" in args else node.tcp))
        self.assertEqual((code, errors), (0, ""), output)
        self.assertEqual(node.process.wait(timeout=GUARD), 0)
        return output.decode()

    def test_nodes_are_replaced_one_after_the_other_under_load(self):
        subjects = {"ada": "a", "bob": "a", "cyd": "b"}
        for subject, name in subjects.items():
            self.perform(self.nodes[name], subject)
        viewers = {subject: self.watch(self.nodes["c"], subject) for subject in subjects}
        for viewer in viewers.values():
            viewer.wait_for(20)
        # The neutral pose and a captured pose move along.
        for pose in ("neutral", "smile"):
            status, reply = self.nodes["a"].get("/api/capture", {"subject": "ada", "pose": pose})
            self.assertEqual(status, 200, reply)
        _, epoch = self.holder()
        moved = {}
        for name, args in (("a", ["--udp"]), ("b", []), ("c", ["60"])):
            old = self.nodes.pop(name)
            held = [s for s in subjects if old.holder(s)[0] == name]
            output = self.drain(old, *args)
            moved[name] = len(held)
            self.assertIn(f"drained: {len(held)} subject", output)
            for viewer in viewers.values():
                viewer.wait_for(20)
            self.nodes[name] = self.add_node(name, ports=old.ports)
            for node in self.nodes.values():
                wait_until(node.is_ready, f"node {node.name} is ready")
        self.assertEqual(moved["a"], 2)
        for subject, viewer in viewers.items():
            self.assertEqual((reorderings(viewer.frames), repetitions(viewer.frames)), (0, 0), subject)
        name, next_epoch = self.holder()
        self.assertGreater(next_epoch, epoch)
        self.assertTrue(self.reference_poses(self.nodes[name]) >= {"smile"})
        listed = self.nodes[name].get("/api/subjects")[1]["subjects"]
        self.assertTrue(next(each for each in listed if each["name"] == "ada")["neutral"])
        log = [line for node in self.nodes.values() for line in node.log]
        self.assertFalse([line for line in log if b"cannot take over" in line])

    @staticmethod
    def reference_poses(node):
        status, rig = node.get("/api/rig.json")
        return {pose["name"] for pose in rig["reference_poses"]} if status == 200 else set()

    def test_what_cannot_move_is_named(self):
        only = self.nodes["a"]
        self.perform(only)
        self.watch(only).wait_for(5)
        for name in "bc":
            self.nodes.pop(name).signal(signal.SIGKILL)
        wait_until(lambda: len(only.get("/api/cluster")[1]["nodes"]) == 1, "the others are gone")
        code, _, errors = finish(spawn("drain", "--wait", "1", only.tcp))
        self.assertEqual(code, 1)
        self.assertIn("timed out; 1 subject did not move: 'ada' (no other node has room)", errors)
        # It goes on until there is room.
        self.watch(only).wait_for(5)
        self.add_node("d")
        self.assertEqual(only.process.wait(timeout=GUARD), 0)

    def test_sigterm_moves_the_subjects(self):
        a = self.nodes.pop("a")
        self.perform(a)
        viewer = self.watch(self.nodes["b"])
        viewer.wait_for(20)
        a.signal(signal.SIGTERM)
        self.assertEqual(a.process.wait(timeout=GUARD), 0)
        viewer.wait_for(60)
        self.assertIn(self.holder()[0], "bc")
        self.assertEqual((reorderings(viewer.frames), repetitions(viewer.frames)), (0, 0))

    def test_two_daemons_of_one_name_are_noticed(self):
        rival = self.add_node("a")
        message = "another daemon of the cluster has the name 'a'"
        wait_until(lambda: message in str(rival.get("/readyz")), "the second one says what is wrong")


if __name__ == "__main__":
    unittest.main()
