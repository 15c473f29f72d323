// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/stream_definition.h"

#include <algorithm>
#include <span>
#include <utility>

#include <spdlog/spdlog.h>

namespace furrow::server {
namespace {

std::string Join(std::span<const std::string> names, std::size_t at_most = 12) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < at_most; ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > at_most) text += " and " + std::to_string(names.size() - at_most) + " more";
  return text;
}

bool SameOrder(const wrinkle::Skeleton& a, const wrinkle::Skeleton& b) {
  return std::ranges::equal(a.source_index(), b.source_index());
}

}  // namespace

Result<std::shared_ptr<const StreamDefinition>> StreamDefinitions::Get(StreamOffer offer) {
  wrinkle::Skeleton skeleton;
  if (!offer.joints.empty()) {
    auto created = wrinkle::Skeleton::Create(std::move(offer.joints));
    if (!created.ok()) return created.status();
    skeleton = *std::move(created);
  }
  const auto is_same = [&](const std::shared_ptr<const StreamDefinition>& known) {
    return known->skeleton.hash() == skeleton.hash() && SameOrder(known->skeleton, skeleton) &&
           known->blend_shapes == offer.blend_shapes;
  };
  const auto known = std::find_if(known_.begin(), known_.end(), is_same);
  if (known != known_.end()) {
    known_.splice(known_.begin(), known_, known);
    return known_.front();
  }
  auto made = Make(std::move(skeleton), std::move(offer.blend_shapes));
  if (!made.ok()) return made;
  known_.push_front(*made);
  if (known_.size() > capacity_) known_.pop_back();  // its subjects, if any, keep it alive
  return made;
}

Result<std::shared_ptr<const StreamDefinition>> StreamDefinitions::Make(
    wrinkle::Skeleton skeleton, std::vector<std::string> blend_shapes) {
  auto binding =
      wrinkle::RigBinding::Create(*rig_, skeleton, blend_shapes, {.allow_missing = true});
  if (!binding.ok()) return binding.status();
  const auto missing_joints = binding->missing_joints();
  const auto missing_shapes = binding->missing_blend_shapes();
  if (!missing_joints.empty()) {
    spdlog::warn("the stream lacks joints of the rig, their drivers rest: {}",
                 Join(missing_joints));
  }
  if (!missing_shapes.empty()) {
    spdlog::warn("the stream lacks blend shapes of the rig, their drivers rest: {}",
                 Join(missing_shapes));
  }
  auto definition = std::make_shared<StreamDefinition>();
  definition->joint_of_wire.resize(static_cast<std::size_t>(skeleton.num_joints()));
  for (int joint = 0; joint < skeleton.num_joints(); ++joint) {
    definition->joint_of_wire[static_cast<std::size_t>(skeleton.source_index()[joint])] =
        static_cast<std::int16_t>(joint);
  }
  if (character_ != nullptr) {
    auto retarget = wrinkle::Retarget::Create(skeleton, *character_);
    if (!retarget.unmatched_source().empty()) {
      spdlog::info("joints that the character does not have are ignored: {}",
                   Join(retarget.unmatched_source()));
    }
    definition->retarget = std::make_shared<const wrinkle::Retarget>(std::move(retarget));
  }
  definition->binding = std::make_shared<const wrinkle::RigBinding>(*std::move(binding));
  definition->skeleton = std::move(skeleton);
  definition->blend_shapes = std::move(blend_shapes);
  return std::shared_ptr<const StreamDefinition>(std::move(definition));
}

}  // namespace furrow::server
