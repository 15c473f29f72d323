// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "client/cpp/transport.h"
#include "protocol/codec/codec.h"

namespace furrow::client {

// The peer of a FakeTransport, controlled by the test: sent messages, and messages to receive next.
struct FarEnd {
  std::vector<std::vector<std::uint8_t>> sent;
  std::deque<std::vector<std::uint8_t>> to_receive;
  IoStatus when_empty = IoStatus::kTimeout;
  IoStatus when_sent = IoStatus::kOk;
  bool takes_bundles = false;  // this end
  bool reconnects = false;     // this end
  std::uint64_t generation = 1;
  bool abandoned = false;         // this end gave up the connection
  bool follows = false;           // this end goes where it is sent
  std::vector<Elsewhere> moves;   // where it was sent
  std::vector<Elsewhere> others;  // what it was told

  template <class Message>
  void Answer(const protocol::Header& header, const Message& message) {
    protocol::Encoder encoder;
    encoder.Encode(header, message, to_receive.emplace_back());
  }

  // Returns the kinds of all messages sent since the last call.
  std::vector<protocol::MessageKind> TakeKinds() {
    std::vector<protocol::MessageKind> kinds;
    for (const auto& bytes : sent) {
      protocol::MessageView view;
      (void)protocol::OpenMessage(bytes, view);
      kinds.push_back(view.kind);
    }
    sent.clear();
    return kinds;
  }
};

class FakeTransport : public Transport {
 public:
  FakeTransport(TransportKind kind, std::shared_ptr<FarEnd> far)
      : Transport(kind), far_(std::move(far)) {}

  IoStatus Send(std::span<const std::uint8_t> message) override {
    far_->sent.emplace_back(message.begin(), message.end());
    return far_->when_sent;
  }

  IoStatus Receive(std::span<const std::uint8_t>& message, std::chrono::milliseconds) override {
    if (far_->to_receive.empty()) return far_->when_empty;
    current_ = std::move(far_->to_receive.front());
    far_->to_receive.pop_front();
    message = current_;
    return IoStatus::kOk;
  }

  [[nodiscard]] bool takes_bundles() const override { return far_->takes_bundles; }
  [[nodiscard]] bool reconnects() const override { return far_->reconnects; }
  [[nodiscard]] std::uint64_t generation() const override { return far_->generation; }
  void Abandon() override { far_->abandoned = true; }
  bool GoTo(const Elsewhere& server) override {
    far_->moves.push_back(server);
    return far_->follows;
  }
  void Remember(std::span<const Elsewhere> others) override {
    far_->others.assign(others.begin(), others.end());
  }
  [[nodiscard]] bool has_others() const override { return !far_->others.empty(); }

 private:
  std::shared_ptr<FarEnd> far_;
  std::vector<std::uint8_t> current_;
};

}  // namespace furrow::client
