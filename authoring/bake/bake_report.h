// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "authoring/bake/request/bake_request.h"
#include "authoring/bake/request/baked_maps.h"
#include "character/character.h"

namespace furrow::authoring {

// The facts that a report states besides the maps. The spans must stay valid until ReportHtml()
// returns.
struct ReportDetails {
  std::string character;  // file name, as shown to people
  std::string rig;        // file name
  std::string strokes;    // file name; empty: no strokes
  std::span<const BakePose> poses;
  std::span<const std::string> notes;     // drivers that could not be baked
  std::span<const std::string> warnings;  // faults of the surfaces that do not prevent a bake
  BakeOptions options;
  double seconds = 0.0;  // duration of the bake
};

// The report of a bake as HTML (report.html). It shows the pictures of ReportPictures().
[[nodiscard]] std::string ReportHtml(const BakedMaps& maps, const ReportDetails& facts);

// The pictures of the report, at most 1,024 texels per side: each map lit from the upper left, its
// heights (blue valleys, red ridges) and its masks in colours. The names match the HTML:
// "report/squash_lit.png".
[[nodiscard]] std::vector<character::Picture> ReportPictures(const BakedMaps& maps);

// Suspicious results, one sentence each: a map without folds, a compression beyond the material's
// limit, folds too fine for the texels.
[[nodiscard]] std::vector<std::string> BakeWarnings(const BakedMaps& maps,
                                                    const BakeOptions& options);

}  // namespace furrow::authoring
