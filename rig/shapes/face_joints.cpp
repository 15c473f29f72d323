// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/face_joints.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>

#include "rig/shapes/arkit_shapes.h"

namespace furrow::rig {
namespace {

constexpr std::size_t kMinLandmarks = 6;
constexpr float kCornea = 0.19f;  // from an eye's centre to its front, in distances of the eyes
constexpr float kReach = 0.3f;    // from a joint to the surface, in distances of the eyes

// The fronts of the left and the right eye, in model space in the rest pose.
struct Eyes {
  std::array<glm::vec3, 2> fronts;
  [[nodiscard]] glm::vec3 Middle() const { return 0.5f * (fronts[0] + fronts[1]); }
  [[nodiscard]] float Distance() const { return glm::distance(fronts[0], fronts[1]); }
};

int FindRole(const wrinkle::JointRoles& roles, wrinkle::JointRole role) {
  const auto found = std::ranges::find(roles, role);
  return found == roles.end() ? wrinkle::kNoJoint : static_cast<int>(found - roles.begin());
}

// `turn`: from the skeleton's model space to Furrow's, in which faces look along +Z.
std::optional<Eyes> EyesOfJoints(const wrinkle::Skeleton& skeleton,
                                 const wrinkle::JointRoles& roles, const glm::quat& turn) {
  const int left = FindRole(roles, wrinkle::JointRole::kLeftEye);
  const int right = FindRole(roles, wrinkle::JointRole::kRightEye);
  if (left == wrinkle::kNoJoint || right == wrinkle::kNoJoint) return std::nullopt;
  Eyes eyes{{RestOrigin(skeleton, left), RestOrigin(skeleton, right)}};
  const glm::vec3 front = glm::conjugate(turn) * glm::vec3(0.0f, 0.0f, kCornea * eyes.Distance());
  for (glm::vec3& at : eyes.fronts) at += front;
  return eyes;
}

// Where a closing lid moves: the centre of the points, weighted by the fourth power of the motion.
std::optional<glm::vec3> EyeOfBlink(const ShapeFace& face, const wrinkle::ShapeProgram& program,
                                    std::string_view blink) {
  std::vector<float> coefficients(kNumArkitShapes, 0.0f);
  coefficients[static_cast<std::size_t>(FindArkitShape(blink))] = 1.0f;
  std::vector<float> weights(face.shapes.size());
  if (program.Run(coefficients, weights) != wrinkle::JobStatus::kOk) return std::nullopt;
  glm::dvec3 sum(0.0);
  double total = 0.0;
  for (const auto& point : face.surface.points) {
    glm::dvec3 motion(0.0);
    for (const auto& [shape, delta] : point.deltas) motion += glm::dvec3(weights[shape] * delta);
    const double fourth = glm::dot(motion, motion) * glm::dot(motion, motion);
    sum += fourth * glm::dvec3(point.position);
    total += fourth;
  }
  if (!(total > 0.0)) return std::nullopt;
  return glm::vec3(sum / total);
}

std::optional<Eyes> EyesOf(const ShapeFace& face, const ShapeMatcher& matcher) {
  const auto& names = ArkitShapes();
  const auto program =
      MatchShapes(matcher, std::vector<std::string>(names.begin(), names.end()), face.shapes);
  const auto left = EyeOfBlink(face, program, "eyeBlinkLeft");
  const auto right = EyeOfBlink(face, program, "eyeBlinkRight");
  if (left && right) {
    const Eyes eyes{{*left, *right}};
    // One shape for both lids would put both eyes between the eyes.
    if (eyes.fronts[0].x > eyes.fronts[1].x && eyes.Distance() > 1e-4f) return eyes;
  }
  return EyesOfJoints(face.skeleton, face.roles, glm::quat(1.0f, 0.0f, 0.0f, 0.0f));
}

// The joints below the head that the character lacks.
std::vector<bool> MovedJoints(const FaceJoints& joints, int head) {
  const wrinkle::Skeleton& skeleton = joints.skeleton;
  std::vector<bool> moved(static_cast<std::size_t>(skeleton.num_joints()), false);
  for (const std::string& name : joints.unmatched) {
    const int joint = skeleton.Find(name);
    if (joint == wrinkle::kNoJoint || joint == head) continue;
    moved[static_cast<std::size_t>(joint)] = skeleton.IsAncestor(head, joint);
  }
  return moved;
}

// The points that move with the joint, in its space. An eye has its front alone, because its centre
// says nothing, and a leaf its end too if the file states one.
std::vector<glm::vec3> PointsOf(const FaceJoints& joints, const Eyes& eyes, int joint) {
  const wrinkle::Skeleton& skeleton = joints.skeleton;
  const wrinkle::JointRole role = joints.roles[static_cast<std::size_t>(joint)];
  if (role == wrinkle::JointRole::kLeftEye || role == wrinkle::JointRole::kRightEye) {
    const glm::vec3& front = eyes.fronts[role == wrinkle::JointRole::kLeftEye ? 0 : 1];
    return {glm::vec3(glm::inverse(skeleton.rest_model()[joint]) * glm::vec4(front, 1.0f))};
  }
  const bool is_leaf =
      std::ranges::find(skeleton.joint_parents(), joint) == skeleton.joint_parents().end();
  const glm::vec3& tail = skeleton.tails()[joint];
  if (is_leaf && tail != skeleton.rest_pose()[joint].translation) return {glm::vec3(0.0f), tail};
  return {glm::vec3(0.0f)};
}

// The mouth's shapes by their meaning.
wrinkle::JointShapes::FaceShapes ShapesOf(const ShapeFace& face, const ShapeMatcher& matcher) {
  const ShapeMeanings meanings = matcher.MeaningsOf(face.shapes);
  wrinkle::JointShapes::FaceShapes shapes{.count = face.shapes.size()};
  const int jaw = meanings.Find("jawOpen");
  const int close = meanings.Find("mouthClose");
  if (jaw < 0 || close < 0) return shapes;
  shapes.jaw_open = static_cast<std::uint32_t>(jaw);
  shapes.mouth_close = static_cast<std::uint32_t>(close);
  shapes.close_contains_jaw = std::ranges::any_of(face.rules, [&](const auto& rule) {
    return rule.shape == shapes.mouth_close && rule.contains == shapes.jaw_open;
  });
  return shapes;
}

}  // namespace

wrinkle::JointShapes MatchFaceJoints(const FaceJoints& joints, const ShapeFace& face,
                                     const ShapeMatcher& matcher) {
  const int head = FindRole(joints.roles, wrinkle::JointRole::kHead);
  if (head == wrinkle::kNoJoint || face.shapes.empty()) return {};
  const std::vector<bool> moved = MovedJoints(joints, head);
  if (std::ranges::count(moved, true) == 0) return {};
  const auto from = EyesOfJoints(joints.skeleton, joints.roles, joints.turn);
  if (!from || !(from->Distance() > 0.0f)) return {};
  const auto to = EyesOf(face, matcher);
  if (!to) return {};
  const float distance = to->Distance();
  const wrinkle::JointShapes::Scaling scaling{
      .turn = joints.turn, .scale = distance / from->Distance(), .reach = kReach * distance};
  std::vector<wrinkle::FaceLandmark> landmarks;
  for (int joint = 0; joint < joints.skeleton.num_joints(); ++joint) {
    if (!moved[static_cast<std::size_t>(joint)]) continue;
    for (const glm::vec3& point : PointsOf(joints, *from, joint)) {
      const glm::vec3 at(joints.skeleton.rest_model()[joint] * glm::vec4(point, 1.0f));
      landmarks.push_back(
          {joint, point, to->Middle() + scaling.scale * (scaling.turn * (at - from->Middle()))});
    }
  }
  auto result = wrinkle::JointShapes::Create(joints.skeleton, moved, landmarks, scaling,
                                             face.surface, ShapesOf(face, matcher));
  return result.num_landmarks() < kMinLandmarks ? wrinkle::JointShapes() : std::move(result);
}

}  // namespace furrow::rig
