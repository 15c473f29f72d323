// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/operate/drainer.h"

#include <utility>

#include "client/cpp/publisher.h"
#include "protocol/messages/limits.h"

namespace furrow::client {
namespace {

constexpr std::int64_t kAskMicroseconds = 100'000;

}  // namespace

Drainer::Drainer(std::unique_ptr<Transport> transport, std::string name)
    : transport_(std::move(transport)),
      session_(NewSession()),
      introduction_(transport_.get(), std::move(name), session_) {
  introduction_.SendHello();
}

IoStatus Drainer::Poll(std::int64_t now_us, std::chrono::milliseconds wait) {
  if (now_us - sent_us_ >= kAskMicroseconds) {
    sent_us_ = now_us;
    if (introduction_.proven()) {
      encoder_.Encode({.session = session_, .sequence = ++number_}, protocol::Drain{true}, bytes_);
      (void)transport_->Send(bytes_);
    } else {
      introduction_.SendHello();
    }
  }
  std::span<const std::uint8_t> message;
  IoStatus status = transport_->Receive(message, wait);
  while (status == IoStatus::kOk) {
    Handle(message, now_us);
    const IoStatus more = transport_->Receive(message, std::chrono::milliseconds(0));
    if (more == IoStatus::kTimeout) break;
    status = more;
  }
  return status;
}

void Drainer::Handle(std::span<const std::uint8_t> message, std::int64_t now_us) {
  using protocol::DecodeStatus;
  protocol::MessageView view;
  if (protocol::OpenMessage(message, view, protocol::kMaxReplyBytes) != DecodeStatus::kOk) return;
  protocol::Welcome welcome;
  protocol::Ping ping;
  protocol::DrainState state;
  protocol::ErrorMessage error;
  if (protocol::Decode(view, welcome) == DecodeStatus::kOk) {
    if (introduction_.OnWelcome(welcome)) sent_us_ = 0;
  } else if (protocol::Decode(view, ping) == DecodeStatus::kOk) {
    introduction_.OnPing(ping);
  } else if (protocol::Decode(view, state) == DecodeStatus::kOk) {
    state_ = std::move(state);
    heard_us_ = now_us;
  } else if (protocol::Decode(view, error) == DecodeStatus::kOk) {
    // A busy daemon is asked again.
    if (error.code != protocol::ErrorCode::kLimit) refusal_ = error.message;
  }
}

}  // namespace furrow::client
