// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/secure/crypto/primitives.h"
#include "protocol/secure/noise/cipher_state.h"

namespace furrow::protocol::secure {

// The chaining key and the hash of everything said so far (Noise, section 5.2), with SHA-256.
class SymmetricState {
 public:
  explicit SymmetricState(ByteView protocol_name);

  [[nodiscard]] const Hash& hash() const { return hash_; }

  void MixHash(ByteView data) { hash_ = Sha256(hash_, data); }
  void MixKey(ByteView material);
  void MixKeyAndHash(ByteView material);

  // Precondition of both: a key was mixed in. The first works in place; the second writes as many
  // bytes as `text` has to `plain`, and does not hash what is not authentic.
  void EncryptAndHash(ByteSpan text, TagSpan tag);
  [[nodiscard]] bool DecryptAndHash(ByteView text, TagView tag, ByteSpan plain);

  // The keys of both directions: first the initiator's, then the responder's.
  void Split(Key& initiator, Key& responder) const;

 private:
  Key chaining_key_;
  Hash hash_{};
  CipherState cipher_;
};

}  // namespace furrow::protocol::secure
