// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/crypto/primitives.h"

#include <cstdio>
#include <cstdlib>

#include <sodium.h>

#include "protocol/messages/bytes.h"

namespace furrow::protocol::secure {
namespace {

static_assert(kKeyBytes == crypto_aead_chacha20poly1305_ietf_KEYBYTES);
static_assert(kTagBytes == crypto_aead_chacha20poly1305_ietf_ABYTES);
static_assert(kKeyBytes == crypto_aead_xchacha20poly1305_ietf_KEYBYTES);
static_assert(kTokenNonceBytes == crypto_aead_xchacha20poly1305_ietf_NPUBBYTES);
static_assert(kHashBytes == crypto_hash_sha256_BYTES);
static_assert(kHashBytes == crypto_auth_hmacsha256_BYTES);
static_assert(kPublicKeyBytes == crypto_scalarmult_BYTES);

// Selects the fastest implementations. Without it, libsodium works with its portable ones. Runs
// before main(), because every program that calls a function of this file links its initialisers.
[[maybe_unused]] const bool kReady = [] {
  if (sodium_init() >= 0) return true;
  std::fputs("libsodium does not start: the system has no source of random numbers\n", stderr);
  std::abort();
}();

using Nonce = std::array<std::uint8_t, crypto_aead_chacha20poly1305_ietf_NPUBBYTES>;

Nonce NonceOf(std::uint64_t counter) {
  Nonce nonce{};
  StoreLittle(counter, nonce.data() + 4);
  return nonce;
}

// libsodium accepts no null pointer, not even to nothing.
std::uint8_t* PointerTo(ByteSpan text) {
  static std::uint8_t nothing = 0;
  return text.data() != nullptr ? text.data() : &nothing;
}

// HMAC-SHA256 of the concatenation of `first` and `second`.
void Hmac(const Key& key, ByteView first, ByteView second, Key& out) {
  crypto_auth_hmacsha256_state state;
  crypto_auth_hmacsha256_init(&state, key.bytes().data(), kKeyBytes);
  crypto_auth_hmacsha256_update(&state, first.data(), first.size());
  crypto_auth_hmacsha256_update(&state, second.data(), second.size());
  crypto_auth_hmacsha256_final(&state, out.bytes().data());
  sodium_memzero(&state, sizeof state);
}

// The first two outputs of HKDF's second half.
void Expand(const Key& secret, Key& first, Key& second) {
  constexpr std::uint8_t kCounts[] = {1, 2};
  Hmac(secret, {}, ByteView(kCounts, 1), first);
  Hmac(secret, first.bytes(), ByteView(kCounts + 1, 1), second);
}

class System : public RandomSource {
 public:
  void Fill(ByteSpan bytes) override { randombytes_buf(bytes.data(), bytes.size()); }
};

}  // namespace

void Wipe(ByteSpan bytes) { sodium_memzero(bytes.data(), bytes.size()); }

RandomSource& SystemRandom() {
  static System source;
  return source;
}

bool EqualInConstantTime(ByteView a, ByteView b) {
  return a.size() == b.size() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

void Seal(const Key& key, std::uint64_t counter, ByteView associated, ByteSpan text, TagSpan tag) {
  crypto_aead_chacha20poly1305_ietf_encrypt_detached(
      PointerTo(text), tag.data(), nullptr, PointerTo(text), text.size(), associated.data(),
      associated.size(), nullptr, NonceOf(counter).data(), key.bytes().data());
}

bool Open(const Key& key, std::uint64_t counter, ByteView associated, ByteSpan text, TagView tag) {
  return crypto_aead_chacha20poly1305_ietf_decrypt_detached(
             PointerTo(text), nullptr, PointerTo(text), text.size(), tag.data(), associated.data(),
             associated.size(), NonceOf(counter).data(), key.bytes().data()) == 0;
}

void SealWithNonce(const Key& key, const TokenNonce& nonce, ByteView associated, ByteSpan text,
                   TagSpan tag) {
  crypto_aead_xchacha20poly1305_ietf_encrypt_detached(
      PointerTo(text), tag.data(), nullptr, PointerTo(text), text.size(), associated.data(),
      associated.size(), nullptr, nonce.data(), key.bytes().data());
}

bool OpenWithNonce(const Key& key, const TokenNonce& nonce, ByteView associated, ByteSpan text,
                   TagView tag) {
  return crypto_aead_xchacha20poly1305_ietf_decrypt_detached(
             PointerTo(text), nullptr, PointerTo(text), text.size(), tag.data(), associated.data(),
             associated.size(), nonce.data(), key.bytes().data()) == 0;
}

Hash Sha256(ByteView first, ByteView second, ByteView third) {
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  crypto_hash_sha256_update(&state, first.data(), first.size());
  crypto_hash_sha256_update(&state, second.data(), second.size());
  crypto_hash_sha256_update(&state, third.data(), third.size());
  Hash hash;
  crypto_hash_sha256_final(&state, hash.data());
  return hash;
}

// RFC 5869: extract, then expand.
void Hkdf2(const Key& chaining_key, ByteView material, Key& first, Key& second) {
  Key secret;
  Hmac(chaining_key, material, {}, secret);
  Expand(secret, first, second);
}

void Hkdf3(const Key& chaining_key, ByteView material, Key& first, Key& second, Key& third) {
  Key secret;
  Hmac(chaining_key, material, {}, secret);
  Expand(secret, first, second);
  constexpr std::uint8_t kThird = 3;
  Hmac(secret, second.bytes(), {&kThird, 1}, third);
}

Mac Blake2b128(ByteView data) {
  Mac mac;
  crypto_generichash(mac.data(), mac.size(), data.data(), data.size(), nullptr, 0);
  return mac;
}

Mac Blake2b128(const Key& key, ByteView data) {
  Mac mac;
  crypto_generichash(mac.data(), mac.size(), data.data(), data.size(), key.bytes().data(),
                     kKeyBytes);
  return mac;
}

KeyPair MakeKeyPair(RandomSource& random) {
  KeyPair pair;
  random.Fill(pair.secret.bytes());
  crypto_scalarmult_base(pair.shared.data(), pair.secret.bytes().data());
  return pair;
}

bool X25519(const Key& secret, const PublicKey& other, Key& result) {
  return crypto_scalarmult(result.bytes().data(), secret.bytes().data(), other.data()) == 0;
}

}  // namespace furrow::protocol::secure
