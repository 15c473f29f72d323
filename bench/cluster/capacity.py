#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs three daemons as a cluster, each with its share of the performers, and prints what `furrow plan` predicts beside
what they use (bench/cluster.sh --capacity)."""
import contextlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from cluster_testing import NATS, NatsServer, Node, PERFORMANCE
from furrow_testing import furrow, solve, spawn, wait_until
from processes import cpu_seconds, resident_kib

SECONDS = 15
SETTLE = 3  # before and after what is measured
HERTZ = 60
JOINTS = 81  # of the recording
ETHERNET = 24  # preamble, checksum and gap of a packet, which the loopback does not count


def traffic():
    """Bits that have passed this network so far."""
    (line,) = [line for line in pathlib.Path("/proc/net/dev").read_text().splitlines() if line.strip().startswith("lo:")]
    size, packets = line.split(":")[1].split()[:2]
    return 8 * (int(size) + ETHERNET * int(packets))


def streaming(node):
    """How many subjects the node serves."""
    return len(node.get("/api/subjects")[1]["subjects"])


def run(performers, subscribers):
    """What the daemons and the network use while a cluster of three serves the performers."""
    with contextlib.ExitStack() as stack:
        nats = NatsServer()
        stack.callback(nats.close)
        nodes = [stack.enter_context(Node(name, "--cluster", nats.url)) for name in "abc"]
        for node in nodes:
            wait_until(node.is_ready, "the nodes are ready")
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        loads = [spawn("load", node.udp, PERFORMANCE, "--first", 1000 * i, "--subjects", performers // 3, "--rate", HERTZ,
                       "--subscribers", subscribers, "--quantise", "--duration", SECONDS + 2 * SETTLE,
                       "--json", folder / f"{i}.json") for i, node in enumerate(nodes)]
        for node in nodes:
            wait_until(lambda node=node: streaming(node) == performers // 3, "the performers stream")
        time.sleep(SETTLE)
        pids = [node.process.pid for node in nodes]
        begun, before = time.monotonic(), (list(map(cpu_seconds, [*pids, nats.process.pid])), traffic())
        time.sleep(SECONDS)
        after, passed = (list(map(cpu_seconds, [*pids, nats.process.pid])), traffic()), time.monotonic() - begun
        memory = sum(map(resident_kib, pids)) / 1024 / 3
        for load in loads:
            out, errors = load.communicate(timeout=120)
            assert load.returncode == 0, errors.decode() + out.decode()
        lost = sum(json.loads((folder / f"{i}.json").read_text())["run"]["lost"] for i in range(3))
    cores = [(b - a) / passed for a, b in zip(before[0], after[0])]
    return {"cores": sum(cores[:3]), "each": cores[:3], "nats": cores[3], "bits": (after[1] - before[1]) / passed,
            "memory": memory, "lost": lost}


def plan(performers, subscribers, weights):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "plan.json")
        furrow("plan", "--performers", performers, "--joints", JOINTS, "--hz", HERTZ, "--subscribers", subscribers,
               "--weights", weights, "--json", file, check=0)
        return json.loads(file.read_text())


def main():
    if NATS is None:
        print("bench/cluster.sh: nats-server is not installed", file=sys.stderr)
        return 1
    if os.environ.get("FURROW_OWN_NETWORK") is None:
        # Nobody else's traffic on the loopback.
        environment = {**os.environ, "FURROW_OWN_NETWORK": "1"}
        command = ["unshare", "--net", "sh", "-c", 'ip link set lo up && exec "$@"', "sh", sys.executable, "-B", *sys.argv]
        return subprocess.run(command, env=environment, check=False).returncode
    weights = len(solve(PERFORMANCE, "--rig", "default").names)
    print("| Performers | Subscribers | Busy cores: plan | measured, of each daemon | Traffic: plan | measured | "
          "Memory of a daemon: plan | measured | Busy cores of NATS | Weights lost |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for performers, subscribers in ((30, 1), (30, 3), (90, 1), (90, 3)):
        wanted, used = plan(performers, subscribers, weights), run(performers, subscribers)
        bits = wanted["bits_in_per_second"] + wanted["bits_out_per_second"]
        memory = wanted["memory_bytes"] / 2**20
        print(f"| {performers} | {subscribers} | {wanted['busy_cores']:.2f} | {used['cores']:.2f} ("
              f"{', '.join(f'{each:.2f}' for each in used['each'])}) | {bits / 1e6:.1f} Mbit/s | "
              f"{used['bits'] / 1e6:.1f} Mbit/s | {memory:.0f} MiB | {used['memory']:.0f} MiB | {used['nats']:.3f} | "
              f"{used['lost']} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
