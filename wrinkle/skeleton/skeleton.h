// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/status.h"
#include "wrinkle/skeleton/transform.h"

namespace furrow::wrinkle {

inline constexpr int kNoJoint = -1;
inline constexpr int kMaxJoints = 1024;

// One joint as a file or a stream describes it.
struct JointDesc {
  std::string name;               // unique, not empty, at most 255 bytes
  int parent = kNoJoint;          // index into the same list, in any order; kNoJoint for a root
  Transform rest;                 // local: relative to the parent
  std::optional<glm::vec3> tail;  // local end of a leaf (BVH's End Site); none: see tails()
};

// An immutable tree (or forest) of named joints with their rest pose.
//
// Parents are stored before their children, so one forward loop computes model space. Create()
// sorts the joints if necessary, and otherwise keeps the input order; source_index() maps back.
class Skeleton {
 public:
  Skeleton() = default;

  // Errors: kLimit (none, or more than kMaxJoints), kInvalidArgument (empty, overlong or duplicate
  // name, parent out of range, rest rotation not unit), kCyclic, kNonFinite (rest pose or tail).
  // The message names the joint.
  [[nodiscard]] static Result<Skeleton> Create(std::vector<JointDesc> joints);

  [[nodiscard]] int num_joints() const { return static_cast<int>(names_.size()); }
  [[nodiscard]] std::span<const std::string> joint_names() const { return names_; }
  [[nodiscard]] std::span<const std::int16_t> joint_parents() const { return parents_; }
  [[nodiscard]] std::span<const Transform> rest_pose() const { return rest_; }
  // Model-space rotation and position of every joint in the rest pose.
  [[nodiscard]] std::span<const glm::mat4> rest_model() const { return rest_model_; }
  [[nodiscard]] std::span<const glm::quat> rest_model_rotations() const { return rest_rotations_; }
  // The end of each joint in its own space: the tail from JointDesc, or else the mean of its
  // children's rest translations, or else (for a leaf) its own translation repeated.
  [[nodiscard]] std::span<const glm::vec3> tails() const { return tails_; }
  // The index of each joint in the list given to Create().
  [[nodiscard]] std::span<const std::int16_t> source_index() const { return source_; }

  [[nodiscard]] int Find(std::string_view name) const;  // kNoJoint if there is none
  // True if `ancestor` is `joint` itself or above it.
  [[nodiscard]] bool IsAncestor(int ancestor, int joint) const;
  // FNV-1a over names, parents, rest pose and tails: equal skeletons have equal hashes on every
  // machine.
  [[nodiscard]] std::uint64_t hash() const { return hash_; }

 private:
  // Computes everything that follows from names, parents, rest pose and stated tails.
  void Finish(std::span<const std::optional<glm::vec3>> stated_tails);

  std::vector<std::string> names_;
  std::vector<std::int16_t> parents_;
  std::vector<std::int16_t> source_;
  std::vector<Transform> rest_;
  std::vector<glm::mat4> rest_model_;
  std::vector<glm::quat> rest_rotations_;
  std::vector<glm::vec3> tails_;
  std::vector<std::pair<std::string, std::int16_t>> by_name_;  // sorted
  std::uint64_t hash_ = 0;
};

// The origin of `joint` in the rest pose, model space, in the skeleton's units. `joint` must exist.
[[nodiscard]] inline glm::vec3 RestOrigin(const Skeleton& skeleton, int joint) {
  return glm::vec3(skeleton.rest_model()[joint][3]);
}

// The rotation of `joint` in the rest pose, model space. kNoJoint, the parent of a root: the
// identity.
[[nodiscard]] inline glm::quat RestRotation(const Skeleton& skeleton, int joint) {
  return joint == kNoJoint ? glm::quat(1.0f, 0.0f, 0.0f, 0.0f)
                           : skeleton.rest_model_rotations()[joint];
}

// The same joints, turned as a whole about the origin of model space: only roots change.
[[nodiscard]] Skeleton TurnRoots(const Skeleton& skeleton, const glm::quat& turn);
// Turns a pose of the skeleton in the same way. `locals`: num_joints() local transforms.
void TurnRoots(const Skeleton& skeleton, const glm::quat& turn, std::span<Transform> locals);

}  // namespace furrow::wrinkle
