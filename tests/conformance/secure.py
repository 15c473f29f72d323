# SPDX-License-Identifier: Apache-2.0
"""Connect tokens and secure datagrams, written from sections 14 and 15 of protocol/STANDARD.md alone."""
import base64
import hashlib
import os
import struct

from flat_table import require
from noise import Handshake, rekey, seal, unseal, xseal, xunseal

ROLES = {1: "publish", 2: "watch", 4: "direct", 8: "operate"}
LABEL = b"furrow secure 1\n"
INITIATION, RETRY, RESPONSE, REFUSED, DATA, CONTROL = range(1, 7)
PROBE, PROBE_ANSWER, PATH_CHALLENGE, PATH_ANSWER, RENEW, RENEWED, CLOSE = range(1, 8)
WINDOW = 1024


# --- Section 14 ------------------------------------------------------------------------------------------


def read_text(field):
    size = field[0]
    require(size < len(field) and not any(field[1 + size:]), "a malformed text field")
    text = field[1:1 + size].decode("utf-8")
    require(all(ord(c) >= 0x20 and ord(c) != 0x7F for c in text), "control characters")
    return text


def write_text(text, size):
    data = text.encode()
    return bytes([len(data)]) + data + bytes(size - 1 - len(data))


def read_head(token):
    require(len(token) == 252, "a token of another size")
    magic, version, *reserved, key_id, expires, nonce = struct.unpack_from("<4sBBBBIQ24s", token)
    require(magic == b"FRTK" and version == 1 and not any(reserved), "not a token of version 1")
    return key_id, expires, nonce


def open_token(token, token_key):
    key_id, expires, nonce = read_head(token)
    part = xunseal(token_key, nonce, token[:44], token[44:])
    client_id, client_key, roles, reserved, rate = struct.unpack_from("<Q32sHHI", part)
    require(reserved == 0 and roles != 0 and roles < 16, "reserved bits")
    subjects = read_text(part[96:])
    require(subjects, "no subjects")
    return {"key_id": key_id, "expires": expires, "client_id": f"0x{client_id:016x}", "client_key": client_key.hex(),
            "roles": ",".join(word for bit, word in ROLES.items() if roles & bit), "packets_per_second": rate,
            "audience": read_text(part[48:96]), "subjects": subjects}


def make_token(key_id, token_key, expires, client_id, client_key, roles, rate=0, audience="", subjects="*"):
    nonce = os.urandom(24)
    head = struct.pack("<4sBBBBIQ24s", b"FRTK", 1, 0, 0, 0, key_id, expires, nonce)
    part = struct.pack("<Q32sHHI", client_id, client_key, roles, 0, rate) + write_text(audience, 48) + \
        write_text(subjects, 96)
    return head + xseal(token_key, nonce, head, part)


def token_text(token, client_key):
    content = token + client_key
    return "frw1_" + base64.urlsafe_b64encode(content + hashlib.blake2b(content, digest_size=16).digest()[:4]).decode()


def parse_token_text(text):
    require(text.startswith("frw1_") and len(text) == 5 + 384, "not a token in text form")
    data = base64.b64decode(text[5:], altchars=b"-_", validate=True)
    require(hashlib.blake2b(data[:284], digest_size=16).digest()[:4] == data[284:], "wrong checksum")
    return data[:252], data[252:284]


# --- Section 15.1 ----------------------------------------------------------------------------------------


def read_short(packet, kind, size):
    require(len(packet) == size and packet[0] == kind and not any(packet[1:4]), "not the expected packet")
    return struct.unpack_from("<I", packet, 4)[0], packet[8:]


def write_short(kind, index):
    return struct.pack("<BBBBI", kind, 0, 0, 0, index)


class ClientHandshake:
    """One initiation and the response to it."""

    def __init__(self, token, client_key, hello, cookie=bytes(24), index=None, ephemeral=None):
        self.index = int.from_bytes(os.urandom(4), "little") if index is None else index
        head = write_short(INITIATION, self.index) + token + cookie
        self.noise = Handshake(True, client_key, LABEL + head, ephemeral)
        payload = struct.pack("<H", len(hello)) + hello
        self.initiation = head + self.noise.write(payload + bytes(868 - len(payload)))

    def read_retry(self, packet):
        index, cookie = read_short(packet, RETRY, 32)
        require(index == self.index, "the retry of another initiation")
        return cookie

    def read_response(self, packet):
        """Returns the session."""
        index, message = read_short(packet, RESPONSE, 60)
        require(index == self.index, "the response to another initiation")
        server_index = struct.unpack("<I", self.noise.read(message))[0]
        client, server = self.noise.split()
        return Session(Sealer(client, server_index), Opener(server), self.index, self.noise.hash)


def answer_initiation(packet, token_keys, index, cookie=None, ephemeral=None):
    """What a server does: (retry, None, None) or (response, session, hello). `cookie`: the only good one."""
    client_index, rest = read_short(packet, INITIATION, 1200)
    token, shown, message = rest[:252], rest[252:276], rest[276:]
    key_id, _, _ = read_head(token)
    require(key_id in token_keys, "unknown key")
    if cookie is not None and shown != cookie:
        return write_short(RETRY, client_index) + cookie, None, None
    client_key = bytes.fromhex(open_token(token, token_keys[key_id])["client_key"])
    noise = Handshake(False, client_key, LABEL + packet[:284], ephemeral)
    payload = noise.read(message)
    size = struct.unpack_from("<H", payload)[0]
    require(size <= 866, "a hello that is too long")
    response = write_short(RESPONSE, client_index) + noise.write(struct.pack("<I", index))
    client, server = noise.split()
    return response, Session(Sealer(server, client_index), Opener(client), index, noise.hash), payload[2:2 + size]


# --- Section 15.2 ----------------------------------------------------------------------------------------


class Sealer:
    def __init__(self, key, index, packets_per_key=2**24, counter=0):
        self.key, self.index, self.packets_per_key, self.counter = key, index, packets_per_key, counter
        self.phase, self.used = 0, 0

    def seal(self, kind, inner):
        require(len(inner) <= 1200 and self.counter < 2**64 - 1, "too large, or no counter is left")
        if self.used == self.packets_per_key:
            self.key, self.phase, self.used = rekey(self.key), self.phase ^ 0x80, 0
        header = struct.pack("<BBBBIQ", kind | self.phase, 0, 0, 0, self.index, self.counter)
        packet = header + seal(self.key, self.counter, header, inner)
        self.counter, self.used = self.counter + 1, self.used + 1
        return packet


class Opener:
    def __init__(self, key):
        self.former, self.key, self.phase = None, key, 0
        self.first = 0  # counter of this phase
        self.seen = set()

    def open(self, packet):
        require(32 <= len(packet) <= 1232 and packet[0] & 0x7F in (DATA, CONTROL) and not any(packet[1:4]), "bad header")
        index, counter = struct.unpack_from("<IQ", packet, 4)
        require(counter != 2**64 - 1 and counter not in self.seen, "a counter that was used")
        require(not self.seen or max(self.seen) - counter < WINDOW, "too old")
        turns = packet[0] & 0x80 != self.phase and not (self.former and counter < self.first)
        key = rekey(self.key) if turns else self.key if packet[0] & 0x80 == self.phase else self.former
        inner = unseal(key, counter, packet[:16], packet[16:])
        if turns:
            self.former, self.key, self.phase, self.first = self.key, key, self.phase ^ 0x80, counter
        self.seen = {c for c in self.seen if max(self.seen) - c < WINDOW} | {counter}
        return packet[0] & 0x7F, index, counter, inner


class Session:
    def __init__(self, sealer, opener, index, handshake_hash):
        self.sealer, self.opener, self.index, self.hash = sealer, opener, index, handshake_hash

    def control(self, kind, content=b""):
        return self.sealer.seal(CONTROL, bytes([kind]) + content)

    def data(self, inner):
        return self.sealer.seal(DATA, inner)

    def open(self, packet):
        """Returns (kind, inner)."""
        kind, index, _, inner = self.opener.open(packet)
        require(index == self.index, "a packet of another session")
        return kind, inner

    def renewal(self, token, client_key):
        return self.control(RENEW, token + renewal_proof(client_key, self.hash))


def renewal_proof(client_key, handshake_hash):
    return hashlib.blake2b(b"furrow renewal 1" + handshake_hash, key=client_key, digest_size=16).digest()
