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

// One subject of what is played: the frames of a clip, or a take's poses exactly as they were
// received.
class PlaySource {
 public:
  // All the subjects of a recording, or the one that `file` names ("take.mcap#ada"). Errors:
  // LoadClipArgument()'s and TakePoses::LoadAll()'s; kInvalidArgument for a recording without
  // frames. Warnings are printed.
  [[nodiscard]] static Result<std::vector<PlaySource>> Load(const std::string& file);

  // Of the frames: seconds, increasing.
  [[nodiscard]] std::span<const double> times() const;
  // When the first frame is due: seconds after that of the first subject.
  [[nodiscard]] double start() const;
  // Who was captured, as far as the recording says; else the file's name.
  [[nodiscard]] const std::string& subject() const { return subject_; }
  // `metres_per_unit` counts on top of what a take says of its unit.
  [[nodiscard]] protocol::SkeletonOffer Offer(const std::string& subject,
                                              float metres_per_unit) const;
  void Fill(int frame, protocol::PoseFrame* pose) const;

 private:
  std::variant<motion::Clip, recording::TakePoses> poses_;
  std::string subject_;
};

}  // namespace furrow::cli
