#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Attacks a real daemon over loopback and prints what its other users notice.

    attacks.py BIN RECORDING [--only WORD] [--seconds S]

Prints one row per attack: what the victim notices without and with the attack, and how much the daemon's memory grows. Attacker and
victim share the machine, and mostly the address 127.0.0.1, so the victim competes with the attacker's programs, too. BIN: the folder with
furrow and furrowd, of a release build. RECORDING: a clip for `furrow load`.
"""
import argparse
import contextlib
import http.client
import json
import multiprocessing
import pathlib
import resource
import signal
import socket
import ssl
import statistics
import struct
import subprocess
import sys
import tempfile
import time

from attackers import (DEADLINE, VECTORS, Offers, api_flood, attackers, captures, forged_mocap, framed, leave_no_disk, leave_no_memory,
                       long_patterns, offers, rival, snapshots, stalled_handshakes, strangers, subscribe_weights, table_of, tracker,
                       udp_socket, unsubscribes, vector)
from victims import Daemon, Table, weights_gap_ms

HEAVY = "occlusion.samples=64&subsurface.method=burley&subsurface.samples=64&shadow.taps=32"
API_PATHS = ["/api/status", "/api/subjects", "/api/rig", "/api/rig.json", "/metrics"]


def waiting_tcp(table, options):
    with Daemon(options.bin, "--no-render") as daemon:
        held = []
        memory = daemon.mebibytes()
        for _ in range(300):
            one = socket.create_connection(("127.0.0.1", daemon.ports["tcp"]))
            one.sendall(framed(vector("subscribe_weights_all")))
            held.append(one)
        time.sleep(0.5)
        begun = time.monotonic()
        newcomer = socket.create_connection(("127.0.0.1", daemon.ports["tcp"]))
        newcomer.settimeout(DEADLINE)
        newcomer.sendall(framed(vector("ping")))
        answer = newcomer.recv(4096)
        outcome = "refused" if answer[40:44] == (VECTORS / "error.bin").read_bytes()[36:40] else "served"
        table.row("300 waiting subscriptions", "a newcomer over TCP", "served",
                  f"{outcome} after {1000 * (time.monotonic() - begun):.0f} ms", daemon.mebibytes() - memory)


def waiting_web(table, options):
    with Daemon(options.bin, "--no-render") as daemon:
        plain = daemon.get("/api/status")
        memory = daemon.mebibytes()
        held = []
        for _ in range(160):
            one = socket.create_connection(("127.0.0.1", daemon.ports["http"]))
            one.sendall(b"GET /weights?subject=nobody HTTP/1.1\r\nHost: localhost\r\n\r\n")
            held.append(one)
        time.sleep(0.5)
        status, seconds = daemon.get("/api/status")
        table.row("160 waiting /weights", "a newcomer over HTTP", f"{plain[0]}, {1000 * plain[1]:.0f} ms",
                  f"{status}, {1000 * seconds:.0f} ms", daemon.mebibytes() - memory)


def requests(table, options):
    with Daemon(options.bin, "--no-render", "--play", options.recording) as daemon:
        http_port, tcp = daemon.ports["http"], daemon.ports["tcp"]
        table.weights("API, 8 connections without pause", daemon, *[(api_flood, http_port, API_PATHS)] * 8)
        table.weights("/readyz, 8 connections without pause", daemon, *[(api_flood, http_port, ["/readyz"])] * 8)
        table.weights("19,000/s Unsubscribes of nothing", daemon, (unsubscribes, tcp, 19_000))
        table.weights("1,000/s patterns of 4 kB", daemon, (long_patterns, tcp, 1_000))
        table.weights("captures, 2 connections without pause", daemon, (captures, http_port, 1), (captures, http_port, 2))


def forged(table, options):
    with Daemon(options.bin, "--no-render") as daemon:
        for name, per_second, messages in (("5,000/s Hello that prove nothing", 5_000, ["hello"]),
                                           ("10,000/s Ping of strangers", 10_000, ["ping"]),
                                           ("5,000/s forged offers, Unsubscribes, Goodbyes and poses far ahead", 5_000,
                                            ["skeleton_offer", "unsubscribe", "goodbye", "pose"])):
            counts = multiprocessing.Array("q", 2)
            table.weights(name, daemon, (strangers, daemon.ports["udp"], per_second, counts, messages))
            table.row("the same", "bytes out per byte in", "", f"{counts[1] / max(1, counts[0]):.2f}")


def departed(table, options):
    """A viewer has gone, and somebody sends pings in its name: what does the daemon send to its address?"""
    with Daemon(options.bin, "--no-render", "--play", options.recording) as daemon:
        viewer = udp_socket(daemon.ports["udp"])
        viewer.settimeout(DEADLINE)
        viewer.send(vector("hello"))
        hello = vector("hello_token")
        known = struct.pack("<Q", int(json.loads((VECTORS / "hello_token.json").read_text())["message"]["token"], 16))
        viewer.send(hello.replace(known, struct.pack("<Q", table_of(viewer.recv(2048)).scalar(1, "Q"))))
        viewer.recv(2048)
        viewer.send(subscribe_weights("*", 2))
        begun = last_weights = time.monotonic()
        received = sent = 0
        while time.monotonic() - begun < 12:
            sent += viewer.send(vector("ping"))
            due = time.monotonic() + 0.05
            while (left := due - time.monotonic()) > 0:
                viewer.settimeout(left)
                with contextlib.suppress(TimeoutError):
                    message = viewer.recv(1 << 16)
                    received += len(message)
                    if message[36:40] == b"FWGT":
                        last_weights = time.monotonic()
        table.row("20/s pings for a viewer that has gone, 12 s", "bytes to its address; weights end after", "",
                  f"{received / 1024:.0f} KiB; {last_weights - begun:.1f} s; {sent / 1024:.0f} KiB in")


def skeletons(table, options):
    with Daemon(options.bin, "--no-render") as daemon:
        template = Offers()

        def newcomer(name):
            """The time until a publisher of another host, with a skeleton of its own, is answered."""
            offer = framed(template.make(name, b"new" + name[:4]))
            with socket.create_connection(("127.0.0.1", daemon.ports["tcp"])) as connection:
                connection.settimeout(0.1)
                begun, answer = time.monotonic(), b""
                while b"FSKR" not in answer and time.monotonic() - begun < DEADLINE:
                    connection.sendall(offer)
                    with contextlib.suppress(TimeoutError):
                        answer += connection.recv(4096)
            took = time.monotonic() - begun
            # The status of a SkeletonReply: 0, accepted, is left out of the table (STANDARD.md section 5).
            message = answer[4:]
            return f"{1000 * took:.0f} ms" if message[36:40] == b"FSKR" and table_of(message).scalar(1, "B") == 0 else "refused or never"

        for per_second in (100, 1_100):
            name = b"n%04d" % per_second
            before, memory = newcomer(name[::-1]), daemon.mebibytes()
            with attackers((offers, daemon.ports["tcp"], per_second)):
                time.sleep(options.seconds)
                after = newcomer(name)
                table.row(f"{per_second:,}/s offers of new skeletons and subjects", "a newcomer with another skeleton", before, after,
                          daemon.mebibytes() - memory)


def mocap(table, options):
    with Daemon(options.bin, "--no-render", "--rig", "arkit", "--vmc", "0") as daemon, attackers((tracker, daemon.ports["vmc"], 60)):
        before = weights_gap_ms(daemon.ports["http"], "vmc", options.seconds)
        for per_second in (1, 1_000):
            with attackers((forged_mocap, daemon.ports["vmc"], per_second)):
                during = weights_gap_ms(daemon.ports["http"], "vmc", options.seconds)
            table.row(f"{per_second:,}/s forged frames of another host for the VMC port", "longest time without weights at 60 Hz",
                      f"{before:.0f} ms", f"{during:.0f} ms")


def takeover(table, options):
    with Daemon(options.bin, "--no-render") as daemon:
        table.weights("another sender offers the same 20 subjects", daemon, (rival, options.bin, daemon.ports["udp"], options.recording))


def hold(port, request):
    """A connection that sends and never reads."""
    one = socket.socket()
    one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    one.connect(("127.0.0.1", port))
    one.sendall(request)
    return one


def growth(daemon, memory, seconds):
    """The most mebibytes above `memory` within this time."""
    most, end = 0, time.monotonic() + seconds
    while time.monotonic() < end:
        time.sleep(0.5)
        most = max(most, daemon.mebibytes() - memory)
    return most


def unread(table, options):
    with Daemon(options.bin, "--play", options.recording) as daemon:
        request = b"GET /mjpeg?width=1536&height=1536&quality=100 HTTP/1.1\r\nHost: localhost\r\n\r\n"
        with hold(daemon.ports["http"], request) as first:  # what one viewer needs anyway
            first.recv(1 << 20)
            time.sleep(options.seconds)
        memory = daemon.mebibytes()
        held = [hold(daemon.ports["http"], request) for _ in range(8)]
        table.row("8 viewers of 1536 x 1536 who never read", "", "", "", growth(daemon, memory, 2 * options.seconds))
        del held


def unread_weights(table, options):
    clients = 130  # as many as may have 60 subscriptions each
    with Daemon(options.bin, "--no-render", "--play", options.recording) as daemon:
        before, longest_before, _ = daemon.weights_ms(options.recording, options.seconds)
        memory = daemon.mebibytes()
        requests_of_one = b"".join(framed(subscribe_weights("*", i, every=True)) for i in range(60))
        held = [hold(daemon.ports["tcp"], requests_of_one) for _ in range(clients)]
        most = growth(daemon, memory, 6 * options.seconds)
        during, longest, lost = daemon.weights_ms(options.recording, options.seconds)
        alive = sum(is_open(one) for one in held)
        table.row(f"{clients} clients with 60 subscriptions to every frame who never read ({alive} stay connected)", "weights, p50 (longest)",
                  f"{before:.2f} ms ({longest_before:.0f} ms)", f"{during:.2f} ms ({longest:.0f} ms), {100 * lost:.1f}% lost", most)


def is_open(one):
    """The peer has not closed the connection, whose input nobody reads."""
    info = one.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, 1)
    return info[0] == 1  # TCP_ESTABLISHED


def handshakes(table, options):
    with tempfile.TemporaryDirectory() as folder:
        certificate, key = f"{folder}/tls.crt", f"{folder}/tls.key"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2", "-subj",
                        "/CN=localhost", "-keyout", key, "-out", certificate], check=True, capture_output=True)
        with Daemon(options.bin, "--no-render", "--tls-certificate", certificate, "--tls-key", key) as daemon:
            context = ssl.create_default_context(cafile=certificate)
            context.check_hostname = False

            def newcomer():
                begun = time.monotonic()
                try:
                    with context.wrap_socket(socket.create_connection(("127.0.0.1", daemon.ports["tcp"]), DEADLINE, ("127.0.0.2", 0))):
                        return f"{1000 * (time.monotonic() - begun):.0f} ms"
                except OSError as error:
                    return f"refused ({error})"

            before, memory = newcomer(), daemon.mebibytes()
            with attackers((stalled_handshakes, daemon.ports["tcp"]), (stalled_handshakes, daemon.ports["http"])):
                time.sleep(options.seconds)
                table.row("handshakes of TLS that never end", "a newcomer of another address over TLS", before, newcomer(),
                          daemon.mebibytes() - memory)


def viewer_seconds(daemon, seconds):
    """The time of small snapshots, one after the other."""
    times, failed, end = [], 0, time.monotonic() + seconds
    while time.monotonic() < end:
        status, took = daemon.get("/snapshot.png?width=160&height=160")
        times.append(took)
        failed += status != 200
    return statistics.median(times), max(times), failed


def pictures(table, options):
    with Daemon(options.bin, "--play", options.recording) as daemon:
        for _ in range(5):  # until the shaders are ready
            daemon.get("/snapshot.png?width=160&height=160")
            daemon.get(f"/snapshot.png?width=160&height=160&{HEAVY}")
        for name, heavy, leaves in (("8 viewers of 2048 x 2048 in distinct sizes", "", False),
                                    ("the same, with the dearest settings", HEAVY, False),
                                    ("the same, who leave before they are served", HEAVY, True)):
            before = viewer_seconds(daemon, options.seconds)
            memory = daemon.mebibytes()
            with attackers(*[(snapshots, daemon.ports["http"], number, heavy, leaves) for number in range(8)]):
                during = viewer_seconds(daemon, 3 * options.seconds)
                growth = daemon.mebibytes() - memory
            table.row(name, "a snapshot of 160 x 160, p50 (longest, failed)",
                      f"{before[0]:.2f} s ({before[1]:.2f} s, {before[2]})",
                      f"{during[0]:.2f} s ({during[1]:.2f} s, {during[2]})", growth)
        table.weights("8 viewers of 2048 x 2048, the dearest settings", daemon,
                      *[(snapshots, daemon.ports["http"], number, HEAVY, False) for number in range(8)])


def variants(table, options):
    with Daemon(options.bin, "--play", options.recording) as daemon:
        daemon.get(f"/snapshot.png?width=64&height=64&{HEAVY}")
        memory = daemon.mebibytes()
        for i in range(100):
            daemon.get(f"/snapshot.png?width=64&height=64&occlusion.samples={4 + i % 60}&shadow.taps={1 + i % 32}")
        table.row("100 variants of the shaders", "", "", "", daemon.mebibytes() - memory)


def scarce_memory(table, options):
    with Daemon(options.bin, "--no-render") as daemon:
        table.weights("no more memory, and the API on 8 connections without pause", daemon, (leave_no_memory, daemon.process.pid),
                      *[(api_flood, daemon.ports["http"], API_PATHS)] * 8)
        resource.prlimit(daemon.process.pid, resource.RLIMIT_DATA, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        time.sleep(2)
        table.row("the same", "chunks of the reserve that were used", "0", daemon.metric("furrow_memory_reserve_used_total"))


def full_disk(table, options):
    with tempfile.TemporaryDirectory() as folder:
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256m", "none", folder], capture_output=True, check=False).returncode != 0:
            print("full_disk: only a user who may mount can measure it", file=sys.stderr)
            return
        try:
            with Daemon(options.bin, "--no-render", "--record", folder) as daemon:
                table.weights("a full disk under the recording", daemon, (leave_no_disk, folder))
                before = daemon.get("/readyz")[0]
                (pathlib.Path(folder) / "ballast").unlink()
                begun = time.monotonic()
                while daemon.get("/readyz")[0] != 200 and time.monotonic() - begun < DEADLINE:
                    daemon.weights_ms(options.recording, 1)
                table.row("the same, with room again", "/readyz", before, f"{daemon.get('/readyz')[0]} after {time.monotonic() - begun:.1f} s")
        finally:
            subprocess.run(["umount", folder], check=True)


def sigterm(table, options):
    with Daemon(options.bin, "--play", options.recording) as daemon:
        daemon.get("/snapshot.png?width=160&height=160")
        with attackers(*[(snapshots, daemon.ports["http"], number, HEAVY, False) for number in range(4)]):
            begun = time.monotonic()
            daemon.process.send_signal(signal.SIGTERM)
            daemon.process.wait(timeout=60)
            table.row("SIGTERM while 2048 x 2048 is drawn", "time until the daemon has ended", "",
                      f"{time.monotonic() - begun:.2f} s (drain_seconds is 2)")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("recording")
    parser.add_argument("--only", default="", help="run the groups with this word in their name")
    parser.add_argument("--seconds", type=float, default=5.0, help="of each measurement")
    options = parser.parse_args()
    table = Table(options)
    for group in (waiting_tcp, waiting_web, requests, forged, departed, skeletons, mocap, takeover, handshakes, unread, unread_weights,
                  pictures, variants, scarce_memory, full_disk, sigterm):
        if options.only in group.__name__:
            group(table, options)


if __name__ == "__main__":
    main()
