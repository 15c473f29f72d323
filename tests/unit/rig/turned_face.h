// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "motion/clip/clip.h"
#include "rig/skeleton_match.h"
#include "wrinkle/solver/subject_solver.h"

// A body with one joint in its face that raises it, in axes of any kind, and a rig that takes its
// reference pose from the same recording.
namespace furrow::rig {

inline wrinkle::Skeleton BodyWithBrow() {
  return *wrinkle::Skeleton::Create({{"hips", -1, {{0, 1, 0}}, {}},
                                     {"spine", 0, {{0, 0.1f, 0}}, {}},
                                     {"chest", 1, {{0, 0.2f, 0}}, {}},
                                     {"neck", 2, {{0, 0.2f, -0.02f}}, {}},
                                     {"head", 3, {{0, 0.1f, 0.03f}}, {}},
                                     {"frontalis_inner_l", 4, {{0.02f, 0.08f, 0.09f}}, {}},
                                     {"upper_leg_l", 0, {{0.1f, 0, 0}}, {}},
                                     {"lower_leg_l", 6, {{0, -0.45f, 0}}, {}},
                                     {"foot_l", 7, {{0, -0.45f, 0}}, glm::vec3(0, -0.1f, 0.15f)},
                                     {"upper_leg_r", 0, {{-0.1f, 0, 0}}, {}},
                                     {"lower_leg_r", 9, {{0, -0.45f, 0}}, {}},
                                     {"foot_r", 10, {{0, -0.45f, 0}}, glm::vec3(0, -0.1f, 0.15f)},
                                     {"upper_arm_l", 2, {{0.2f, 0.15f, 0}}, {}},
                                     {"lower_arm_l", 12, {{0.3f, 0, 0}}, {}},
                                     {"upper_arm_r", 2, {{-0.2f, 0.15f, 0}}, {}},
                                     {"lower_arm_r", 14, {{-0.3f, 0, 0}}, {}}});
}

// Two frames, turned as a whole: frame 0 at rest, frame 1 with the brow raised.
inline motion::Clip RaisedBrow(const glm::quat& turn) {
  const wrinkle::Skeleton upright = BodyWithBrow();
  motion::Clip clip;
  clip.name = "face";
  clip.skeleton = wrinkle::TurnRoots(upright, turn);
  clip.times = {0.0, 0.1};
  for (const float raised : {0.0f, 1.0f}) {
    std::vector<wrinkle::Transform> locals(upright.rest_pose().begin(), upright.rest_pose().end());
    locals[5].translation += raised * glm::vec3(0.001f, 0.006f, 0.004f);
    wrinkle::TurnRoots(upright, turn, locals);
    clip.locals.insert(clip.locals.end(), locals.begin(), locals.end());
  }
  return clip;
}

// The rig of such a recording, whose only value is 1 in frame 1.
inline std::string RaisedBrowRig(const std::string& file) {
  return R"({"name": "brow", "anchor": "head",
    "reference_poses": [{"name": "up", "file": ")" +
         file + R"(", "frame": 1}],
    "drivers": [{"name": "brow", "pose": {
      "points": [{"joint": "frontalis_inner_l", "kind": "origin"}],
      "values": [{"name": "up", "reference_pose": "up"}]}}],
    "regions": [{"name": "brow", "mask": {"kind": "skinning"},
                 "feeds": [{"map": "folds", "sources": [{"from": "brow.up"}]}]}],
    "wrinkle_maps": [{"name": "folds"}]})";
}

// The first driver value of the rig in a frame of the clip, bound by roles as commands and the
// daemon do.
inline float FirstValue(const wrinkle::Rig& rig, const SkeletonMatcher& matcher,
                        const motion::Clip& clip, int frame) {
  const SkeletonMatch match = matcher.Match(clip.skeleton, rig, nullptr);
  auto binding = wrinkle::RigBinding::Create(rig, clip.skeleton, {}, match.Options(true));
  EXPECT_TRUE(binding.ok()) << binding.status().ToString();
  wrinkle::SubjectSolver solver(std::make_shared<const wrinkle::RigBinding>(*std::move(binding)),
                                false);
  wrinkle::LocalPose pose;
  clip.GetPose(frame, &pose);
  EXPECT_EQ(solver.Update(pose, 0.0), wrinkle::JobStatus::kOk);
  return solver.driver_values()[0];
}

// From Furrow's axes: faces -Z, +X or -X; Z-up, facing -Y; and lying on a side.
inline std::vector<glm::quat> TurnsOfFiles() {
  const auto turn = [](float degrees, const glm::vec3& axis) {
    return glm::angleAxis(glm::radians(degrees), axis);
  };
  return {turn(180, {0, 1, 0}), turn(90, {0, 1, 0}), turn(-90, {0, 1, 0}), turn(90, {1, 0, 0}),
          turn(90, {0, 0, 1})};
}

}  // namespace furrow::rig
