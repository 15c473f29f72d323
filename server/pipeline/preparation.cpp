// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/preparation.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "render/temporal/shot.h"
#include "server/pipeline/picture_streams.h"
#include "server/pipeline/snapshot.h"
#include "wrinkle/shapes/blend_shape_pose.h"
#include "wrinkle/skeleton/retarget.h"
#include "wrinkle/solver/solver.h"

namespace furrow::server {
namespace {

// Pixels. Large enough that no pass of a picture, such as a scaled-down bloom, is left out. Mesa's
// llvmpipe compiles a program once for textures with sides that are powers of two and once for
// others. In most pictures, no side is one, and neither is its half or its quarter; nor here.
constexpr int kWidth = 96;
constexpr int kHeight = 72;

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

// Makes small pictures of a character at rest.
class JobMaker {
 public:
  static Result<JobMaker> Create(const character::Character& character, const wrinkle::Rig& rig,
                                 const render::Settings& settings, const render::Camera& camera) {
    auto binding =
        wrinkle::RigBinding::Create(rig, character.skeleton, {}, {.allow_missing = true});
    FURROW_RETURN_IF_ERROR(binding);
    JobMaker maker(character);
    maker.binding_ = std::make_shared<const wrinkle::RigBinding>(*std::move(binding));
    maker.spec_ = {.view = settings.view,
                   .camera = camera,
                   .width = kWidth,
                   .height = kHeight,
                   .settings = std::make_shared<const render::Settings>(settings)};
    return maker;
  }

  [[nodiscard]] RenderJob Make(std::uint64_t stream, Wrinkles wrinkles) const {
    RenderJob job;
    job.spec = spec_;
    job.snapshot = SnapshotOf(*character_, binding_, wrinkles);
    job.stream = stream;
    job.prepares = true;
    return job;
  }

 private:
  explicit JobMaker(const character::Character& character) : character_(&character) {}

  const character::Character* character_;
  std::shared_ptr<const wrinkle::RigBinding> binding_;
  PictureSpec spec_;
};

Status Draw(const RenderJob& job, wrinkle::CharacterPose* pose, render::Renderer* renderer) {
  render::FrameRequest request;
  FURROW_RETURN_IF_ERROR(Show(*job.snapshot, pose, &request));
  job.spec.Describe(&request);
  request.is_moving = renderer->is_software();
  if (render::CanBeCompleted(request, renderer->is_software())) {
    const PictureStreams::Place place = PictureStreams().Find(job);
    request.stream = place.stream;
    request.scale = place.scale;
  }
  return renderer->Render(request).status();
}

}  // namespace

Result<std::vector<RenderJob>> Preparations(const character::Character& character,
                                            const wrinkle::Rig& rig,
                                            const render::Settings& settings,
                                            const render::Camera& camera) {
  const auto maker = JobMaker::Create(character, rig, settings, camera);
  FURROW_RETURN_IF_ERROR(maker);
  std::vector<RenderJob> jobs;
  // A stream begins in full. On a GPU, the second three only repeat the first.
  for (const std::uint64_t stream : {std::uint64_t{0}, PictureStreams::kPreparation}) {
    for (const Wrinkles wrinkles : {Wrinkles::kAll, Wrinkles::kOneMap, Wrinkles::kNone}) {
      jobs.push_back(maker->Make(stream, wrinkles));
    }
  }
  return jobs;
}

Status WarmUp(render::Renderer* renderer, const character::Character& character,
              const wrinkle::Rig& rig, const render::Settings& settings) {
  const auto camera = renderer->Preset("face");
  FURROW_RETURN_IF_ERROR(camera);
  const auto maker = JobMaker::Create(character, rig, settings, *camera);
  FURROW_RETURN_IF_ERROR(maker);
  wrinkle::CharacterPose pose(&character.skeleton);
  FURROW_RETURN_IF_ERROR(Draw(maker->Make(0, Wrinkles::kAll), &pose, renderer));
  // The second picture of a stream is the first one that is completed from a former one.
  const RenderJob stream = maker->Make(PictureStreams::kPreparation, Wrinkles::kAll);
  FURROW_RETURN_IF_ERROR(Draw(stream, &pose, renderer));
  return Draw(stream, &pose, renderer);
}

}  // namespace furrow::server
