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
import random
import re
import signal
import socket
import ssl
import statistics
import struct
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in ("bench/report", "tests/conformance", "tests/end_to_end")]
import flat_table  # pylint: disable=wrong-import-position
from messages import fnv1a  # pylint: disable=wrong-import-position
from processes import resident_kib  # pylint: disable=wrong-import-position
from tracker_packets import vmc  # pylint: disable=wrong-import-position

VECTORS = ROOT / "protocol" / "vectors"
STRANGER = "127.0.0.2"  # another host, for the daemon
DEADLINE = 15.0  # seconds; whatever takes longer counts as an outage
HEAVY = "occlusion.samples=64&subsurface.method=burley&subsurface.samples=64&shadow.taps=32"


def vector(name, sequence=1, session=0x1234567):
    """A message of the wire with another session and sequence (STANDARD.md section 2)."""
    data = bytearray((VECTORS / f"{name}.bin").read_bytes())
    struct.pack_into("<Q", data, 8, session)
    struct.pack_into("<I", data, 16, sequence)
    return bytes(data)


def table_of(message):
    """The FlatBuffers table of a message (STANDARD.md section 3)."""
    return flat_table.Table(message, 32 + struct.unpack_from("<I", message, 32)[0])


class Offers:
    """SkeletonOffers that differ in the name of a joint and in their subject."""

    def __init__(self):
        self.bytes = vector("skeleton_offer")
        known = json.loads((VECTORS / "skeleton_offer.json").read_text())["message"]
        self.joint, self.subject = self.bytes.rindex(b"spine"), self.bytes.rindex(b'nna "1"')
        self.hash = self.bytes.index(struct.pack("<Q", int(known["skeleton_hash"], 16)))
        # What the hash is of (STANDARD.md section 4).
        self.hashed = struct.pack("<H", len(known["joints"]))
        for joint in known["joints"]:
            tail = joint.get("tail", [])
            self.hashed += joint["name"].encode() + b"\0" + struct.pack(
                f"<h10fH{len(tail)}f", joint["parent"], *joint["rest_translation"], *joint["rest_rotation"], *joint["rest_scale"],
                bool(tail), *tail)
        self.hashed += struct.pack("<fH", known["metres_per_unit"], len(known["blend_shape_names"]))
        self.hashed += b"".join(name.encode() + b"\0" for name in known["blend_shape_names"])

    def make(self, joint, subject, stream=1):
        """`joint`: 5 bytes. `subject`: 7 bytes, its end."""
        offer = bytearray(self.bytes)
        struct.pack_into("<H", offer, 6, stream)
        offer[self.joint:self.joint + 5], offer[self.subject:self.subject + 7] = joint, subject
        struct.pack_into("<Q", offer, self.hash, fnv1a(self.hashed.replace(b"spine\0", joint + b"\0")))
        return bytes(offer)


def udp_socket(port, host="127.0.0.1"):
    one = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    one.bind((host, 0))
    one.connect(("127.0.0.1", port))
    return one


def framed(message):
    return struct.pack("<I", len(message)) + message


class Daemon:
    def __init__(self, bin_folder, *arguments):
        self.bin = bin_folder
        self.process = subprocess.Popen([bin_folder / "furrowd", "--tcp", "0", "--udp", "0", "--http", "0", *arguments],
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        ready = self.process.stdout.readline()
        self.ports = {name: int(port) for name, port in re.findall(r"(\w+)=\S*?:(\d+)", ready)}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def mebibytes(self):
        return resident_kib(self.process.pid) / 1024

    def get(self, path, timeout=DEADLINE):
        """Returns the status and the seconds; status 0: no answer."""
        begun = time.monotonic()
        status = 0
        with contextlib.suppress(OSError, http.client.HTTPException):
            web = http.client.HTTPConnection("127.0.0.1", self.ports["http"], timeout=timeout)
            web.request("GET", path)
            answer = web.getresponse()
            answer.read()
            status = answer.status
            web.close()
        return status, time.monotonic() - begun

    def weights_ms(self, recording, seconds):
        """The p50 and the longest latency of weights, in ms, and the part that was lost."""
        with tempfile.NamedTemporaryFile(suffix=".json") as report:
            subprocess.run([self.bin / "furrow", "load", f"127.0.0.1:{self.ports['udp']}", recording, "--subjects", "20",
                            "--rate", "60", "--duration", str(seconds), "--quantise", "--json", report.name],
                           capture_output=True, check=False)
            run = json.loads(pathlib.Path(report.name).read_text())["run"]
        lost = run["lost"] if "lost" in run else run["tally"]["lost"]
        latency = run["latency_us"]
        return latency["p50"] / 1000, latency["max"] / 1000, lost / max(1, run.get("sent", 20 * 60 * seconds))


def weights_gap_ms(port, subject, seconds):
    """The longest time without a new brow of the tracker() over HTTP, in ms."""
    with socket.create_connection(("127.0.0.1", port), DEADLINE) as web:
        web.sendall(f"GET /weights?subject={subject}&pattern=brow_l.* HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        last, longest, end, text, before = time.monotonic(), 0.0, time.monotonic() + seconds, b"", None
        while (now := time.monotonic()) < end:
            web.settimeout(end - now)
            with contextlib.suppress(TimeoutError):
                text += web.recv(1 << 16)
            *lines, text = text.split(b"\n")
            for line in lines:
                values = json.loads(line).get("values", []) if line.startswith(b"{") else []
                # Of the tracker, and not of whoever forges frames: see forged_mocap().
                if 0.0 < max(values, default=0.0) < 0.3 and values != before:
                    now, before = time.monotonic(), values
                    longest, last = max(longest, now - last), now
    return 1000 * max(longest, time.monotonic() - last)


# --- Attackers, each a process of its own ------------------------------------------------------------------


def tcp_flood(port, make, per_second):
    """Sends make(i) over one connection and drops what comes back."""
    with socket.create_connection(("127.0.0.1", port)) as connection:
        connection.setblocking(False)
        begun, sent, waiting = time.monotonic(), 0, b""
        while True:
            due = int((time.monotonic() - begun) * per_second)
            while sent < due and len(waiting) < 1 << 20:
                waiting += framed(make(sent))
                sent += 1
            with contextlib.suppress(BlockingIOError):
                waiting = waiting[connection.send(waiting):]
            with contextlib.suppress(BlockingIOError):
                connection.recv(1 << 16)
            if due <= sent:
                time.sleep(0.001)


def unsubscribes(port, per_second):
    tcp_flood(port, lambda i: vector("unsubscribe", i), per_second)


def long_patterns(port, per_second):
    tcp_flood(port, lambda i: subscribe_weights(",".join(f"?a{i}{k}*z" for k in range(450))[:4000], i), per_second)


def subscribe_weights(pattern, sequence, every=False):
    """A SubscribeWeights message, written by hand: a FlatBuffers table with the fields pattern and every."""
    text = pattern.encode()
    # Root offset, identifier, vtable of 7 fields (subject, wait, pattern, max_rate_hz, format, source, every), table, string.
    vtable = struct.pack("<9H", 18, 9, 0, 0, 4, 0, 0, 0, 8) + b"\0\0"
    table_at = 8 + len(vtable)
    table = struct.pack("<iIB3x", len(vtable), 8, every)
    payload = struct.pack("<I", table_at) + IDENTIFIER_OF_WEIGHTS + vtable + table + struct.pack("<I", len(text)) + text + b"\0"
    payload += b"\0" * (-len(payload) % 4)
    envelope = bytearray(vector("subscribe_weights", sequence)[:32])
    struct.pack_into("<I", envelope, 20, len(payload))
    return bytes(envelope) + payload


IDENTIFIER_OF_WEIGHTS = (VECTORS / "subscribe_weights.bin").read_bytes()[36:40]


def api_flood(port, paths):
    while True:
        with contextlib.suppress(OSError, http.client.HTTPException):
            web = http.client.HTTPConnection("127.0.0.1", port, timeout=DEADLINE)
            while True:
                web.request("GET", random.choice(paths))
                web.getresponse().read()


def snapshots(port, number, heavy, leaves):
    """Asks for large pictures, each of another size. `leaves`: closes before the picture comes."""
    side = 2048 - 16 * number
    while True:
        side = side - 1 if side > 1024 else 2048
        with contextlib.suppress(OSError, http.client.HTTPException):
            web = http.client.HTTPConnection("127.0.0.1", port, timeout=0.05 if leaves else DEADLINE)
            web.request("GET", f"/snapshot.png?width={side}&height={side}&{heavy}")
            web.getresponse().read()


def captures(port, number):
    web = http.client.HTTPConnection("127.0.0.1", port, timeout=DEADLINE)
    i = 0
    while True:
        i += 1
        with contextlib.suppress(OSError, http.client.HTTPException):
            web.request("POST", "/api/capture", json.dumps({"pose": f"p{number}_{i % 300}"}))
            web.getresponse().read()


def strangers(port, per_second, counts, messages):
    """Sends the messages in turn, from addresses that never prove themselves, each with a new session."""
    sockets = [udp_socket(port) for _ in range(16)]
    for one in sockets:
        one.setblocking(False)
    begun, sent = time.monotonic(), 0
    while True:
        due = int((time.monotonic() - begun) * per_second)
        while sent < due:
            one = sockets[sent % len(sockets)]
            message = vector(messages[sent // len(sockets) % len(messages)], 0x7FFFFFFF, random.getrandbits(63) | 1)
            with contextlib.suppress(OSError):
                counts[0] += one.send(message)
            sent += 1
        for one in sockets:
            with contextlib.suppress(OSError):
                while True:
                    counts[1] += len(one.recv(1 << 16))
        time.sleep(0.001)


def offers(port, per_second):
    """Offers skeletons that the daemon does not know, each for another subject, over one connection of another host."""
    template = Offers()
    with socket.create_connection(("127.0.0.1", port), DEADLINE, (STRANGER, 0)) as connection:
        connection.setblocking(False)
        begun, sent, waiting = time.monotonic(), 0, b""
        while True:
            due = int((time.monotonic() - begun) * per_second)
            while sent < due and len(waiting) < 1 << 20:
                waiting += framed(template.make(b"%05d" % (sent % 100_000), b"%07d" % sent, 1 + sent % 65_535))
                sent += 1
            with contextlib.suppress(BlockingIOError):
                waiting = waiting[connection.send(waiting):]
            with contextlib.suppress(BlockingIOError):
                connection.recv(1 << 16)
            time.sleep(0.001)


def forged_mocap(port, per_second):
    """Sends frames to a port of VMC from another host, as if it were the face tracker."""
    one = udp_socket(port, STRANGER)
    while True:
        for packet in vmc({"browInnerUp": 1.0}):
            with contextlib.suppress(OSError):
                one.send(packet)
        time.sleep(1 / per_second)


def tracker(port, rate):
    """A face tracker that speaks VMC."""
    one, due, frame = udp_socket(port), time.monotonic(), 0
    while True:
        frame += 1
        for packet in vmc({"browInnerUp": 0.1 + 0.2 * (frame % 2)}):
            with contextlib.suppress(OSError):
                one.send(packet)
        due += 1 / rate
        time.sleep(max(0.0, due - time.monotonic()))


def rival(bin_folder, port, recording):
    """Publishes the subjects of the victim, over and over, soon after the victim has begun."""
    time.sleep(2.5)
    while True:
        subprocess.run([bin_folder / "furrow", "load", f"127.0.0.1:{port}", recording, "--subjects", "20", "--rate", "60", "--duration", "5"],
                       capture_output=True, check=False)


def client_hello():
    """The first bytes of a client that speaks TLS."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    outgoing = ssl.MemoryBIO()
    with contextlib.suppress(ssl.SSLWantReadError):
        context.wrap_bio(ssl.MemoryBIO(), outgoing).do_handshake()
    return outgoing.read()


def stalled_handshakes(port):
    """Keeps as many connections as it gets, each with a handshake that never ends."""
    hello, held = client_hello(), []
    while True:
        with contextlib.suppress(OSError):
            one = socket.create_connection(("127.0.0.1", port), timeout=DEADLINE)
            one.sendall(hello)
            held.append(one)
        held = held[-400:]
        time.sleep(0.01)


@contextlib.contextmanager
def attackers(*calls):
    running = [multiprocessing.Process(target=call[0], args=call[1:], daemon=True) for call in calls]
    for one in running:
        one.start()
    time.sleep(1.0)  # until the attack has its full strength
    try:
        yield
    finally:
        for one in running:
            one.kill()
            one.join()


# --- Rows -----------------------------------------------------------------------------------------------


class Table:
    def __init__(self, options):
        self.options = options
        print("| attack | victim | without | with | memory |\n|---|---|---|---|---|")

    def row(self, attack, victim, without, with_it, growth=None):
        print(f"| {attack} | {victim} | {without} | {with_it} | {'' if growth is None else f'{growth:+.0f} MiB'} |", flush=True)

    def weights(self, attack, daemon, *calls):
        before, longest_before, _ = daemon.weights_ms(self.options.recording, self.options.seconds)
        memory = daemon.mebibytes()
        with attackers(*calls):
            during, longest, lost = daemon.weights_ms(self.options.recording, self.options.seconds)
            growth = daemon.mebibytes() - memory
        self.row(attack, "weights, p50 (longest)", f"{before:.2f} ms ({longest_before:.0f} ms)",
                 f"{during:.2f} ms ({longest:.0f} ms), {100 * lost:.1f}% lost", growth)


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
        paths = ["/api/status", "/api/subjects", "/api/rig", "/api/rig.json", "/metrics"]
        table.weights("API, 8 connections without pause", daemon, *[(api_flood, http_port, paths)] * 8)
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
    for group in (waiting_tcp, waiting_web, requests, forged, departed, skeletons, mocap, takeover, handshakes, unread, unread_weights, pictures, variants, sigterm):
        if options.only in group.__name__:
            group(table, options)


if __name__ == "__main__":
    main()
