// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <variant>

#include "motion/clip.h"
#include "protocol/messages.h"
#include "recording/take_poses.h"
#include "wrinkle/status.h"

namespace furrow::cli {

// What is played: the frames of a clip, or a take's poses exactly as they were received.
class PlaySource {
 public:
  // Errors: LoadClipArgument()'s and TakePoses::Load()'s; kInvalidArgument for a recording without
  // frames. Warnings are printed.
  [[nodiscard]] static Result<PlaySource> Load(const std::string& file);

  // Of the frames: seconds, increasing.
  [[nodiscard]] std::span<const double> times() const;
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
