// SPDX-License-Identifier: Apache-2.0
#include "bench/video/scenes.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "client/cli/common/inputs.h"
#include "client/cli/render/subject_group.h"
#include "motion/clip/clip.h"
#include "motion/clip_file.h"
#include "motion/find_recording.h"
#include "render/renderer.h"

namespace furrow::bench {
namespace {

constexpr double kHz = 30.0;
constexpr float kTurn = 35.0f;          // degrees to each side
constexpr double kTurnSeconds = 4.0;    // there and back
constexpr double kCameraSeconds = 8.0;  // around the head
constexpr double kTau = 2.0 * std::numbers::pi;

glm::quat AboutY(double radians) {
  return glm::angleAxis(static_cast<float>(radians), glm::vec3(0, 1, 0));
}

// The recording at kHz, from its beginning, and again if it is shorter.
Result<motion::Clip> LoadPerformance(Scene scene, int count) {
  const auto path = motion::FindRecording("performance");
  FURROW_RETURN_IF_ERROR(path);
  auto clip = motion::LoadClip(*path, {});
  FURROW_RETURN_IF_ERROR(clip);
  const auto joints = static_cast<std::size_t>(clip->skeleton.num_joints());
  const int head = clip->skeleton.Find("head");
  if (head == wrinkle::kNoJoint) return Status(StatusCode::kNotFound, "no joint 'head'");
  motion::Clip sampled;
  sampled.skeleton = clip->skeleton;
  std::size_t from = 0;
  for (int i = 0; i < count; ++i) {
    const double at = std::fmod(i / kHz, clip->duration());
    if (i > 0 && at < 1.0 / kHz) from = 0;
    while (from + 1 < clip->times.size() && clip->times[from + 1] - clip->times[0] <= at) ++from;
    sampled.times.push_back(i / kHz);
    const auto pose = clip->locals.begin() + static_cast<std::ptrdiff_t>(from * joints);
    sampled.locals.insert(sampled.locals.end(), pose, pose + static_cast<std::ptrdiff_t>(joints));
    if (scene == Scene::kFace) continue;
    const double turn = glm::radians(kTurn) * std::sin(kTau * i / kHz / kTurnSeconds);
    glm::quat& rotation =
        sampled.locals[sampled.locals.size() - joints + static_cast<std::size_t>(head)].rotation;
    rotation = AboutY(turn) * rotation;
  }
  return sampled;
}

render::Camera Circle(render::Camera camera, double seconds) {
  camera.position =
      camera.target + AboutY(kTau * seconds / kCameraSeconds) * (camera.position - camera.target);
  return camera;
}

}  // namespace

std::string NameOf(Scene scene) {
  switch (scene) {
    case Scene::kFace: return "calm face";
    case Scene::kTurningFace: return "turning face";
    case Scene::kTurningCamera: return "turning camera";
  }
  return {};
}

SceneDrawer::SceneDrawer(character::Character character, rig::SkeletonMatcher matcher,
                         rig::ShapeMatcher shapes, std::unique_ptr<render::Renderer> renderer)
    : character_(std::move(character)),
      matcher_(std::move(matcher)),
      shapes_(std::move(shapes)),
      renderer_(std::move(renderer)) {}

Result<std::unique_ptr<SceneDrawer>> SceneDrawer::Create() {
  auto character = cli::LoadCharacterArgument("", "", {}, "");
  FURROW_RETURN_IF_ERROR(character);
  auto matcher = cli::LoadSkeletonMatcher("", &*character);
  FURROW_RETURN_IF_ERROR(matcher);
  auto shapes = cli::LoadShapeMatcher("");
  FURROW_RETURN_IF_ERROR(shapes);
  auto renderer = render::Renderer::Create(*character);
  FURROW_RETURN_IF_ERROR(renderer);
  return std::unique_ptr<SceneDrawer>(new SceneDrawer(*std::move(character), *std::move(matcher),
                                                      *std::move(shapes), *std::move(renderer)));
}

Result<std::vector<render::Image>> SceneDrawer::Draw(Scene scene, int width, int height, int count,
                                                     const Adjust& adjust) {
  auto clip = LoadPerformance(scene, count);
  FURROW_RETURN_IF_ERROR(clip);
  auto group = cli::SubjectGroup::Create(character_,
                                         {std::make_shared<const motion::Clip>(*std::move(clip))},
                                         {"performance"}, matcher_, shapes_, {});
  FURROW_RETURN_IF_ERROR(group);
  const auto camera = renderer_->Preset("face");
  FURROW_RETURN_IF_ERROR(camera);
  (*group)->FrameBy(*camera, static_cast<float>(width) / static_cast<float>(height));
  std::vector<render::Image> images;
  for (int i = 0; i < count; ++i) {
    FURROW_RETURN_IF_ERROR((*group)->Advance(i));
    render::FrameRequest request = (*group)->Request();
    request.settings.shading = render::Shading::kSkin;
    request.width = width;
    request.height = height;
    if (scene == Scene::kTurningCamera) request.camera = Circle(request.camera, i / kHz);
    if (adjust) adjust(&request);
    auto image = renderer_->Render(request);
    FURROW_RETURN_IF_ERROR(image);
    images.push_back(*std::move(image));
  }
  return images;
}

}  // namespace furrow::bench
