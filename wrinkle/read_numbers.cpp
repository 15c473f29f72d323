// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/read_numbers.h"

#include <algorithm>

#include "wrinkle/binding_data.h"

namespace furrow::wrinkle {
namespace {

constexpr std::size_t kJointNumbers = sizeof(Transform) / sizeof(float);
constexpr std::size_t kTranslation = 0;
constexpr std::size_t kRotation = 3;
constexpr std::size_t kScale = 7;
// Looking at a few numbers too many is faster than to begin anew.
constexpr std::size_t kLeastGap = 32;

class ReadNumbers {
 public:
  explicit ReadNumbers(std::size_t num_joints) : is_read_(num_joints * kJointNumbers, false) {}

  void AddPoint(const JointChains::Chain& chain) {
    const bool is_origin = chain.offset == glm::vec3(0.0f);
    for (std::size_t i = 0; i < chain.up.size(); ++i) {
      const bool whole = i > 0 || !is_origin;
      Add(chain.up[i], kTranslation, whole ? kJointNumbers : kRotation);
    }
    for (const std::int16_t joint : chain.down) Add(joint, kTranslation, kJointNumbers);
  }

  void AddRotation(int joint) { Add(joint, kRotation, kScale); }

  [[nodiscard]] std::vector<NumberRange> Others() const {
    std::vector<NumberRange> ranges;
    for (std::size_t i = 0; i < is_read_.size(); ++i) {
      if (is_read_[i]) continue;
      if (!ranges.empty() && i - (ranges.back().first + ranges.back().count) < kLeastGap) {
        ranges.back().count = i + 1 - ranges.back().first;
      } else {
        ranges.push_back({i, 1});
      }
    }
    return ranges;
  }

 private:
  void Add(int joint, std::size_t from, std::size_t to) {
    const auto first = is_read_.begin() + static_cast<std::ptrdiff_t>(joint) *
                                              static_cast<std::ptrdiff_t>(kJointNumbers);
    std::fill(first + static_cast<std::ptrdiff_t>(from), first + static_cast<std::ptrdiff_t>(to),
              true);
  }

  std::vector<bool> is_read_;
};

}  // namespace

std::vector<NumberRange> UnreadNumbers(const BindingData& data) {
  ReadNumbers read(static_cast<std::size_t>(data.skeleton.num_joints()));
  const auto add_bones = [&](const BonePair& bones) {
    read.AddPoint(data.chains.chain(bones.joint_point));
    read.AddPoint(data.chains.chain(bones.end_point));
  };
  for (const PoseDriverSet::Entry& entry : data.pose_drivers.entries()) {
    if (entry.solve == PoseSolve::kNnls) continue;  // not evaluated side by side
    for (const auto& point : data.pose_drivers.points(entry)) {
      read.AddPoint(data.chains.chain(point.point));
    }
  }
  for (const HingeDriverSet::Entry& entry : data.hinge_drivers.entries()) add_bones(entry.bones);
  for (const BallDriverSet::Entry& entry : data.ball_drivers.entries()) add_bones(entry.bones);
  for (const TwistDriverSet::Entry& entry : data.twist_drivers.entries()) {
    for (const auto& joint : data.twist_drivers.joints(entry)) read.AddRotation(joint.joint);
  }
  return read.Others();
}

}  // namespace furrow::wrinkle
