// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client/cpp/transport.h"
#include "protocol/codec/codec.h"

namespace furrow::client {

// What Subscriber::Next() found. The message that `kind` names is valid until the next call.
struct Event {
  enum class Kind {
    kTimeout,       // nothing in the time given
    kReply,         // reply(): a subscription began, or its names changed
    kWeights,       // weights()
    kPicture,       // picture()
    kSkeleton,      // skeleton(): what the poses that follow mean
    kPose,          // pose(), and payload() as it was published
    kDropped,       // dropped(): of a subscription to every frame
    kSubjects,      // subjects(): who is there
    kError,         // error(): request `header.sequence`, or subscription `header.stream`, failed
    kGoodbye,       // goodbye()
    kClosed,        // TCP: the daemon closed the connection, or answers nothing for 15 s
    kNoConnection,  // UDP: nobody listens there, or answers for 15 s
  };
  Kind kind = Kind::kTimeout;
  protocol::Header header;  // stream: the subscription; sequence and capture time: the pose's
};

// Receives weights, poses and pictures from a daemon; pictures over TCP alone.
//
//   Subscriber subscriber(std::move(transport), "my engine 1.0");
//   subscriber.Subscribe(protocol::SubscribeWeights{.subject = "ada"});
//   for (;;) { const Event event = subscriber.Next(now_us, 16ms); ... }
//
// Over UDP it proves its address first and keeps its lease; what was lost is asked for again: an
// answer, the names of weights that came, or everything where the daemon was restarted. Time is a
// parameter (microseconds on any clock that does not go back); no thread, one thread.
class Subscriber {
 public:
  Subscriber(std::unique_ptr<Transport> transport, std::string name);

  // Ask, and get the request's number, which the answer repeats in header.sequence.
  std::uint32_t Subscribe(const protocol::SubscribeWeights& request);
  std::uint32_t Subscribe(const protocol::SubscribePictures& request);
  std::uint32_t Subscribe(const protocol::SubscribePoses& request);
  void Unsubscribe(std::uint16_t subscription);
  // Asks who is there; `follow`: again whenever somebody comes or goes. Over TCP (over UDP the
  // daemon answers with an error).
  std::uint32_t ListSubjects(bool follow);

  [[nodiscard]] Event Next(std::int64_t now_us, std::chrono::milliseconds wait);

  [[nodiscard]] const protocol::SubscribeReply& reply() const { return reply_; }
  [[nodiscard]] const protocol::WeightFrame& weights() const { return weights_; }
  [[nodiscard]] const protocol::ImageFrame& picture() const { return picture_; }
  [[nodiscard]] const protocol::SkeletonOffer& skeleton() const { return skeleton_; }
  [[nodiscard]] const protocol::PoseFrame& pose() const { return pose_; }
  [[nodiscard]] const protocol::Dropped& dropped() const { return dropped_; }
  [[nodiscard]] const protocol::Subjects& subjects() const { return subjects_; }
  [[nodiscard]] const protocol::ErrorMessage& error() const { return error_; }
  [[nodiscard]] const protocol::Goodbye& goodbye() const { return goodbye_; }

  // The FlatBuffers buffer of the message that the last event names; valid until the next call.
  [[nodiscard]] std::span<const std::uint8_t> payload() const { return payload_; }

  // Messages that could not be decoded, and so were dropped.
  [[nodiscard]] std::uint64_t malformed() const { return malformed_; }

 private:
  // Kept as long as its subscription, so that it can be repeated.
  struct Request {
    std::uint32_t number = 0;
    bool wait = false;
    bool waiting = true;  // for an answer
    std::uint16_t subscription = 0;
    std::uint64_t names_hash = 0;  // or the skeleton's
    std::vector<std::uint8_t> bytes;
  };

  template <class Message>
  std::uint32_t Ask(const Message& message);
  void SendHello();
  void SendWaiting();
  void ProveAgain();
  void Maintain(std::int64_t now_us);  // pings; over UDP hello and requests without answer, too
  [[nodiscard]] Event::Kind Silence(std::int64_t now_us) const;
  void NoticeRestart(std::uint64_t server_session);
  bool Handle(std::span<const std::uint8_t> message, Event& event);
  bool HandleWelcome(const protocol::MessageView& view);
  void OnReply(const protocol::Header& header);
  void OnSkeleton(std::uint16_t subscription);
  void OnFrame(std::uint16_t subscription, std::uint64_t hash);
  [[nodiscard]] bool OnError(const protocol::Header& header);
  void OnGoodbye(std::uint16_t subscription);

  std::unique_ptr<Transport> transport_;
  std::string name_;
  protocol::Encoder encoder_;
  std::uint64_t session_;
  std::uint32_t next_request_ = 1;
  std::vector<Request> requests_;
  std::uint64_t server_session_ = 0;  // 0: not heard yet
  bool proven_;
  std::uint64_t token_ = 0;
  std::int64_t last_sent_us_ = 0;
  std::optional<std::int64_t> unanswered_since_us_;  // when something was sent, nothing heard since
  bool started_ = false;
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
