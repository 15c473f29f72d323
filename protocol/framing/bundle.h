// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/framing/envelope.h"

namespace furrow::protocol {

// A bundle is one datagram that holds several whole messages of one sender, one right behind the
// other; all but the last have kFlagFollowed set. Where a message ends follows from its own payload
// size, so there is nothing else that could lie (STANDARD.md section 3). Never nested, never with a
// fragment inside; servers send them to clients that asked for it in their Hello.

// Why a bundle was refused. The order is the order of the checks.
enum class BundleStatus : std::uint8_t {
  kOk = 0,
  kTooLarge,     // above kMaxDatagramBytes
  kBadEnvelope,  // of a later message: not all there, another magic, version or flags, session 0
  kFragment,     // a fragment inside
  kBadSession,   // messages of different sessions
  kBadLength,    // a payload that is no message's, ends beyond the datagram or before its end
};

// Says of a message that another one follows it in its datagram. `message`: its envelope and more.
inline void MarkFollowed(std::span<std::uint8_t> message) { message[5] |= kFlagFollowed; }

// The messages as one bundle (a single one as it is). False, and `out` is unspecified, where they
// are none or exceed kMaxDatagramBytes. Precondition: whole messages of one session.
[[nodiscard]] bool WriteBundle(std::span<const std::vector<std::uint8_t>> messages,
                               std::vector<std::uint8_t>& out);

// Takes datagrams apart.
//
//   (void)unbundler.Open(datagram);
//   while (unbundler.Next(message)) ...
class Unbundler {
 public:
  // Begins with `datagram`, which must outlive the last Next(), and is changed in place: what
  // Next() gives is what Encode() made. All of a bundle is checked before any of it is given out. A
  // datagram that is no bundle is given out as it is, unchecked; so is a malformed one, unchanged,
  // which OpenMessage() then refuses for its flags. Never reads beyond `datagram`, whatever it
  // says.
  BundleStatus Open(std::span<std::uint8_t> datagram);

  // The next message, in the order they were sent; false: no more.
  [[nodiscard]] bool Next(std::span<const std::uint8_t>& message);
  [[nodiscard]] bool has_more() const { return !rest_.empty(); }

 private:
  std::span<std::uint8_t> rest_;
  bool is_bundle_ = false;
};

}  // namespace furrow::protocol
