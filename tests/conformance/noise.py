# SPDX-License-Identifier: Apache-2.0
"""Noise_NNpsk0_25519_ChaChaPoly_SHA256 and XChaCha20-Poly1305, from their specifications, over the primitives of
python3-cryptography.
"""
import hashlib
import hmac
import struct

from cryptography.exceptions import InvalidTag
from cryptography.hazmat.primitives.asymmetric.x25519 import X25519PrivateKey, X25519PublicKey
from cryptography.hazmat.primitives.ciphers.aead import ChaCha20Poly1305
from cryptography.hazmat.primitives.serialization import Encoding, PublicFormat

from flat_table import Refused, require

MAX_NONCE = 2**64 - 1


def seal(key, counter, associated, text):
    return ChaCha20Poly1305(key).encrypt(bytes(4) + struct.pack("<Q", counter), text, associated)


def unseal(key, counter, associated, text):
    try:
        return ChaCha20Poly1305(key).decrypt(bytes(4) + struct.pack("<Q", counter), text, associated)
    except InvalidTag:
        raise Refused("wrong tag") from None


def rekey(key):
    return seal(key, MAX_NONCE, b"", bytes(32))[:32]


def hchacha20(key, nonce):
    """The first 16 bytes of a nonce of XChaCha20 select a subkey (draft-irtf-cfrg-xchacha-03, section 2.2)."""
    state = list(struct.unpack("<16I", b"expand 32-byte k" + key + nonce))

    def mix(a, b, c, d):
        for target, source, turned, turn in ((a, b, d, 16), (c, d, b, 12), (a, b, d, 8), (c, d, b, 7)):
            state[target] = (state[target] + state[source]) & 0xFFFFFFFF
            value = state[turned] ^ state[target]
            state[turned] = (value << turn | value >> (32 - turn)) & 0xFFFFFFFF

    for _ in range(10):
        for column in range(4):
            mix(column, column + 4, column + 8, column + 12)
        for diagonal in range(4):
            mix(diagonal, (diagonal + 1) % 4 + 4, (diagonal + 2) % 4 + 8, (diagonal + 3) % 4 + 12)
    return struct.pack("<8I", *state[:4], *state[12:])


def xchacha(key, nonce):
    return ChaCha20Poly1305(hchacha20(key, nonce[:16])), bytes(4) + nonce[16:]


def xseal(key, nonce, associated, text):
    cipher, rest = xchacha(key, nonce)
    return cipher.encrypt(rest, text, associated)


def xunseal(key, nonce, associated, text):
    cipher, rest = xchacha(key, nonce)
    try:
        return cipher.decrypt(rest, text, associated)
    except InvalidTag:
        raise Refused("wrong tag") from None


def public_key(secret):
    return secret.public_key().public_bytes(Encoding.Raw, PublicFormat.Raw)


def shared_secret(secret, other):
    try:
        return secret.exchange(X25519PublicKey.from_public_bytes(other))
    except ValueError:
        raise Refused("a public key of low order") from None


class Handshake:
    """One side. `ephemeral`: 32 bytes for vectors; random if absent."""

    NAME = b"Noise_NNpsk0_25519_ChaChaPoly_SHA256"

    def __init__(self, initiator, psk, prologue, ephemeral=None):
        self.initiator = initiator
        self.secret = X25519PrivateKey.from_private_bytes(ephemeral) if ephemeral else X25519PrivateKey.generate()
        self.chaining = self.hash = hashlib.sha256(self.NAME).digest()
        self.key, self.nonce, self.other = None, 0, None
        self.mix_hash(prologue)
        self.chaining, hashed, self.key = self.hkdf(psk, 3)
        self.mix_hash(hashed)

    def hkdf(self, material, count):
        secret = hmac.digest(self.chaining, material, "sha256")
        outputs = [b""]
        for number in range(1, count + 1):
            outputs.append(hmac.digest(secret, outputs[-1] + bytes([number]), "sha256"))
        return outputs[1:]

    def mix_hash(self, data):
        self.hash = hashlib.sha256(self.hash + data).digest()

    def mix_key(self, material):
        self.chaining, self.key = self.hkdf(material, 2)
        self.nonce = 0

    def mix_ephemeral(self, key, is_second):
        self.mix_hash(key)
        self.mix_key(key)
        if is_second:
            self.mix_key(shared_secret(self.secret, self.other))

    def write(self, payload):
        own = public_key(self.secret)
        self.mix_ephemeral(own, not self.initiator)
        text = seal(self.key, self.nonce, self.hash, payload)
        self.mix_hash(text)
        return own + text

    def read(self, message):
        require(len(message) >= 48, "a handshake message that is too short")
        self.other = message[:32]
        self.mix_ephemeral(self.other, self.initiator)
        payload = unseal(self.key, self.nonce, self.hash, message[32:])
        self.mix_hash(message[32:])
        return payload

    def split(self):
        """The keys of the initiator and of the responder."""
        return self.hkdf(b"", 2)
