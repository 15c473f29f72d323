// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "protocol/secure/crypto/primitives.h"

namespace furrow::protocol::secure {

// The function REKEY of Noise (section 4.2): the key that follows `key`. The old key cannot be
// computed from the new one.
[[nodiscard]] Key NextKey(const Key& key);

// A key and the number of texts that it has encrypted (Noise, section 5.1). The number is the
// nonce.
class CipherState {
 public:
  // The state before the first key: texts pass unchanged and without a tag.
  CipherState() = default;
  explicit CipherState(const Key& key) : key_(key) {}

  [[nodiscard]] bool has_key() const { return key_.has_value(); }

  // Precondition: has_key(). Encrypts in place.
  void Encrypt(ByteView associated, ByteSpan text, TagSpan tag);
  // Precondition: has_key(). Decrypts in place. Returns false if the tag is wrong; the nonce then
  // does not advance.
  [[nodiscard]] bool Decrypt(ByteView associated, ByteSpan text, TagView tag);
  // Precondition: has_key(). The nonce stays.
  void Rekey() { key_ = NextKey(*key_); }

 private:
  std::optional<Key> key_;
  std::uint64_t nonce_ = 0;
};

}  // namespace furrow::protocol::secure
