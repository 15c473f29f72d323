// SPDX-License-Identifier: Apache-2.0
#include "client/load/run/senders.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "base/status.h"
#include "client/cpp/acceptance.h"
#include "client/net/clock.h"
#include "protocol/codec/codec.h"
#include "protocol/framing/envelope.h"
#include "protocol/framing/fragment.h"

namespace furrow::load {

using client::IoStatus;
using std::chrono::milliseconds;

std::string SubjectName(std::uint32_t number) {
  char name[32];
  std::snprintf(name, sizeof(name), "load-%06u", number);
  return name;
}

namespace {

std::int64_t SteadyMicroseconds() { return net::SteadyNanoseconds() / 1000; }

// The error for an answer to an offer. A cancelled wait is none: the caller sees the interrupt.
Status ToStatus(const client::Acceptance& answer) {
  using Kind = client::Acceptance::Kind;
  switch (answer.kind) {
    case Kind::kAccepted:
    case Kind::kCancelled: return {};
    case Kind::kRefused:
      return {StatusCode::kInvalidArgument, "the skeleton was not accepted: " + answer.reason};
    case Kind::kError:
      return {StatusCode::kInvalidArgument, "the daemon reports an error: " + answer.reason};
    case Kind::kNoAnswer:
    case Kind::kNoConnection: break;
  }
  return {StatusCode::kUnavailable, "no answer"};
}

}  // namespace

Result<Senders> Senders::Open(const SocketOpener& open, int sockets, const Workload& workload) {
  Senders senders(workload);
  for (int i = 0; i < sockets; ++i) {
    auto socket = open(i);
    FURROW_RETURN_IF_ERROR(socket);
    Sender& sender = senders.senders_.emplace_back();
    sender.socket = socket->get();
    sender.publisher = std::make_unique<client::Publisher>(*std::move(socket));
  }
  return senders;
}

Status Senders::Offer(std::uint32_t first, int count, const std::function<bool()>& keep_going) {
  protocol::SkeletonOffer offer = workload_->offer;
  for (int subject = 0; subject < count && keep_going(); ++subject) {
    const auto number = static_cast<std::uint32_t>(subject);
    offer.subject = SubjectName(first + number);
    Sender& sender = senders_[number % senders_.size()];
    const std::uint16_t stream = sender.publisher->AddSubject(offer, SteadyMicroseconds());
    // Offers one skeleton at a time; a thousand at once would overflow the server's receive buffer.
    const client::Acceptance answer =
        client::WaitUntilAccepted(*sender.publisher, stream, SteadyMicroseconds, keep_going);
    FURROW_RETURN_IF_ERROR(ToStatus(answer));
  }
  return {};
}

void Senders::RepeatPrevious(const Plan& plan) {
  protocol::Encoder encoder;
  protocol::PoseFrame pose;
  const auto frames = static_cast<std::uint32_t>(messages_.size());
  repeating_ = messages_;
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    protocol::MessageView view;
    const bool is_pose =
        protocol::OpenMessage(messages_[frame], view) == protocol::DecodeStatus::kOk &&
        protocol::Decode(view, pose) == protocol::DecodeStatus::kOk;
    if (!is_pose) continue;
    // A subject with start phase 0 sends each frame as the pose of the same number. Rounds repeat.
    const std::uint32_t number = frame + frames;
    const auto& previous = messages_[(number - 1) % frames];
    pose.previous.assign(previous.begin() + protocol::kEnvelopeBytes, previous.end());
    pose.previous_age_us =
        static_cast<std::uint32_t>(plan.CaptureUs(0, number) - plan.CaptureUs(0, number - 1));
    std::vector<std::uint8_t> message;
    encoder.Encode({.session = 1}, pose, message, protocol::PoseEncoding::Small());
    if (protocol::NumDatagrams(message.size()) == 1) repeating_[frame] = std::move(message);
  }
}

IoStatus Senders::Send(std::uint32_t subject, std::uint32_t pose, int frame,
                       std::int64_t capture_time_us) {
  const std::size_t i = subject % senders_.size();
  // The payload of a frame is encoded once. Only the envelope differs between subjects and rounds,
  // so sending costs no encoding, which would count as latency.
  const bool repeats =
      pose > 0 && !repeating_.empty() && senders_[i].socket->kind() == client::TransportKind::kUdp;
  auto& messages = repeats ? repeating_ : messages_;
  std::vector<std::uint8_t>& message = messages[static_cast<std::size_t>(frame)];
  const protocol::Envelope envelope{
      .header = {.session = senders_[i].publisher->session(),
                 .stream = static_cast<std::uint16_t>(subject / senders_.size()),
                 .sequence = pose,
                 .capture_time_us = capture_time_us},
      .payload_bytes = static_cast<std::uint32_t>(message.size() - protocol::kEnvelopeBytes)};
  protocol::WriteEnvelope(envelope,
                          std::span<std::uint8_t>(message).first<protocol::kEnvelopeBytes>());
  return senders_[i].socket->Send(message);
}

IoStatus Senders::Read(std::size_t i) {
  return senders_[i].publisher->Poll(SteadyMicroseconds(), milliseconds(0));
}

void Senders::Close() {
  for (Sender& sender : senders_) sender.publisher->Close();
}

}  // namespace furrow::load
