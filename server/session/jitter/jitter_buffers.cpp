// SPDX-License-Identifier: Apache-2.0
#include "server/session/jitter/jitter_buffers.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace furrow::server {
namespace {

// Usual poses reuse memory, so that the path of a pose does not allocate in the long run.
constexpr std::size_t kMaxSpare = 256;
constexpr std::size_t kMaxSpareBytes = 16 * 1024;  // of one

}  // namespace

JitterBuffers::Place JitterBuffers::Add(const StreamKey& stream, const protocol::Header& header,
                                        const protocol::PoseFrame& pose,
                                        std::span<const std::uint8_t> payload, Time delay,
                                        Time now) {
  JitterBuffer& buffer = streams_[stream];
  Time due{0};
  switch (buffer.Look(header, delay, now, &due)) {
    case JitterBuffer::Place::kLate: return Place::kLate;
    case JitterBuffer::Place::kDuplicate: return Place::kDuplicate;
    case JitterBuffer::Place::kHeld: break;
  }
  return Hold(stream, buffer, header, pose, payload, due);
}

JitterBuffers::Place JitterBuffers::AddAhead(const StreamKey& stream,
                                             const protocol::Header& header,
                                             const protocol::PoseFrame& pose,
                                             std::span<const std::uint8_t> payload, Time wait,
                                             Time now) {
  JitterBuffer& buffer = ahead_[stream];
  Time due{0};
  if (buffer.LookAhead(header, wait, now, &due) != JitterBuffer::Place::kHeld) {
    return Place::kDuplicate;
  }
  return Hold(stream, buffer, header, pose, payload, due);
}

JitterBuffers::Place JitterBuffers::Hold(const StreamKey& stream, JitterBuffer& buffer,
                                         const protocol::Header& header,
                                         const protocol::PoseFrame& pose,
                                         std::span<const std::uint8_t> payload, Time due) {
  std::unique_ptr<HeldPose> held = NewPose();
  held->header = header;
  held->pose = pose;
  held->payload.assign(payload.begin(), payload.end());
  held->due = due;
  bytes_ += held->bytes();
  buffer.Hold(std::move(held));
  // The oldest pose of the same stream leaves early: a stream cannot push out the others' poses.
  const bool full = buffer.size() > kMaxPoses || bytes_ > kMaxBytes;
  if (full) Release(stream, buffer.TakeOldest());
  return full ? Place::kFull : Place::kHeld;
}

void JitterBuffers::Release(const StreamKey& stream, std::unique_ptr<HeldPose> pose) {
  bytes_ -= pose->bytes();
  released_.push_back({stream, pose.get()});
  taken_.push_back(std::move(pose));
}

std::unique_ptr<HeldPose> JitterBuffers::NewPose() {
  if (spare_.empty()) return std::make_unique<HeldPose>();
  std::unique_ptr<HeldPose> pose = std::move(spare_.back());
  spare_.pop_back();
  return pose;
}

std::span<const JitterBuffers::Released> JitterBuffers::TakeDue(Time now) {
  for (auto entry = streams_.begin(); entry != streams_.end();) {
    auto& [stream, buffer] = *entry;
    while (auto pose = buffer.TakeDue(now)) Release(stream, std::move(pose));
    const bool forgotten = buffer.empty() && now - buffer.last_arrival() > kForget;
    entry = forgotten ? streams_.erase(entry) : std::next(entry);
  }
  TakeAhead(now);
  return released_;
}

// A pose that has waited as long as allowed leaves, and with it those that follow it directly.
void JitterBuffers::TakeAhead(Time now) {
  for (auto entry = ahead_.begin(); entry != ahead_.end();) {
    auto& [stream, buffer] = *entry;
    while (auto pose = buffer.TakeDue(now)) {
      do {
        Release(stream, std::move(pose));
        pose = buffer.TakeIf(buffer.newest_left() + 1);
      } while (pose != nullptr);
    }
    entry = buffer.empty() ? ahead_.erase(entry) : std::next(entry);
  }
}

std::optional<Time> JitterBuffers::NextAhead() const {
  // A pose that left early because there was no room for it.
  if (!released_.empty()) return Time{0};
  std::optional<Time> next;
  for (const auto& [stream, buffer] : ahead_) {
    if (!buffer.empty()) next = std::min(next.value_or(buffer.due()), buffer.due());
  }
  return next;
}

std::span<const JitterBuffers::Released> JitterBuffers::TakeFollowing(const StreamKey& stream,
                                                                      std::uint32_t newest) {
  const auto found = ahead_.find(stream);
  if (found == ahead_.end()) return released_;
  JitterBuffer& buffer = found->second;
  while (auto pose = buffer.TakeIf(++newest)) Release(stream, std::move(pose));
  if (buffer.empty()) ahead_.erase(found);
  return released_;
}

std::span<const JitterBuffers::Released> JitterBuffers::TakeAll(const StreamKey& stream) {
  const auto take = [&](JitterBuffer& buffer) {
    while (!buffer.empty()) Release(stream, buffer.TakeOldest());
  };
  if (const auto found = streams_.find(stream); found != streams_.end()) take(found->second);
  if (const auto found = ahead_.find(stream); found != ahead_.end()) {
    take(found->second);
    ahead_.erase(found);
  }
  return released_;
}

void JitterBuffers::Recycle() {
  released_.clear();
  for (std::unique_ptr<HeldPose>& pose : taken_) {
    if (spare_.size() < kMaxSpare && pose->bytes() <= kMaxSpareBytes) {
      spare_.push_back(std::move(pose));
    }
  }
  taken_.clear();
}

}  // namespace furrow::server
