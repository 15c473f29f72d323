// SPDX-License-Identifier: Apache-2.0
#include "server/rendering.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include <malloc.h>
#include <spdlog/spdlog.h>

#include "base/process/in_background.h"
#include "render/renderer.h"
#include "render/request/camera_preset.h"
#include "render/video/video_codec.h"
#include "server/net/clock.h"
#include "server/pipeline/preparation.h"
#include "server/session/subscriptions/picture_views.h"

namespace furrow::server {
namespace {

// The time that joining a thread may take after it has ended.
constexpr Time kJoinTime = std::chrono::milliseconds(50);
// Of loading a character while drafts of it are drawn.
constexpr int kLoadNiceness = 10;

}  // namespace

void Rendering::MakeVideo(int max_encoders) {
  if (max_encoders == 0) {
    video_ = std::make_unique<VideoEncoders>(nullptr, 0, "render.max_video_encoders is 0");
    return;
  }
  const auto codec = render::GetVideoCodec();
  if (codec.ok()) {
    spdlog::info("H.264 by {}, for at most {} viewers", (*codec)->library, max_encoders);
    video_ = std::make_unique<VideoEncoders>(*codec, max_encoders);
    return;
  }
  spdlog::warn("pictures are sent as JPEG only: {}", codec.status().ToString());
  // Without the paths of this machine, because viewers read it.
  video_ = std::make_unique<VideoEncoders>(nullptr, 0, "its library cannot be loaded; see its log");
}

namespace {

// A software renderer starts its threads with its first context, and they inherit the niceness.
Result<render::Renderer::Device> FindDevice(const std::string& name) {
  return InBackground(RenderThread::kNiceness,
                      [&name] { return render::Renderer::FindDevice(name); })
      .get();
}

// Programs that are not compiled ahead are compiled when they are needed.
void LogIfFailed(const Status& status) {
  if (!status.ok()) spdlog::debug("programs are not compiled ahead: {}", status.ToString());
}

Result<std::unique_ptr<render::Renderer>> CreateRenderer(const character::Character& character,
                                                         const std::string& device) {
  return render::Renderer::Create(
      character, {.device = device, .max_texture_bytes = PictureViews::kMaxTextureBytes});
}

// An exception on the render thread would end the daemon, which can serve weights.
Result<Rendering::SharedCharacter> Load(const Rendering::Later& later,
                                        character::Pictures pictures) {
  try {
    return later.load(pictures);
  } catch (const std::bad_alloc&) {
    return Status(StatusCode::kUnavailable, "not enough memory to load the character");
  } catch (const std::exception& error) {
    return Status(StatusCode::kInternal, std::string("cannot load the character: ") + error.what());
  }
}

// The draft comes first.
Result<Rendering::SharedCharacter> LoadWithoutHurry(const Rendering::Later& later) {
  return InBackground(kLoadNiceness, [&later] { return Load(later, character::Pictures::kLoad); })
      .get();
}

// Compiles programs into the driver's cache while the render thread loads a draft and compiles
// others: those of skin and of the passes after it, such as light and bloom, which it needs last.
Status CompileAhead(const Rendering::Later& later, const std::string& device,
                    const render::Settings& settings) {
  const auto loaded = Load(later, character::Pictures::kStandIns);
  FURROW_RETURN_IF_ERROR(loaded);
  character::Character part = **loaded;
  std::erase_if(part.meshes, [&part](const character::Mesh& mesh) {
    return part.materials.at(static_cast<std::size_t>(mesh.material)).kind !=
           character::Material::Kind::kSkin;
  });
  const auto renderer = CreateRenderer(part, device);
  FURROW_RETURN_IF_ERROR(renderer);
  return WarmUp(renderer->get(), part, part.rig, settings);
}

}  // namespace

RenderThread::Factory Rendering::MakeFactory(const Parts& parts) {
  return [character = parts.character, device = parts.device] {
    return CreateRenderer(*character, device);
  };
}

// The first call runs beside the render thread, which draws a draft, and helps it.
RenderThread::Factory Rendering::MakeLateFactory(const Parts& parts) {
  return [this, character = parts.character, later = parts.later, device = parts.device,
          settings = parts.settings]() mutable -> Result<std::unique_ptr<render::Renderer>> {
    if (later.load == nullptr) return CreateRenderer(*character, device);
    const Rendering::Later loads = std::exchange(later, {});
    const bool drafts = loads.drafts;
    if (drafts) LogIfFailed(CompileAhead(loads, device, settings));
    auto loaded = drafts ? LoadWithoutHurry(loads) : Load(loads, character::Pictures::kLoad);
    load_status_ = loaded.status();
    FURROW_RETURN_IF_ERROR(loaded);
    character = loaded_ = *std::move(loaded);
    auto renderer = CreateRenderer(*character, device);
    FURROW_RETURN_IF_ERROR(renderer);
    if (drafts) LogIfFailed(WarmUp(renderer->get(), *character, character->rig, settings));
    return renderer;
  };
}

Status Rendering::Start(Parts parts) {
  character_ = parts.character;
  MakeVideo(parts.max_video_encoders);
  spdlog::info("starting the renderer");
  if (parts.later.load) {
    const auto device = FindDevice(parts.device);
    if (!device.ok()) {
      spdlog::error("cannot render pictures: {}", device.status().ToString());
      return {};
    }
    parts.later.drafts &= device->is_software;
    RenderThread::Later later{
        .presets = render::CameraPresets(*parts.character),
        .draft = nullptr,
        .on_started = [this, on_started = parts.later.on_started](const Status& status) {
          if (!status.ok()) spdlog::error("cannot render pictures: {}", status.ToString());
          on_started(load_status_);
        }};
    if (parts.later.drafts) {
      later.draft = [loads = parts.later,
                     device = parts.device]() -> Result<std::unique_ptr<render::Renderer>> {
        const auto draft = Load(loads, character::Pictures::kColours);
        FURROW_RETURN_IF_ERROR(draft);
        return CreateRenderer(**draft, device);
      };
    }
    thread_ =
        RenderThread::StartLater(parts.skeleton, MakeLateFactory(parts), parts.metrics, &ReadClock,
                                 std::move(parts.deliver), video_.get(), std::move(later));
    thread_->SetBudget(parts.budget);
    return {};
  }
  auto started = RenderThread::Start(parts.skeleton, MakeFactory(parts), parts.metrics, &ReadClock,
                                     std::move(parts.deliver), video_.get());
  if (started.ok()) {
    thread_ = *std::move(started);
    thread_->SetBudget(parts.budget);
    spdlog::info("rendering on {}", thread_->description());
    return {};
  }
  // Weights work without OpenGL, so the daemon serves them unless the user insists on pictures.
  if (parts.required) return started.status();
  spdlog::error("cannot render pictures: {}", started.status().ToString());
  return {};
}

void Rendering::Prepare(const wrinkle::Rig& rig, const render::Settings& settings) {
  const auto camera = thread_->Preset("face");
  if (!camera.ok()) return;
  const character::Character& drawn = loaded_ != nullptr ? *loaded_ : *character_;
  auto jobs = Preparations(drawn, rig, settings, *camera);
  if (jobs.ok()) thread_->Prepare(*std::move(jobs));
}

bool Rendering::LetGo() {
  if (thread_ == nullptr) return true;
  if (!thread_->ended()) return false;
  if (!freed_.valid()) {
    freed_ = InBackground([this] {
      character_.reset();
      loaded_.reset();
      malloc_trim(0);
    });
  }
  return freed_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void Rendering::End(std::optional<Time> deadline, const std::function<void()>& give_up) {
  if (thread_ == nullptr) return;
  const std::future<void> ended = InBackground([this] { thread_.reset(); });
  if (!deadline) return;  // the future waits
  // The thread has been stopped already, so it has usually ended by now, and is only joined.
  const Time left = std::max(*deadline - ReadClock(), kJoinTime);
  if (ended.wait_for(left) != std::future_status::ready) give_up();
}

}  // namespace furrow::server
