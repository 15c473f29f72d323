#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the vectors of connect tokens and secure datagrams with secure.py, which was written from the document.

    secure_vectors.py VECTORS/secure
"""
import json
import sys
from pathlib import Path

import secure
from flat_table import Refused
from noise import Handshake, hchacha20, seal


def check(what, found, expected):
    if found != expected:
        raise AssertionError(f"{what}: found {found}, expected {expected}")


def must_refuse(what, function, *arguments):
    try:
        function(*arguments)
    except Refused:
        return
    raise AssertionError(f"accepted: {what}")


def check_primitives(folder):
    """The example of the XChaCha20 draft, and the public vector of the handshake."""
    key = bytes(range(32))
    subkey = hchacha20(key, bytes.fromhex("000000090000004a0000000031415927"))
    check("HChaCha20", subkey.hex(), "82413b4227b27bfed30e42508a877d73a0f9e4d58a74a853c12ec41326d3ecdc")
    vector = json.loads((folder / "noise_nnpsk0.json").read_text())
    prologue, psk = bytes.fromhex(vector["init_prologue"]), bytes.fromhex(vector["init_psks"][0])
    sides = [Handshake(True, psk, prologue, bytes.fromhex(vector["init_ephemeral"])),
             Handshake(False, psk, prologue, bytes.fromhex(vector["resp_ephemeral"]))]
    keys, counters = None, [0, 0]
    for number, message in enumerate(vector["messages"]):
        payload, sender = bytes.fromhex(message["payload"]), number % 2
        if number < 2:
            text = sides[sender].write(payload)
            check("payload", sides[1 - sender].read(text), payload)
            keys = sides[0].split() if number == 1 else None
        else:
            text = seal(keys[sender], counters[sender], b"", payload)
            counters[sender] += 1
        check(f"message {number}", text.hex(), message["ciphertext"])
    check("handshake hash", sides[0].hash.hex(), vector["handshake_hash"])


def check_token(folder, expected):
    token, key = (folder / "token.bin").read_bytes(), bytes.fromhex(expected["token_key"])
    opened = secure.open_token(token, key)
    check("token", opened, {name: expected[name] for name in opened})
    client_key = bytes.fromhex(expected["client_key"])
    check("text form", secure.token_text(token, client_key), expected["text"])
    check("parsed text", secure.parse_token_text(expected["text"]), (token, client_key))
    must_refuse("refuse_token", secure.open_token, (folder / "refuse_token.bin").read_bytes(), key)
    return token, client_key, {expected["key_id"]: key}


def check_handshake(folder, session, token, client_key, keys):
    """Both sides, byte for byte. Returns the two sessions."""
    read = lambda name: (folder / f"{name}.bin").read_bytes()
    index, hello = session["client_index"], bytes.fromhex(session["hello"])
    cookie = bytes.fromhex(session["cookie"])
    first = secure.ClientHandshake(token, client_key, hello, bytes(24), index, bytes(range(0x10, 0x30)))
    check("initiation_first", first.initiation, read("initiation_first"))
    retry, _, _ = secure.answer_initiation(read("initiation_first"), keys, session["server_index"], cookie)
    check("retry", retry, read("retry"))
    check("cookie", first.read_retry(retry), cookie)
    client = secure.ClientHandshake(token, client_key, hello, cookie, index, bytes.fromhex(session["client_ephemeral"]))
    check("initiation", client.initiation, read("initiation"))
    response, at_server, received = secure.answer_initiation(read("initiation"), keys, session["server_index"], cookie,
                                                             bytes.fromhex(session["server_ephemeral"]))
    check("response", response, read("response"))
    check("hello", received, hello)
    at_client = client.read_response(response)
    check("handshake hash", at_client.hash.hex(), session["handshake_hash"])
    check("client key", at_client.sealer.key.hex(), session["client_key"])
    check("server key", at_server.sealer.key.hex(), session["server_key"])
    must_refuse("refuse_initiation", secure.answer_initiation, read("refuse_initiation"), keys, 1, cookie)
    return at_client, at_server


def check_packets(folder, packets, at_client, at_server):
    at_client.sealer.packets_per_key = 2
    for packet in packets:
        data = (folder / packet["file"]).read_bytes()
        sender, receiver = (at_client, at_server) if packet["from"] == "client" else (at_server, at_client)
        kind, inner = (secure.DATA if packet["kind"] == "data" else secure.CONTROL), bytes.fromhex(packet["inner"])
        sender.sealer.counter = int(packet["counter"], 16)
        check(packet["file"], sender.sealer.seal(kind, inner), data)
        check("phase", data[0] & 0x80 != 0, packet["phase"])
        check(packet["file"], receiver.open(data), (kind, inner))
        must_refuse(f"{packet['file']} twice", receiver.open, data)


def main(arguments):
    folder = Path(arguments[0])
    expected = json.loads((folder / "secure.json").read_text(encoding="utf-8"))
    check_primitives(folder)
    token, client_key, keys = check_token(folder, expected["token"])
    at_client, at_server = check_handshake(folder, expected["session"], token, client_key, keys)
    changed = (folder / "refuse_packet.bin").read_bytes()
    must_refuse("refuse_packet", at_server.open, changed)
    check_packets(folder, expected["packets"], at_client, at_server)
    renewal = bytes.fromhex(next(p["inner"] for p in expected["packets"] if p["file"] == "client_3.bin"))
    check("proof of a renewal", renewal[-16:], secure.renewal_proof(client_key, at_client.hash))
    print(f"secure_vectors: {len(expected['packets'])} packets, 1 handshake, 1 token, 0 faults")


if __name__ == "__main__":
    main(sys.argv[1:])
