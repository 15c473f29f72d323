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
  kBadEnvelope,  // a later envelope is incomplete or has a bad magic, version, flags or session
  kFragment,     // the bundle holds a fragment
  kBadSession,   // the messages belong to different sessions
  kBadLength,    // a payload is too short, exceeds the datagram or leaves bytes behind it
};

// Marks a message as followed by another one. `message` holds at least its envelope.
inline void MarkFollowed(std::span<std::uint8_t> message) { message[5] |= kFlagFollowed; }

// Joins messages into one bundle. A single message is copied as it is. Returns false, with `out`
// unspecified, if there are no messages or they exceed kMaxDatagramBytes. Precondition: whole
// messages of one session.
[[nodiscard]] bool WriteBundle(std::span<const std::vector<std::uint8_t>> messages,
                               std::vector<std::uint8_t>& out);

// Splits datagrams into messages.
//
//   (void)unbundler.Open(datagram);
//   while (unbundler.Next(message)) ...
class Unbundler {
 public:
  // Starts with `datagram`, which must outlive the last Next(). Clears the bundle flags in place,
  // so Next() returns messages exactly as Encode() wrote them. Checks a whole bundle before Next()
  // returns any message of it. Next() returns other datagrams unchecked and unchanged. That
  // includes malformed bundles, which OpenMessage() then rejects because of their flags. Never
  // reads beyond `datagram`.
  BundleStatus Open(std::span<std::uint8_t> datagram);

  // Gets the next message, in sending order. Returns false if there are no more.
  [[nodiscard]] bool Next(std::span<const std::uint8_t>& message);
  [[nodiscard]] bool has_more() const { return !rest_.empty(); }

 private:
  std::span<std::uint8_t> rest_;
  bool is_bundle_ = false;
};

}  // namespace furrow::protocol
