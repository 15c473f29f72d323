// SPDX-License-Identifier: Apache-2.0
#include "client/load/schedule/senders.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "base/status.h"
#include "client/cpp/acceptance.h"
#include "client/load/net/clock.h"
#include "protocol/framing/envelope.h"

namespace furrow::load {

using client::IoStatus;
using std::chrono::milliseconds;

std::string SubjectName(std::uint32_t subject) {
  char name[32];
  std::snprintf(name, sizeof(name), "load-%06u", subject);
  return name;
}

namespace {

std::int64_t SteadyMicroseconds() { return SteadyNanoseconds() / 1000; }

Status ToStatus(const client::Acceptance& answer) {
  using Kind = client::Acceptance::Kind;
  switch (answer.kind) {
    case Kind::kAccepted:
    case Kind::kGivenUp: return {};
    case Kind::kRefused:
      return {StatusCode::kInvalidArgument, "the daemon refuses: " + answer.reason};
    case Kind::kError: return {StatusCode::kInvalidArgument, "the daemon says: " + answer.reason};
    case Kind::kNobody:
    case Kind::kNoConnection: break;
  }
  return {StatusCode::kUnavailable, "nobody answers"};
}

}  // namespace

Result<Senders> Senders::Open(const OpenSocket& open, int sockets, const Performance& performance) {
  Senders senders(performance);
  for (int i = 0; i < sockets; ++i) {
    auto socket = open(i);
    FURROW_RETURN_IF_ERROR(socket);
    Sender& sender = senders.senders_.emplace_back();
    sender.socket = socket->get();
    sender.publisher = std::make_unique<client::Publisher>(*std::move(socket));
  }
  return senders;
}

Status Senders::Offer(int count, const std::function<bool()>& go_on) {
  protocol::SkeletonOffer offer = performance_->offer;
  for (int subject = 0; subject < count && go_on(); ++subject) {
    const auto number = static_cast<std::uint32_t>(subject);
    offer.subject = SubjectName(number);
    Sender& sender = senders_[number % senders_.size()];
    const std::uint16_t stream = sender.publisher->AddSubject(offer, SteadyMicroseconds());
    // One after the other: a thousand skeletons at once would not fit the server's socket.
    const client::Acceptance answer =
        client::WaitUntilAccepted(*sender.publisher, stream, SteadyMicroseconds, go_on);
    FURROW_RETURN_IF_ERROR(ToStatus(answer));
  }
  return {};
}

IoStatus Senders::Send(std::uint32_t subject, std::uint32_t pose, int frame,
                       std::int64_t capture_time_us) {
  const std::size_t i = subject % senders_.size();
  std::vector<std::uint8_t>& message = messages_[static_cast<std::size_t>(frame)];
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
