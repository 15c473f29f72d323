// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "base/numbers.h"
#include "base/status.h"
#include "motion/bvh/bvh.h"
#include "motion/clip/resample.h"

namespace furrow::motion {
namespace {

using wrinkle::kNoJoint;
using wrinkle::Skeleton;
using wrinkle::Transform;

constexpr int kDecimals = 6;
constexpr int kTimeDecimals = 9;
constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr float kScaleTolerance = 1e-4f;

struct Euler {
  double z = 0.0, y = 0.0, x = 0.0;  // degrees; R = Rz * Ry * Rx
};

// `angle` plus the multiple of 360 degrees that brings it closest to `previous`.
double Nearest(double angle, double previous) {
  return angle + 360.0 * std::round((previous - angle) / 360.0);
}

// Euler angles of `rotation`. Of all equivalent sets, takes the one closest to `previous`, so that
// curves stay continuous.
Euler ToEuler(const glm::quat& rotation, const Euler& previous) {
  const glm::dmat3 m = glm::mat3_cast(glm::normalize(glm::dquat(rotation)));  // m[column][row]
  const double cos_y = std::hypot(m[0][0], m[0][1]);
  Euler a;
  a.y = std::atan2(-m[0][2], cos_y) * kDegrees;
  if (cos_y > 1e-9) {
    a.z = std::atan2(m[0][1], m[0][0]) * kDegrees;
    a.x = std::atan2(m[1][2], m[2][2]) * kDegrees;
  } else {  // gimbal lock: only x - z (or x + z) is determined, so z keeps its value
    a.z = previous.z;
    const double sign = a.y > 0.0 ? 1.0 : -1.0;
    a.x = sign * a.z + std::atan2(sign * m[1][0], sign * m[2][0]) * kDegrees;
  }
  const auto near = [&previous](Euler e) {
    return Euler{Nearest(e.z, previous.z), Nearest(e.y, previous.y), Nearest(e.x, previous.x)};
  };
  const auto distance = [&previous](const Euler& e) {
    return std::abs(e.z - previous.z) + std::abs(e.y - previous.y) + std::abs(e.x - previous.x);
  };
  const Euler first = near(a);
  // Every rotation has a second set of angles, beyond 90 degrees of y.
  const Euler second = near({a.z + 180.0, 180.0 - a.y, a.x + 180.0});
  return distance(first) <= distance(second) ? first : second;
}

// The format has no quotes: a name ends at a brace or at the end of its line.
Status CheckName(const std::string& name) {
  bool good = !name.empty() && name.front() != ' ' && name.back() != ' ';
  for (const char c : name) {
    good = good && static_cast<unsigned char>(c) >= ' ' && c != '{' && c != '}';
  }
  if (good) return {};
  return {StatusCode::kInvalidArgument, "BVH cannot express the joint name '" + name + "'"};
}

// Writes the skeleton and the motion after it has removed rest rotations and constant scales.
class BvhWriter {
 public:
  explicit BvhWriter(const Clip& clip)
      : clip_(clip),
        skeleton_(clip.skeleton),
        num_joints_(static_cast<std::size_t>(clip.skeleton.num_joints())),
        children_(num_joints_),
        moves_(num_joints_, false),
        scale_(num_joints_, 1.0f) {}

  Result<std::string> Run() {
    for (const std::string& name : skeleton_.joint_names()) {
      FURROW_RETURN_IF_ERROR(CheckName(name));
    }
    FURROW_RETURN_IF_ERROR(AccumulateScales());
    FindChildrenAndMoves();
    text_ = "HIERARCHY\n";
    for (std::size_t j = 0; j < num_joints_; ++j) {
      if (Parent(j) == kNoJoint) WriteTree(j);
    }
    WriteMotion();
    return std::move(text_);
  }

 private:
  [[nodiscard]] int Parent(std::size_t j) const { return skeleton_.joint_parents()[j]; }

  [[nodiscard]] const Transform& Local(std::size_t frame, std::size_t j) const {
    return clip_.locals[frame * num_joints_ + j];
  }

  // scale_[j]: the product of uniform scales from the root to j.
  Status AccumulateScales() {
    for (std::size_t j = 0; j < num_joints_; ++j) {
      const glm::vec3 rest = skeleton_.rest_pose()[j].scale;
      bool good = IsUniform(rest, rest.x);
      for (std::size_t f = 0; good && f < clip_.times.size(); ++f) {
        good = IsUniform(Local(f, j).scale, rest.x);
      }
      if (!good) {
        return {StatusCode::kUnsupported,
                "joint '" + skeleton_.joint_names()[j] + "' has a scale that BVH cannot express"};
      }
      scale_[j] =
          rest.x * (Parent(j) == kNoJoint ? 1.0f : scale_[static_cast<std::size_t>(Parent(j))]);
    }
    return {};
  }

  // Only positive uniform scales become lengths. Others would shear or mirror, which BVH cannot
  // express.
  static bool IsUniform(const glm::vec3& scale, float value) {
    const float bound = kScaleTolerance * std::abs(value);
    return value > 0.0f && std::abs(scale.x - value) <= bound &&
           std::abs(scale.y - value) <= bound && std::abs(scale.z - value) <= bound;
  }

  void FindChildrenAndMoves() {
    for (std::size_t j = 0; j < num_joints_; ++j) {
      if (Parent(j) != kNoJoint) children_[static_cast<std::size_t>(Parent(j))].push_back(j);
      // Position channels only where a joint leaves its offset, beyond rounding. Roots always have
      // them.
      const glm::vec3 rest = skeleton_.rest_pose()[j].translation;
      const float bound = 1e-6f * (1.0f + glm::length(rest));
      moves_[j] = Parent(j) == kNoJoint;
      for (std::size_t f = 0; !moves_[j] && f < clip_.times.size(); ++f) {
        moves_[j] = glm::length(Local(f, j).translation - rest) > bound;
      }
    }
  }

  // Converts a translation in the parent's space to the parent's axes after its rest rotation was
  // removed.
  [[nodiscard]] glm::vec3 Offset(std::size_t j, const glm::vec3& translation) const {
    if (Parent(j) == kNoJoint) return translation;
    const auto parent = static_cast<std::size_t>(Parent(j));
    return skeleton_.rest_model_rotations()[parent] * (scale_[parent] * translation);
  }

  // BVH has no rest rotations: the rest pose has all angles 0. Each local rotation is expressed in
  // model axes at rest.
  [[nodiscard]] glm::quat Rotation(std::size_t frame, std::size_t j) const {
    const auto rest = skeleton_.rest_model_rotations();
    const glm::quat turned = Local(frame, j).rotation * glm::inverse(rest[j]);
    return Parent(j) == kNoJoint ? turned : rest[static_cast<std::size_t>(Parent(j))] * turned;
  }

  void Line(std::size_t depth, std::string_view text) {
    text_.append(depth, '\t').append(text).append("\n");
  }

  void OffsetLine(std::size_t depth, const glm::vec3& offset) {
    text_.append(depth, '\t').append("OFFSET");
    for (int axis = 0; axis < 3; ++axis) {
      text_ += ' ';
      AppendFixed(offset[axis], kDecimals, &text_);
    }
    text_ += '\n';
  }

  void OpenJoint(std::size_t j, std::size_t depth) {
    order_.push_back(j);
    Line(depth, (depth == 0 ? "ROOT " : "JOINT ") + skeleton_.joint_names()[j]);
    Line(depth, "{");
    OffsetLine(depth + 1, Offset(j, skeleton_.rest_pose()[j].translation));
    Line(depth + 1, moves_[j]
                        ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation"
                        : "CHANNELS 3 Zrotation Yrotation Xrotation");
    if (!children_[j].empty()) return;
    Line(depth + 1, "End Site");
    Line(depth + 1, "{");
    OffsetLine(depth + 2, skeleton_.rest_model_rotations()[j] * (scale_[j] * skeleton_.tails()[j]));
    Line(depth + 1, "}");
  }

  // Depth first with an explicit stack of (joint, number of children already written).
  void WriteTree(std::size_t root) {
    std::vector<std::pair<std::size_t, std::size_t>> open = {{root, 0}};
    OpenJoint(root, 0);
    while (!open.empty()) {
      auto& [joint, next] = open.back();
      if (next < children_[joint].size()) {
        const std::size_t child = children_[joint][next++];
        OpenJoint(child, open.size());
        open.emplace_back(child, 0);
      } else {
        Line(open.size() - 1, "}");
        open.pop_back();
      }
    }
  }

  void WriteMotion() {
    const double frame_time = MeanFrameTime(clip_);
    text_ += "MOTION\nFrames: " + std::to_string(clip_.num_frames()) + "\nFrame Time: ";
    AppendFixed(frame_time > 0.0 ? frame_time : 1.0 / 30.0, kTimeDecimals, &text_);
    text_ += '\n';
    std::vector<Euler> previous(num_joints_);
    for (std::size_t f = 0; f < clip_.times.size(); ++f) {
      for (const std::size_t j : order_) WriteJoint(f, j, &previous[j]);
      // Replaces the blank behind the last number.
      text_.back() = '\n';
    }
  }

  void WriteJoint(std::size_t frame, std::size_t j, Euler* euler) {
    if (moves_[j]) {
      const glm::vec3 offset = Offset(j, Local(frame, j).translation);
      for (int axis = 0; axis < 3; ++axis) WriteNumber(offset[axis]);
    }
    *euler = ToEuler(Rotation(frame, j), *euler);
    for (const double angle : {euler->z, euler->y, euler->x}) WriteNumber(angle);
  }

  void WriteNumber(double value) {
    AppendFixed(value, kDecimals, &text_);
    text_ += ' ';
  }

  const Clip& clip_;
  const Skeleton& skeleton_;
  const std::size_t num_joints_;
  std::vector<std::vector<std::size_t>> children_;
  std::vector<bool> moves_;  // per joint: has position channels
  std::vector<float> scale_;
  std::vector<std::size_t> order_;  // joints in the order of the file
  std::string text_;
};

}  // namespace

Result<std::string> BvhToText(const Clip& clip, ClipReport* report) {
  if (clip.skeleton.num_joints() == 0) {
    return Status(StatusCode::kUnsupported,
                  "the clip has no joints, and BVH can express nothing else");
  }
  if (clip.num_frames() == 0) return Status(StatusCode::kInvalidArgument, "the clip has no frames");
  if (!clip.blend_shape_names.empty() && report != nullptr) {
    report->warnings.push_back("BVH has no blend shapes: " +
                               std::to_string(clip.blend_shape_names.size()) + " are dropped");
  }
  if (IsEvenlySpaced(clip)) return BvhWriter(clip).Run();
  if (report != nullptr) {
    report->warnings.emplace_back(
        "the frames are not evenly spaced and were resampled at their mean rate");
  }
  const Clip even = Resample(clip, 1.0 / MeanFrameTime(clip));
  return BvhWriter(even).Run();
}

}  // namespace furrow::motion
