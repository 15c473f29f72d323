// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/packet/packet.h"

#include "protocol/messages/bytes.h"

namespace furrow::protocol::secure {
namespace {
bool ReservedIsZero(ByteView packet) { return (packet[1] | packet[2] | packet[3]) == 0; }
}  // namespace

void WritePacketHeader(const PacketHeader& header, ByteSpan packet) {
  WriteShortHeader(header.kind, header.index, packet);
  if (header.phase) packet[0] |= kPhaseBit;
  StoreLittle(header.counter, &packet[8]);
}

bool ReadPacketHeader(ByteView packet, PacketHeader& header) {
  if (packet.size() < kPacketOverheadBytes || packet.size() > kMaxPacketBytes) return false;
  header.kind = static_cast<PacketKind>(packet[0] & ~int{kPhaseBit});
  if (header.kind != PacketKind::kData && header.kind != PacketKind::kControl) return false;
  if (!ReservedIsZero(packet)) return false;
  header.phase = (packet[0] & kPhaseBit) != 0;
  header.index = LoadLittle<std::uint32_t>(&packet[4]);
  header.counter = LoadLittle<std::uint64_t>(&packet[8]);
  return true;
}

void WriteShortHeader(PacketKind kind, std::uint32_t index, ByteSpan packet) {
  packet[0] = static_cast<std::uint8_t>(kind);
  packet[1] = packet[2] = packet[3] = 0;
  StoreLittle(index, &packet[4]);
}

bool ReadShortHeader(ByteView packet, PacketKind kind, std::uint32_t& index) {
  if (packet.size() < kShortHeaderBytes) return false;
  if (packet[0] != static_cast<std::uint8_t>(kind) || !ReservedIsZero(packet)) return false;
  index = LoadLittle<std::uint32_t>(&packet[4]);
  return true;
}

}  // namespace furrow::protocol::secure
