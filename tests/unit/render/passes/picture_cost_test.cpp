// SPDX-License-Identifier: Apache-2.0
#include "render/passes/picture_cost.h"

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

TEST(PictureCost, GrowsWithPixelsSamplesShadowsAndStrips) {
  const Settings settings;
  const PictureCost small = EstimateCost(settings, 64, 64);
  const PictureCost large = EstimateCost(settings, 2048, 2048);
  EXPECT_GT(large.texture_bytes, small.texture_bytes + 2048u * 2048u * 32u);
  EXPECT_GT(large.work, 20 * small.work);
  Settings fine = settings;
  fine.anti_aliasing.samples = 8;
  EXPECT_GT(EstimateCost(fine, 2048, 2048).texture_bytes, std::size_t{1} << 30);
  EXPECT_GT(EstimateCost(fine, 512, 512).work, 4 * EstimateCost(settings, 512, 512).work);
  Settings shadows = settings;
  shadows.shadow.filter = ShadowFilter::kPcf;
  shadows.shadow.lamps = 3;
  shadows.shadow.resolution = 4096;
  EXPECT_GT(EstimateCost(shadows, 64, 64).texture_bytes, std::size_t{190} << 20);
  Settings strip = settings;
  strip.strip.views.assign(8, View::kFinal);
  EXPECT_GT(EstimateCost(strip, 64, 64).work, 4 * small.work) << "each draws the meshes again";
}

TEST(PictureCost, TheDevicesOwnNumberOfSamplesCounts) {
  const Settings settings;  // samples 0
  EXPECT_GT(EstimateCost(settings, 512, 512, 4).work, 2 * EstimateCost(settings, 512, 512).work);
  Settings fixed;
  fixed.anti_aliasing.samples = 1;
  EXPECT_EQ(EstimateCost(fixed, 512, 512, 4).work, EstimateCost(fixed, 512, 512).work);
}

}  // namespace
}  // namespace furrow::render
