// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/noise/handshake.h"

#include <algorithm>
#include <string_view>

namespace furrow::protocol::secure {
namespace {

constexpr std::string_view kProtocolName = "Noise_NNpsk0_25519_ChaChaPoly_SHA256";

ByteView AsBytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

Handshake::Handshake(Side side, const Key& psk, ByteView prologue, RandomSource& random)
    : is_initiator_(side == Side::kInitiator), state_(AsBytes(kProtocolName)), random_(random) {
  state_.MixHash(prologue);
  state_.MixKeyAndHash(psk.bytes());
}

HandshakeStatus Handshake::Write(ByteView payload, ByteSpan message) {
  if (!MyTurn()) return HandshakeStatus::kOutOfTurn;
  if (message.size() != payload.size() + kHandshakeOverheadBytes) return HandshakeStatus::kBadSize;
  SymmetricState next = state_;
  own_ = MakeKeyPair(random_);
  // "e": with a pre-shared key, the public key is mixed into the key as well (Noise, section 9.2).
  next.MixHash(own_.shared);
  next.MixKey(own_.shared);
  if (!is_initiator_) {
    Key shared;  // "ee"
    if (!X25519(own_.secret, other_, shared)) return HandshakeStatus::kBadPoint;
    next.MixKey(shared.bytes());
  }
  std::copy(own_.shared.begin(), own_.shared.end(), message.begin());
  const ByteSpan text = message.subspan(kPublicKeyBytes, payload.size());
  std::copy(payload.begin(), payload.end(), text.begin());
  next.EncryptAndHash(text, message.last<kTagBytes>());
  state_ = next;
  ++step_;
  return HandshakeStatus::kOk;
}

HandshakeStatus Handshake::Read(ByteView message, ByteSpan payload) {
  if (step_ >= 2 || MyTurn()) return HandshakeStatus::kOutOfTurn;
  if (message.size() != payload.size() + kHandshakeOverheadBytes) return HandshakeStatus::kBadSize;
  SymmetricState next = state_;
  PublicKey other;
  std::copy_n(message.begin(), kPublicKeyBytes, other.begin());
  next.MixHash(other);
  next.MixKey(other);
  if (is_initiator_) {
    Key shared;
    if (!X25519(own_.secret, other, shared)) return HandshakeStatus::kBadPoint;
    next.MixKey(shared.bytes());
  }
  if (!next.DecryptAndHash(message.subspan(kPublicKeyBytes, payload.size()),
                           message.last<kTagBytes>(), payload)) {
    return HandshakeStatus::kNotAuthentic;
  }
  other_ = other;
  state_ = next;
  ++step_;
  return HandshakeStatus::kOk;
}

SessionKeys Handshake::Split() const {
  SessionKeys keys;
  state_.Split(is_initiator_ ? keys.send : keys.receive, is_initiator_ ? keys.receive : keys.send);
  keys.handshake_hash = state_.hash();
  return keys;
}

}  // namespace furrow::protocol::secure
