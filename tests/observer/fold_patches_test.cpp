// SPDX-License-Identifier: Apache-2.0
#include "tests/observer/fold_patches.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "authoring/bake/bake_pictures.h"
#include "authoring/bake/bake_poses.h"
#include "tests/unit/authoring/bake/toys.h"

namespace furrow::observer {
namespace {

namespace toys = authoring::toys;

constexpr float kHeight = 4.0f;  // millimetres, of the height picture

void AddPicture(character::Picture picture, character::Character* to) {
  to->rig_pictures.emplace_back(picture.name, static_cast<int>(to->pictures.size()));
  to->pictures.push_back(std::move(picture));
}

// A sheet of 10 cm in z = 0 that a pose squeezes by a fifth along x. Its region is the half at
// small x.
character::Character SqueezedSheet() {
  character::Character sheet = toys::Wearing(toys::Grid(20, 20, [](float u, float v) {
    return toys::Point{{0.1f * u, 0.1f * v, 0.0f}, {u, 1.0f - v}, u};
  }));
  wrinkle::Rig& rig = sheet.rig;
  rig.anchor = "a";
  wrinkle::ReferencePose in;
  in.name = "in";
  in.joints.push_back({.joint = "b", .translation = {-0.02f, 0.0f, 0.0f}});
  rig.reference_poses.push_back(in);
  wrinkle::Driver pull;
  pull.name = "pull";
  pull.kind = wrinkle::Driver::Kind::kPose;
  pull.pose.points.push_back({.joint = "b", .kind = wrinkle::ControlPoint::Kind::kOrigin});
  pull.pose.values.push_back({.name = "in", .reference_pose = "in"});
  rig.drivers.push_back(pull);
  rig.regions[0].feeds = {{"folds", {{"pull", "in", 1.0f}}}};
  rig.regions[0].mask.kind = wrinkle::Mask::Kind::kTexture;
  rig.regions[0].mask.texture = "masks";
  rig.wrinkle_maps[0].normal = "normals";
  rig.wrinkle_maps[0].height = "heights";
  rig.wrinkle_maps[0].height_mm = kHeight;
  character::Picture masks{.name = "masks", .width = 2, .height = 1, .channels = 1};
  masks.pixels = {255, 0};
  AddPicture(std::move(masks), &sheet);
  return sheet;
}

// With the pictures of a bake.
character::Character FoldedSheet(const character::Character& sheet) {
  const auto poses = authoring::CollectBakePoses(sheet);
  EXPECT_TRUE(poses.ok()) << poses.status().ToString();
  const authoring::BakedMap map = toys::BakeFolds(sheet, poses->poses, toys::Exact());
  character::Character folded = sheet;
  AddPicture(authoring::NormalPicture(map, "normals"), &folded);
  AddPicture(authoring::HeightPicture(map, kHeight, "heights"), &folded);
  return folded;
}

using Patches = std::vector<std::pair<std::string, FoldPatch>>;

Patches PatchesOf(const character::Character& character,
                  const std::vector<authoring::BakeStroke>& strokes = {}) {
  const Result<Patches> patches = SkinPatches(character, strokes);
  EXPECT_TRUE(patches.ok()) << patches.status().ToString();
  return patches.ok() ? *patches : Patches();
}

TEST(SkinPatches, HoldTheFoldsOfARegion) {
  const Patches patches = PatchesOf(FoldedSheet(SqueezedSheet()));
  ASSERT_EQ(patches.size(), 1u);
  EXPECT_EQ(patches[0].first, "patch.folds");
  const std::vector<FoldPlace>& places = patches[0].second.places;
  ASSERT_NEAR(static_cast<double>(places.size()), 256.0 * 128.0, 300.0);
  double rise = 0.0, slope = 0.0;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const FoldPlace& place = places[i];
    ASSERT_LT(place.position.x, 50.0f);
    ASSERT_NEAR(place.area, 100.0f * 100.0f / (256.0f * 256.0f), 0.01f);
    ASSERT_NEAR(place.normal.z, 1.0f, 1e-5f);
    ASSERT_NEAR(place.compression, 0.2f, 0.02f);
    ASSERT_NEAR(std::abs(place.direction.x), 1.0f, 0.01f);
    // Texels follow each other along x.
    const float step = places[i + 1].position.x - place.position.x;
    if (step <= 0.0f) continue;
    const float mean = 0.5f * (place.slope.x + places[i + 1].slope.x);
    rise += std::abs(static_cast<double>(places[i + 1].height - place.height - mean * step));
    slope += std::abs(static_cast<double>(mean * step));
  }
  EXPECT_LT(rise, 0.1 * slope);  // the slope is that of the height
  EXPECT_TRUE(IsWithin(MeasureScars(patches[0].second), kScarLimits));
}

TEST(SkinPatches, KnowWhatIsDrawn) {
  authoring::BakeStroke stroke;
  stroke.maps = {"folds"};
  stroke.width_mm = 8.0f;
  stroke.points = {{0.02f, 0.0f, 0.001f}, {0.02f, 0.1f, 0.001f}};
  authoring::BakeStroke guide = stroke;
  guide.kind = authoring::BakeStroke::Kind::kDirection;
  guide.points = {{0.04f, 0.0f, 0.0f}, {0.04f, 0.1f, 0.0f}};
  const Patches patches = PatchesOf(FoldedSheet(SqueezedSheet()), {stroke, guide});
  ASSERT_EQ(patches.size(), 1u);
  for (const FoldPlace& place : patches[0].second.places) {
    const float away = std::abs(place.position.x - 20.0f);
    if (std::abs(away - 10.0f) < 0.1f) continue;
    ASSERT_EQ(place.drawn, away < 10.0f) << place.position.x;
  }
}

TEST(SkinPatches, LeaveOutMapsWithoutAPicture) { EXPECT_TRUE(PatchesOf(SqueezedSheet()).empty()); }

}  // namespace
}  // namespace furrow::observer
