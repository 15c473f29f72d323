// SPDX-License-Identifier: Apache-2.0
#include "server/session/jitter/jitter_buffers.h"

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
  return released_;
}

std::span<const JitterBuffers::Released> JitterBuffers::TakeAll(const StreamKey& stream) {
  const auto found = streams_.find(stream);
  while (found != streams_.end() && !found->second.empty()) {
    Release(stream, found->second.TakeOldest());
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
