// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "server/core/thread_slot.h"
#include "server/core/time.h"
#include "server/core/timings.h"

namespace furrow::server {

// The counters of a daemon, in particular one for every kind of drop. CounterHelp() describes each
// counter. Counters only grow and have no labels for subjects or peers.
enum class Counter {
  kDatagramsReceived,
  kDatagramsSent,
  kDatagramsOverrun,
  kDatagramsMalformed,
  kDatagramsUnsendable,
  kDatagramsUnproven,
  kWakeUps,
  kWakeUpsSpared,
  kHandshakes,
  kHandshakeRetries,
  kSealedForged,
  kSealedReplayed,
  kFragmentsMalformed,
  kFragmentsRefused,
  kFragmentsExpired,
  kConnectionsAccepted,
  kAcceptsFailed,
  kConnectionsRefused,
  kConnectionsMalformed,
  kConnectionsOverrun,
  kWaitingRefused,
  kConnectionsIdle,
  kTlsHandshakes,
  kTlsPlain,
  kTlsSlow,
  kTlsBusy,
  kTlsOldVersion,
  kTlsWrongProtocol,
  kTlsNoCertificate,
  kTlsBadCertificate,
  kTlsRefusedByClient,
  kTlsFailed,
  kConnectionsGaveWay,
  kMessagesBundled,
  kMessagesReceived,
  kMessagesThrottled,
  kRequestsThrottled,
  kMessagesMalformed,
  kMessagesRefused,
  kRepliesWithoutConsent,
  kRefusedNoToken,
  kRefusedUnknownSession,
  kRefusedUnknownKey,
  kRefusedExpired,
  kRefusedForgedToken,
  kRefusedWrongServer,
  kRefusedTokenInUse,
  kRefusedForgedHandshake,
  kRefusedBusy,
  kRefusedFull,
  kRefusedMalformed,
  kRefusedInClear,
  kRefusedPublish,
  kRefusedWatch,
  kRefusedDirect,
  kRefusedOperate,
  kTokensEnded,
  kTokensMade,
  kPosesReceived,
  kPosesLate,
  kPosesUnplaced,
  kPosesDuplicate,
  kPosesInvalid,
  kPosesUnknownStream,
  kPosesRecovered,
  kPosesHeld,
  kPosesHeldFull,
  kSkeletonsOffered,
  kSkeletonsRejected,
  kSkeletonsRequested,
  kSkeletonsThrottled,
  kSubjectsRestarted,
  kSubjectsContested,
  kRedirected,
  kSubjectsLost,
  kStalls,
  kSubscriptionsAccepted,
  kSubscriptionsRefused,
  kWeightsSent,
  kFramesSkippedRate,
  kWeightsDroppedSlow,
  kPosesRelayed,
  kPosesDroppedSlow,
  kPicturesRendered,
  kPicturesEncoded,
  kVideoPictures,
  kVideoKeyPictures,
  kPicturesSent,
  kPicturesDroppedSlow,
  kPicturesFailed,
  kPicturesCrowded,
  kPicturesWithdrawn,
  kSnapshotsReplaced,
  kPicturesHeld,
  kRendererRestarts,
  kRendererStuck,
  kAllocationsFailed,
  kReserveUsed,
  kMocapPackets,
  kMocapMalformed,
  kMocapReordered,
  kMocapIncomplete,
  kMocapStale,
  kMocapFrames,
  kMocapLockedOut,
  kMocapRefused,
  kOscPacketsSent,
  kOscPacketsUnsendable,
  kHttpConnections,
  kHttpRequests,
  kHttpRefused,
  kHttpThrottled,
  kHttpSlowed,
  kWebSocketsAccepted,
  kRecordingMessages,
  kRecordingDropped,
  kRecordingFailures,
  kCount,
};

// The Prometheus name, for example "furrow_poses_late_total".
[[nodiscard]] std::string_view CounterName(Counter counter);

// One sentence for Prometheus' HELP line.
[[nodiscard]] std::string_view CounterHelp(Counter counter);

// The counters and histograms of one daemon. Any thread may add and read at any time.
//
// Each thread adds to its slot (thread_slot.h), and Get() sums the slots.
class Metrics {
 public:
  // Adds `count` to a counter. Never blocks.
  void Add(Counter counter, std::uint64_t count = 1) {
    if (count == 0) return;
    const std::size_t slot = SlotOfThread();
    AddInSlot(slot, slots_[slot].values[static_cast<std::size_t>(counter)], count);
  }
  // The value of a counter since the start.
  [[nodiscard]] std::uint64_t Get(Counter counter) const {
    std::uint64_t sum = 0;
    for (const Slot& slot : slots_) {
      sum += slot.values[static_cast<std::size_t>(counter)].load(std::memory_order_relaxed);
    }
    return sum;
  }

  // Counts a duration.
  void Observe(Timing timing, Time duration) { timings_.Observe(timing, duration); }
  [[nodiscard]] const Timings& timings() const { return timings_; }

 private:
  struct alignas(64) Slot {
    std::array<std::atomic<std::uint64_t>, static_cast<std::size_t>(Counter::kCount)> values{};
  };

  std::array<Slot, kThreadSlots> slots_;
  Timings timings_;
};

}  // namespace furrow::server
