#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A decoder of the Furrow wire, written from protocol/STANDARD.md alone, with the Python standard library.

    decode.py FILE...          print messages as JSON
    decode.py --check FOLDER   decode every *.bin in FOLDER and compare the result with its *.json

messages.py reads the content of messages; this file reads envelopes, fragments, bundles and streams.
"""
import json
import math
import struct
import sys
from pathlib import Path

from flat_table import Refused, Table, require
from messages import KINDS, hexadecimal

ENVELOPE = struct.Struct("<4sBBHQIIq")  # section 2
MAX_DATAGRAM = 1200
SLICE = 1160


# --- Sections 1 to 3 -----------------------------------------------------------------------------------


def envelope(data):
    require(len(data) >= ENVELOPE.size, "shorter than an envelope")
    magic, version, flags, stream, session, sequence, size, time = ENVELOPE.unpack_from(data)
    require(magic == b"FRRW", "wrong magic")
    require(version == 1, "unsupported version")
    require(flags in (0, 1, 2), "undefined flags, or both flags together")
    require(session != 0, "session 0")
    require(abs(time) < 2**62, "capture time out of range")
    return flags, size, {"session": hexadecimal(session), "stream": stream, "sequence": sequence,
                         "capture_time_us": time}


def decode(data):
    flags, size, result = envelope(data)
    require(flags == 0, "a fragment or bundle instead of a whole message")
    payload = data[ENVELOPE.size:]
    require(len(payload) == size and size >= 8, "payload size and byte count differ")
    kind = KINDS.get(payload[4:8])
    require(kind is not None, "unknown identifier")
    root = Table(payload, struct.unpack_from("<I", payload)[0])
    return {"kind": kind.__name__, **result, "message": kind(root)}


def frames(data):
    """Section 1: splits the bytes of a TCP connection into messages."""
    while data:
        require(len(data) >= 4, "incomplete length")
        size = struct.unpack_from("<I", data)[0]
        require(len(data) >= 4 + size, "incomplete frame")
        yield data[4:4 + size]
        data = data[4 + size:]


def reassemble(datagrams):
    slices, first = {}, None
    for datagram in datagrams:
        require(len(datagram) <= MAX_DATAGRAM, "a datagram above 1,200 bytes")
        flags, size, head = envelope(datagram)
        require(flags == 1, "not a fragment")
        number, index, count = struct.unpack_from("<IHH", datagram, 32)
        require(count == -(-size // SLICE) and index < count, "count or index contradicts the payload size")
        require(len(datagram) == 40 + min(SLICE, size - SLICE * index), "length contradicts the payload size")
        first = first or (head, size, number, datagram)
        require(first[:3] == (head, size, number), "fragments of different messages")
        slices[index] = datagram[40:]
    require(first and len(slices) == -(-first[1] // SLICE), "missing fragments")
    head = bytearray(first[3][:32])
    head[5] = 0
    return bytes(head) + b"".join(slices[i] for i in sorted(slices))


def unbundle(datagram):
    """Section 3: splits a datagram into messages, each identical to the message sent alone."""
    require(len(datagram) <= MAX_DATAGRAM, "a datagram above 1,200 bytes")
    messages, followed, session = [], True, datagram[8:16]
    while followed:
        flags, size, _ = envelope(datagram)
        followed = flags == 2
        require(flags != 1, "a fragment inside")
        require(datagram[8:16] == session, "messages of different sessions")
        require(8 <= size <= len(datagram) - 32, "payload too short or beyond the datagram")
        require(followed or size == len(datagram) - 32, "bytes after the last message")
        messages.append(datagram[:5] + b"\0" + datagram[6:32 + size])
        datagram = datagram[32 + size:]
    return messages


def decode_datagram(data):
    return list(map(decode, unbundle(data))) if data[5:6] == b"\2" else decode(data)


# --- Comparison ------------------------------------------------------------------------------------------


def equal(a, b):
    if isinstance(a, float) or isinstance(b, float):
        return math.isclose(a, b, rel_tol=1e-6, abs_tol=1e-6)
    if isinstance(a, list):
        return isinstance(b, list) and len(a) == len(b) and all(map(equal, a, b))
    if isinstance(a, dict):
        return isinstance(b, dict) and a.keys() == b.keys() and all(equal(a[k], b[k]) for k in a)
    return a == b


def check_one(path):
    """Returns None, or a description of the fault."""
    expected = json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))
    container = expected.pop("container")
    data = path.read_bytes()
    try:
        decoded = decode(reassemble(frames(data))) if container == "datagrams" else decode_datagram(data)
    except Refused as refusal:
        return None if container == "refuse" else f"rejected: {refusal}"
    if container == "refuse":
        return f"accepted in spite of: {expected['why']}"
    if container == "bundle":
        expected = [{k: v for k, v in m.items() if k != "container"} for m in expected["messages"]]
    return None if equal(expected, decoded) else f"decoded as {json.dumps(decoded)}"


def check(folder):
    paths = sorted(Path(folder).glob("*.bin"))
    wrong = [(path.name, fault) for path in paths if (fault := check_one(path))]
    for name, fault in wrong:
        print(f"{name}: {fault}", file=sys.stderr)
    kinds = {json.loads(p.with_suffix(".json").read_text(encoding="utf-8")).get("kind") for p in paths}
    missing = {kind.__name__ for kind in KINDS.values()} - kinds
    if missing:
        print(f"no vector of: {', '.join(sorted(missing))}", file=sys.stderr)
    print(f"{len(paths)} vectors, {len(wrong)} faults")
    return 1 if wrong or missing else 0


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "--check":
        return check(arguments[1])
    for name in arguments:
        print(json.dumps(decode(Path(name).read_bytes()), indent=2))
    return 0 if arguments else 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
