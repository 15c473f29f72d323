// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/size_reference.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "wrinkle/skeleton/retarget.h"

namespace furrow::wrinkle {
namespace {

// Skeletons of other families share names by chance: "head" and "jaw" say little about a size.
constexpr std::size_t kLeastShared = 4;

// In double: the joints of a face are close together and far from the origin.
double Spread(std::span<const glm::dvec3> places) {
  glm::dvec3 centre(0.0);
  for (const glm::dvec3& place : places) centre += place / static_cast<double>(places.size());
  double square = 0.0;
  for (const glm::dvec3& place : places) square += glm::dot(place - centre, place - centre);
  return std::sqrt(square / static_cast<double>(places.size()));
}

}  // namespace

float SkeletonSizeBy(const SizeReference* reference, const Skeleton& skeleton) {
  if (reference == nullptr) return SkeletonSize(skeleton);
  std::vector<glm::dvec3> stated;
  std::vector<glm::dvec3> found;
  for (const SizeReference::Joint& joint : reference->joints) {
    const int index = skeleton.Find(joint.name);
    if (index == kNoJoint) continue;
    stated.emplace_back(joint.position);
    found.emplace_back(RestOrigin(skeleton, index));
  }
  if (stated.size() < std::max<std::size_t>(2, std::min(kLeastShared, reference->joints.size()))) {
    return SkeletonSize(skeleton);
  }
  const double from = Spread(stated);
  const double to = Spread(found);
  if (!(from > 0.0 && to > 0.0)) return SkeletonSize(skeleton);
  return static_cast<float>(reference->size * (to / from));
}

SizeReference MakeSizeReference(const Skeleton& skeleton, const std::set<std::string>& joints) {
  SizeReference reference{.size = SkeletonSize(skeleton)};
  for (int joint = 0; joint < skeleton.num_joints(); ++joint) {
    const std::string& name = skeleton.joint_names()[joint];
    if (joints.contains(name)) reference.joints.push_back({name, RestOrigin(skeleton, joint)});
  }
  return reference;
}

}  // namespace furrow::wrinkle
