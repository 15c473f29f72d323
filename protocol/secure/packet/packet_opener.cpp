// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/packet/packet_opener.h"

#include "protocol/secure/noise/cipher_state.h"

namespace furrow::protocol::secure {

PacketOpener::PacketOpener(const Key& key, std::uint64_t max_failures)
    : current_(key), next_(NextKey(key)), max_failures_(max_failures) {}

PacketOpener::PacketOpener(const State& state, std::uint64_t max_failures)
    : previous_(state.previous),
      current_(state.current),
      next_(NextKey(state.current)),
      phase_(state.phase),
      has_previous_(state.has_previous),
      phase_first_counter_(state.phase_first_counter),
      turned_us_(state.turned_us),
      window_(state.window),
      failures_(state.failures),
      max_failures_(max_failures) {}

PacketOpener::State PacketOpener::state() const {
  return {previous_,  current_,        phase_,   has_previous_, phase_first_counter_,
          turned_us_, window_.state(), failures_};
}

OpenStatus PacketOpener::Open(ByteSpan packet, std::int64_t now_us, OpenedPacket& opened) {
  if (failures_ >= max_failures_) return OpenStatus::kExhausted;
  PacketHeader header;
  if (!ReadPacketHeader(packet, header) || header.counter > kMaxCounter) {
    return OpenStatus::kBadHeader;
  }
  switch (window_.Check(header.counter)) {
    case ReplayWindow::Answer::kNew: break;
    case ReplayWindow::Answer::kDuplicate: return OpenStatus::kDuplicate;
    case ReplayWindow::Answer::kTooOld: return OpenStatus::kTooOld;
  }
  const Key* const key = KeyFor(header, now_us);
  if (key == nullptr) return OpenStatus::kOldKey;
  const ByteSpan inner = packet.subspan(kPacketHeaderBytes, packet.size() - kPacketOverheadBytes);
  if (!secure::Open(*key, header.counter, packet.first(kPacketHeaderBytes), inner,
                    packet.last<kTagBytes>())) {
    ++failures_;
    return OpenStatus::kNotAuthentic;
  }
  if (key == &next_) TurnTo(header, now_us);
  window_.Mark(header.counter);
  opened = {header.kind, header.counter, inner};
  return OpenStatus::kOk;
}

// The phase bit alone leaves two keys for a packet of the other phase. The former key was used only
// for smaller counters than the present one.
const Key* PacketOpener::KeyFor(const PacketHeader& header, std::int64_t now_us) const {
  if (header.phase == phase_) return &current_;
  const bool is_older = has_previous_ && header.counter < phase_first_counter_;
  if (!is_older) return &next_;
  return now_us - turned_us_ < kOldKeyMicroseconds ? &previous_ : nullptr;
}

void PacketOpener::TurnTo(const PacketHeader& header, std::int64_t now_us) {
  previous_ = current_;
  current_ = next_;
  next_ = NextKey(current_);
  phase_ = !phase_;
  has_previous_ = true;
  phase_first_counter_ = header.counter;
  turned_us_ = now_us;
}

}  // namespace furrow::protocol::secure
