// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/pose_batch.h"

#include <utility>

namespace furrow::server {

// Prepare() marks the pipeline as waiting, so that StreamRouter publishes the batch before it
// accepts another pose of the subject.
void PoseBatch::Add(const GatheredPose& pose) {
  updates_[size_] =
      pose.subject->pipeline->Prepare(pose.header.sequence, pose.header.capture_time_us);
  poses_[size_++] = pose;
}

std::span<const GatheredPose> PoseBatch::Solve() {
  const std::size_t count = std::exchange(size_, 0);
  // A refused pose does not affect the others: each has its own status.
  solver_.Run(std::span(updates_).first(count));
  for (std::size_t i = 0; i < count; ++i) {
    poses_[i].status = poses_[i].subject->pipeline->Finish(updates_[i].status);
  }
  return std::span(poses_).first(count);
}

}  // namespace furrow::server
