// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/session/channel.h"

#include <algorithm>
#include <string_view>

namespace furrow::protocol::secure {

int ControlContentBytes(std::uint8_t type) {
  switch (static_cast<ControlType>(type)) {
    case ControlType::kProbeAnswer:
    case ControlType::kClose: return 0;
    case ControlType::kProbe:
    case ControlType::kPathChallenge:
    case ControlType::kPathAnswer: return static_cast<int>(kCookieBytes);
    case ControlType::kRenew: return static_cast<int>(kRenewBytes);
    case ControlType::kRenewed: return static_cast<int>(kRenewedBytes);
  }
  return -1;
}

Mac RenewalProof(const Key& token_key, const Hash& handshake_hash) {
  constexpr std::string_view kLabel = "furrow renewal 1";
  std::array<std::uint8_t, kLabel.size() + kHashBytes> input;
  auto* const end = std::copy(kLabel.begin(), kLabel.end(), input.begin());
  std::copy(handshake_hash.begin(), handshake_hash.end(), end);
  return Blake2b128(token_key, input);
}

std::size_t Channel::SealControl(ControlType type, ByteView content, ByteSpan packet,
                                 std::int64_t now_us) {
  const ByteSpan used = packet.first(ControlPacketBytes(content.size()));
  used[kPacketHeaderBytes] = static_cast<std::uint8_t>(type);
  std::copy(content.begin(), content.end(), used.begin() + kPacketHeaderBytes + 1);
  const SealStatus status = sealer.Seal(PacketKind::kControl, used, now_us);
  return status == SealStatus::kOk ? used.size() : 0;
}

bool ReadControl(ByteView inner, ControlMessage& message) {
  if (inner.empty()) return false;
  message.content = inner.subspan(1);
  if (ControlContentBytes(inner[0]) != static_cast<int>(message.content.size())) return false;
  message.type = static_cast<ControlType>(inner[0]);
  return true;
}

}  // namespace furrow::protocol::secure
