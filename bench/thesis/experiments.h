// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/thesis/stage.h"

namespace furrow::bench {

struct ExperimentOptions {
  PictureSize size;
  int frames = 8;      // a sample
  std::string device;  // RendererOptions::device
};

// One line of a table.
struct Row {
  std::string name;
  std::size_t stage = 0;  // in Experiment::stages
  render::Settings settings;
  std::size_t baseline = 0;   // row that its frame rate is compared with
  double thesis_fps = 0.0;    // what the thesis measured; 0: not stated
  double thesis_share = 0.0;  // its frame rate as a share of the baseline's; 0: not stated
};

struct Experiment {
  std::string id;  // "table-5.1"
  std::string title;
  std::vector<std::unique_ptr<Stage>> stages;
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
