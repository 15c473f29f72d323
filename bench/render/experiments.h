// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/render/moving_scene.h"

namespace furrow::bench {

struct ExperimentOptions {
  PictureSize size;
  int frames = 8;      // per sample
  std::string device;  // RendererOptions::device
};

// One row of a table.
struct Row {
  std::string name;
  std::size_t scene = 0;  // index in Experiment::scenes
  render::Settings settings;
  std::size_t baseline = 0;   // index of the row for comparison
  double thesis_fps = 0.0;    // frame rate in the thesis; 0: not stated
  double thesis_share = 0.0;  // frame rate in the thesis relative to the baseline; 0: not stated
};

struct Experiment {
  std::string id;  // "table-5.1"
  std::string title;
  std::vector<std::unique_ptr<MovingScene>> scenes;
  std::vector<Row> rows;
};

// One head: diffuse, wrinkles by skinning weights and by masks, depth passes, skin shading, SSAO.
[[nodiscard]] Experiment MakeTable51(const ExperimentOptions& options);
// One body: no drivers, 2 hinges and a ball, 100 hinges and 50 balls.
[[nodiscard]] Experiment MakeTable52(const ExperimentOptions& options);
// 1, 10 and 100 heads, diffuse and with skin shading.
[[nodiscard]] Experiment MakeFigure51(const ExperimentOptions& options);
// One head with skin shading: every subsurface and occlusion method, and displacement.
[[nodiscard]] Experiment MakeMethods(const ExperimentOptions& options);

}  // namespace furrow::bench
