// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/subscriber.h"

#include <algorithm>
#include <utility>

#include "client/cpp/publisher.h"
#include "protocol/limits.h"

namespace furrow::client {
namespace {

using protocol::DecodeStatus;
using protocol::MessageKind;

// While something is unanswered it is sent again this often; a settled UDP lease is renewed rarely.
constexpr std::int64_t kResendMicroseconds = 200'000;
constexpr std::int64_t kRenewMicroseconds = protocol::kUdpLeaseMicroseconds / 5;

}  // namespace

Subscriber::Subscriber(std::unique_ptr<Transport> transport, std::string name)
    : transport_(std::move(transport)),
      name_(std::move(name)),
      session_(NewSession()),
      proven_(transport_->kind() == TransportKind::kTcp) {
  SendHello();
}

void Subscriber::SendHello() {
  encoder_.Encode({.session = session_}, protocol::Hello{.client = name_, .token = token_}, bytes_);
  (void)transport_->Send(bytes_);
}

template <class Message>
std::uint32_t Subscriber::Ask(const Message& message) {
  Request& request = waiting_.emplace_back();
  request.number = next_request_++;
  encoder_.Encode({.session = session_, .sequence = request.number}, message, request.bytes);
  if (proven_) (void)transport_->Send(request.bytes);  // a closed connection shows in Next()
  return request.number;
}

std::uint32_t Subscriber::Subscribe(const protocol::SubscribeWeights& request) {
  return Ask(request);
}
std::uint32_t Subscriber::Subscribe(const protocol::SubscribePictures& request) {
  return Ask(request);
}

void Subscriber::Unsubscribe(std::uint16_t subscription) {
  encoder_.Encode({.session = session_, .stream = subscription, .sequence = next_request_++},
                  protocol::Unsubscribe{}, bytes_);
  (void)transport_->Send(bytes_);
}

void Subscriber::Maintain(std::int64_t now_us) {
  if (transport_->kind() == TransportKind::kTcp) return;
  if (!started_) {
    started_ = true;
    last_sent_us_ = now_us;
    return;
  }
  const bool unsettled = !proven_ || !waiting_.empty();
  if (now_us - last_sent_us_ < (unsettled ? kResendMicroseconds : kRenewMicroseconds)) return;
  last_sent_us_ = now_us;
  if (!proven_) {
    SendHello();
    return;
  }
  for (const Request& request : waiting_) (void)transport_->Send(request.bytes);
  if (waiting_.empty()) {
    encoder_.Encode({.session = session_}, protocol::Ping{.time_us = now_us}, bytes_);
    (void)transport_->Send(bytes_);
  }
}

Event Subscriber::Next(std::int64_t now_us, std::chrono::milliseconds wait) {
  Maintain(now_us);
  Event event;
  std::span<const std::uint8_t> message;
  for (;;) {
    switch (transport_->Receive(message, wait)) {
      case IoStatus::kOk: break;
      case IoStatus::kNoConnection: event.kind = Event::Kind::kNoConnection; return event;
      case IoStatus::kClosed:
      case IoStatus::kMalformed: event.kind = Event::Kind::kClosed; return event;
      default: event.kind = Event::Kind::kTimeout; return event;
    }
    if (Handle(message, event)) return event;
    // Not for the caller (a pong, a welcome). What is already there may be: look, but do not wait
    // on, since only the caller knows the time.
    wait = std::chrono::milliseconds(0);
  }
}

bool Subscriber::Handle(std::span<const std::uint8_t> message, Event& event) {
  protocol::MessageView view;
  if (protocol::OpenMessage(message, view, protocol::kMaxReplyBytes) != DecodeStatus::kOk) {
    ++malformed_;
    return false;
  }
  event.header = view.header;
  DecodeStatus status = DecodeStatus::kOk;
  switch (view.kind) {
    case MessageKind::kWeights:
      status = protocol::Decode(view, weights_);
      event.kind = Event::Kind::kWeights;
      break;
    case MessageKind::kImage:
      status = protocol::Decode(view, picture_);
      event.kind = Event::Kind::kPicture;
      break;
    case MessageKind::kSubscribeReply:
      status = protocol::Decode(view, reply_);
      event.kind = Event::Kind::kReply;
      if (status == DecodeStatus::kOk) Answered(view.header.sequence);
      break;
    case MessageKind::kError:
      status = protocol::Decode(view, error_);
      event.kind = Event::Kind::kError;
      if (status == DecodeStatus::kOk) Answered(view.header.sequence);
      break;
    case MessageKind::kGoodbye:
      status = protocol::Decode(view, goodbye_);
      event.kind = Event::Kind::kGoodbye;
      break;
    case MessageKind::kWelcome: return HandleWelcome(view);
    default: return false;  // pongs, and what a newer daemon may say
  }
  if (status == DecodeStatus::kOk) return true;
  ++malformed_;
  return false;
}

bool Subscriber::HandleWelcome(const protocol::MessageView& view) {
  protocol::Welcome welcome;
  if (protocol::Decode(view, welcome) != DecodeStatus::kOk) {
    ++malformed_;
  } else if (!proven_) {
    if (welcome.token != 0) {
      token_ = welcome.token;
      SendHello();
    } else {
      proven_ = true;
      for (const Request& request : waiting_) (void)transport_->Send(request.bytes);
    }
  }
  return false;
}

void Subscriber::Answered(std::uint32_t number) {
  std::erase_if(waiting_, [number](const Request& request) { return request.number == number; });
}

}  // namespace furrow::client
