// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client/cpp/introduction.h"
#include "client/cpp/transport.h"
#include "protocol/codec/codec.h"

namespace furrow::client {

// What Subscriber::Next() received. The message of this kind is valid until the next call.
struct Event {
  enum class Kind {
    kTimeout,       // nothing arrived in time
    kReply,         // reply(): a subscription started, or its names changed
    kWeights,       // weights()
    kPicture,       // picture()
    kSkeleton,      // skeleton(): describes the poses that follow
    kPose,          // pose(); payload() holds the published bytes
    kDropped,       // dropped(): frames lost by a subscription to every frame
    kSubjects,      // subjects(): the list of subjects
    kError,         // error(): request `header.sequence` or subscription `header.stream` failed
    kGoodbye,       // goodbye()
    kConnected,     // reconnecting transports: the daemon answered, at first or after a loss
    kClosed,        // TCP: the daemon closed the connection, or sent nothing for 15 s
    kNoConnection,  // UDP: the port is closed, or the daemon sent nothing for 15 s; reconnecting
                    // transports: there is no connection at present
  };
  Kind kind = Kind::kTimeout;
  protocol::Header header;  // `stream`: subscription; `sequence` and capture time: of the pose
};

// Receives weights, poses and pictures from a daemon. Pictures need TCP.
//
//   Subscriber subscriber(std::move(transport), "my engine 1.0");
//   subscriber.Subscribe(protocol::SubscribeWeights{.subject = "ada"});
//   for (;;) { const Event event = subscriber.Next(now_us, 16ms); ... }
//
// Over UDP it first proves its address, then answers challenges and repeats requests whose answers
// were lost. After a restart of the daemon it repeats all requests.
//
// With a transport that reconnects it outlives every loss: Next() then reports kNoConnection, later
// kConnected, and all subscriptions resume. They wait for their subjects then, even those that were
// made without `wait`, because the publishers also need a moment to come back.
//
// Time is a parameter: microseconds of any monotonic clock. The class starts no thread and must be
// used on one thread.
class Subscriber {
 public:
  // `transport`: not null. `name`: of this program, for the daemon's log.
  Subscriber(std::unique_ptr<Transport> transport, std::string name);

  // Sends a request for weights, pictures or poses. Returns the number of the request; the answer
  // repeats the number in header.sequence.
  std::uint32_t Subscribe(const protocol::SubscribeWeights& request);
  std::uint32_t Subscribe(const protocol::SubscribePictures& request);
  std::uint32_t Subscribe(const protocol::SubscribePoses& request);
  // Ends a subscription, named by header.stream of its events.
  void Unsubscribe(std::uint16_t subscription);
  // Ends the subscription of a request, even if the daemon has not answered it yet. A reply that is
  // under way still arrives; pass its header.stream to Unsubscribe().
  void Cancel(std::uint32_t request);
  // Requests the list of subjects. With `follow` the daemon sends the list again at every change.
  // Needs TCP: over UDP the daemon answers with an error.
  std::uint32_t ListSubjects(bool follow);

  // Waits up to `wait` for the next message and returns what it is; kTimeout if nothing arrived.
  // Also keeps the connection alive, so call it at least once per second.
  [[nodiscard]] Event Next(std::int64_t now_us, std::chrono::milliseconds wait);

  // The message of the last event, each valid only if Event::Kind names it, until the next Next().
  [[nodiscard]] const protocol::SubscribeReply& reply() const { return reply_; }
  [[nodiscard]] const protocol::WeightFrame& weights() const { return weights_; }
  [[nodiscard]] const protocol::ImageFrame& picture() const { return picture_; }
  [[nodiscard]] const protocol::SkeletonOffer& skeleton() const { return skeleton_; }
  [[nodiscard]] const protocol::PoseFrame& pose() const { return pose_; }
  [[nodiscard]] const protocol::Dropped& dropped() const { return dropped_; }
  [[nodiscard]] const protocol::Subjects& subjects() const { return subjects_; }
  // Its message is never empty.
  [[nodiscard]] const protocol::ErrorMessage& error() const { return error_; }
  [[nodiscard]] const protocol::Goodbye& goodbye() const { return goodbye_; }

  // The FlatBuffers buffer of the message that the last event names; valid until the next call.
  [[nodiscard]] std::span<const std::uint8_t> payload() const { return payload_; }

  // True if a lost connection is made again.
  [[nodiscard]] bool reconnects() const { return transport_->reconnects(); }
  // Transport::failure().
  [[nodiscard]] std::string failure() const { return transport_->failure(); }
  // Why the daemon refuses the token; empty if it does not. Nothing proves it.
  [[nodiscard]] std::string refusal() const { return RefusedTokenText(transport_->refusal()); }

  // Number of messages dropped because they could not be decoded.
  [[nodiscard]] std::uint64_t malformed() const { return malformed_; }

 private:
  // A request is kept as long as its subscription, so that it can be repeated.
  struct Request {
    std::uint32_t number = 0;
    bool wait = false;
    bool waiting = true;  // no answer yet
    std::uint16_t subscription = 0;
    std::string subject;
    std::string served;            // the subject of the last reply; `subject` may be empty
    std::uint64_t epoch = 0;       // the highest one that served it
    bool fenced = false;           // the daemon has a lower one, so its frames are dropped
    std::uint64_t names_hash = 0;  // hash of the names, or of the skeleton
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint8_t> resumed;  // as `bytes`, with `wait`; replaces them after a loss
  };

  template <class Message>
  std::uint32_t Ask(const Message& message);
  void SendWaiting();
  void ResumeAll();
  void ProveAgain();
  void StartOver();
  void OnNoConnection();
  // Sends pings; over UDP also repeats the hello and unanswered requests.
  void Maintain(std::int64_t now_us);
  [[nodiscard]] Event::Kind OnTimeout(std::int64_t now_us);
  void NoticeRestart(std::uint64_t server_session);
  bool Handle(std::span<const std::uint8_t> message, Event& event);
  std::optional<protocol::DecodeStatus> Read(const protocol::MessageView& view, Event::Kind& kind);
  bool TakeIn(const protocol::Header& header, Event::Kind kind);
  bool HandleWelcome(const protocol::MessageView& view, Event& event);
  void HandlePing(const protocol::MessageView& view);
  [[nodiscard]] bool OnReply(const protocol::Header& header);
  [[nodiscard]] bool IsFenced(std::uint16_t subscription) const;
  [[nodiscard]] bool Follow(const protocol::Header& header);
  void OnSkeleton(std::uint16_t subscription);
  void OnFrame(std::uint16_t subscription, std::uint64_t hash);
  [[nodiscard]] bool OnError(const protocol::Header& header);
  [[nodiscard]] bool OnGoodbye(std::uint16_t subscription);

  std::unique_ptr<Transport> transport_;
  protocol::Encoder encoder_;
  std::uint64_t session_;
  std::uint32_t next_request_ = 1;
  std::vector<Request> requests_;
  std::vector<std::uint8_t> list_;    // the request to follow the list of subjects; empty: none
  std::uint64_t generation_;          // of the transport's connection that the requests went to
  bool answered_ = false;             // the daemon has answered since the last loss
  std::uint64_t server_session_ = 0;  // 0: unknown
  Introduction introduction_;
  std::int64_t last_sent_us_ = 0;
  std::int64_t now_us_ = 0;             // of the last Next()
  std::int64_t last_challenge_us_ = 0;  // or when requests were repeated for lack of one
  std::optional<std::int64_t> unanswered_since_us_;  // oldest send without any message since
  bool started_ = false;
  bool sent_away_ = false;  // the daemon has named another one, and none has answered since
  std::uint64_t malformed_ = 0;

  std::vector<std::uint8_t> bytes_;
  protocol::SubscribeReply reply_;
  protocol::WeightFrame weights_;
  protocol::ImageFrame picture_;
  protocol::SkeletonOffer skeleton_;
  protocol::PoseFrame pose_;
  protocol::Dropped dropped_;
  protocol::Subjects subjects_;
  std::span<const std::uint8_t> payload_;
  protocol::ErrorMessage error_;
  protocol::Goodbye goodbye_;
};

}  // namespace furrow::client
