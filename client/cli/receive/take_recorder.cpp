// SPDX-License-Identifier: Apache-2.0
#include "client/cli/receive/take_recorder.h"

#include <algorithm>

#include "base/status.h"

namespace furrow::cli {
namespace {

using client::Event;
using recording::TakeKind;

// Well below one second, the most that a killed recorder may lose.
constexpr std::int64_t kFlushMicroseconds = 400'000;

}  // namespace

void TakeRecorder::Subscribe(client::Subscriber& subscriber, const std::string& subject,
                             bool wait) {
  // The list of subjects arrives again at each change, with subjects that are known already.
  if (!subscribed_.insert(subject).second) return;
  Source& source = sources_.emplace_back();
  // Subscribe to poses first, so that each pose precedes its weights in the file.
  source.requests.push_back(subscriber.Subscribe(
      protocol::SubscribePoses{.subject = subject, .wait = wait, .every = true}));
  source.requests.push_back(subscriber.Subscribe(
      protocol::SubscribeWeights{.subject = subject, .wait = wait, .every = true}));
}

void TakeRecorder::SubscribeToAll(client::Subscriber& subscriber) {
  (void)subscriber.ListSubjects(/*follow=*/true);
}

Status TakeRecorder::Begin(std::int64_t now_us) {
  // The file is created with the first answer, so that a wrong address leaves no empty take.
  if (folder_ != nullptr) return {};
  const auto now_ns = static_cast<std::uint64_t>((now_us + wall_offset_us_) * 1000);
  auto folder = recording::TakeFolder::Open(options_, now_ns);
  FURROW_RETURN_IF_ERROR(folder);
  folder_ = *std::move(folder);
  flushed_us_ = now_us;
  return {};
}

Status TakeRecorder::OnEvent(const Event& event, client::Subscriber& subscriber,
                             std::int64_t now_us) {
  if (event.kind == Event::Kind::kSubjects) {
    const std::uint32_t total = subscriber.subjects().total;
    returning_ = returning_ && total == 0;
    if (!returning_) num_present_ = total;
    // With `wait`, because a subject may leave before the daemon reads the request, and may return.
    for (const std::string& name : subscriber.subjects().names) Subscribe(subscriber, name, true);
    return {};
  }
  if (event.kind == Event::Kind::kReply) return OnReply(event, subscriber, now_us);
  if (event.kind == Event::Kind::kDropped) {
    // The message carries the total of the subscription, so a lost report does no harm.
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

Status TakeRecorder::OnReply(const Event& event, const client::Subscriber& subscriber,
                             std::int64_t now_us) {
  FURROW_RETURN_IF_ERROR(Begin(now_us));
  const protocol::SubscribeReply& reply = subscriber.reply();
  // Every source has two requests, first poses and then weights.
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
  // Each session of a publisher has its own channels in the file, and so its own names.
  if (source->names.empty() || source->session == 0) return {};
  return Write(TakeKind::kNames, *source, {}, source->names, now_us);
}

Status TakeRecorder::Write(TakeKind kind, const Source& source, const protocol::Header& header,
                           std::span<const std::uint8_t> payload, std::int64_t now_us) {
  return folder_->Write(
      kind, source.subject,
      {.session = source.session,
       .sequence = header.sequence,
       .capture_time_us = header.capture_time_us,
       .log_time_ns = static_cast<std::uint64_t>((now_us + wall_offset_us_) * 1000)},
      payload);
}

void TakeRecorder::OnReturn() {
  dropped_before_ = num_dropped();
  dropped_.clear();
  source_of_.clear();  // numbers of subscriptions belong to a connection
  num_present_.reset();
  returning_ = true;
}

Status TakeRecorder::Flush(std::int64_t now_us) {
  if (folder_ == nullptr || now_us - flushed_us_ < kFlushMicroseconds) return {};
  flushed_us_ = now_us;
  return folder_->Flush();
}

Status TakeRecorder::Close() { return folder_ != nullptr ? folder_->Close() : Status(); }

std::string TakeRecorder::SubjectNames() const {
  std::string names;
  for (const Source& source : sources_) {
    if (!source.subject.empty()) names += (names.empty() ? "" : ", ") + source.subject;
  }
  return names;
}

std::uint64_t TakeRecorder::num_dropped() const {
  std::uint64_t sum = dropped_before_;
  for (const auto& [subscription, frames] : dropped_) sum += frames;
  return sum;
}

}  // namespace furrow::cli
