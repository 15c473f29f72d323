// SPDX-License-Identifier: Apache-2.0
#include "protocol/framing/bundle.h"

#include <algorithm>
#include <utility>

#include "protocol/messages/bytes.h"

namespace furrow::protocol {
namespace {

// Byte 5 of the envelope holds the flags, bytes 20 to 23 the size of the payload (envelope.cpp).
bool IsFollowed(std::span<const std::uint8_t> message) { return (message[5] & kFlagFollowed) != 0; }

std::size_t MessageBytes(std::span<const std::uint8_t> message) {
  return kEnvelopeBytes + LoadLittle<std::uint32_t>(&message[20]);
}

// Checks the first message in `rest`. Sets `bytes` to its size with envelope.
BundleStatus CheckMessage(std::span<const std::uint8_t> rest, std::uint64_t session,
                          std::size_t& bytes) {
  Envelope envelope;
  if (ReadEnvelope(rest, envelope) != EnvelopeStatus::kOk) return BundleStatus::kBadEnvelope;
  if ((envelope.flags & kFlagFragment) != 0) return BundleStatus::kFragment;
  if (envelope.header.session != session) return BundleStatus::kBadSession;
  const std::size_t left = rest.size() - kEnvelopeBytes;
  const std::size_t payload = envelope.payload_bytes;
  if (payload < kMinPayloadBytes || payload > left) return BundleStatus::kBadLength;
  if (!IsFollowed(rest) && payload != left) return BundleStatus::kBadLength;
  bytes = kEnvelopeBytes + payload;
  return BundleStatus::kOk;
}

// Checks all messages before the first is used, so that a malformed bundle has no effect. Each
// round consumes at least an envelope, which bounds the loop.
BundleStatus CheckBundle(std::span<const std::uint8_t> datagram, std::uint64_t session) {
  if (datagram.size() > kMaxDatagramBytes) return BundleStatus::kTooLarge;
  for (bool is_last = false; !is_last;) {
    std::size_t bytes = 0;
    const BundleStatus status = CheckMessage(datagram, session, bytes);
    if (status != BundleStatus::kOk) return status;
    is_last = !IsFollowed(datagram);
    datagram = datagram.subspan(bytes);
  }
  return BundleStatus::kOk;
}

}  // namespace

bool WriteBundle(std::span<const std::vector<std::uint8_t>> messages,
                 std::vector<std::uint8_t>& out) {
  out.clear();
  for (const std::vector<std::uint8_t>& message : messages) {
    const std::size_t begin = out.size();
    out.insert(out.end(), message.begin(), message.end());
    if (&message != &messages.back()) MarkFollowed(std::span(out).subspan(begin));
  }
  return !out.empty() && out.size() <= kMaxDatagramBytes;
}

BundleStatus Unbundler::Open(std::span<std::uint8_t> datagram) {
  rest_ = datagram;
  is_bundle_ = false;
  Envelope first;
  if (ReadEnvelope(datagram, first) != EnvelopeStatus::kOk || !IsFollowed(datagram)) {
    return BundleStatus::kOk;
  }
  const BundleStatus status = CheckBundle(datagram, first.header.session);
  is_bundle_ = status == BundleStatus::kOk;
  return status;
}

bool Unbundler::Next(std::span<const std::uint8_t>& message) {
  if (rest_.empty()) return false;
  if (!is_bundle_ || !IsFollowed(rest_)) {
    message = std::exchange(rest_, {});
    return true;
  }
  const std::size_t bytes = MessageBytes(rest_);
  // The message is then byte for byte what Encode() wrote.
  rest_[5] = static_cast<std::uint8_t>(rest_[5] & ~kFlagFollowed);
  message = rest_.first(bytes);
  rest_ = rest_.subspan(bytes);
  return true;
}

}  // namespace furrow::protocol
