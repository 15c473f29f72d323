#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The Python implementation (secure.py) and the C++ one talk to each other: handshake, data, a new address, renewal.

    secure_meeting.py SECURE_PEER
"""
import os
import struct
import subprocess
import sys

import secure
from flat_table import Refused

NOW = 1_800_000_000  # the time of secure_peer
KEY_ID = 0x1234ABCD
PROBE = bytes([secure.PROBE]) + bytes(24)


class Peer:
    """The C++ side."""

    def __init__(self, *command):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def tell(self, line):
        """What it says: a list of (word, bytes or text)."""
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        said = []
        while (answer := self.process.stdout.readline().rstrip("\n")) != ".":
            if not answer:
                raise AssertionError("secure_peer has ended")
            word, _, rest = answer.partition(" ")
            said.append((word, rest if word in ("refused", "to") else bytes.fromhex(rest)))
        return said

    def close(self):
        self.process.stdin.close()
        assert self.process.wait(timeout=60) == 0


def only(said, word):
    found = [content for kind, content in said if kind == word]
    assert len(found) == 1, f"expected one '{word}' in {said}"
    return found[0]


def make_token(key, client_key, expires=NOW + 3600, client_id=5):
    return secure.make_token(KEY_ID, key, expires, client_id, client_key, roles=3, subjects="stage-*")


def meet_server(program):
    """Python is the client."""
    key, client_key = os.urandom(32), os.urandom(32)
    peer = Peer(program, "server", f"{KEY_ID:x}", key.hex())
    send = lambda packet, port=5000: peer.tell(f"{port} {packet.hex()}")
    token = make_token(key, client_key)

    first = secure.ClientHandshake(token, client_key, b"hello")
    cookie = first.read_retry(only(send(first.initiation), "send"))
    handshake = secure.ClientHandshake(token, client_key, b"hello", cookie)
    response = only(send(handshake.initiation), "send")
    assert only(send(handshake.initiation), "send") == response, "a repeated initiation gets the same response"
    session = handshake.read_response(response)

    said = send(session.control(secure.PROBE, bytes(24)))
    assert only(said, "opened") == b"hello"
    assert session.open(only(said, "send")) == (secure.CONTROL, bytes([secure.PROBE_ANSWER]))
    for size in (0, 1, 400, 1200):
        inner = os.urandom(size)
        said = send(session.data(inner))
        if size:
            assert only(said, "inner") == inner
            assert session.open(only(said, "send")) == (secure.DATA, inner)

    # The keys change on both sides.
    session.sealer.packets_per_key = session.sealer.used
    said = send(session.data(b"another key"))
    assert only(said, "inner") == b"another key"
    assert session.open(only(said, "send"))[1] == b"another key"

    # A new port counts after the answer to a challenge.
    said = send(session.data(bytes(100)), 6000)
    assert only(said, "to") == "5000"
    challenge = session.open([content for word, content in said if word == "send"][0])
    assert challenge[1][0] == secure.PATH_CHALLENGE
    send(session.control(secure.PATH_ANSWER, challenge[1][1:]), 6000)
    assert only(send(session.data(b"moved"), 6000), "to") == "6000"

    # Renewal.
    new_key = os.urandom(32)
    said = send(session.renewal(make_token(key, new_key, NOW + 7200), new_key), 6000)
    assert only(said, "renewed") == b""
    answer = session.open(only(said, "send"))[1]
    assert answer[0] == secure.RENEWED and struct.unpack_from("<Q", answer, 1)[0] == NOW + 7200 and answer[9] == 0

    # Refusals.
    assert only(send(secure.ClientHandshake(make_token(key, client_key, NOW), client_key, b"").initiation), "refused") == "3"
    forged = bytearray(session.data(b"forged"))
    forged[-1] ^= 1
    assert send(bytes(forged), 6000) == []
    stranger = secure.ClientHandshake(token, os.urandom(32), b"", cookie)
    assert only(send(stranger.initiation), "refused") == "7"
    peer.close()


def meet_client(program):
    """Python is the server."""
    key, client_key = os.urandom(32), os.urandom(32)
    token = make_token(key, client_key)
    peer = Peer(program, "client", secure.token_text(token, client_key))
    keys, cookie = {KEY_ID: key}, os.urandom(24)
    retry, session, _ = secure.answer_initiation(only(peer.tell("wait 1"), "send"), keys, 7, cookie)
    assert session is None
    response, session, hello = secure.answer_initiation(only(peer.tell(retry.hex()), "send"), keys, 7, cookie)
    assert hello == b"hello"
    said = peer.tell(response.hex())
    assert ("connected", b"") in said
    opened = [session.open(content) for word, content in said if word == "send"]
    assert (secure.DATA, b"pose") in opened and (secure.CONTROL, PROBE) in opened
    assert only(peer.tell(session.data(b"weights").hex()), "inner") == b"weights"
    challenge = bytes([secure.PATH_CHALLENGE]) + cookie
    said = peer.tell(session.sealer.seal(secure.CONTROL, challenge).hex())
    assert session.open(only(said, "send")) == (secure.CONTROL, bytes([secure.PATH_ANSWER]) + cookie)
    session.sealer.packets_per_key = session.sealer.used
    assert only(peer.tell(session.data(b"another key").hex()), "inner") == b"another key"
    changed = bytearray(session.data(b"weights"))
    changed[0] ^= 0x80
    assert peer.tell(bytes(changed).hex()) == []
    # Silence: a probe, and then a new handshake.
    probe = only(peer.tell("wait 600"), "send")
    assert session.open(probe) == (secure.CONTROL, PROBE)
    said = [content for word, content in peer.tell("wait 1000") if word == "send"]
    assert len(said[0]) == 1200
    try:
        secure.answer_initiation(said[0], {1: key}, 7)
        raise AssertionError("a token of an unknown key was accepted")
    except Refused:
        pass
    peer.close()


if __name__ == "__main__":
    meet_server(sys.argv[1])
    meet_client(sys.argv[1])
    print("secure_meeting: both directions agree")
