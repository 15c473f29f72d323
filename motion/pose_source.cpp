// SPDX-License-Identifier: Apache-2.0
#include "motion/pose_source.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "base/status.h"
#include "motion/clip_file.h"

namespace furrow::motion {
namespace {

Result<wrinkle::PoseFrame> GetFrame(const Clip& clip, const std::filesystem::path& path,
                                    int frame) {
  if (clip.skeleton.num_joints() == 0 && clip.blend_shape_names.empty()) {
    return Status(StatusCode::kUnsupported, "the recording has neither joints nor blend shapes",
                  path.string());
  }
  if (frame < 0 || frame >= clip.num_frames()) {
    return Status(StatusCode::kInvalidArgument,
                  "frame " + std::to_string(frame) + " does not exist: the recording has " +
                      std::to_string(clip.num_frames()) + " frames, counted from 0",
                  path.string());
  }
  wrinkle::PoseFrame result;
  result.skeleton = clip.skeleton;
  clip.GetPose(frame, &result.pose);
  result.blend_shape_names = clip.blend_shape_names;
  return result;
}

}  // namespace

struct CachedPoseSource::Entry {
  std::filesystem::path path;
  std::filesystem::file_time_type time;
  std::uintmax_t size = 0;
  std::optional<Clip> clip;
};

CachedPoseSource::CachedPoseSource(const LoadOptions& options,
                                   std::function<void(const std::string&)> warn)
    : options_(options), warn_(std::move(warn)), entry_(std::make_shared<Entry>()) {}

Result<wrinkle::PoseFrame> CachedPoseSource::operator()(const std::filesystem::path& path,
                                                        int frame) const {
  std::error_code error;  // ignored: LoadClip() reports what is wrong with the file
  std::filesystem::path file;
  std::string animation;
  SplitClipPath(path, &file, &animation);
  const auto time = std::filesystem::last_write_time(file, error);
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  // A rig names many frames of one file, so the last file stays loaded. Time and size tell whether
  // it changed on disk.
  const bool fresh =
      entry_->clip && entry_->path == path && entry_->time == time && entry_->size == size;
  if (!fresh) {
    entry_->clip.reset();
    ClipReport report;
    Result<Clip> clip = LoadClip(path, options_, &report);
    FURROW_RETURN_IF_ERROR(clip);
    if (warn_) std::for_each(report.warnings.begin(), report.warnings.end(), warn_);
    *entry_ = {path, time, size, std::move(*clip)};
  }
  return GetFrame(*entry_->clip, path, frame);
}

}  // namespace furrow::motion
