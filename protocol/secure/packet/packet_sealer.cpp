// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/packet/packet_sealer.h"

#include "protocol/secure/noise/cipher_state.h"

namespace furrow::protocol::secure {

PacketSealer::PacketSealer(const Key& key, std::uint32_t index, std::int64_t now_us,
                           RekeyLimits limits, std::uint64_t first_counter)
    : key_(key), index_(index), limits_(limits), counter_(first_counter), phase_began_us_(now_us) {}

PacketSealer::PacketSealer(const State& state, RekeyLimits limits)
    : key_(state.key),
      index_(state.index),
      limits_(limits),
      counter_(state.counter),
      phase_(state.phase),
      phase_packets_(state.phase_packets),
      phase_began_us_(state.phase_began_us) {}

PacketSealer::State PacketSealer::state() const {
  return {key_, index_, counter_, phase_, phase_packets_, phase_began_us_};
}

SealStatus PacketSealer::Seal(PacketKind kind, ByteSpan packet, std::int64_t now_us) {
  if (packet.size() < kPacketOverheadBytes || packet.size() > kMaxPacketBytes) {
    return SealStatus::kBadSize;
  }
  if (counter_ > kMaxCounter) return SealStatus::kExhausted;
  ChangeKeyIfDue(now_us);
  WritePacketHeader({kind, phase_, index_, counter_}, packet);
  const ByteSpan inner = packet.subspan(kPacketHeaderBytes, packet.size() - kPacketOverheadBytes);
  secure::Seal(key_, counter_, packet.first(kPacketHeaderBytes), inner, packet.last<kTagBytes>());
  ++counter_;
  ++phase_packets_;
  return SealStatus::kOk;
}

void PacketSealer::ChangeKeyIfDue(std::int64_t now_us) {
  if (phase_packets_ < limits_.packets && now_us - phase_began_us_ < limits_.microseconds) return;
  key_ = NextKey(key_);
  phase_ = !phase_;
  phase_packets_ = 0;
  phase_began_us_ = now_us;
}

}  // namespace furrow::protocol::secure
