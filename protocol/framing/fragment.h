// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <span>
#include <vector>

#include "protocol/framing/envelope.h"

namespace furrow::protocol {

// A fragment is one datagram of a message that is larger than kMaxDatagramBytes (STANDARD.md
// section 3). It holds the message's envelope with kFlagFragment set, u32 message id, u16 index,
// u16 count (all little-endian), and a slice of the payload. All slices except the last have
// kFragmentPayloadBytes. Every size and position therefore follows from the payload size in the
// envelope, and receivers reject fragments that contradict it.
inline constexpr std::size_t kFragmentHeaderBytes = 8;
inline constexpr std::size_t kFragmentPayloadBytes =
    kMaxDatagramBytes - kEnvelopeBytes - kFragmentHeaderBytes;

// The number of datagrams that a message of `message_bytes` (with its envelope) needs, at least 1.
[[nodiscard]] std::size_t NumDatagrams(std::size_t message_bytes);

// Writes datagram `index` of a message to the start of `out` and returns its size. `message`: what
// Encode() wrote, at most kMaxUdpMessageBytes. `index`: below NumDatagrams(message.size()).
// `message_id` must differ between the fragmented messages of a session; use a counter. `out` must
// have kMaxDatagramBytes. Nothing is checked.
std::size_t WriteDatagram(std::span<const std::uint8_t> message, std::uint32_t message_id,
                          std::size_t index, std::span<std::uint8_t> out);

// Limits of unfinished messages, envelopes included. If a message does not fit, the oldest
// unfinished messages make room: of its stream, then of its peer, then of all peers.
//
// A stream of full poses (5 kB, 60 Hz) needs 30 kB for those that are on their way with 100 ms of
// jitter; poses that lost a fragment take the rest. The largest message fits a stream. A peer with
// many streams shares max_peer_bytes.
struct ReassemblyLimits {
  std::size_t max_message_bytes = kMaxUdpMessageBytes;  // of one message
  std::size_t max_stream_bytes = kMaxUdpMessageBytes;   // of one stream of a peer's session
  std::size_t max_peer_bytes = 1024 * 1024;
  std::size_t max_total_bytes = 8 * 1024 * 1024;
  std::int64_t max_age_us = 500'000;  // unfinished messages are dropped after this time
};

enum class FragmentStatus : std::uint8_t {
  kWhole = 0,  // not a fragment: the datagram is the message
  kComplete,   // the last missing fragment: `message` is whole
  kPending,    // the fragment was stored; others are missing
  kDuplicate,  // dropped: this fragment was received before
  kMalformed,  // sizes contradict the envelope or earlier fragments
  kOverLimit,  // the message alone exceeds a limit of bytes
};

// Reassembles fragmented messages within bounded memory.
class Reassembler {
 public:
  explicit Reassembler(const ReassemblyLimits& limits = {});
  Reassembler(const Reassembler&) = delete;
  Reassembler& operator=(const Reassembler&) = delete;

  // Takes one datagram. `peer`: a number that the caller assigns to the source address. `now_us`:
  // microseconds on any clock that never runs backwards. On kWhole and kComplete, `message` is a
  // complete message for OpenMessage(); kWhole: it is `datagram` itself, kComplete: it is valid
  // until the next call. Otherwise `message` is unchanged.
  [[nodiscard]] FragmentStatus Push(std::uint64_t peer, std::span<const std::uint8_t> datagram,
                                    std::int64_t now_us, std::span<const std::uint8_t>& message);

  // Drops unfinished messages above max_age_us. Returns the number of messages dropped since the
  // last call, for their age or for lack of memory. Call it about once per second.
  std::size_t Expire(std::int64_t now_us);
  // Drops the unfinished messages of a peer.
  void ForgetPeer(std::uint64_t peer);

  [[nodiscard]] std::size_t pending_messages() const { return pending_.size(); }
  [[nodiscard]] std::size_t pending_bytes() const { return all_.bytes; }

 private:
  struct Key {
    std::uint64_t peer = 0;
    std::uint64_t session = 0;
    std::uint32_t message_id = 0;
    friend auto operator<=>(const Key&, const Key&) = default;
  };
  struct StreamKey {
    std::uint64_t peer = 0;
    std::uint64_t session = 0;
    std::uint16_t stream = 0;
    friend auto operator<=>(const StreamKey&, const StreamKey&) = default;
  };
  // The unfinished messages that share one limit, oldest first.
  struct Queue {
    std::list<Key> by_age;
    std::size_t bytes = 0;
  };
  struct Pending {
    // Positions in the queues of all peers, of its peer and of its stream.
    std::list<Key>::iterator in_all;
    std::list<Key>::iterator in_peer;
    std::list<Key>::iterator in_stream;
    Envelope envelope;
    std::int64_t first_us = 0;
    std::size_t missing = 0;
    std::vector<bool> have;
    std::vector<std::uint8_t> bytes;  // envelope and payload
  };
  using PendingMap = std::map<Key, Pending>;

  [[nodiscard]] Pending& Begin(const Key& key, const Envelope& envelope, std::size_t count,
                               std::int64_t now_us);
  std::size_t DropOld(std::int64_t now_us);
  void MakeRoom(const StreamKey& stream, std::size_t bytes);
  void Shrink(const Queue& queue, std::size_t max_bytes);
  void Remove(PendingMap::iterator it);
  [[nodiscard]] static StreamKey StreamOf(const Key& key, const Envelope& envelope) {
    return {key.peer, key.session, envelope.header.stream};
  }

  ReassemblyLimits limits_;
  PendingMap pending_;
  Queue all_;
  std::map<std::uint64_t, Queue> peers_;  // entries without messages are removed
  std::map<StreamKey, Queue> streams_;
  std::size_t evicted_ = 0;  // since the last Expire()
  std::vector<std::uint8_t> done_;
};

}  // namespace furrow::protocol
