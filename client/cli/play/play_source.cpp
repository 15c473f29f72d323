// SPDX-License-Identifier: Apache-2.0
#include "client/cli/play/play_source.h"

#include <filesystem>
#include <utility>

#include "base/status.h"
#include "client/cli/common/inputs.h"
#include "motion/clip_file.h"
#include "recording/take_clip.h"
#include "recording/wire_pose.h"

namespace furrow::cli {

using recording::TakePoses;

Result<std::vector<PlaySource>> PlaySource::Load(const std::string& path,
                                                 const motion::LoadOptions& read) {
  std::vector<PlaySource> sources;
  if (recording::IsTakePath(path)) {
    std::string subject;
    const auto take = OpenTakeArgument(path, &subject);
    FURROW_RETURN_IF_ERROR(take);
    motion::ClipReport report;
    auto all = TakePoses::LoadAll(**take, subject, &report);
    PrintWarnings(report.warnings);
    FURROW_RETURN_IF_ERROR(all);
    for (TakePoses& poses : *all) {
      PlaySource& source = sources.emplace_back();
      source.subject_ = poses.offer().subject;
      source.poses_ = std::move(poses);
    }
    return sources;
  }
  auto clip = LoadClipArgument(path, read);
  FURROW_RETURN_IF_ERROR(clip);
  if (clip->num_frames() == 0)
    return Status(StatusCode::kInvalidArgument, "the recording has no frames", path);
  PlaySource& source = sources.emplace_back();
  std::filesystem::path file;
  std::string animation;
  motion::SplitClipPath(path, &file, &animation);
  source.subject_ = file.stem().string();
  source.poses_ = *std::move(clip);
  return sources;
}

double PlaySource::start() const {
  // A clip has one subject, which starts the session.
  const auto* poses = std::get_if<TakePoses>(&poses_);
  return poses != nullptr ? poses->start() : 0.0;
}

std::span<const double> PlaySource::times() const {
  if (const auto* clip = std::get_if<motion::Clip>(&poses_)) return clip->times;
  return std::get<TakePoses>(poses_).times();
}

protocol::SkeletonOffer PlaySource::Offer(const std::string& subject, float metres_per_unit) const {
  if (const auto* clip = std::get_if<motion::Clip>(&poses_))
    return recording::OfferOf(*clip, subject, metres_per_unit);
  protocol::SkeletonOffer offer = std::get<TakePoses>(poses_).offer();
  offer.subject = subject;
  // The take has a unit of its own, which --scale multiplies.
  offer.metres_per_unit *= metres_per_unit;
  return offer;
}

Result<wrinkle::Skeleton> PlaySource::Skeleton() const {
  if (const auto* clip = std::get_if<motion::Clip>(&poses_)) return clip->skeleton;
  return recording::SkeletonOf(std::get<TakePoses>(poses_).offer(), 1.0f);
}

// Poses of a take are sent as recorded; those of a clip are made from its transforms.
void PlaySource::Fill(int frame, protocol::PoseFrame* pose) const {
  if (const auto* clip = std::get_if<motion::Clip>(&poses_)) {
    recording::FillPose(*clip, frame, pose);
  } else {
    std::get<TakePoses>(poses_).Get(static_cast<std::size_t>(frame), pose);
  }
}

}  // namespace furrow::cli
