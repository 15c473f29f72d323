// SPDX-License-Identifier: Apache-2.0
// Binding: a rig that was accepted may come from a stranger. Bound to a skeleton that has its
// joints, or half of them, it gives weights in [0, 1], whatever the pose. The input is the JSON of
// the rig, a zero byte, and a program of poses.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "rig/rig_file.h"
#include "tests/fuzz/fuzz_input.h"
#include "wrinkle/rig/rig_blend_shapes.h"
#include "wrinkle/rig/rig_joints.h"
#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {
namespace {

using fuzz::Input;

// Every `step`-th joint of the rig, as a tree whose shape the input decides.
Result<Skeleton> SkeletonOf(const Rig& rig, std::size_t step, Input& input) {
  std::vector<JointDesc> joints;
  std::size_t index = 0;
  for (const std::string& name : JointsOf(rig)) {
    if (index++ % step != 0) continue;
    if (joints.size() == kMaxJoints) break;
    JointDesc joint;
    joint.name = name;
    joint.parent = static_cast<int>(joints.size()) - 1 - input.Byte() % 3;
    joint.parent = std::max(joint.parent, kNoJoint);
    joint.rest.translation = {input.Signed(), input.Signed(), input.Signed()};
    joints.push_back(std::move(joint));
  }
  if (joints.empty()) joints.push_back({.name = "root"});
  return Skeleton::Create(std::move(joints));
}

void Solve(std::shared_ptr<const RigBinding> binding, std::size_t num_shapes, Input& input) {
  SubjectSolver solver(binding);
  LocalPose pose;
  pose.SetRest(binding->skeleton());
  pose.blend_shapes.resize(num_shapes);
  for (int frame = 0; frame < 8; ++frame) {
    for (Transform& joint : pose.joints) {
      const glm::quat turn(input.Signed(), input.Signed(), input.Signed(), input.Signed());
      const float length = glm::length(turn);
      joint.rotation = length > 1e-3f ? turn / length : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
    }
    for (float& shape : pose.blend_shapes) shape = input.Signed();
    if (solver.Update(pose, 1.0 / 60.0) != JobStatus::kOk) std::abort();
    for (const float weight : solver.wrinkle_weights()) {
      if (!(weight >= 0.0f && weight <= 1.0f)) std::abort();
    }
    for (const float value : solver.filtered_values()) {
      if (!(value >= 0.0f && value <= 1.0f)) std::abort();
    }
  }
}

void Play(const Rig& rig, Input input) {
  const std::size_t step = 1 + input.Byte() % 2;
  const auto skeleton = SkeletonOf(rig, step, input);
  if (!skeleton.ok()) return;
  const std::vector<std::string> shapes = BlendShapesOf(rig);
  auto binding = RigBinding::Create(rig, *skeleton, shapes, {.allow_missing = true});
  if (!binding.ok()) return;
  Solve(std::make_shared<const RigBinding>(*std::move(binding)), shapes.size(), input);
}

}  // namespace
}  // namespace furrow::wrinkle

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  fuzz::Input input({data, size});
  const auto json = input.UntilZero();
  const auto rig = rig::ParseRig({reinterpret_cast<const char*>(json.data()), json.size()},
                                 "fuzz.json", "no/such/folder");
  if (rig.ok()) wrinkle::Play(*rig, input);
  return 0;
}
