// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace furrow::server {

// Everything that is counted, above all everything that is dropped. Counts only grow; base units,
// Prometheus' naming, never labelled by subject or peer.
enum class Counter {
  kDatagramsReceived,
  kDatagramsSent,
  kDatagramsOverrun,     // lost in the socket's full buffer, as the system counts them
  kDatagramsMalformed,   // no verified message: wrong magic, truncated, hostile
  kDatagramsUnsendable,  // the socket's buffer was full, or the address is gone
  kDatagramsUnproven,    // not sent: the address is unproven and has had its share
  kFragmentsMalformed,
  kFragmentsRefused,  // over the limits of reassembly
  kFragmentsExpired,  // messages whose rest never came
  kConnectionsAccepted,
  kConnectionsRefused,    // over the limit
  kConnectionsMalformed,  // closed for a frame of impossible length
  kConnectionsOverrun,    // closed because they do not read their replies
  kConnectionsIdle,       // closed by the watchdog
  kMessagesBundled,       // that left in a datagram with others
  kMessagesReceived,
  kMessagesThrottled,  // over a peer's token bucket; not looked at
  kMessagesMalformed,  // an envelope, but not what it says
  kMessagesRefused,    // verified, but not to be obeyed; answered
  kPosesReceived,
  kPosesLate,
  kPosesDuplicate,
  kPosesInvalid,         // wrong counts, non-finite, not a unit quaternion
  kPosesUnknownStream,   // no skeleton offered under this session and hash
  kPosesRetiredSession,  // of a sender that has restarted or lost its subject
  kSkeletonsOffered,
  kSkeletonsRejected,
  kSkeletonsRequested,  // 'needed' answers to poses without an offer
  kSkeletonsThrottled,  // new ones that came too fast; not looked at, to be offered again
  kSubjectsRestarted,   // a new session took over a subject
  kSubjectsLost,        // a publisher vanished; its subject decays to neutral
  kSubscriptionsAccepted,
  kSubscriptionsRefused,
  kWeightsSent,
  kFramesSkippedRate,   // weights or pictures not due yet at the subscriber's rate
  kWeightsDroppedSlow,  // replaced in a full outbox by a newer one
  kPosesRelayed,
  kPosesDroppedSlow,  // left out or replaced in a full outbox
  kPicturesRendered,
  kPicturesEncoded,
  kPicturesSent,
  kPicturesDroppedSlow,  // replaced in an outbox by a newer one
  kPicturesFailed,
  kSnapshotsReplaced,  // a newer pose came before the renderer took the older one
  kRendererRestarts,
  kMocapPackets,
  kMocapMalformed,
  kMocapReordered,   // older than what was used already
  kMocapIncomplete,  // frames used without their sender's mark of the end
  kMocapStale,       // of a sender that says its tracking is off
  kMocapFrames,
  kMocapLockedOut,  // of a sender that the port does not listen to
  kMocapRefused,    // frames of a subject that is refused or one too many
  kOscPacketsSent,
  kOscPacketsUnsendable,
  kHttpConnections,
  kHttpRequests,
  kHttpRefused,  // no HTTP, too large, or a Host or Origin that may not ask
  kWebSocketsAccepted,
  kRecordingMessages,  // written to a take
  kRecordingDropped,   // the disk was too slow for them
  kRecordingFailures,  // recordings that ended for an error
  kCount,
};

// "furrow_poses_late_total".
[[nodiscard]] std::string_view CounterName(Counter counter);

// The counters of one daemon. Any thread may add and read; reading sees each counter by itself.
// Each thread adds in a place of its own, as far as there are places, and reading sums them: what
// is counted at every pose would else travel between the processors at every pose.
class Metrics {
 public:
  void Add(Counter counter, std::uint64_t count = 1) {
    places_[PlaceOfThread()].values[static_cast<std::size_t>(counter)].fetch_add(
        count, std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t Get(Counter counter) const {
    std::uint64_t sum = 0;
    for (const Place& place : places_) {
      sum += place.values[static_cast<std::size_t>(counter)].load(std::memory_order_relaxed);
    }
    return sum;
  }

 private:
  static constexpr std::size_t kPlaces = 16;
  struct alignas(64) Place {
    std::array<std::atomic<std::uint64_t>, static_cast<std::size_t>(Counter::kCount)> values{};
  };
  static std::size_t PlaceOfThread() {
    static std::atomic<std::size_t> next = 0;
    thread_local const std::size_t place = next.fetch_add(1, std::memory_order_relaxed) % kPlaces;
    return place;
  }

  std::array<Place, kPlaces> places_;
};

}  // namespace furrow::server
