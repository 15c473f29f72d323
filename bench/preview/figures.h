// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/report/aims.h"
#include "render/renderer.h"

namespace furrow::bench {

struct PreviewSetting {
  render::Image picture;  // what is looked at
  int rounds = 201;       // pictures of the first figure
  int stills = 21;
  int viewers = 16;  // of the figures between
  double stall_seconds = 10.0;
};

// How long a drawn picture takes to a viewer, beside packing it alone; what a stalled viewer holds,
// and how old what it sees first is, beside one that is sent everything; how many pictures are
// packed for many viewers, beside one each; how soon the refined still of a pose at rest comes.
[[nodiscard]] std::vector<Aim> MeasurePreview(const PreviewSetting& setting);

}  // namespace furrow::bench
