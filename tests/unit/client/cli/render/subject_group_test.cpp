// SPDX-License-Identifier: Apache-2.0
#include "client/cli/render/subject_group.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace furrow::cli {
namespace {

TEST(ArrangeGroup, ASingleSubjectIsInTheMiddle) {
  const std::vector<glm::vec3> spots = ArrangeGroup(1, 0.6f, 0.5f, 1.6f);
  ASSERT_EQ(spots.size(), 1u);
  EXPECT_EQ(spots[0], glm::vec3(0.0f));
}

TEST(ArrangeGroup, NoSubjectHidesAnother) {
  for (const int people : {2, 3, 10, 57, 256}) {
    for (const float aspect : {0.5f, 1.0f, 1.6f}) {
      const std::vector<glm::vec3> spots = ArrangeGroup(people, 0.6f, 0.5f, aspect);
      ASSERT_EQ(spots.size(), static_cast<std::size_t>(people));
      for (std::size_t i = 0; i < spots.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          // Neighbours in a row are one spacing apart. The next row fills the gaps, higher and
          // behind.
          const glm::vec3 apart = spots[i] - spots[j];
          EXPECT_LE(apart.z, 0.0f);
          EXPECT_TRUE(std::abs(apart.x) > 0.29f || apart.y > 0.6f)
              << people << ": " << i << ", " << j;
          if (apart.z < 0.0f) {
            EXPECT_GT(apart.y, 0.3f);
          }
        }
      }
    }
  }
}

TEST(ArrangeGroup, FillsTheShapeOfThePicture) {
  const auto width = [](float aspect) {
    float most = 0.0f;
    for (const glm::vec3& spot : ArrangeGroup(12, 0.6f, 0.5f, aspect)) {
      most = std::max(most, std::abs(spot.x));
    }
    return most;
  };
  EXPECT_LT(width(0.5f), width(1.0f));
  EXPECT_LT(width(1.0f), width(2.5f));
}

TEST(FrameGroup, ShowsAllPositionsWithTheirSurroundingsTightly) {
  render::Camera one;
  one.position = {0.0f, 1.6f, 1.0f};
  one.target = {0.0f, 1.6f, 0.0f};
  one.fov_y_degrees = 20.0f;
  one.follow_joint = 3;
  one.fit_shorter_side = true;
  const float tangent = std::tan(glm::radians(10.0f));
  for (const float aspect : {0.6f, 1.0f, 2.0f}) {
    const std::vector<glm::vec3> spots = ArrangeGroup(10, 0.5f, 2.0f * tangent, aspect);
    const render::Camera all = FrameGroup(one, spots, aspect);
    EXPECT_EQ(all.follow_joint, -1);
    EXPECT_FALSE(all.fit_shorter_side);
    float fullest = 0.0f;  // 0 in the middle of the picture, 1 at the border
    for (const glm::vec3& spot : spots) {
      const glm::vec3 place = one.target + spot - all.position;
      fullest = std::max({fullest, (std::abs(place.y) + tangent) / (-place.z * tangent),
                          (std::abs(place.x) + tangent) / (-place.z * tangent * aspect)});
    }
    EXPECT_NEAR(fullest, 1.0f, 1e-3f);
  }
}

}  // namespace
}  // namespace furrow::cli
