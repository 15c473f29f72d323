// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "protocol/secure/crypto/primitives.h"
#include "protocol/secure/noise/symmetric_state.h"

namespace furrow::protocol::secure {

// Bytes that a handshake message adds to its payload: a public key and a tag.
inline constexpr std::size_t kHandshakeOverheadBytes = kPublicKeyBytes + kTagBytes;

// What both sides know after the handshake.
struct SessionKeys {
  Key send;
  Key receive;
  // A hash of the whole handshake, equal on both sides and different in every session. Not secret.
  Hash handshake_hash{};
};

enum class HandshakeStatus : std::uint8_t {
  kOk = 0,
  kOutOfTurn,     // the other side is to speak, or the handshake has ended
  kBadSize,       // the message does not have the size of the payload and the overhead
  kNotAuthentic,  // another key, another prologue, or changed bytes
  kBadPoint,      // a public key of low order
};

// One side of the handshake Noise_NNpsk0_25519_ChaChaPoly_SHA256 (Noise, revision 34):
//
//   -> psk, e
//   <- e, ee
//
// The initiator calls Write() and Read(), the responder Read() and Write(), then both Split(). A
// key pair is made for every object. A failed Read() changes nothing that a later good message
// needs.
class Handshake {
 public:
  enum class Side : std::uint8_t { kInitiator, kResponder };

  // `psk`: the secret that both sides know in advance. `prologue`: bytes that both sides must agree
  // on. The object keeps a reference to `random`.
  Handshake(Side side, const Key& psk, ByteView prologue, RandomSource& random);

  // Writes the next message, with `payload` encrypted, to `message`, which has
  // payload.size() + kHandshakeOverheadBytes bytes. The two must not overlap. The responder
  // computes X25519 here, after the other side has proved that it knows the key.
  [[nodiscard]] HandshakeStatus Write(ByteView payload, ByteSpan message);
  // Reads the next message. `payload` receives its message.size() - kHandshakeOverheadBytes bytes.
  [[nodiscard]] HandshakeStatus Read(ByteView message, ByteSpan payload);

  [[nodiscard]] bool done() const { return step_ == 2; }
  // Precondition: done().
  [[nodiscard]] SessionKeys Split() const;

 private:
  [[nodiscard]] bool MyTurn() const { return step_ < 2 && (step_ == 0) == is_initiator_; }

  bool is_initiator_;
  int step_ = 0;  // messages so far
  SymmetricState state_;
  RandomSource& random_;
  KeyPair own_;
  PublicKey other_{};
};

}  // namespace furrow::protocol::secure
