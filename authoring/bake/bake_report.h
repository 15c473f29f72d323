// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "authoring/bake/bake.h"

namespace furrow::character::bake {

// What a report says besides the maps themselves.
struct ReportFacts {
  std::string character;  // file names, for people
  std::string rig;
  std::string strokes;  // empty: none
  std::span<const BakePose> poses;
  std::span<const std::string> notes;     // what could not be baked
  std::span<const std::string> warnings;  // what was put up with
  BakeOptions options;
  double seconds = 0.0;
};

// The report of a bake, to judge it by: report.html and the pictures that it shows, each map lit
// from the upper left, its heights (blue valleys, red ridges) and its masks in colours, at most
// 1024 texels a side.
[[nodiscard]] std::string ReportHtml(const BakedMaps& maps, const ReportFacts& facts);

// Named as in the HTML: "report/squash_lit.png".
[[nodiscard]] std::vector<Picture> ReportPictures(const BakedMaps& maps);

// What a person should look at, one sentence each: a map without folds, skinning that compresses
// beyond what the material does, folds too fine for the texels.
[[nodiscard]] std::vector<std::string> Doubts(const BakedMaps& maps, const BakeOptions& options);

}  // namespace furrow::character::bake
