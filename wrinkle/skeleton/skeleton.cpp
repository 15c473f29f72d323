// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/skeleton.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <queue>
#include <unordered_set>
#include <utility>

#include "base/status.h"
#include "base/text.h"
#include "wrinkle/skeleton/finite.h"

namespace furrow::wrinkle {
namespace {

constexpr std::size_t kMaxNameBytes = 255;

std::string Quoted(const std::string& name) { return "joint '" + name + "'"; }

// 64-bit FNV-1a over little-endian bytes on every machine.
class Fnv1a {
 public:
  void AddByte(std::uint8_t byte) { hash_ = (hash_ ^ byte) * 0x100000001b3u; }
  void Add(std::uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) AddByte(static_cast<std::uint8_t>(word >> shift));
  }
  void Add(float value) { Add(std::bit_cast<std::uint32_t>(value + 0.0f)); }  // -0 counts as 0
  void Add(const glm::vec3& v) {
    Add(v.x);
    Add(v.y);
    Add(v.z);
  }
  void Add(const glm::quat& q) {
    Add(q.x);
    Add(q.y);
    Add(q.z);
    Add(q.w);
  }
  void Add(std::string_view text) {
    Add(static_cast<std::uint32_t>(text.size()));
    for (const char c : text) AddByte(static_cast<std::uint8_t>(c));
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

Status CheckRest(const JointDesc& joint) {
  const Transform& rest = joint.rest;
  const bool finite = AllFinite(std::span(&rest, 1)) && (!joint.tail || AllFinite(*joint.tail));
  if (!finite) {
    return {StatusCode::kNonFinite, Quoted(joint.name) + " has a rest pose that is not finite"};
  }
  if (!IsValid(rest)) {
    return {StatusCode::kInvalidArgument,
            Quoted(joint.name) + " has a rest rotation that is not a unit quaternion"};
  }
  return {};
}

Status CheckJoints(const std::vector<JointDesc>& joints) {
  if (joints.empty()) return {StatusCode::kLimit, "the skeleton has no joints"};
  if (joints.size() > static_cast<std::size_t>(kMaxJoints)) {
    return {StatusCode::kLimit, "the skeleton has " + std::to_string(joints.size()) +
                                    " joints; at most " + std::to_string(kMaxJoints) +
                                    " are accepted"};
  }
  std::unordered_set<std::string_view> names;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JointDesc& joint = joints[i];
    if (joint.name.empty()) {
      return {StatusCode::kInvalidArgument, "joint " + std::to_string(i) + " has no name"};
    }
    if (joint.name.size() > kMaxNameBytes) {
      return {StatusCode::kInvalidArgument,
              "joint " + std::to_string(i) + " has a name of " + std::to_string(joint.name.size()) +
                  " bytes; at most " + std::to_string(kMaxNameBytes) + " are accepted"};
    }
    if (!names.insert(joint.name).second) {
      return {StatusCode::kInvalidArgument, Quoted(joint.name) + " appears twice"};
    }
    if (joint.parent < kNoJoint || joint.parent >= static_cast<int>(joints.size())) {
      return {StatusCode::kInvalidArgument,
              Quoted(joint.name) + " has parent " + std::to_string(joint.parent) +
                  "; the skeleton has " + std::to_string(joints.size()) + " joints"};
    }
    FURROW_RETURN_IF_ERROR(CheckRest(joint));
  }
  return {};
}

// A joint on the cycle above `start`, which no root reaches.
// After as many steps as there are joints, a walk that never ends at a root is on the cycle.
int JointOnCycle(const std::vector<JointDesc>& joints, int start) {
  for (std::size_t step = 0; step < joints.size(); ++step) start = joints[start].parent;
  return start;
}

// Sorts parents before children, and otherwise by index. Input in a valid order keeps its order.
Result<std::vector<int>> SortParentsFirst(const std::vector<JointDesc>& joints) {
  const int count = static_cast<int>(joints.size());
  std::vector<std::vector<int>> children(joints.size());
  // The smallest index first, so that sorting is deterministic and stable for sorted input.
  std::priority_queue<int, std::vector<int>, std::greater<>> ready;
  for (int i = 0; i < count; ++i) {
    if (joints[i].parent == kNoJoint) {
      ready.push(i);
    } else {
      children[joints[i].parent].push_back(i);
    }
  }
  std::vector<int> order;
  std::vector<bool> placed(joints.size(), false);
  while (!ready.empty()) {
    const int next = ready.top();
    ready.pop();
    order.push_back(next);
    placed[next] = true;
    for (const int child : children[next]) ready.push(child);
  }
  if (order.size() < joints.size()) {
    const auto lost = std::find(placed.begin(), placed.end(), false) - placed.begin();
    const int on_cycle = JointOnCycle(joints, static_cast<int>(lost));
    return Status(StatusCode::kCyclic, Quoted(joints[on_cycle].name) + " is its own ancestor");
  }
  return order;
}

}  // namespace

Result<Skeleton> Skeleton::Create(std::vector<JointDesc> joints) {
  FURROW_RETURN_IF_ERROR(CheckJoints(joints));
  Result<std::vector<int>> order = SortParentsFirst(joints);
  FURROW_RETURN_IF_ERROR(order);

  Skeleton skeleton;
  std::vector<std::int16_t> new_index(joints.size());
  for (std::size_t i = 0; i < order->size(); ++i) {
    new_index[(*order)[i]] = static_cast<std::int16_t>(i);
  }
  std::vector<std::optional<glm::vec3>> stated_tails;
  for (const int source : *order) {
    JointDesc& joint = joints[source];
    skeleton.names_.push_back(std::move(joint.name));
    skeleton.parents_.push_back(joint.parent == kNoJoint ? static_cast<std::int16_t>(kNoJoint)
                                                         : new_index[joint.parent]);
    skeleton.source_.push_back(static_cast<std::int16_t>(source));
    skeleton.rest_.push_back(joint.rest);
    stated_tails.push_back(joint.tail);
  }
  skeleton.Finish(stated_tails);
  return skeleton;
}

void Skeleton::Finish(std::span<const std::optional<glm::vec3>> stated_tails) {
  const std::size_t count = names_.size();
  // One forward loop suffices because parents precede children.
  std::vector<glm::vec3> child_sum(count, glm::vec3(0.0f));
  std::vector<int> child_count(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::mat4 local = ToMatrix(rest_[i]);
    const int parent = parents_[i];
    if (parent == kNoJoint) {
      rest_model_.push_back(local);
      rest_rotations_.push_back(glm::normalize(rest_[i].rotation));
      continue;
    }
    rest_model_.push_back(rest_model_[parent] * local);
    rest_rotations_.push_back(glm::normalize(rest_rotations_[parent] * rest_[i].rotation));
    child_sum[parent] += rest_[i].translation;
    ++child_count[parent];
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (stated_tails[i]) {
      tails_.push_back(*stated_tails[i]);
    } else if (child_count[i] > 0) {
      tails_.push_back(child_sum[i] / static_cast<float>(child_count[i]));
    } else {
      // The joint's translation is in its parent's axes; tails are in the joint's own.
      tails_.push_back(glm::conjugate(glm::normalize(rest_[i].rotation)) * rest_[i].translation);
    }
    by_name_.emplace_back(names_[i], static_cast<std::int16_t>(i));
  }
  std::sort(by_name_.begin(), by_name_.end());

  Fnv1a hash;
  for (std::size_t i = 0; i < count; ++i) {
    hash.Add(names_[i]);
    // A root's parent (-1) becomes 0.
    hash.Add(static_cast<std::uint32_t>(parents_[i] + 1));
    hash.Add(rest_[i].translation);
    hash.Add(rest_[i].rotation);
    hash.Add(rest_[i].scale);
    hash.Add(tails_[i]);
  }
  hash_ = hash.value();
}

int Skeleton::Find(std::string_view name) const {
  const auto found = std::lower_bound(
      by_name_.begin(), by_name_.end(), name,
      [](const auto& entry, std::string_view wanted) { return entry.first < wanted; });
  return found != by_name_.end() && found->first == name ? found->second : kNoJoint;
}

bool Skeleton::IsAncestor(int ancestor, int joint) const {
  // Parents precede children, so an ancestor never has a larger index.
  while (joint > ancestor) joint = parents_[joint];
  return joint == ancestor && joint >= 0;
}

Skeleton TurnRoots(const Skeleton& skeleton, const glm::quat& turn) {
  std::vector<Transform> rest(skeleton.rest_pose().begin(), skeleton.rest_pose().end());
  TurnRoots(skeleton, turn, rest);
  std::vector<JointDesc> joints;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    joints.push_back(
        {skeleton.joint_names()[i], skeleton.joint_parents()[i], rest[i], skeleton.tails()[i]});
  }
  Result<Skeleton> turned = Skeleton::Create(std::move(joints));
  // A skeleton stays valid when it turns; one without joints has nothing to turn.
  return turned.ok() ? *std::move(turned) : skeleton;
}

void TurnRoots(const Skeleton& skeleton, const glm::quat& turn, std::span<Transform> locals) {
  for (std::size_t i = 0; i < locals.size(); ++i) {
    if (skeleton.joint_parents()[i] != kNoJoint) continue;
    locals[i].rotation = glm::normalize(turn * locals[i].rotation);
    locals[i].translation = turn * locals[i].translation;
  }
}

}  // namespace furrow::wrinkle
