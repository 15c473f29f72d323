// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "motion/clip/clip.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::motion {

// Loads frames of recordings with LoadClip(); a wrinkle::PoseSource. It caches the last recording,
// so that a rig with sixty frames of one file reads the file once. A file that changed on disk
// (size or time) is read again.
//
// - `frame` counts from 0. Copies share the cache. Not thread-safe.
// - Errors: those of LoadClip(), kInvalidArgument (no such frame; the message says how many there
//   are), kUnsupported (a recording without joints and blend shapes).
class CachedPoseSource {
 public:
  // `warn` receives the reader's warnings each time a recording is read. Optional.
  explicit CachedPoseSource(const LoadOptions& options = {},
                            std::function<void(const std::string&)> warn = {});

  [[nodiscard]] Result<wrinkle::PoseFrame> operator()(const std::filesystem::path& path,
                                                      int frame) const;

 private:
  struct Entry;
  LoadOptions options_;
  std::function<void(const std::string&)> warn_;
  std::shared_ptr<Entry> entry_;
};

}  // namespace furrow::motion
