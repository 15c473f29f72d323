// SPDX-License-Identifier: Apache-2.0
#include "rig/skeleton_fit.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/text.h"

namespace furrow::rig {
namespace {

using wrinkle::JointRole;

// The map of VRM's own names. The human bones of a .vrma file have them, whatever their nodes are
// called.
constexpr char kVrmMap[] = "vrm";

// Below these are fingers, hair and the ends of bones.
bool EndsBody(JointRole role) {
  const JointRole left = role >= JointRole::kRightEye ? wrinkle::MirrorOf(role) : role;
  return left == JointRole::kHead || left == JointRole::kLeftHand || left == JointRole::kLeftFoot ||
         left == JointRole::kLeftToes || wrinkle::IsFinger(role) || wrinkle::IsOfFace(role);
}

// What lies above and below each joint.
struct Surroundings {
  std::vector<bool> below_role;
  std::vector<bool> above_role;
  std::vector<bool> below_end;  // of the body
  std::vector<bool> has_children;
};

// Parents come first, so one pass marks what is below, and one pass back what is above.
Surroundings SurroundingsOf(std::span<const std::int16_t> parents,
                            const wrinkle::JointRoles& roles) {
  const std::vector<bool> none(parents.size(), false);
  Surroundings found{none, none, none, none};
  for (std::size_t j = 0; j < parents.size(); ++j) {
    if (parents[j] < 0) continue;
    const auto parent = static_cast<std::size_t>(parents[j]);
    found.has_children[parent] = true;
    found.below_role[j] = found.below_role[parent] || roles[parent] != JointRole::kNone;
    found.below_end[j] = found.below_end[parent] || EndsBody(roles[parent]);
  }
  for (std::size_t j = parents.size(); j-- > 0;) {
    if (parents[j] < 0) continue;
    const auto parent = static_cast<std::size_t>(parents[j]);
    if (found.above_role[j] || roles[j] != JointRole::kNone) found.above_role[parent] = true;
  }
  return found;
}

// "a, b, c, d, ..."
std::string FirstNames(std::span<const std::string> names) {
  constexpr std::size_t kNamed = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kNamed); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return text + (names.size() > kNamed ? ", ..." : "");
}

}  // namespace

SkeletonFit FitOf(const SkeletonRoles& roles, const wrinkle::Skeleton& skeleton) {
  SkeletonFit fit;
  const auto names = skeleton.joint_names();
  fit.num_joints = skeleton.num_joints();
  wrinkle::JointRoles all = roles.roles;
  all.resize(names.size(), JointRole::kNone);
  for (const JointRole role : all) {
    if (role == JointRole::kNone) continue;
    ++fit.num_explained;
    if (!wrinkle::IsFinger(role) && !wrinkle::IsOfFace(role)) ++fit.num_of_body;
  }
  for (const JointRole role : wrinkle::kEssentialRoles) {
    if (std::ranges::find(all, role) == all.end()) fit.missing.push_back(role);
  }
  const bool has_hips = std::ranges::find(all, JointRole::kHips) != all.end();
  const Surroundings around = SurroundingsOf(skeleton.joint_parents(), all);
  for (std::size_t j = 0; j < names.size(); ++j) {
    if (all[j] != JointRole::kNone || around.below_end[j] || !around.has_children[j]) continue;
    // Joints above the hips, such as a scene's root, do not belong to the body.
    if (!around.below_role[j] && around.above_role[j] && has_hips) continue;
    fit.left_out.push_back(names[j]);
    if (around.below_role[j] && around.above_role[j]) ++fit.num_between;
  }
  return fit;
}

std::string Describe(const SkeletonRoles& roles) {
  if (roles.map.empty()) return {};
  const std::string share = Counted(static_cast<std::uint64_t>(roles.num_roles), "role") + ", " +
                            std::to_string(roles.num_joints) + " of " +
                            Counted(roles.roles.size(), "joint");
  if (roles.map == kFromHierarchy) {
    return "no skeleton map fits; guessed from the hierarchy: " + share;
  }
  if (roles.map == kFromPackage) return "joint roles of the character's package: " + share;
  std::string text = "skeleton map '" + roles.map + "': " + share;
  // Body captures without fingers or a face are usual; listing all of these roles would bury the
  // rest.
  std::vector<JointRole> missing = roles.missing;
  for (const auto& kind : {wrinkle::IsFinger, wrinkle::IsOfFace}) {
    if (std::ranges::none_of(roles.roles, kind)) std::erase_if(missing, kind);
  }
  if (!missing.empty()) text += "; missing: " + JoinRoles(missing);
  return text;
}

std::vector<std::string> WarningsOf(const SkeletonFit& fit, const SkeletonRoles& roles) {
  if (roles.map.empty() || roles.map == kFromHierarchy) return {};
  const std::string map =
      roles.map == kFromPackage ? "the character's package " : "skeleton map '" + roles.map + "' ";
  const std::string way_out =
      "; choose another map with --skeleton-map, or write one with 'furrow rig propose-map'";
  if (fit.num_explained == 0) {
    return {map + "knows none of the " + std::to_string(fit.num_joints) + " joints" + way_out};
  }
  // Where all bones have VRM's names, other joints are helpers, which no map could explain.
  if (roles.map == kVrmMap && fit.missing.empty()) return {};
  const std::string left_out = Counted(fit.left_out.size(), "joint") + " of trunk and limbs (" +
                               FirstNames(fit.left_out) + ")";
  if (!fit.missing.empty() && !fit.left_out.empty()) {
    return {map + "gives no role to " + left_out +
            ", and these roles are missing: " + JoinRoles(fit.missing) + way_out};
  }
  if (4 * fit.num_between > fit.num_of_body) {
    return {map + "gives no role to " + left_out + ", which move stiffly" + way_out};
  }
  return {};
}

}  // namespace furrow::rig
