// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/cloth_folds.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// A sheet of cloth of 20 x 12 cm, and its folds.
class Garment : public testing::Test {
 protected:
  Garment() : mesh_(toys::Sheet(0.2f, 0.12f, 10, 6)) {
    const character::Mesh* const meshes[] = {&mesh_};
    surface_ = std::make_unique<Surface>(meshes);
    fine_ = std::make_unique<FineMesh>(*surface_, 0.007f);
  }

  [[nodiscard]] std::vector<float> Everywhere(float mask = 1.0f) const {
    return std::vector<float>(surface_->positions().size(), mask);
  }
  // A pose that presses the sheet by a fifth along x, on the way from rest.
  [[nodiscard]] static BakePose Pressed(float weight = 1.0f) {
    BakePose pose = toys::Pose(toys::Squeeze(0.2f, 0.0f));
    pose.weight = weight;
    for (float pressed = 0.0f; pressed < 0.21f; pressed += 0.05f) {
      pose.path.emplace_back(2, toys::Squeeze(pressed, 0.0f));
    }
    return pose;
  }
  [[nodiscard]] static FabricFolds Fabric(float wavelength, float radius = 0.0f) {
    return {.wavelength = wavelength, .radius = radius};
  }
  [[nodiscard]] ClothFolds Folds() const { return {*fine_, *fine_, 0.05f, 1.0f, 1}; }
  // The root of the mean square of the heights, metres.
  [[nodiscard]] double Depth(const ClothFolds& folds) const {
    double sum = 0.0, count = 0.0;
    for (std::uint32_t t = 0; t < surface_->triangles().size(); ++t) {
      const FoldSample sample =
          folds.At({t, vec3(1.0f / 3.0f), vec3(0.0f)}, vec3(1, 0, 0), vec3(0, 1, 0));
      sum += static_cast<double>(sample.height) * static_cast<double>(sample.height);
      count += 1.0;
    }
    return std::sqrt(sum / count);
  }

  BakeProgress progress_{nullptr};
  character::Mesh mesh_;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<FineMesh> fine_;
};

TEST_F(Garment, WithoutPosesIsFlat) {
  ClothFolds folds = Folds();
  ASSERT_TRUE(folds.Solve(1, &progress_));
  EXPECT_EQ(Depth(folds), 0.0);
  EXPECT_EQ(folds.Wavelengths(), std::pair(0.0f, 0.0f));
}

TEST_F(Garment, FoldsOnlyInsideItsMask) {
  ClothFolds folds = Folds();
  std::vector<float> left = Everywhere();
  for (std::size_t v = 0; v < left.size(); ++v) {
    if (surface_->positions()[v].x > 0.1f) left[v] = 0.0f;
  }
  folds.Add(Pressed(), left, Fabric(0.03f));
  ASSERT_TRUE(folds.Solve(1, &progress_));
  EXPECT_GT(Depth(folds), 1e-4);
  for (std::uint32_t t = 0; t < surface_->triangles().size(); ++t) {
    const auto& corners = surface_->triangles()[t].vertices;
    const bool right = std::ranges::all_of(
        corners, [&](std::uint32_t v) { return surface_->positions()[v].x > 0.13f; });
    if (!right) continue;
    EXPECT_EQ(folds.At({t, vec3(1.0f / 3.0f), vec3(0.0f)}, vec3(1, 0, 0), vec3(0, 1, 0)).height,
              0.0f);
  }
}

TEST_F(Garment, WeakPosesHaveShallowFolds) {
  ClothFolds full = Folds(), half = Folds();
  full.Add(Pressed(), Everywhere(), Fabric(0.03f));
  half.Add(Pressed(0.5f), Everywhere(), Fabric(0.03f));
  ASSERT_TRUE(full.Solve(1, &progress_) && half.Solve(1, &progress_));
  EXPECT_NEAR(Depth(half), 0.5 * Depth(full), 1e-6);
}

// However much cloth a pose presses together, it creases instead of gaping.
TEST_F(Garment, SlopesAreLimited) {
  for (const float pressed : {0.2f, 0.5f, 0.9f}) {
    BakePose pose = toys::Pose(toys::Squeeze(pressed, 0.0f));
    pose.path.emplace_back(2, toys::Squeeze(0.0f, 0.0f));
    pose.path.emplace_back(2, toys::Squeeze(pressed, 0.0f));
    ClothFolds folds = Folds();
    folds.Add(pose, Everywhere(), Fabric(0.03f));
    ASSERT_TRUE(folds.Solve(1, &progress_));
    float steepest = 0.0f;
    for (std::uint32_t t = 0; t < surface_->triangles().size(); ++t) {
      for (const vec3& corners : {vec3(0.2f, 0.3f, 0.5f), vec3(0.6f, 0.2f, 0.2f)}) {
        const FoldSample sample = folds.At({t, corners, vec3(0.0f)}, vec3(1, 0, 0), vec3(0, 1, 0));
        steepest = std::max(steepest, std::hypot(sample.slope.x, sample.slope.y));
      }
    }
    EXPECT_GT(steepest, 0.3f) << pressed;
    EXPECT_LT(steepest, 2.0f) << pressed;
  }
}

// By the largest change of slope within a triangle of 2 cm.
TEST_F(Garment, FoldsAreAsRoundAsTheFabric) {
  const auto sharpest = [&](float radius) {
    ClothFolds folds = Folds();
    folds.Add(Pressed(), Everywhere(), Fabric(0.03f, radius));
    EXPECT_TRUE(folds.Solve(1, &progress_));
    float most = 0.0f;
    for (std::uint32_t t = 0; t < surface_->triangles().size(); ++t) {
      const auto slope = [&](const vec3& corners) {
        return folds.At({t, corners, vec3(0.0f)}, vec3(1, 0, 0), vec3(0, 1, 0)).slope.x;
      };
      most = std::max(most, std::abs(slope({0.7f, 0.2f, 0.1f}) - slope({0.3f, 0.6f, 0.1f})));
    }
    return most;
  };
  EXPECT_LT(sharpest(0.008f), 0.8f * sharpest(0.002f));
  EXPECT_LT(sharpest(0.016f), 0.8f * sharpest(0.008f));
}

// Two regions of one pose are one piece of cloth.
TEST_F(Garment, MasksOfOnePoseAreJoined) {
  ClothFolds whole = Folds(), parts = Folds();
  std::vector<float> left = Everywhere(), right = Everywhere();
  for (std::size_t v = 0; v < left.size(); ++v) {
    (surface_->positions()[v].x > 0.1f ? left : right)[v] = 0.0f;
  }
  whole.Add(Pressed(), Everywhere(), Fabric(0.03f));
  parts.Add(Pressed(), left, Fabric(0.03f));
  parts.Add(Pressed(), right, Fabric(0.03f));
  ASSERT_TRUE(whole.Solve(1, &progress_) && parts.Solve(1, &progress_));
  EXPECT_NEAR(Depth(parts), Depth(whole), 0.2 * Depth(whole));
}

// A pose that hardly folds the cloth does not flatten the folds of another.
TEST_F(Garment, TheDeepestFoldsPrevail) {
  ClothFolds alone = Folds(), both = Folds();
  BakePose still = toys::Pose(toys::Squeeze(0.01f, 0.0f));
  still.path.emplace_back(2, toys::Squeeze(0.01f, 0.0f));
  alone.Add(Pressed(), Everywhere(), Fabric(0.03f));
  both.Add(Pressed(), Everywhere(), Fabric(0.03f));
  both.Add(still, Everywhere(), Fabric(0.03f));
  ASSERT_TRUE(alone.Solve(1, &progress_) && both.Solve(1, &progress_));
  EXPECT_GT(Depth(both), 0.8 * Depth(alone));
}

TEST_F(Garment, DoesNotDependOnTheNumberOfThreads) {
  ClothFolds one = Folds(), four = Folds();
  for (ClothFolds* folds : {&one, &four}) {
    for (const float wavelength : {0.03f, 0.04f, 0.05f}) {
      folds->Add(Pressed(), Everywhere(), Fabric(wavelength));
    }
    ASSERT_TRUE(folds->Solve(folds == &one ? 1 : 4, &progress_));
    EXPECT_EQ(folds->Wavelengths(), std::pair(0.03f, 0.05f));
  }
  for (std::uint32_t t = 0; t < surface_->triangles().size(); ++t) {
    const SurfacePoint point{t, vec3(0.2f, 0.3f, 0.5f), vec3(0.0f)};
    const FoldSample a = one.At(point, vec3(1, 0, 0), vec3(0, 1, 0));
    const FoldSample b = four.At(point, vec3(1, 0, 0), vec3(0, 1, 0));
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.slope, b.slope);
    EXPECT_EQ(a.cavity, b.cavity);
  }
}

TEST_F(Garment, CanBeCancelledWithinAPose) {
  int calls = 0;
  BakeProgress progress([&](float) { return ++calls < 3; });
  ClothFolds folds = Folds();
  folds.Add(Pressed(), Everywhere(), Fabric(0.03f));
  EXPECT_FALSE(folds.Solve(1, &progress));
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace furrow::authoring
