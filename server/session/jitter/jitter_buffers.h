// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "protocol/messages/messages.h"
#include "server/core/time.h"
#include "server/session/jitter/jitter_buffer.h"
#include "server/session/subjects/subject_registry.h"

namespace furrow::server {

// The poses of a shard that wait: in jitter buffers, one per stream whose subject has a delay, and
// in other streams for an earlier pose that may still come (AddAhead()). Used under the shard's
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
  // The same for a stream without a delay. The pose leaves when TakeFollowing() or TakeDue() takes
  // the poses before it, at the latest after `wait`. Never returns kLate: the caller knows the
  // newest pose that was used, and passes newer ones only.
  Place AddAhead(const StreamKey& stream, const protocol::Header& header,
                 const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload, Time wait,
                 Time now);

  // True if a pose with this sequence would be held.
  [[nodiscard]] bool Misses(const StreamKey& stream, std::uint32_t sequence) const {
    const auto misses = [&](const auto& buffers) {
      const auto found = buffers.find(stream);
      return found == buffers.end() || found->second.Misses(sequence);
    };
    return misses(streams_) && misses(ahead_);
  }
  // True if poses of the stream wait for an earlier one.
  [[nodiscard]] bool WaitsAhead(const StreamKey& stream) const { return ahead_.contains(stream); }
  // When to call TakeDue() for the poses that wait for an earlier one; nothing if none waits.
  [[nodiscard]] std::optional<Time> NextAhead() const;

  // A pose that has waited long enough; valid until Recycle().
  struct Released {
    StreamKey stream;
    const HeldPose* pose = nullptr;
  };
  // Takes all poses that are due, in order per stream. Also removes forgotten buffers.
  [[nodiscard]] std::span<const Released> TakeDue(Time now);
  // Takes the poses that waited for the pose `newest` of their stream, which has been used.
  [[nodiscard]] std::span<const Released> TakeFollowing(const StreamKey& stream,
                                                        std::uint32_t newest);
  // Takes all poses of one stream, due or not, as at the end of the stream.
  [[nodiscard]] std::span<const Released> TakeAll(const StreamKey& stream);
  // Frees the poses that were taken.
  void Recycle();

  // True if no stream has a buffer and no pose waits.
  [[nodiscard]] bool empty() const { return streams_.empty() && ahead_.empty(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }  // of all waiting poses

 private:
  using Buffers = std::unordered_map<StreamKey, JitterBuffer, StreamKeyHash>;

  Place Hold(const StreamKey& stream, JitterBuffer& buffer, const protocol::Header& header,
             const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload, Time due);
  void TakeAhead(Time now);
  void Release(const StreamKey& stream, std::unique_ptr<HeldPose> pose);
  [[nodiscard]] std::unique_ptr<HeldPose> NewPose();

  Buffers streams_;
  Buffers ahead_;  // of streams without a delay
  std::vector<Released> released_;
  std::vector<std::unique_ptr<HeldPose>> taken_;  // owns the poses of released_
  std::vector<std::unique_ptr<HeldPose>> spare_;  // memory for the next poses
  std::size_t bytes_ = 0;
};

}  // namespace furrow::server
