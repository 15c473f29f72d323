// SPDX-License-Identifier: Apache-2.0
#include "bench/load/variants.h"

#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "base/status.h"
#include "client/cli/common/inputs.h"
#include "client/cli/load/load_input.h"
#include "motion/clip/clip.h"
#include "motion/clip_file.h"
#include "rig/rig_file.h"

namespace furrow::bench {
namespace {

wrinkle::Region Renamed(wrinkle::Region region, const std::string& suffix) {
  region.name += suffix;
  for (wrinkle::Feed& feed : region.feeds) {
    for (wrinkle::Feed::Source& source : feed.sources) source.driver += suffix;
  }
  for (std::string& neighbour : region.neighbours) neighbour += suffix;
  return region;
}

std::vector<wrinkle::JointDesc> JointsOf(const wrinkle::Skeleton& skeleton) {
  std::vector<wrinkle::JointDesc> joints;
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    joints.push_back({.name = skeleton.joint_names()[j],
                      .parent = skeleton.joint_parents()[j],
                      .rest = skeleton.rest_pose()[j],
                      .tail = skeleton.tails()[j]});
  }
  return joints;
}

}  // namespace

Status SaveMultipliedRig(const std::filesystem::path& path, int copies,
                         const std::filesystem::path& out) {
  auto rig = cli::LoadRigArgument(path);
  FURROW_RETURN_IF_ERROR(rig);
  const auto drivers = rig->drivers;
  const auto regions = rig->regions;
  for (int copy = 2; copy <= copies; ++copy) {
    const std::string suffix = "_copy" + std::to_string(copy);
    for (wrinkle::Driver driver : drivers) {
      driver.name += suffix;
      rig->drivers.push_back(std::move(driver));
    }
    for (const wrinkle::Region& region : regions) rig->regions.push_back(Renamed(region, suffix));
  }
  return rig::SaveRig(*rig, out);
}

Status SavePaddedRecording(const std::filesystem::path& path, int num_joints,
                           const std::filesystem::path& out) {
  auto clip = motion::LoadClip(path);
  FURROW_RETURN_IF_ERROR(clip);
  auto joints = JointsOf(clip->skeleton);
  const std::size_t own = joints.size();
  while (joints.size() < static_cast<std::size_t>(num_joints)) {
    joints.push_back({.name = "padding_" + std::to_string(joints.size()),
                      .parent = 0,
                      .rest = {.translation = {0.0f, 0.1f, 0.0f}},
                      .tail = glm::vec3(0.0f, 0.1f, 0.0f)});
  }
  auto skeleton = wrinkle::Skeleton::Create(joints);
  FURROW_RETURN_IF_ERROR(skeleton);
  std::vector<wrinkle::Transform> locals;
  for (int frame = 0; frame < clip->num_frames(); ++frame) {
    const auto first = clip->locals.begin() + static_cast<std::ptrdiff_t>(own) * frame;
    locals.insert(locals.end(), first, first + static_cast<std::ptrdiff_t>(own));
    for (std::size_t j = own; j < joints.size(); ++j) {
      wrinkle::Transform turned = joints[j].rest;
      turned.rotation = glm::angleAxis(0.01f * static_cast<float>(frame), glm::vec3(1, 0, 0));
      locals.push_back(turned);
    }
  }
  clip->skeleton = *std::move(skeleton);
  clip->locals = std::move(locals);
  return motion::SaveClip(*clip, out);
}

Result<int> CountWeights(const std::filesystem::path& recording, const std::filesystem::path& rig) {
  const auto performance =
      cli::LoadWorkload({.file = recording, .rig = rig, .packing = cli::Packing::kNever});
  FURROW_RETURN_IF_ERROR(performance);
  return static_cast<int>(performance->binding->weight_names().size());
}

}  // namespace furrow::bench
