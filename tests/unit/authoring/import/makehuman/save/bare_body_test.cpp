// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/bare_body.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "base/files.h"
#include "rig/rig_check.h"
#include "rig/rig_file.h"

namespace furrow::authoring {
namespace {

TEST(RemoveClothMaps, LeavesTheFaceOfARig) {
  constexpr const char* kRig = R"({
    "name": "toy", "anchor": "head",
    "drivers": [{"name": "elbow", "hinge": {"parent": "root", "joint": "arm", "axis": [1, 0, 0]}},
                {"name": "unused", "hinge": {"parent": "root", "joint": "leg", "axis": [1, 0, 0]}},
                {"name": "neck", "hinge": {"parent": "root", "joint": "head", "axis": [1, 0, 0]}}],
    "regions": [
      {"name": "sleeve", "mask": {"kind": "skinning"}, "neighbours": ["throat"],
       "feeds": [{"map": "folds", "sources": [{"from": "elbow.flexed"}]}]},
      {"name": "throat", "mask": {"kind": "skinning"}, "neighbours": ["sleeve"],
       "feeds": [{"map": "folds", "sources": [{"from": "neck.flexed"}]},
                 {"map": "lines", "sources": [{"from": "neck.flexed"}]}]}],
    "wrinkle_maps": [{"name": "folds", "normal": "a", "surface": "cloth"},
                     {"name": "lines", "normal": "b", "opposes": "folds", "surface": "skin"}]
  })";
  Result<wrinkle::Rig> rig = rig::ParseRig(kRig, "toy", {}, {});
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  RemoveClothMaps(&*rig);
  ASSERT_EQ(rig->wrinkle_maps.size(), 1u);
  EXPECT_EQ(rig->wrinkle_maps[0].name, "lines");
  EXPECT_EQ(rig->wrinkle_maps[0].opposes, "");
  ASSERT_EQ(rig->regions.size(), 1u);
  EXPECT_EQ(rig->regions[0].name, "throat");
  EXPECT_EQ(rig->regions[0].feeds.size(), 1u);
  EXPECT_TRUE(rig->regions[0].neighbours.empty());
  ASSERT_EQ(rig->drivers.size(), 2u);
  EXPECT_EQ(rig->drivers[0].name, "unused");  // was not used before either
  EXPECT_EQ(rig->drivers[1].name, "neck");
  EXPECT_TRUE(rig::CheckRig(*rig).ok()) << rig::CheckRig(*rig).ToString();
}

}  // namespace
}  // namespace furrow::authoring
