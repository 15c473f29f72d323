// SPDX-License-Identifier: Apache-2.0
#include "render/temporal/history.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "render/temporal/jitter.h"

namespace furrow::render {
namespace {

int Scaled(int side, float scale) {
  return std::max(1, static_cast<int>(std::lround(static_cast<float>(side) * scale)));
}

}  // namespace

SceneMotion MotionOf(const TemporalFrame& frame) {
  const glm::vec2 size(static_cast<float>(frame.width), static_cast<float>(frame.height));
  History& history = *frame.history;
  const float scale =
      static_cast<float>(frame.height) / static_cast<float>(frame.colour.desc.height);
  return {.jitter = 2.0f * frame.jitter / size,
          .detail = std::log2(scale),
          .shadows = frame.keeps_shadows ? &history.shadows : nullptr,
          .camera = history.is_valid ? &history.camera : nullptr,
          .vertices = &history.vertices};
}

std::size_t History::num_other_bytes() const {
  return vertices.num_bytes() + shadows.maps.num_bytes();
}

std::size_t History::num_bytes() const {
  std::size_t bytes = num_other_bytes();
  for (const auto* pair : {&colours, &places}) {
    for (const KeptTexture& kept : *pair) bytes += kept.num_bytes();
  }
  return bytes;
}

std::size_t Histories::num_bytes() const {
  std::size_t bytes = 0;
  for (const auto& [stream, history] : histories_) bytes += history.num_bytes();
  return bytes;
}

Histories::~Histories() {
  for (auto& [stream, history] : histories_) Release(&history);
}

void Histories::Release(History* history) {
  for (auto* pair : {&history->colours, &history->places}) {
    for (KeptTexture& kept : *pair) kept.Release(device_);
  }
  history->shadows.maps.Release(device_);
}

std::map<std::uint64_t, History>::iterator Histories::Drop(
    std::map<std::uint64_t, History>::iterator it) {
  Release(&it->second);
  return histories_.erase(it);
}

void Histories::Drop(std::uint64_t stream) {
  if (const auto found = histories_.find(stream); found != histories_.end()) (void)Drop(found);
}

void Histories::DropResting() {
  for (auto it = histories_.begin(); it != histories_.end();) {
    it = num_pictures_ - it->second.used > kMaxRest ? Drop(it) : std::next(it);
  }
}

// Whether the history fits beside the others, each at its full scale: a change of the scale takes
// no stream its history.
bool Histories::HasRoom(const FrameRequest& request) {
  const auto most_bytes = [](int width, int height) {
    return 4 * TextureBytes({width, height, PixelFormat::kRgba16F, 1});
  };
  std::size_t bytes = most_bytes(request.width, request.height);
  for (auto& [stream, history] : histories_) {
    most_others_ = std::max(most_others_, history.num_other_bytes());
    if (stream != request.stream) bytes += most_bytes(history.shot.width, history.shot.height);
  }
  const std::size_t others = histories_.size() - histories_.count(request.stream);
  return bytes + (others + 1) * most_others_ <= kMaxBytes;
}

const TemporalFrame* Histories::Begin(const FrameRequest& request, bool is_software) {
  frame_ = {};
  ++num_pictures_;
  DropResting();
  if (!IsCompleted(request, is_software) || !HasRoom(request)) {
    Drop(request.stream);
    return nullptr;
  }
  const auto found = histories_.find(request.stream);
  if (found != histories_.end() && !Continues(found->second.shot, ShotOf(request))) {
    Drop(request.stream);
  }
  const TextureDesc whole{request.width, request.height, PixelFormat::kRgba16F, 1};
  const TextureDesc drawn{Scaled(request.width, request.scale),
                          Scaled(request.height, request.scale), PixelFormat::kRgba16F, 1};
  History& history = histories_[request.stream];
  if (!history.is_valid) history.shot = ShotOf(request);
  const auto next = static_cast<std::size_t>(1 - history.newest);
  history.colours[next].Prepare(whole, device_);
  history.places[next].Prepare(drawn, device_);
  history.used = num_pictures_;
  frame_ = {.history = &history,
            .width = drawn.width,
            .height = drawn.height,
            .jitter = Jitter(history.number, request.scale),
            .colour = history.colours[next],
            .place = history.places[next]};
  if (history.is_valid) {
    frame_.former_colour = history.colours[1 - next];
    frame_.former_place = history.places[1 - next];
    frame_.keeps_shadows = history.number % 2 == 1 && history.shadows.is_drawn;
  }
  return &frame_;
}

void Histories::End(const FrameRequest& request, const CameraFrame& camera) {
  History& history = *frame_.history;
  history.is_valid = true;
  ++history.number;
  history.newest = 1 - history.newest;
  history.shot = ShotOf(request);
  history.camera = camera;
}

void Histories::KeepShadows(const std::array<ShadowView, kNumLights>& views, int resolution) {
  if (frame_.keeps_shadows) return;
  frame_.history->shadows.views = views;
  frame_.history->shadows.resolution = resolution;
}

}  // namespace furrow::render
