#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes parts of a cluster fail and measures what a viewer notices (bench/cluster.sh)."""
import contextlib
import math
import signal
import sys
import threading
import time

from cluster_testing import NATS, NatsServer, Node, Performer, Viewer, Wire
from furrow_testing import finish, missing, reorderings, repetitions, spawn, wait_until

BEFORE = 60  # frames before each failure: a second
AFTER = 120
FROZEN = 5.0  # seconds
CUT = 5.0


class Claims:
    """Asks every node again and again which epochs it serves itself, and counts epochs of two nodes."""

    def __init__(self, nodes):
        self.nodes = nodes
        self.owners = {}
        self.split = 0
        self.stop = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.stop.wait(0.1):
            for node in list(self.nodes.values()):
                with contextlib.suppress(OSError, ValueError):
                    for served in node.get("/api/cluster")[1]["subjects"]:
                        if served["node"] == node.name:
                            owner = self.owners.setdefault((served["name"], served["epoch"]), node.name)
                            self.split += owner != node.name

    def close(self):
        self.stop.set()
        self.thread.join()


def outage(frames, since):
    """The longest time without a frame from shortly before `since` on, in ms. Infinite: there is none."""
    times = [at for at, _ in frames if at >= since - 0.5]
    return max((b - a for a, b in zip(times, times[1:])), default=math.inf) * 1000


def percentile(values, part):
    values = sorted(values)
    return values[min(len(values) - 1, math.ceil(part * len(values)) - 1)]


class Stage:
    """The cluster, and a performer and a viewer of each subject."""

    def __init__(self, stack, subjects):
        self.stack = stack
        self.nats = NatsServer()
        stack.callback(self.nats.close)
        self.nodes = {}
        self.wires = {name: Wire(self.nats.port) for name in "abc"}  # each node's own way to NATS
        for wire in self.wires.values():
            stack.callback(wire.close)
        for name in "abc":
            self.start(name)
        for node in self.nodes.values():
            wait_until(node.is_ready, "the nodes are ready")
        self.viewers = []
        for number in range(subjects):
            # A connection of its own each: those with several subjects follow nobody.
            subject, address = f"subject-{number}", self.nodes["abc"[number % 3]].udp
            stack.callback(Performer(address, subject).close)
            self.viewers.append(Viewer(address, subject))
            stack.callback(self.viewers[-1].close)
        self.wait_for(1)
        self.claims = Claims(self.nodes)
        stack.callback(self.claims.close)

    def start(self, name, ports=None):
        self.nodes[name] = self.stack.enter_context(Node(name, "--cluster", self.wires[name].url, ports=ports))

    def wait_for(self, count):
        """Waits for `count` more frames of each subject, all at a time."""
        wanted = [len(viewer.frames) + count for viewer in self.viewers]
        for viewer, number in zip(self.viewers, wanted):
            viewer.wait_for(number - len(viewer.frames))

    def holder(self):
        """The node that serves the first subject."""
        def agreed():
            found = {node.holder("subject-0") for node in self.nodes.values()}
            return found.pop() if len(found) == 1 else None
        return self.nodes[wait_until(agreed, "the nodes agree")[0]]

    def kill(self):
        node = self.holder()
        since = time.monotonic()
        node.signal(signal.SIGKILL)
        self.wait_for(AFTER)
        self.start(node.name, node.ports)
        wait_until(self.nodes[node.name].is_ready, "the node is back")
        return since

    def freeze(self):
        node = self.holder()
        since = time.monotonic()
        node.signal(signal.SIGSTOP)
        threading.Event().wait(FROZEN)
        node.signal(signal.SIGCONT)
        self.wait_for(AFTER)
        wait_until(node.is_ready, "the node is back")
        return since

    def empty(self):
        since = time.monotonic()
        self.nats.kill()
        self.wait_for(AFTER)
        self.nats.start()
        for node in self.nodes.values():
            wait_until(node.is_ready, "the nodes are ready again")
        self.wait_for(AFTER)
        return since

    def cut(self):
        """The holder loses its way to NATS alone."""
        node = self.holder()
        since = time.monotonic()
        self.wires[node.name].cut()
        threading.Event().wait(CUT)
        self.wires[node.name].mend()
        self.wait_for(AFTER)
        for each in self.nodes.values():
            wait_until(each.is_ready, "the nodes are ready again")
        return since

    def end(self):
        return self.leave(self.holder(), lambda node: node.signal(signal.SIGTERM))

    def drain(self):
        return self.leave(self.holder(), lambda node: finish(spawn("drain", "--wait", node.tcp)))

    def roll(self):
        """Replaces all nodes, one after the other."""
        since = time.monotonic()
        for node in list(self.nodes.values()):
            self.leave(node, lambda old: finish(spawn("drain", "--wait", old.tcp)))
        return since

    def leave(self, node, end):
        since = time.monotonic()
        end(node)
        node.process.wait()
        self.wait_for(AFTER)
        self.start(node.name, node.ports)
        wait_until(self.nodes[node.name].is_ready, "the node is back")
        return since


def main():
    if NATS is None:
        print("bench/cluster.sh: nats-server is not installed", file=sys.stderr)
        return 1
    rounds, subjects, only = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    print(f"{'failure':<28}{'rounds':>7}{'p50':>9}{'p99':>9}{'max':>9}  twice  disorder  missing  split")
    with contextlib.ExitStack() as stack:
        stage = Stage(stack, subjects)
        for label, fail in (("the holder is killed", stage.kill), ("the holder freezes for 5 s", stage.freeze),
                            ("NATS restarts, emptied", stage.empty),
                            ("its way to NATS is cut, 5 s", stage.cut), ("the holder ends (SIGTERM)", stage.end),
                            ("the holder is drained", stage.drain), ("all are replaced in turn", stage.roll)):
            if only not in label:
                continue
            first, split = [len(viewer.frames) for viewer in stage.viewers], stage.claims.split
            outages = []
            for _ in range(rounds):
                stage.wait_for(BEFORE)
                since = fail()
                # Of the subject that noticed most: the others may be at other nodes.
                outages.append(max(outage(viewer.frames, since) for viewer in stage.viewers))
            found = [viewer.frames[begin:] for viewer, begin in zip(stage.viewers, first)]
            twice, disorder, lost = (sum(map(count, found)) for count in (repetitions, reorderings, missing))
            print(f"{label:<28}{rounds:>7}" + "".join(f"{percentile(outages, p):>6.0f} ms" for p in (0.5, 0.99, 1.0)) +
                  f"{twice:>7}{disorder:>10}{lost:>9}{stage.claims.split - split:>7}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
