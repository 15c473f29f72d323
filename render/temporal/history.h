// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>

#include <glm/vec2.hpp>

#include "render/graph/frame_graph.h"
#include "render/scene/motion.h"
#include "render/temporal/shot.h"

namespace furrow::render {

// The former picture of a stream, and what the next one needs to find its surfaces there.
struct History {
  bool is_valid = false;               // there is a former picture that the next one may continue
  int number = 0;                      // of the next picture, for its jitter
  int newest = 0;                      // index of the former picture's textures
  std::array<KeptTexture, 2> colours;  // shaders/temporal/accumulate.frag.glsl, f_history
  std::array<KeptTexture, 2> places;   // shaders/temporal/neighbours.frag.glsl, f_place
  Shot shot;
  CameraFrame camera;
  FormerVertices vertices;
  KeptShadows shadows;
  std::uint64_t used = 0;  // the last picture's number among those of all streams

  // Of vertices and shadow maps.
  [[nodiscard]] std::size_t num_other_bytes() const;
  [[nodiscard]] std::size_t num_bytes() const;
};

// How a picture of a stream is drawn. The history is that of the stream.
struct TemporalFrame {
  History* history = nullptr;
  int width = 0;  // pixels that are drawn
  int height = 0;
  glm::vec2 jitter{0.0f};  // by which the scene is moved, in these pixels
  // Textures of the history.
  KeptTexture colour;
  KeptTexture place;
  KeptTexture former_colour;
  KeptTexture former_place;

  bool keeps_shadows = false;  // the picture uses the shadow maps of the former one

  // False: the picture begins the stream.
  [[nodiscard]] bool has_former() const { return former_colour.texture != 0; }
};

// How the scene is drawn for `frame`, whose history must outlive the result.
[[nodiscard]] SceneMotion MotionOf(const TemporalFrame& frame);

// Keeps the histories of streams. A history is used by its stream alone, and is dropped when the
// stream cuts (Continues()), draws a picture that stands alone, or rests. Together they take at
// most kMaxBytes, and new streams get none while the others need these: if the least recent one
// made room, many streams that take turns would all lose their histories. Needs a current context.
class Histories {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{128} << 20;
  // A stream that has no picture among this many of all streams rests.
  static constexpr std::uint64_t kMaxRest = 256;

  // `device` outlives this object.
  explicit Histories(FrameGraphDevice* device) : device_(device) {}
  ~Histories();
  Histories(const Histories&) = delete;
  Histories& operator=(const Histories&) = delete;

  // Prepares the next picture of a stream. Null: the picture stands alone, because IsCompleted() is
  // false or there is no room for its history. The result is valid until the next call.
  [[nodiscard]] const TemporalFrame* Begin(const FrameRequest& request, bool is_software);
  // The picture of the last Begin() has been drawn, with `camera`. Without this call, the history
  // remains as it was.
  void End(const FrameRequest& request, const CameraFrame& camera);
  // The history of the last Begin(), which gets the vertices of the picture.
  [[nodiscard]] FormerVertices* vertices() { return &frame_.history->vertices; }
  // States how the lamps saw the picture of the last Begin(), for the next one.
  void KeepShadows(const std::array<ShadowView, kNumLights>& views, int resolution);

  [[nodiscard]] std::size_t num_bytes() const;

 private:
  void Release(History* history);
  // Erases a history and returns the next one.
  std::map<std::uint64_t, History>::iterator Drop(std::map<std::uint64_t, History>::iterator it);
  void Drop(std::uint64_t stream);
  void DropResting();
  [[nodiscard]] bool HasRoom(const FrameRequest& request);

  FrameGraphDevice* device_;
  std::map<std::uint64_t, History> histories_;  // by stream
  std::uint64_t num_pictures_ = 0;
  std::size_t most_others_ = 0;  // bytes, of any history: what a new one will need
  TemporalFrame frame_;
};

}  // namespace furrow::render
