// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/secure/crypto/random_source.h"
#include "protocol/secure/crypto/secret.h"

// The primitives of secure datagrams, from libsodium: spans in, no allocation. Only this folder
// includes libsodium's headers.
namespace furrow::protocol::secure {

using ByteView = std::span<const std::uint8_t>;
using ByteSpan = std::span<std::uint8_t>;

inline constexpr std::size_t kTagBytes = 16;
inline constexpr std::size_t kHashBytes = 32;
inline constexpr std::size_t kPublicKeyBytes = 32;
inline constexpr std::size_t kTokenNonceBytes = 24;
inline constexpr std::size_t kMacBytes = 16;

using Hash = std::array<std::uint8_t, kHashBytes>;
using PublicKey = std::array<std::uint8_t, kPublicKeyBytes>;
using TokenNonce = std::array<std::uint8_t, kTokenNonceBytes>;
using Mac = std::array<std::uint8_t, kMacBytes>;
using TagSpan = std::span<std::uint8_t, kTagBytes>;
using TagView = std::span<const std::uint8_t, kTagBytes>;

// Compares without a branch that depends on the content. False if the sizes differ.
[[nodiscard]] bool EqualInConstantTime(ByteView a, ByteView b);

// ChaCha20-Poly1305 (RFC 8439) as Noise uses it: the 12 bytes of the nonce are 4 zero bytes and
// `counter` in little-endian order. Encrypts `text` in place and writes `tag`.
void Seal(const Key& key, std::uint64_t counter, ByteView associated, ByteSpan text, TagSpan tag);
// Decrypts `text` in place. Returns false if the tag is wrong; `text` is then unspecified, and
// never holds decrypted bytes.
[[nodiscard]] bool Open(const Key& key, std::uint64_t counter, ByteView associated, ByteSpan text,
                        TagView tag);

// The same with XChaCha20-Poly1305 (draft-irtf-cfrg-xchacha-03) and a random nonce of 24 bytes.
void SealWithNonce(const Key& key, const TokenNonce& nonce, ByteView associated, ByteSpan text,
                   TagSpan tag);
[[nodiscard]] bool OpenWithNonce(const Key& key, const TokenNonce& nonce, ByteView associated,
                                 ByteSpan text, TagView tag);

// SHA-256 (FIPS 180-4) of the concatenation of the parts.
[[nodiscard]] Hash Sha256(ByteView first, ByteView second = {}, ByteView third = {});

// The two-output HKDF of Noise (revision 34, section 4.3) with HMAC-SHA256. An output may be
// `chaining_key` itself.
void Hkdf2(const Key& chaining_key, ByteView material, Key& first, Key& second);
// The three-output HKDF.
void Hkdf3(const Key& chaining_key, ByteView material, Key& first, Key& second, Key& third);

// BLAKE2b (RFC 7693) with an output of 128 bits.
[[nodiscard]] Mac Blake2b128(ByteView data);
[[nodiscard]] Mac Blake2b128(const Key& key, ByteView data);

// A Curve25519 key pair (RFC 7748).
struct KeyPair {
  Key secret;
  PublicKey shared{};
};
[[nodiscard]] KeyPair MakeKeyPair(RandomSource& random);
// Returns false if `other` is a point of low order, which would give a result that anybody knows.
[[nodiscard]] bool X25519(const Key& secret, const PublicKey& other, Key& result);

}  // namespace furrow::protocol::secure
