// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/noise/symmetric_state.h"

#include <algorithm>

namespace furrow::protocol::secure {

SymmetricState::SymmetricState(ByteView protocol_name) {
  if (protocol_name.size() <= kHashBytes) {
    std::copy(protocol_name.begin(), protocol_name.end(), hash_.begin());
  } else {
    hash_ = Sha256(protocol_name);
  }
  std::copy(hash_.begin(), hash_.end(), chaining_key_.bytes().begin());
}

void SymmetricState::MixKey(ByteView material) {
  Key key;
  Hkdf2(chaining_key_, material, chaining_key_, key);
  cipher_ = CipherState(key);
}

void SymmetricState::MixKeyAndHash(ByteView material) {
  Key hashed;
  Key key;
  Hkdf3(chaining_key_, material, chaining_key_, hashed, key);
  MixHash(hashed.bytes());
  cipher_ = CipherState(key);
}

void SymmetricState::EncryptAndHash(ByteSpan text, TagSpan tag) {
  cipher_.Encrypt(hash_, text, tag);
  hash_ = Sha256(hash_, text, tag);
}

bool SymmetricState::DecryptAndHash(ByteView text, TagView tag, ByteSpan plain) {
  std::copy(text.begin(), text.end(), plain.begin());
  if (!cipher_.Decrypt(hash_, plain, tag)) return false;
  hash_ = Sha256(hash_, text, tag);
  return true;
}

void SymmetricState::Split(Key& initiator, Key& responder) const {
  Hkdf2(chaining_key_, {}, initiator, responder);
}

}  // namespace furrow::protocol::secure
