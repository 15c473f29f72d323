// SPDX-License-Identifier: Apache-2.0
#include "client/cli/output/take_listener.h"

#include <algorithm>

#include "base/status.h"

namespace furrow::cli {
namespace {

using client::Event;
using recording::TakeKind;

// Well below the second that a killed recorder may lose.
constexpr std::int64_t kFlushMicroseconds = 400'000;

}  // namespace

void TakeListener::Ask(client::Subscriber& subscriber, const std::string& subject, bool wait) {
  if (!asked_.insert(subject).second) return;
  Source& source = sources_.emplace_back();
  // Poses first: then each is in the file before its weights.
  source.requests.push_back(subscriber.Subscribe(
      protocol::SubscribePoses{.subject = subject, .wait = wait, .every = true}));
  source.requests.push_back(subscriber.Subscribe(
      protocol::SubscribeWeights{.subject = subject, .wait = wait, .every = true}));
}

void TakeListener::AskForAll(client::Subscriber& subscriber) {
  (void)subscriber.ListSubjects(/*follow=*/true);
}

Status TakeListener::Begin(std::int64_t now_us) {
  if (folder_ != nullptr) return {};
  const auto now_ns = static_cast<std::uint64_t>((now_us + wall_offset_us_) * 1000);
  auto folder = recording::TakeFolder::Open(options_, now_ns);
  FURROW_RETURN_IF_ERROR(folder);
  folder_ = *std::move(folder);
  flushed_us_ = now_us;
  return {};
}

Status TakeListener::OnEvent(const Event& event, client::Subscriber& subscriber,
                             std::int64_t now_us) {
  if (event.kind == Event::Kind::kSubjects) {
    num_present_ = subscriber.subjects().total;
    // Each may leave and return; who is here now may have left before the daemon reads this.
    for (const std::string& name : subscriber.subjects().names) Ask(subscriber, name, true);
    return {};
  }
  if (event.kind == Event::Kind::kReply) return OnReply(event, subscriber, now_us);
  if (event.kind == Event::Kind::kDropped) {
    dropped_[event.header.stream] = subscriber.dropped().frames;
    return {};
  }
  const auto found = source_of_.find(event.header.stream);
  if (found == source_of_.end()) return {};
  const Source& source = sources_[found->second];
  switch (event.kind) {
    case Event::Kind::kSkeleton:
      return Write(TakeKind::kSkeleton, source, {}, subscriber.payload(), now_us);
    case Event::Kind::kPose:
      ++num_poses_;
      return Write(TakeKind::kPose, source, event.header, subscriber.payload(), now_us);
    case Event::Kind::kWeights:
      ++num_weights_;
      return Write(TakeKind::kWeights, source, event.header, subscriber.payload(), now_us);
    default: return {};
  }
}

Status TakeListener::OnReply(const Event& event, const client::Subscriber& subscriber,
                             std::int64_t now_us) {
  FURROW_RETURN_IF_ERROR(Begin(now_us));
  const protocol::SubscribeReply& reply = subscriber.reply();
  const auto source = std::ranges::find_if(sources_, [&](const Source& each) {
    return std::ranges::count(each.requests, event.header.sequence) > 0;
  });
  if (source == sources_.end() || reply.subject.empty()) return {};
  source_of_[event.header.stream] = static_cast<std::size_t>(source - sources_.begin());
  source->subject = reply.subject;
  if (event.header.sequence == source->requests.front()) {
    source->session = reply.publisher_session;
  } else {
    source->names.assign(subscriber.payload().begin(), subscriber.payload().end());
  }
  // Another run of the sender has channels of its own, and so names of its own.
  if (source->names.empty() || source->session == 0) return {};
  return Write(TakeKind::kNames, *source, {}, source->names, now_us);
}

Status TakeListener::Write(TakeKind kind, const Source& source, const protocol::Header& header,
                           std::span<const std::uint8_t> payload, std::int64_t now_us) {
  return folder_->Write(
      kind, source.subject,
      {.session = source.session,
       .sequence = header.sequence,
       .capture_time_us = header.capture_time_us,
       .log_time_ns = static_cast<std::uint64_t>((now_us + wall_offset_us_) * 1000)},
      payload);
}

Status TakeListener::Flush(std::int64_t now_us) {
  if (folder_ == nullptr || now_us - flushed_us_ < kFlushMicroseconds) return {};
  flushed_us_ = now_us;
  return folder_->Flush();
}

Status TakeListener::Close() { return folder_ != nullptr ? folder_->Close() : Status(); }

std::string TakeListener::SubjectNames() const {
  std::string names;
  for (const Source& source : sources_) {
    if (!source.subject.empty()) names += (names.empty() ? "" : ", ") + source.subject;
  }
  return names;
}

std::uint64_t TakeListener::num_dropped() const {
  std::uint64_t sum = 0;
  for (const auto& [subscription, frames] : dropped_) sum += frames;
  return sum;
}

}  // namespace furrow::cli
