// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "protocol/framing/envelope.h"
#include "protocol/messages/messages.h"
#include "server/core/time.h"
#include "server/session/delivery/publish_context.h"
#include "server/session/recording_tap.h"
#include "server/session/shard.h"
#include "server/session/subjects/publishers.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/subscribers.h"
#include "server/session/trace/pose_tracer.h"

namespace furrow::server {

// Called with each new or decayed set of weights. `shard`: of the calling thread; 0 if that thread
// holds the exclusive lock.
using OnWeights = std::function<void(const Subject& subject, int shard, Time now)>;

// Connects publishers to subscribers: takes skeleton offers and decoded poses, solves the poses in
// batches, and hands each result to the subscriptions, the recorder and OSC.
class StreamRouter {
 public:
  struct Parts {
    Publishers* publishers = nullptr;
    Subscribers* subscribers = nullptr;
    SubjectRegistry* subjects = nullptr;
    PublishContext* exclusive_context = nullptr;  // used under the exclusive lock
    RecordingTap* recording = nullptr;            // optional
    PoseTracer* tracer = nullptr;                 // optional
  };
  explicit StreamRouter(const Parts& parts) : parts_(parts) {}

  // Starts or changes a subject. False: the offer was rejected, ignored or throttled. Requires the
  // exclusive lock.
  bool OnOffer(Peer& peer, const protocol::Header& header, const protocol::SkeletonOffer& offer,
               Time now);

  // Goes on with a subject of the daemon that was here before (Publishers::Resume()). Requires the
  // exclusive lock.
  [[nodiscard]] Subject* Resume(Peer& peer, const protocol::Header& header,
                                const protocol::SkeletonOffer& offer,
                                const Arrivals::Arrived& arrived, Time now);

  // Requests the memory that a pose of the stream uses. Call it before the pose is decoded.
  // Requires the lock of the stream's shard.
  void Prefetch(const Peer& peer, const protocol::Header& header);
  // Copies a pose into its subject's pipeline and adds it to the shard's batch, where it waits for
  // PublishGathered(). If the subject has a jitter buffer, the pose waits there for ReleaseHeld().
  // Without one, a pose may wait for an earlier one, for kEarlierPatience at most.
  // `payload`: the FlatBuffers buffer of the pose, valid until then; empty if the pose is partial.
  // Requires the lock of `shard`.
  void AcceptPose(Shard& shard, Peer& peer, const protocol::Header& header,
                  const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload, Time now);
  // True if the pose before `header`'s can still be used: it was not received, and no newer one was
  // used. Requires the lock of `shard`.
  [[nodiscard]] bool MissesPrevious(Shard& shard, const Peer& peer, const protocol::Header& header);
  // Takes the pose that another one repeats, before that one. Requires the lock of `shard`.
  // `header`: of the other one; `age_us`: PoseFrame::previous_age_us.
  void AcceptPrevious(Shard& shard, const Peer& peer, protocol::Header header, std::uint32_t age_us,
                      const protocol::PoseFrame& previous, Time now);
  // Accepts the poses of the shard that have waited long enough, and publishes them. Requires the
  // lock of `shard`.
  void ReleaseHeld(Shard& shard, Time now);
  // The same for all poses of one stream, due or not, before the stream ends. Requires the
  // exclusive lock.
  void ReleaseStream(Shard& shard, const StreamKey& stream, Time now);
  // A frame arrived in which the tracker of a subject sees no face. Requires the lock of the peer's
  // shard.
  void OnNoFace(const Peer& peer, const protocol::Header& header, Time now) {
    parts_.publishers->OnNoFace(peer, header, now);
  }
  // Solves the waiting poses of a shard together and publishes them in order of arrival. Requires
  // the lock of `shard`.
  void PublishGathered(Shard& shard);
  // The messages of the shard have left. Requires the lock of `shard`.
  void OnFlushed(Shard& shard) {
    if (shard.followed == Shard::Followed::kPublished) EndTrace(shard);
  }

  // Publishes weights that changed without a new pose. `age_us`: time since the last pose, > 0.
  // Requires the exclusive lock.
  void PublishAged(Shard& shard, Subject& subject, std::int64_t age_us, Time now);

  // Stops sending to subscribers, which have been sent a goodbye. Recorder and OSC go on.
  void StopFanOut() { fans_out_ = false; }
  // A thread has the exclusive lock, or gives it up. Requires it.
  void SetExclusive(bool exclusive) { exclusive_ = exclusive; }

  // Is called with each subject's new weights; empty, as at first: nobody is. Requires the
  // exclusive lock.
  void SetOnWeights(OnWeights on_weights) { on_weights_ = std::move(on_weights); }

 private:
  void HoldOrUse(Shard& shard, Subject& subject, const protocol::Header& header,
                 const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload, Time now);
  [[nodiscard]] static bool IsAhead(Shard& shard, const Subject& subject,
                                    const protocol::Header& header, Time now);
  void CountHeld(Subject& subject, JitterBuffers::Place place);
  [[nodiscard]] bool Hold(Shard& shard, Subject& subject, const protocol::Header& header,
                          const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload,
                          Time now);
  void Use(Shard& shard, Subject& subject, const protocol::Header& header,
           const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload, Time now);
  void UseReleased(Shard& shard, std::span<const JitterBuffers::Released> released, Time now);
  static void NotePublished(Shard& shard, const GatheredPose& pose);
  void BeginTrace(Shard& shard, Subject& subject, const protocol::Header& header, Time now);
  void RetryTrace(Shard& shard);
  void EndTrace(Shard& shard);
  void Publish(Shard& shard, Subject& subject, std::span<const std::uint8_t> payload,
               std::int64_t age_us, Time now);

  Parts parts_;
  OnWeights on_weights_;  // may be empty
  bool fans_out_ = true;
  bool exclusive_ = false;  // SetExclusive()
};

}  // namespace furrow::server
