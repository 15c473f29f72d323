// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "rig/skeleton_map.h"
#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::rig {

// How well a skeleton's roles explain it.
struct SkeletonFit {
  int num_joints = 0;     // of the skeleton
  int num_explained = 0;  // joints with a role
  int num_of_body = 0;    // joints with a role, without fingers, jaw and eyes
  // Joints of trunk and limbs without a role that lead to other joints: not those below head, hands
  // and feet, and no ends, such as twist joints.
  std::vector<std::string> left_out;
  int num_between = 0;  // of these, joints between joints with roles
  // The wrinkle::kEssentialRoles that no joint has.
  std::vector<wrinkle::JointRole> missing;
};

// `roles`: those of `skeleton`; without any, everything is left out and missing.
[[nodiscard]] SkeletonFit FitOf(const SkeletonRoles& roles, const wrinkle::Skeleton& skeleton);

// One line for a log: "skeleton map 'cmu': 20 roles, 21 of 29 joints; missing: leftToes,
// rightToes". Fingers, eyes and jaw are listed as missing only if some of them are present. Empty
// if nothing tells the roles.
[[nodiscard]] std::string Describe(const SkeletonRoles& roles);

// Why a map fits badly, one sentence each, with what to do. Nothing for a guess and without a map.
//
// A map fits badly if it explains nothing, if essential roles are missing while joints that could
// have them are left out, or if the joints that it leaves out between others exceed a quarter of
// those that it explains. If the recording lacks arms, the map is not at fault. VRM's names say of
// all other joints that they are helpers.
[[nodiscard]] std::vector<std::string> WarningsOf(const SkeletonFit& fit,
                                                  const SkeletonRoles& roles);

}  // namespace furrow::rig
