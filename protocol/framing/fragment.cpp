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

FragmentStatus Reassembler::Push(const FragmentSource& source,
                                 std::span<const std::uint8_t> datagram, std::int64_t now_us,
                                 std::span<const std::uint8_t>& message) {
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
  const Key key{source, envelope.header.session, slice.message_id};
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
  done_.swap(pending.bytes);  // the bytes become the result without a copy
  Remove(pending);
  message = done_;
  return FragmentStatus::kComplete;
}

Reassembler::Pending& Reassembler::Begin(const Key& key, const Envelope& envelope,
                                         std::size_t count, std::int64_t now_us) {
  evicted_ += DropOld(now_us);  // between two calls of Expire(), too
  PendingMap made = Make(key, envelope, count, now_us);
  Pending& pending = made.begin()->second;  // stays where it is
  MakeRoom(pending.stream(), pending.size());
  Link(std::move(made));
  return pending;
}

Reassembler::PendingMap Reassembler::Make(const Key& key, const Envelope& envelope,
                                          std::size_t count, std::int64_t now_us) {
  PendingMap made;
  Pending& pending = made[key];
  pending.key = key;
  pending.envelope = envelope;
  pending.first_us = now_us;
  pending.missing = count;
  pending.have.resize(count);
  pending.bytes.resize(pending.size());
  // The assembled message has the envelope of an unfragmented one.
  Envelope whole = envelope;
  whole.flags = 0;
  WriteEnvelope(whole,
                std::span<std::uint8_t, kEnvelopeBytes>(pending.bytes.data(), kEnvelopeBytes));
  return made;
}

// Lack of memory leaves everything as it was: all nodes are allocated before the first one is
// linked.
void Reassembler::Link(PendingMap made) {
  Pending& pending = made.begin()->second;
  const FragmentSource& source = pending.key.source;
  const StreamKey stream_key = pending.stream();
  List places(4, &pending);
  const auto new_rank = [] {
    Ranks one = {Rank{}};
    return one.extract(one.begin());
  };
  decltype(hosts_) new_host;
  decltype(peers_) new_peer;
  decltype(streams_) new_stream;
  if (!hosts_.contains(source.host)) new_host[source.host].rank = new_rank();
  if (!peers_.contains(source)) new_peer[source].rank = new_rank();
  if (!streams_.contains(stream_key)) (void)new_stream[stream_key];

  pending_.merge(made);
  hosts_.merge(new_host);
  peers_.merge(new_peer);
  streams_.merge(new_stream);
  TakeRanks(source);
  pending.number = next_number_++;
  const auto append = [&](Queue& queue) {
    queue.by_age.splice(queue.by_age.end(), places, places.begin());
    queue.bytes += pending.size();
    return std::prev(queue.by_age.end());
  };
  pending.in_all = append(all_);
  pending.in_host = append(hosts_.find(source.host)->second);
  pending.in_peer = append(peers_.find(source)->second);
  pending.in_stream = append(streams_.find(stream_key)->second);
  PutRanks(source);
}

// Drops the oldest messages. The fragments of one message arrive close together, so the oldest has
// lost a fragment, and a flood of first fragments mostly evicts other first fragments. Rejecting
// new messages instead would let a few datagrams per second from many ports block every large
// message. If the memory of all is used up, the host with the most gives, so a flood from a few
// hosts takes nothing from others, through however many ports (longest queue drop; Suter, Lakshman,
// Stiliadis and Choudhury, "Buffer management schemes for supporting TCP in gigabit routers with
// per-flow queueing", 1999).
void Reassembler::MakeRoom(const StreamKey& stream, std::size_t bytes) {
  if (const auto found = streams_.find(stream); found != streams_.end()) {
    Shrink(found->second, limits_.max_stream_bytes - bytes);
  }
  if (const auto found = peers_.find(stream.source); found != peers_.end()) {
    Shrink(found->second, limits_.max_peer_bytes - bytes);
  }
  while (all_.bytes > limits_.max_total_bytes - bytes) {
    const std::uint64_t host = ranks_.rbegin()->id;
    const std::uint64_t peer = hosts_.find(host)->second.peers.rbegin()->id;
    Remove(*peers_.find({host, peer})->second.by_age.front());
    ++evicted_;
  }
}

void Reassembler::TakeRanks(const FragmentSource& source) {
  // A new queue has its node already.
  const auto take = [](RankedQueue& queue, std::uint64_t id, Ranks& ranks) {
    if (queue.by_age.empty()) return;
    queue.rank = ranks.extract(Rank{queue.bytes, ~queue.by_age.front()->number, id});
  };
  Host& host = hosts_.find(source.host)->second;
  take(host, source.host, ranks_);
  take(peers_.find(source)->second, source.peer, host.peers);
}

void Reassembler::PutRanks(const FragmentSource& source) {
  const auto put = [](RankedQueue& queue, std::uint64_t id, Ranks& ranks) {
    queue.rank.value() = {queue.bytes, ~queue.by_age.front()->number, id};
    ranks.insert(std::move(queue.rank));
  };
  const auto host = hosts_.find(source.host);
  if (host == hosts_.end()) return;
  put(host->second, source.host, ranks_);
  const auto peer = peers_.find(source);
  if (peer != peers_.end()) put(peer->second, source.peer, host->second.peers);
}

// Removes the oldest messages of `queue` until at most `max_bytes` are left. Remove() erases a
// queue with its last message, so the loop looks at the queue only while messages are left.
void Reassembler::Shrink(const Queue& queue, std::size_t max_bytes) {
  for (std::size_t left = queue.bytes; left > max_bytes;) {
    const Pending& oldest = *queue.by_age.front();
    left -= oldest.size();
    Remove(oldest);
    ++evicted_;
  }
}

void Reassembler::Remove(const Pending& pending) {
  const FragmentSource source = pending.key.source;
  TakeRanks(source);
  const auto leave = [&](Queue& queue, List::iterator position) {
    queue.by_age.erase(position);
    queue.bytes -= pending.size();
  };
  const auto leave_one = [&](auto& queues, const auto& key, List::iterator position) {
    const auto queue = queues.find(key);
    leave(queue->second, position);
    if (queue->second.by_age.empty()) queues.erase(queue);
  };
  leave(all_, pending.in_all);
  leave_one(hosts_, source.host, pending.in_host);
  leave_one(peers_, source, pending.in_peer);
  leave_one(streams_, pending.stream(), pending.in_stream);
  pending_.erase(pending_.find(pending.key));
  PutRanks(source);
}

std::size_t Reassembler::DropOld(std::int64_t now_us) {
  std::size_t dropped = 0;
  while (!all_.by_age.empty()) {
    const Pending& oldest = *all_.by_age.front();
    if (now_us - oldest.first_us <= limits_.max_age_us) break;
    Remove(oldest);
    ++dropped;
  }
  return dropped;
}

std::size_t Reassembler::Expire(std::int64_t now_us) {
  return DropOld(now_us) + std::exchange(evicted_, 0);
}

void Reassembler::ForgetPeer(const FragmentSource& source) {
  auto it = pending_.lower_bound(Key{source, 0, 0});
  while (it != pending_.end() && it->first.source == source) {
    const auto next = std::next(it);
    Remove(it->second);
    it = next;
  }
}

}  // namespace furrow::protocol
