// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/preparation.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "server/pipeline/picture_streams.h"
#include "server/pipeline/snapshot.h"
#include "tests/shape_rig.h"

namespace furrow::server {
namespace {

// What viewers see first is compiled first: a stream begins with full pictures.
TEST(Preparations, FullPicturesComeBeforeCompletedOnes) {
  const wrinkle::Rig rig = test::ShapeRig("test", {"brow", "nose"});
  const auto jobs = Preparations(character::Character(), rig, render::Settings(), render::Camera());
  ASSERT_TRUE(jobs.ok()) << jobs.status().ToString();
  ASSERT_EQ(jobs->size(), 6u);
  PictureStreams streams;
  for (std::size_t i = 0; i < jobs->size(); ++i) {
    const RenderJob& job = (*jobs)[i];
    EXPECT_TRUE(job.prepares);
    EXPECT_EQ(streams.Find(job).scale == 1.0f, i < 3);
    EXPECT_EQ(job.snapshot->wrinkle_weights, (*jobs)[i % 3].snapshot->wrinkle_weights);
  }
  // All wrinkles before none.
  const std::vector<float>& all = jobs->front().snapshot->wrinkle_weights;
  EXPECT_TRUE(std::ranges::all_of(all, [](float weight) { return weight == 1.0f; }));
}

}  // namespace
}  // namespace furrow::server
