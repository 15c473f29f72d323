// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "client/c/include/furrow/furrow.h"
#include "protocol/codec/codec.h"
#include "protocol/messages/hash.h"

namespace furrow::capi {

// The daemon's side of one UDP client, controlled by the test. It answers hellos, offers and
// subscriptions, and sends what the test tells it to send.
class FakeDaemon {
 public:
  explicit FakeDaemon(std::uint16_t port = 0, std::uint64_t session = 77)
      : session_(session), fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    socklen_t size = sizeof address;
    ::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~FakeDaemon() { ::close(fd_); }
  FakeDaemon(const FakeDaemon&) = delete;
  FakeDaemon& operator=(const FakeDaemon&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string address(const std::string& query = {}) const {
    return "furrow://127.0.0.1:" + std::to_string(port_) + query;
  }

  // What the daemon does with the next requests.
  std::vector<std::string> names = {"brow_l.squash", "brow_l.stretch"};
  protocol::ErrorCode reject{};        // 0: accept subscriptions
  protocol::ErrorCode reject_poses{};  // 0: accept subscriptions to poses
  protocol::SkeletonOffer skeleton;    // for a subscription to poses; none without a subject
  std::string chosen = "ada";          // for a subscription to the oldest subject

  // What has arrived.
  std::vector<protocol::SubscribeWeights> subscriptions;
  std::vector<protocol::SkeletonOffer> offers;
  std::vector<protocol::PoseFrame> poses;
  int unsubscribed = 0;
  int goodbyes = 0;

  // Reads and answers all datagrams that wait.
  void Step() {
    std::vector<std::uint8_t> bytes(65536);
    for (;;) {
      socklen_t size = sizeof client_;
      const ssize_t count = ::recvfrom(fd_, bytes.data(), bytes.size(), 0,
                                       reinterpret_cast<sockaddr*>(&client_), &size);
      if (count < 0) return;
      protocol::MessageView view;
      const auto message = std::span<const std::uint8_t>(bytes).first(static_cast<size_t>(count));
      if (protocol::OpenMessage(message, view) == protocol::DecodeStatus::kOk) Handle(view);
    }
  }

  template <class Message>
  void Send(protocol::Header header, const Message& message) {
    header.session = session_;
    std::vector<std::uint8_t> bytes;
    protocol::Encoder().Encode(header, message, bytes);
    SendBytes(bytes);
  }
  void SendBytes(std::span<const std::uint8_t> bytes) {
    ::sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&client_),
             sizeof client_);
  }
  // A frame of subscription `stream` (they count from 1), named as `names`.
  void SendWeights(std::uint16_t stream, std::uint32_t sequence, const std::vector<float>& values,
                   std::int64_t age_us = 0) {
    protocol::WeightFrame frame;
    frame.names_hash = protocol::NamesHash(names);
    frame.age_us = age_us;
    frame.values = values;
    Send({.stream = stream, .sequence = sequence, .capture_time_us = std::int64_t{sequence} * 1000},
         frame);
  }
  // Tells subscription `stream`, of request `sequence`, its names.
  void SendReply(std::uint16_t stream, std::uint32_t sequence, const std::string& subject) {
    protocol::SubscribeReply reply;
    reply.subject = subject;
    reply.names = names;
    Send({.stream = stream, .sequence = sequence}, reply);
  }

  std::vector<std::uint32_t> requests;  // sequence numbers of the subscriptions

 private:
  void Handle(const protocol::MessageView& view) {
    using protocol::MessageKind;
    switch (view.kind) {
      case MessageKind::kHello: Send({}, protocol::Welcome{.server = "fake"}); break;
      case MessageKind::kPing: Send({}, protocol::Pong{}); break;
      case MessageKind::kSubscribeWeights: OnSubscribe(view); break;
      case MessageKind::kSubscribePoses: OnSubscribePoses(view); break;
      case MessageKind::kUnsubscribe: ++unsubscribed; break;
      case MessageKind::kGoodbye: ++goodbyes; break;
      case MessageKind::kSkeletonOffer: {
        EXPECT_EQ(protocol::Decode(view, offers.emplace_back()), protocol::DecodeStatus::kOk);
        protocol::SkeletonReply reply;
        reply.skeleton_hash = offers.back().skeleton_hash;
        Send({.stream = view.header.stream}, reply);
        break;
      }
      case MessageKind::kPose:
        EXPECT_EQ(protocol::Decode(view, poses.emplace_back()), protocol::DecodeStatus::kOk);
        break;
      default: break;
    }
  }

  void OnSubscribe(const protocol::MessageView& view) {
    protocol::SubscribeWeights request;
    EXPECT_EQ(protocol::Decode(view, request), protocol::DecodeStatus::kOk);
    if (reject != protocol::ErrorCode{}) {
      return Send({.sequence = view.header.sequence},
                  protocol::ErrorMessage{reject, "rejected by the test"});
    }
    subscriptions.push_back(request);
    requests.push_back(view.header.sequence);
    SendReply(static_cast<std::uint16_t>(requests.size()), view.header.sequence,
              request.subject.empty() ? chosen : request.subject);
  }

  void OnSubscribePoses(const protocol::MessageView& view) {
    protocol::SubscribePoses request;
    EXPECT_EQ(protocol::Decode(view, request), protocol::DecodeStatus::kOk);
    if (reject_poses != protocol::ErrorCode{}) {
      return Send({.sequence = view.header.sequence},
                  protocol::ErrorMessage{reject_poses, "rejected by the test"});
    }
    requests.push_back(view.header.sequence);
    const auto stream = static_cast<std::uint16_t>(requests.size());
    const protocol::Header header{.stream = stream, .sequence = view.header.sequence};
    protocol::SubscribeReply reply;
    reply.subject = request.subject;
    reply.publisher_session = 5;
    Send(header, reply);
    if (skeleton.subject.empty()) return;
    Send(header, skeleton);
  }

  std::uint64_t session_;
  int fd_;
  std::uint16_t port_ = 0;
  sockaddr_in client_{};
};

// Repeats `step` until it returns true. Only a failing test takes the whole time.
[[nodiscard]] inline bool Until(const std::function<bool()>& step) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (std::chrono::steady_clock::now() < end) {
    if (step()) return true;
  }
  return false;
}

}  // namespace furrow::capi
