// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/cpp/introduction.h"
#include "client/cpp/transport.h"
#include "protocol/codec/codec.h"

namespace furrow::client {

// Sends the poses of one or several subjects to a daemon. Over UDP it first proves its address.
//
//   Publisher publisher(std::move(transport));
//   auto stream = publisher.AddSubject(offer, now_us);
//   publisher.Poll(now_us, 100ms);                 // until accepted(stream)
//   publisher.Send(stream, pose, capture_time_us);
//
// With a transport that reconnects, the publisher outlives every loss: it offers all subjects again
// on each connection, and their numbering continues. While the daemon sends it to another server
// of its cluster, poses wait for that server, for at most kMovePatience. Those that are on their
// way to the former server when it hands the subject over are lost.
//
// Time is a parameter: microseconds of any monotonic clock. The class starts no thread and must be
// used on one thread.
class Publisher {
 public:
  // `transport`: not null. `name`: program and version, for the daemon's log.
  explicit Publisher(std::unique_ptr<Transport> transport, std::string name = "furrow publisher");

  // Offers a subject and returns its stream number. Poll() repeats the offer until the daemon
  // answers, those of more than 160 unanswered streams in turn, and again whenever the daemon asks
  // for it, for example after a restart.
  std::uint16_t AddSubject(const protocol::SkeletonOffer& offer, std::int64_t now_us);

  // Sends one pose of a stream that AddSubject() returned. Poses are numbered from 0 per stream.
  // Sets `pose.skeleton_hash`. `capture_time_us`: when the pose was captured, microseconds of any
  // clock that the sender uses for all of its poses. Before the daemon accepts the stream, it drops
  // poses. `repeat_previous`: over UDP, the datagram also holds the stream's pose before, if both
  // fit and are whole, so that a lost datagram loses no pose; both are quantised.
  [[nodiscard]] IoStatus Send(std::uint16_t stream, protocol::PoseFrame& pose,
                              std::int64_t capture_time_us,
                              const protocol::PoseEncoding& encoding = {},
                              bool repeat_previous = false);

  // Reads answers for up to `wait`, 256 at most, and repeats unanswered offers. Call it between
  // poses. On its way to another server, it waits a few milliseconds for each answer. kOk and
  // kTimeout are both normal. kNoConnection over UDP means that the port is closed at present.
  IoStatus Poll(std::int64_t now_us, std::chrono::milliseconds wait);

  // Sends a goodbye for one stream. The stream stays rejected with the reason `why`.
  void Withdraw(std::uint16_t stream, const std::string& why);

  // Sends a goodbye for every stream, so that subscribers learn at once that the subjects left.
  void Close();

  // True if the daemon has accepted the offer of the stream.
  [[nodiscard]] bool accepted(std::uint16_t stream) const;
  // Why the daemon rejected the stream, or why the offer could not be sent; empty if neither
  // happened.
  [[nodiscard]] const std::string& rejection(std::uint16_t stream) const;
  // True if the offer was not sent because it is larger than the transport carries.
  [[nodiscard]] bool oversized(std::uint16_t stream) const;
  // True if the daemon wants a token, or another one. The transport, which shows it, goes on
  // trying.
  [[nodiscard]] bool needs_token() const { return needs_token_; }
  // Why the daemon refuses the token; empty if it does not. Nothing proves it.
  [[nodiscard]] std::string refusal() const { return RefusedTokenText(transport_->refusal()); }
  // The last error message of the daemon; empty if there was none.
  [[nodiscard]] const std::string& last_error() const { return last_error_; }
  // The random session number in every message of this publisher.
  [[nodiscard]] std::uint64_t session() const { return session_; }

 private:
  struct Stream {
    std::vector<std::uint8_t> offer;  // encoded
    std::uint64_t skeleton_hash = 0;
    std::int64_t offered_us = 0;
    std::uint32_t next_sequence = 0;
    std::vector<std::uint8_t> previous;  // payload of the last pose; empty: not kept
    std::int64_t previous_capture_us = 0;
    bool accepted = false;
    std::string rejection;
    bool oversized = false;
  };

  void RepeatPrevious(Stream& stream, const protocol::Header& header, protocol::PoseFrame& pose);
  void SendOffer(Stream& stream, std::int64_t now_us);
  void OfferAll(std::int64_t now_us);
  void RepeatOffers(std::int64_t now_us);
  void Introduce(std::int64_t now_us);
  void StartOver(std::int64_t now_us);
  void OnError(const protocol::Header& header, std::int64_t now_us);
  [[nodiscard]] bool IsFromServer(const protocol::Header& header) const;
  [[nodiscard]] bool Follow(const protocol::Header& header);
  void WatchServer(std::int64_t now_us);
  [[nodiscard]] std::chrono::milliseconds MovePause() const;
  void EndMove();
  void OnReply(const protocol::Header& header, std::int64_t now_us);
  static void OnOversized(Stream& stream);
  static constexpr std::int64_t kMovePatience = 1'000'000;  // microseconds
  static constexpr std::size_t kMostWaiting = 64;
  static constexpr std::size_t kOffersPerRound = 160;  // 800 per second
  void SendGoodbye(std::size_t stream);
  void Handle(std::span<const std::uint8_t> message, std::int64_t now_us);

  std::unique_ptr<Transport> transport_;
  protocol::Encoder encoder_;
  std::uint64_t session_;
  Introduction introduction_;
  std::uint64_t server_session_ = 0;           // of the daemon that has proven the address
  std::optional<std::int64_t> introduced_us_;  // when the last Hello was sent
  std::uint64_t generation_;  // of the transport's connection that the offers went to
  std::vector<Stream> streams_;
  // Of repeated offers: when the round began, how many it may still send, and the next stream.
  std::int64_t round_us_ = 0;
  std::size_t offers_left_ = kOffersPerRound;
  std::size_t next_offer_ = 0;
  std::vector<std::uint8_t> bytes_;
  std::vector<std::uint8_t> alone_;  // a message without the pose that it could repeat
  protocol::SkeletonReply reply_;
  protocol::Welcome welcome_;
  protocol::Ping ping_;
  protocol::ErrorMessage error_;
  std::string last_error_;
  bool needs_token_ = false;
  // Since when it has been on its way to another server, and the poses that wait for it.
  std::optional<std::int64_t> moving_since_us_;
  std::deque<std::vector<std::uint8_t>> waiting_;
  // With other servers to go to: the last call of WatchServer(), and when this server was heard and
  // asked last.
  std::int64_t watched_us_ = 0;
  std::int64_t heard_us_ = 0;
  std::int64_t asked_us_ = 0;
};

// Returns a random session number, never 0. A new number at each start lets the daemon tell a
// restart from a replay.
[[nodiscard]] std::uint64_t NewSession();

}  // namespace furrow::client
