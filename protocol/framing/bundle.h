// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/framing/envelope.h"

namespace furrow::protocol {

// A bundle is one datagram with several whole messages of one sender, back to back (STANDARD.md
// section 3). All but the last have kFlagFollowed set. The payload size of each message states
// where the next one starts; there are no other lengths that could contradict it. Bundles are never
// nested and never hold fragments. Servers send them only to clients that opt in with Hello.

// The reason for which a bundle is rejected. The values are in the order of the checks.
enum class BundleStatus : std::uint8_t {
  kOk = 0,
  kTooLarge,     // above kMaxDatagramBytes
  kBadEnvelope,  // an envelope after the first is incomplete, or ReadEnvelope() rejects it
  kFragment,     // the bundle holds a fragment
  kBadSession,   // the messages belong to different sessions
  kBadLength,    // a payload is too short, exceeds the datagram or leaves bytes behind it
};

// Sets kFlagFollowed in the envelope of `message`, which has at least kEnvelopeBytes.
inline void MarkFollowed(std::span<std::uint8_t> message) { message[5] |= kFlagFollowed; }

// Replaces the content of `out` with one bundle of all messages. A single message is copied
// unchanged. Returns false, with `out` unspecified, if there are no messages or if they have more
// than kMaxDatagramBytes together. Precondition: complete messages (Encode()) of one session.
[[nodiscard]] bool WriteBundle(std::span<const std::vector<std::uint8_t>> messages,
                               std::vector<std::uint8_t>& out);

// Splits datagrams into messages.
//
//   (void)unbundler.Open(datagram);
//   while (unbundler.Next(message)) ...
class Unbundler {
 public:
  // Checks a datagram and makes its messages available to Next(). `datagram` must outlive the last
  // Next(), which clears kFlagFollowed in it, so that messages are exactly as Encode() wrote them.
  // A datagram that is not a bundle (kOk), or a malformed bundle (any other status), is one message
  // for Next(), unchanged; OpenMessage() rejects a malformed bundle. Never reads beyond `datagram`.
  BundleStatus Open(std::span<std::uint8_t> datagram);

  // Sets `message` to the next message, a part of the datagram, in sending order. Returns false,
  // with `message` unchanged, if there are no more.
  [[nodiscard]] bool Next(std::span<const std::uint8_t>& message);
  [[nodiscard]] bool has_more() const { return !rest_.empty(); }

 private:
  std::span<std::uint8_t> rest_;
  bool is_bundle_ = false;
};

}  // namespace furrow::protocol
