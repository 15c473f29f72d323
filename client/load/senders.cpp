// SPDX-License-Identifier: Apache-2.0
#include "client/load/senders.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include "client/load/clock.h"
#include "protocol/envelope.h"

namespace furrow::load {

using client::IoStatus;
using std::chrono::milliseconds;

std::string SubjectName(std::uint32_t subject) {
  char name[32];
  std::snprintf(name, sizeof(name), "load-%06u", subject);
  return name;
}

Result<Senders> Senders::Open(const OpenSocket& open, int sockets, const Performance& performance) {
  Senders senders(performance);
  for (int i = 0; i < sockets; ++i) {
    auto socket = open(i);
    if (!socket.ok()) return socket.status();
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
    const std::uint16_t stream = sender.publisher->AddSubject(offer, SteadyNanoseconds() / 1000);
    if (Status status = WaitUntilAccepted(sender, stream, go_on); !status.ok()) return status;
  }
  return {};
}

// One after the other: a thousand skeletons at once would not fit the server's socket.
Status Senders::WaitUntilAccepted(Sender& sender, std::uint16_t stream,
                                  const std::function<bool()>& go_on) {
  const std::int64_t deadline = SteadyNanoseconds() + 5'000'000'000;
  client::Publisher& publisher = *sender.publisher;
  IoStatus status = IoStatus::kOk;
  while (SteadyNanoseconds() < deadline && go_on()) {
    status = publisher.Poll(SteadyNanoseconds() / 1000, milliseconds(20));
    if (publisher.accepted(stream)) return {};
    if (!publisher.rejection(stream).empty()) {
      return {StatusCode::kInvalidArgument, "the daemon refuses: " + publisher.rejection(stream)};
    }
    if (status == IoStatus::kClosed || status == IoStatus::kMalformed) break;
    // A refusal comes at once and again: the daemon may be just starting.
    if (status == IoStatus::kNoConnection) std::this_thread::sleep_for(milliseconds(20));
  }
  if (!go_on()) return {};
  if (!publisher.last_error().empty())
    return {StatusCode::kInvalidArgument, "the daemon says: " + publisher.last_error()};
  return {StatusCode::kUnavailable, "nobody answers"};
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
  return senders_[i].publisher->Poll(SteadyNanoseconds() / 1000, milliseconds(0));
}

void Senders::Close() {
  for (Sender& sender : senders_) sender.publisher->Close();
}

}  // namespace furrow::load
