// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/noise/cipher_state.h"

#include <limits>

namespace furrow::protocol::secure {

Key NextKey(const Key& key) {
  Key next;  // 32 zero bytes
  Mac unused;
  // Noise reserves the largest nonce for this.
  Seal(key, std::numeric_limits<std::uint64_t>::max(), {}, next.bytes(), unused);
  return next;
}

void CipherState::Encrypt(ByteView associated, ByteSpan text, TagSpan tag) {
  Seal(*key_, nonce_++, associated, text, tag);
}

bool CipherState::Decrypt(ByteView associated, ByteSpan text, TagView tag) {
  if (!Open(*key_, nonce_, associated, text, tag)) return false;
  ++nonce_;
  return true;
}

}  // namespace furrow::protocol::secure
