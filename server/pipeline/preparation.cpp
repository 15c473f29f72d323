// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/preparation.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "server/pipeline/picture_streams.h"
#include "server/pipeline/snapshot.h"
#include "wrinkle/shapes/blend_shape_pose.h"
#include "wrinkle/skeleton/retarget.h"
#include "wrinkle/solver/solver.h"

namespace furrow::server {
namespace {

// Pixels. Large enough that no pass of a picture, such as a scaled-down bloom, is left out.
constexpr int kSize = 64;

// The wrinkles of a picture. Programs differ by the number of wrinkle maps that are active.
enum class Wrinkles { kAll, kOneMap, kNone };

// The map of a weight, "squash" for "brow_l.squash".
std::string_view MapOf(std::string_view weight) { return weight.substr(weight.rfind('.') + 1); }

std::vector<float> WeightsOf(const wrinkle::RigBinding& binding, Wrinkles wrinkles) {
  const auto names = binding.weight_names();
  std::vector<float> weights;
  for (const std::string& name : names) {
    const bool is_active = wrinkles == Wrinkles::kAll ||
                           (wrinkles == Wrinkles::kOneMap && MapOf(name) == MapOf(names.front()));
    weights.push_back(is_active ? 1.0f : 0.0f);
  }
  return weights;
}

std::shared_ptr<const Snapshot> SnapshotOf(
    const character::Character& character,
    const std::shared_ptr<const wrinkle::RigBinding>& binding, Wrinkles wrinkles) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->binding = binding;
  snapshot->retarget = std::make_shared<const wrinkle::Retarget>(
      wrinkle::Retarget::Create(character.skeleton, character.skeleton));
  snapshot->blend_shape_pose = std::make_shared<const wrinkle::BlendShapePose>();
  const auto rest = character.skeleton.rest_pose();
  snapshot->joints.assign(rest.begin(), rest.end());
  snapshot->wrinkle_weights = WeightsOf(*binding, wrinkles);
  snapshot->filtered_values.assign(binding->driver_value_names().size(),
                                   wrinkles == Wrinkles::kNone ? 0.0f : 1.0f);
  return snapshot;
}

}  // namespace

Result<std::vector<RenderJob>> Preparations(const character::Character& character,
                                            const wrinkle::Rig& rig,
                                            const render::Settings& settings,
                                            const render::Camera& camera) {
  auto made = wrinkle::RigBinding::Create(rig, character.skeleton, {}, {.allow_missing = true});
  FURROW_RETURN_IF_ERROR(made);
  const auto binding = std::make_shared<const wrinkle::RigBinding>(*std::move(made));
  const auto look = std::make_shared<const render::Settings>(settings);
  std::vector<RenderJob> jobs;
  // A stream begins in full. On a GPU, the second three only repeat the first.
  for (const std::uint64_t stream : {std::uint64_t{0}, PictureStreams::kPreparation}) {
    for (const Wrinkles wrinkles : {Wrinkles::kAll, Wrinkles::kOneMap, Wrinkles::kNone}) {
      RenderJob job;
      job.spec = {.view = settings.view,
                  .camera = camera,
                  .width = kSize,
                  .height = kSize,
                  .settings = look};
      job.snapshot = SnapshotOf(character, binding, wrinkles);
      job.stream = stream;
      job.prepares = true;
      jobs.push_back(std::move(job));
    }
  }
  return jobs;
}

}  // namespace furrow::server
