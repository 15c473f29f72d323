// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "protocol/messages/messages.h"
#include "server/core/time.h"
#include "server/session/jitter/jitter_buffer.h"
#include "server/session/subjects/subject_registry.h"

namespace furrow::server {

// The jitter buffers of a shard, one per stream whose subject has a delay. Used under the shard's
// lock.
class JitterBuffers {
 public:
  static constexpr std::size_t kMaxPoses = 256;               // per stream
  static constexpr std::size_t kMaxBytes = 32 * 1024 * 1024;  // of all streams
  // A buffer without poses for this long is removed.
  static constexpr Time kForget = std::chrono::seconds(10);

  enum class Place : std::uint8_t {
    kHeld,
    kLate,       // newer poses have left already
    kDuplicate,  // it waits already
    kFull,       // held; another pose of the stream is due early, because it takes too much memory
  };
  // Copies a pose that arrived, so that it waits, or returns why it does not.
  Place Add(const StreamKey& stream, const protocol::Header& header,
            const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload, Time delay,
            Time now);

  // True if a pose with this sequence would be held.
  [[nodiscard]] bool Misses(const StreamKey& stream, std::uint32_t sequence) const {
    const auto found = streams_.find(stream);
    return found == streams_.end() || found->second.Misses(sequence);
  }

  // A pose that has waited long enough; valid until Recycle().
  struct Released {
    StreamKey stream;
    const HeldPose* pose = nullptr;
  };
  // Takes all poses that are due, in order per stream. Also removes forgotten buffers.
  [[nodiscard]] std::span<const Released> TakeDue(Time now);
  // Takes all poses of one stream, due or not, as at the end of the stream.
  [[nodiscard]] std::span<const Released> TakeAll(const StreamKey& stream);
  // Frees the poses that were taken.
  void Recycle();

  // True if no stream has a buffer.
  [[nodiscard]] bool empty() const { return streams_.empty(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }  // of all waiting poses

 private:
  void Release(const StreamKey& stream, std::unique_ptr<HeldPose> pose);
  [[nodiscard]] std::unique_ptr<HeldPose> NewPose();

  std::unordered_map<StreamKey, JitterBuffer, StreamKeyHash> streams_;
  std::vector<Released> released_;
  std::vector<std::unique_ptr<HeldPose>> taken_;  // owns the poses of released_
  std::vector<std::unique_ptr<HeldPose>> spare_;  // memory for the next poses
  std::size_t bytes_ = 0;
};

}  // namespace furrow::server
