// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <set>
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

// Where a datagram comes from, in numbers that the caller assigns.
struct FragmentSource {
  std::uint64_t host = 0;  // which may have many peers
  std::uint64_t peer = 0;  // a source address
  friend auto operator<=>(const FragmentSource&, const FragmentSource&) = default;
};

// Limits of unfinished messages, envelopes included. If a message does not fit, the oldest
// unfinished messages make room: of its stream, then of its peer, then of the host that has the
// most, and there of the peer that has the most.
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

// Reassembles fragmented messages within bounded memory. If Push() throws for lack of memory, it
// has stored nothing, and the object can be used further.
class Reassembler {
 public:
  explicit Reassembler(const ReassemblyLimits& limits = {});
  Reassembler(const Reassembler&) = delete;
  Reassembler& operator=(const Reassembler&) = delete;

  // Takes one datagram. `now_us`: microseconds on any clock that never runs backwards. On kWhole
  // and kComplete, `message` is a complete message for OpenMessage(); kWhole: it is `datagram`
  // itself, kComplete: it is valid until the next call. Otherwise `message` is unchanged.
  [[nodiscard]] FragmentStatus Push(const FragmentSource& source,
                                    std::span<const std::uint8_t> datagram, std::int64_t now_us,
                                    std::span<const std::uint8_t>& message);

  // Drops unfinished messages above max_age_us. Returns the number of messages dropped since the
  // last call, for their age or for lack of memory. Call it about once per second.
  std::size_t Expire(std::int64_t now_us);
  // Drops the unfinished messages of a peer.
  void ForgetPeer(const FragmentSource& source);

  [[nodiscard]] std::size_t pending_messages() const { return pending_.size(); }
  [[nodiscard]] std::size_t pending_bytes() const { return all_.bytes; }

 private:
  struct Key {
    FragmentSource source;
    std::uint64_t session = 0;
    std::uint32_t message_id = 0;
    friend auto operator<=>(const Key&, const Key&) = default;
  };
  struct StreamKey {
    FragmentSource source;
    std::uint64_t session = 0;
    std::uint16_t stream = 0;
    friend auto operator<=>(const StreamKey&, const StreamKey&) = default;
  };
  struct Pending;
  using List = std::list<Pending*>;
  // The unfinished messages that share one limit, oldest first.
  struct Queue {
    List by_age;
    std::size_t bytes = 0;
  };
  // Orders hosts, and the peers of a host, by their memory, those of equal memory by the age of
  // their oldest message.
  struct Rank {
    std::size_t bytes = 0;
    std::uint64_t age = 0;  // larger for an older message
    std::uint64_t id = 0;   // of the host or the peer
    friend auto operator<=>(const Rank&, const Rank&) = default;
  };
  using Ranks = std::set<Rank>;
  // A queue that has a rank. It keeps the node of the rank while it changes, because a change must
  // not fail for lack of memory.
  struct RankedQueue : Queue {
    Ranks::node_type rank;
  };
  struct Host : RankedQueue {
    Ranks peers;
  };
  struct Pending {
    Key key;
    std::uint64_t number = 0;  // of all messages, in the order of their first fragments
    // Positions in the queues of all messages, of its host, of its peer and of its stream.
    List::iterator in_all;
    List::iterator in_host;
    List::iterator in_peer;
    List::iterator in_stream;
    Envelope envelope;
    std::int64_t first_us = 0;
    std::size_t missing = 0;
    std::vector<bool> have;
    std::vector<std::uint8_t> bytes;  // envelope and payload
    [[nodiscard]] std::size_t size() const { return kEnvelopeBytes + envelope.payload_bytes; }
    [[nodiscard]] StreamKey stream() const {
      return {key.source, key.session, envelope.header.stream};
    }
  };
  using PendingMap = std::map<Key, Pending>;

  [[nodiscard]] Pending& Begin(const Key& key, const Envelope& envelope, std::size_t count,
                               std::int64_t now_us);
  [[nodiscard]] static PendingMap Make(const Key& key, const Envelope& envelope, std::size_t count,
                                       std::int64_t now_us);
  void Link(PendingMap made);
  std::size_t DropOld(std::int64_t now_us);
  void MakeRoom(const StreamKey& stream, std::size_t bytes);
  void Shrink(const Queue& queue, std::size_t max_bytes);
  // Takes the ranks of a source out of the orders before its queues change, and puts them back.
  void TakeRanks(const FragmentSource& source);
  void PutRanks(const FragmentSource& source);
  void Remove(const Pending& pending);

  ReassemblyLimits limits_;
  PendingMap pending_;
  Queue all_;
  // Entries without messages are removed.
  std::map<std::uint64_t, Host> hosts_;
  std::map<FragmentSource, RankedQueue> peers_;
  std::map<StreamKey, Queue> streams_;
  Ranks ranks_;  // of hosts_
  std::uint64_t next_number_ = 0;
  std::size_t evicted_ = 0;  // since the last Expire()
  std::vector<std::uint8_t> done_;
};

}  // namespace furrow::protocol
