// SPDX-License-Identifier: Apache-2.0
#include "rig/poses_in_axes.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

namespace furrow::rig {
namespace {

class TurningSource {
 public:
  TurningSource(wrinkle::PoseSource source, std::function<SkeletonMatcher()> make_matcher,
                std::function<void(const std::string&)> warn)
      : source_(std::move(source)),
        make_matcher_(std::move(make_matcher)),
        warn_(std::move(warn)),
        last_(std::make_shared<Last>()) {}

  Result<wrinkle::PoseFrame> operator()(const std::filesystem::path& path, int frame) const {
    Result<wrinkle::PoseFrame> read = source_(path, frame);
    if (!read.ok() || read->skeleton.num_joints() == 0) return read;
    const glm::quat turn = TurnOf(read->skeleton, path);
    if (turn == wrinkle::RestStance().turn) return read;  // the same bits
    // A pose of another length is an error that the reader of rigs reports.
    if (static_cast<int>(read->pose.joints.size()) == read->skeleton.num_joints()) {
      wrinkle::TurnRoots(read->skeleton, turn, read->pose.joints);
    }
    read->skeleton = wrinkle::TurnRoots(read->skeleton, turn);
    return read;
  }

 private:
  // A rig names many frames of one recording, which have one skeleton.
  struct Last {
    std::optional<SkeletonMatcher> matcher;
    std::optional<std::uint64_t> skeleton;
    glm::quat turn;
  };

  [[nodiscard]] glm::quat TurnOf(const wrinkle::Skeleton& skeleton,
                                 const std::filesystem::path& path) const {
    if (last_->skeleton == skeleton.hash()) return last_->turn;
    if (!last_->matcher) last_->matcher = make_matcher_();
    const SkeletonMatcher& matcher = *last_->matcher;
    const auto stance = matcher.StanceOf(skeleton, matcher.RolesOf(skeleton).roles);
    last_->skeleton = skeleton.hash();
    last_->turn = stance ? stance->turn : wrinkle::RestStance().turn;
    if (!stance && warn_) warn_(path.string() + ": " + UnknownAxes());
    return last_->turn;
  }

  wrinkle::PoseSource source_;
  std::function<SkeletonMatcher()> make_matcher_;
  std::function<void(const std::string&)> warn_;
  std::shared_ptr<Last> last_;
};

}  // namespace

wrinkle::PoseSource PosesInFurrowAxes(wrinkle::PoseSource source, SkeletonMatcher matcher,
                                      std::function<void(const std::string&)> warn) {
  return PosesInFurrowAxes(
      std::move(source), [matcher = std::move(matcher)] { return matcher; }, std::move(warn));
}

wrinkle::PoseSource PosesInFurrowAxes(wrinkle::PoseSource source,
                                      std::function<SkeletonMatcher()> make_matcher,
                                      std::function<void(const std::string&)> warn) {
  return TurningSource(std::move(source), std::move(make_matcher), std::move(warn));
}

}  // namespace furrow::rig
