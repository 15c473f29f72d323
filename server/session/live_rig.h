// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/status.h"
#include "protocol/messages/cluster_messages.h"
#include "server/core/time.h"
#include "server/pipeline/stream_definition.h"
#include "server/session/recording_tap.h"
#include "server/session/shards.h"
#include "server/session/stream_router.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/subscribers.h"

namespace furrow::server {

// Changes what the weights of running subjects are measured by: the rig, the maps that find its
// joints, and neutral poses. Subscribers get the new weights at once. All functions require the
// hub's exclusive lock.
class LiveRig {
 public:
  // Outlive this object.
  struct Parts {
    StreamDefinitions* definitions = nullptr;
    SubjectRegistry* subjects = nullptr;
    Subscribers* subscribers = nullptr;
    StreamRouter* router = nullptr;
    Shards* shards = nullptr;
    RecordingTap* recording = nullptr;  // may be null
  };
  explicit LiveRig(const Parts& parts) : parts_(parts), own_(parts.definitions->shared_rig()) {}

  // Those of Hub.
  [[nodiscard]] Status Set(std::shared_ptr<const wrinkle::Rig> rig, Time now);
  [[nodiscard]] Status SetWithMaps(std::shared_ptr<const wrinkle::Rig> rig, StreamMaps maps,
                                   Time now);
  void SetNeutral(Subject& subject, std::optional<wrinkle::LocalPose> neutral, Time now);
  [[nodiscard]] int num_added_poses() const { return num_added_poses_; }
  void AddToAddedPoses(int number) { num_added_poses_ += number; }
  [[nodiscard]] std::uint64_t num_replacements() const { return num_replacements_; }
  [[nodiscard]] bool has_captures() const { return parts_.definitions->shared_rig() != own_; }

  // Takes over the poses that another node has captured from the subject: a capture changes the rig
  // of the daemon, on this node as on the one before. The rig has at most `most` added poses then.
  void AdoptCaptures(const protocol::SubjectState& state, int most, Time now);

 private:
  void Republish(Subject& subject, Time now);

  const Parts parts_;
  std::shared_ptr<const wrinkle::Rig> own_;  // without captures
  int num_added_poses_ = 0;
  std::uint64_t num_replacements_ = 0;
};

}  // namespace furrow::server
