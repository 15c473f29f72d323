// SPDX-License-Identifier: Apache-2.0
#include "protocol/framing/fragment.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include "protocol/messages/bytes.h"

namespace furrow::protocol {
namespace {

constexpr std::size_t kSliceOffset = kEnvelopeBytes + kFragmentHeaderBytes;

struct Slice {
  std::uint32_t message_id = 0;
  std::size_t index = 0;
  std::size_t count = 0;
  std::span<const std::uint8_t> bytes;
};

std::size_t CountFor(std::size_t payload_bytes) {
  return (payload_bytes + kFragmentPayloadBytes - 1) / kFragmentPayloadBytes;
}

std::size_t SliceBytes(std::size_t payload_bytes, std::size_t index) {
  return std::min(kFragmentPayloadBytes, payload_bytes - index * kFragmentPayloadBytes);
}

// Returns false unless all numbers agree with the payload size.
bool ReadSlice(std::span<const std::uint8_t> datagram, const Envelope& envelope,
               std::size_t max_message_bytes, Slice& slice) {
  const std::size_t payload = envelope.payload_bytes;
  if (datagram.size() < kSliceOffset) return false;
  // A message that fits one datagram must not be fragmented: one form per message.
  if (payload + kEnvelopeBytes <= kMaxDatagramBytes) return false;
  // Before any allocation, because the size is only a claim.
  if (payload > max_message_bytes - kEnvelopeBytes) return false;
  const std::uint8_t* at = datagram.data() + kEnvelopeBytes;
  slice.message_id = LoadLittle<std::uint32_t>(at);
  slice.index = LoadLittle<std::uint16_t>(at + 4);
  slice.count = LoadLittle<std::uint16_t>(at + 6);
  if (slice.count != CountFor(payload) || slice.index >= slice.count) return false;
  slice.bytes = datagram.subspan(kSliceOffset);
  return slice.bytes.size() == SliceBytes(payload, slice.index);
}

}  // namespace

std::size_t NumDatagrams(std::size_t message_bytes) {
  return message_bytes <= kMaxDatagramBytes ? 1 : CountFor(message_bytes - kEnvelopeBytes);
}

std::size_t WriteDatagram(std::span<const std::uint8_t> message, std::uint32_t message_id,
                          std::size_t index, std::span<std::uint8_t> out) {
  const std::size_t count = NumDatagrams(message.size());
  if (count == 1) {
    std::memcpy(out.data(), message.data(), message.size());
    return message.size();
  }
  const std::span<const std::uint8_t> payload = message.subspan(kEnvelopeBytes);
  const std::size_t size = SliceBytes(payload.size(), index);
  std::memcpy(out.data(), message.data(), kEnvelopeBytes);
  out[5] |= kFlagFragment;
  StoreLittle(message_id, &out[kEnvelopeBytes]);
  StoreLittle(static_cast<std::uint16_t>(index), &out[kEnvelopeBytes + 4]);
  StoreLittle(static_cast<std::uint16_t>(count), &out[kEnvelopeBytes + 6]);
  std::memcpy(&out[kSliceOffset], payload.data() + index * kFragmentPayloadBytes, size);
  return kSliceOffset + size;
}

Reassembler::Reassembler(const ReassemblyLimits& limits) : limits_(limits) {}

FragmentStatus Reassembler::Push(std::uint64_t peer, std::span<const std::uint8_t> datagram,
                                 std::int64_t now_us, std::span<const std::uint8_t>& message) {
  Envelope envelope;
  if (ReadEnvelope(datagram, envelope) != EnvelopeStatus::kOk ||
      (envelope.flags & kFlagFragment) == 0) {
    message = datagram;  // OpenMessage() reports faults in it
    return FragmentStatus::kWhole;
  }
  Slice slice;
  if (!ReadSlice(datagram, envelope, limits_.max_message_bytes, slice)) {
    return FragmentStatus::kMalformed;
  }
  if (kEnvelopeBytes + envelope.payload_bytes >
      std::min({limits_.max_stream_bytes, limits_.max_peer_bytes, limits_.max_total_bytes})) {
    return FragmentStatus::kOverLimit;
  }
  const Key key{peer, envelope.header.session, slice.message_id};
  const auto found = pending_.find(key);
  Pending& pending =
      found != pending_.end() ? found->second : Begin(key, envelope, slice.count, now_us);
  // Fragments of one message repeat its envelope. Another envelope under the same id is a fault or
  // an attack.
  if (pending.envelope.header != envelope.header ||
      pending.envelope.payload_bytes != envelope.payload_bytes) {
    return FragmentStatus::kMalformed;
  }
  if (pending.have[slice.index]) return FragmentStatus::kDuplicate;
  pending.have[slice.index] = true;
  std::memcpy(&pending.bytes[kEnvelopeBytes + slice.index * kFragmentPayloadBytes],
              slice.bytes.data(), slice.bytes.size());
  if (--pending.missing > 0) return FragmentStatus::kPending;
  const auto complete = pending_.find(key);
  done_.swap(pending.bytes);  // the bytes become the result without a copy
  Remove(complete);
  message = done_;
  return FragmentStatus::kComplete;
}

Reassembler::Pending& Reassembler::Begin(const Key& key, const Envelope& envelope,
                                         std::size_t count, std::int64_t now_us) {
  const std::size_t bytes = kEnvelopeBytes + envelope.payload_bytes;
  const StreamKey stream_key = StreamOf(key, envelope);
  evicted_ += DropOld(now_us);  // between two calls of Expire(), too
  MakeRoom(stream_key, bytes);
  Pending& pending = pending_[key];
  const auto append = [&](Queue& queue) {
    queue.bytes += bytes;
    return queue.by_age.insert(queue.by_age.end(), key);
  };
  pending.in_all = append(all_);
  pending.in_peer = append(peers_[key.peer]);
  pending.in_stream = append(streams_[stream_key]);
  pending.envelope = envelope;
  pending.first_us = now_us;
  pending.missing = count;
  pending.have.resize(count);
  pending.bytes.resize(bytes);
  // The assembled message has the envelope of an unfragmented one.
  Envelope whole = envelope;
  whole.flags = 0;
  WriteEnvelope(whole,
                std::span<std::uint8_t, kEnvelopeBytes>(pending.bytes.data(), kEnvelopeBytes));
  return pending;
}

// Drops the oldest messages. The fragments of one message arrive close together, so the oldest has
// lost a fragment, and a flood of first fragments mostly evicts other first fragments. Rejecting
// new messages instead would let a few datagrams per second from many ports block every large
// message.
void Reassembler::MakeRoom(const StreamKey& stream, std::size_t bytes) {
  if (const auto found = streams_.find(stream); found != streams_.end()) {
    Shrink(found->second, limits_.max_stream_bytes - bytes);
  }
  if (const auto found = peers_.find(stream.peer); found != peers_.end()) {
    Shrink(found->second, limits_.max_peer_bytes - bytes);
  }
  Shrink(all_, limits_.max_total_bytes - bytes);
}

// Removes the oldest messages of `queue` until at most `max_bytes` are left. Remove() erases a
// queue with its last message, so the loop looks at the queue only while messages are left.
void Reassembler::Shrink(const Queue& queue, std::size_t max_bytes) {
  for (std::size_t left = queue.bytes; left > max_bytes;) {
    const auto oldest = pending_.find(queue.by_age.front());
    left -= kEnvelopeBytes + oldest->second.envelope.payload_bytes;
    Remove(oldest);
    ++evicted_;
  }
}

void Reassembler::Remove(PendingMap::iterator it) {
  const Pending& pending = it->second;
  const std::size_t bytes = kEnvelopeBytes + pending.envelope.payload_bytes;
  all_.by_age.erase(pending.in_all);
  all_.bytes -= bytes;
  const auto leave = [bytes](auto& queues, const auto& key, std::list<Key>::iterator position) {
    const auto queue = queues.find(key);
    queue->second.by_age.erase(position);
    queue->second.bytes -= bytes;
    if (queue->second.by_age.empty()) queues.erase(queue);
  };
  leave(peers_, it->first.peer, pending.in_peer);
  leave(streams_, StreamOf(it->first, pending.envelope), pending.in_stream);
  pending_.erase(it);
}

std::size_t Reassembler::DropOld(std::int64_t now_us) {
  std::size_t dropped = 0;
  while (!all_.by_age.empty()) {
    const auto oldest = pending_.find(all_.by_age.front());
    if (now_us - oldest->second.first_us <= limits_.max_age_us) break;
    Remove(oldest);
    ++dropped;
  }
  return dropped;
}

std::size_t Reassembler::Expire(std::int64_t now_us) {
  return DropOld(now_us) + std::exchange(evicted_, 0);
}

void Reassembler::ForgetPeer(std::uint64_t peer) {
  auto it = pending_.lower_bound(Key{peer, 0, 0});
  while (it != pending_.end() && it->first.peer == peer) {
    const auto next = std::next(it);
    Remove(it);
    it = next;
  }
}

}  // namespace furrow::protocol
