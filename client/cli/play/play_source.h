// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/status.h"
#include "motion/clip/clip.h"
#include "protocol/messages/messages.h"
#include "recording/take_poses.h"

namespace furrow::cli {

// One subject to play: the frames of a clip, or the recorded poses of a take, unchanged.
class PlaySource {
 public:
  // Loads all subjects of a recording, or the subject that `file` names ("take.mcap#ada"). Prints
  // warnings. Errors: those of LoadClipArgument() and TakePoses::LoadAll(); kInvalidArgument (no
  // frames).
  [[nodiscard]] static Result<std::vector<PlaySource>> Load(const std::string& file,
                                                            const motion::LoadOptions& read = {});

  // Frame times in seconds, increasing.
  [[nodiscard]] std::span<const double> times() const;
  // Time of the first frame, in seconds after the first frame of the session.
  [[nodiscard]] double start() const;
  // The recorded name of the subject, or the name of the file without extension.
  [[nodiscard]] const std::string& subject() const { return subject_; }
  // The joints of the recording; empty if it has blend shapes only. Errors: those of
  // wrinkle::Skeleton::Create().
  [[nodiscard]] Result<wrinkle::Skeleton> Skeleton() const;
  // The skeleton offer under the name `subject`. `metres_per_unit`: metres per unit of the
  // recording; multiplies the unit that a take states.
  [[nodiscard]] protocol::SkeletonOffer Offer(const std::string& subject,
                                              float metres_per_unit) const;
  // Sets `pose` to frame `frame`, which is an index into times().
  void Fill(int frame, protocol::PoseFrame* pose) const;

 private:
  std::variant<motion::Clip, recording::TakePoses> poses_;
  std::string subject_;
};

}  // namespace furrow::cli
