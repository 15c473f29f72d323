// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/report/aims.h"
#include "render/renderer.h"

namespace furrow::bench {

struct PreviewSetup {
  render::Image picture;  // shown to the viewers
  int rounds = 201;       // pictures for the delivery time
  int stills = 21;        // repetitions for the refined still
  int viewers = 16;       // for all figures about several viewers
  double stall_seconds = 10.0;
};

// Measures
// - the time from a drawn picture to its viewer, compared with JPEG encoding alone;
// - the memory that a stalled viewer holds and the age of the first picture it sees afterwards,
//   compared with a viewer without acknowledgements;
// - the number of pictures encoded for many viewers, compared with one per viewer;
// - the delay of the refined still of a pose at rest.
[[nodiscard]] std::vector<Aim> MeasurePreview(const PreviewSetup& setting);

}  // namespace furrow::bench
