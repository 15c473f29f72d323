# SPDX-License-Identifier: Apache-2.0
"""Programs that attack a daemon over loopback, each in a process of its own, and the messages that they send."""
import contextlib
import http.client
import json
import multiprocessing
import pathlib
import random
import re
import resource
import signal
import socket
import ssl
import struct
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in ("tests/conformance", "tests/end_to_end")]
import flat_table  # pylint: disable=wrong-import-position
from messages import fnv1a  # pylint: disable=wrong-import-position
from tracker_packets import vmc  # pylint: disable=wrong-import-position

VECTORS = ROOT / "protocol" / "vectors"
STRANGER = "127.0.0.2"  # another host, for the daemon
DEADLINE = 15.0  # seconds; whatever takes longer counts as an outage


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


# --- Attackers --------------------------------------------------------------------------------------------


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


def leave_no_memory(pid):
    """From now on, the process gets no more memory from the system."""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    data = 1024 * int(re.search(r"VmData:\s+(\d+) kB", status)[1])
    hard = resource.prlimit(pid, resource.RLIMIT_DATA)[1]
    resource.prlimit(pid, resource.RLIMIT_DATA, (data, hard))
    signal.pause()


def leave_no_disk(folder):
    """Fills a disk, and fills it again whenever others free space."""
    with open(pathlib.Path(folder) / "ballast", "wb", buffering=0) as file:
        while True:
            with contextlib.suppress(OSError):
                file.write(bytes(1 << 16))
                continue
            time.sleep(0.001)


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
