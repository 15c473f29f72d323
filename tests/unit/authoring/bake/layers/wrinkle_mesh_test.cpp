// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/wrinkle_mesh.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "base/scalar.h"
#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr float kWidth = 0.4f, kHeight = 0.12f;  // metres
constexpr float kEdge = 0.007f;                  // of the fine mesh, for folds of 38 mm

// A sheet of cloth in the plane z = 0, without gravity, fixed at its left and right ends.
class Sheet {
 public:
  explicit Sheet(float edge = kEdge) : mesh_(toys::Sheet(kWidth, kHeight, 20, 6)) {
    const character::Mesh* const meshes[] = {&mesh_};
    surface_ = std::make_unique<Surface>(meshes);
    fine_ = std::make_unique<FineMesh>(*surface_, edge);
  }

  [[nodiscard]] const FineMesh& fine() const { return *fine_; }
  [[nodiscard]] std::vector<float> Room() const {
    std::vector<float> room;
    for (const vec3& p : fine_->positions()) {
      room.push_back(p.x > 0.001f && p.x < kWidth - 0.001f ? 1.0f : 0.0f);
    }
    return room;
  }
  [[nodiscard]] std::vector<PosedVertex> Posed(const glm::mat4& motion) const {
    const std::vector<glm::mat4> matrices(2, motion);
    return PoseSurface(*surface_, matrices, surface_->positions());
  }
  // Presses the sheet along x in steps of 2%.
  [[nodiscard]] std::vector<WrinkleMesh::Fold> Press(float compression,
                                                     const WrinkleMesh::Options& options) const {
    WrinkleMesh cloth(*fine_, Room(), options);
    for (float pressed = 0.0f; pressed < compression; pressed += 0.02f) {
      cloth.Step(Posed(toys::Squeeze(pressed, 0.0f)), 60);
    }
    cloth.Step(Posed(toys::Squeeze(compression, 0.0f)), 300);
    return cloth.Folds();
  }

 private:
  character::Mesh mesh_;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<FineMesh> fine_;
};

WrinkleMesh::Options Weightless() {
  WrinkleMesh::Options options;
  options.weight = 0.0f;
  options.ease = 0.0f;
  options.variation = 0.0f;
  options.sink = options.rise * options.wavelength;
  return options;
}

// The mean distance between valleys along x, metres, from the crossings of the mean height in rows.
float WavelengthOf(const FineMesh& mesh, const std::vector<WrinkleMesh::Fold>& folds) {
  int crossings = 0, rows = 0;
  for (float y = 0.3f * kHeight; y < 0.7f * kHeight; y += 0.011f, ++rows) {
    std::vector<std::pair<float, float>> row;  // x and height
    for (std::size_t v = 0; v < folds.size(); ++v) {
      const vec3 p = mesh.positions()[v];
      if (std::abs(p.y - y) < 0.003f && p.x > 0.05f && p.x < kWidth - 0.05f)
        row.emplace_back(p.x, folds[v].height);
    }
    std::sort(row.begin(), row.end());
    float mean = 0.0f;
    for (const auto& [x, height] : row) mean += height / static_cast<float>(row.size());
    for (std::size_t i = 1; i < row.size(); ++i) {
      crossings += (row[i].second > mean) != (row[i - 1].second > mean) ? 1 : 0;
    }
  }
  const float length = (kWidth - 0.1f) * static_cast<float>(rows);
  return 2.0f * length / static_cast<float>(std::max(crossings, 1));
}

// The ends of the sheet, which are not repeated, change the count by a fold or so.
TEST(WrinkleMesh, FoldsAsWideAsAsked) {
  float last = 0.0f;
  for (const float wavelength : {0.029f, 0.038f, 0.045f, 0.068f}) {
    const Sheet sheet;
    WrinkleMesh::Options options = Weightless();
    options.wavelength = wavelength;
    const float found = WavelengthOf(sheet.fine(), sheet.Press(0.2f, options));
    EXPECT_GT(found, 0.65f * wavelength) << wavelength;
    EXPECT_LT(found, 1.3f * wavelength) << wavelength;
    EXPECT_GT(found, last) << wavelength;
    last = found;
  }
}

TEST(WrinkleMesh, FoldsRunAcrossTheCompression) {
  const Sheet sheet;
  double along = 0.0, across = 0.0;
  for (const WrinkleMesh::Fold& fold : sheet.Press(0.12f, Weightless())) {
    along += static_cast<double>(std::abs(fold.gradient.x));
    across += static_cast<double>(std::abs(fold.gradient.y));
  }
  EXPECT_GT(along, 2.0 * across);
}

// The mean of sqrt(1 + slope^2): how much longer the cloth is than the surface.
double ArcOf(const FineMesh& mesh, const std::vector<WrinkleMesh::Fold>& folds) {
  double arc = 0.0, count = 0.0;
  for (std::size_t v = 0; v < folds.size(); ++v) {
    const vec3 p = mesh.positions()[v];
    if (p.x < 0.05f || p.x > kWidth - 0.05f) continue;
    arc += std::hypot(1.0, static_cast<double>(glm::length(folds[v].gradient)));
    count += 1.0;
  }
  return arc / count;
}

// Pressed to 1 - e of its length, cloth that kept all of its length would be 1 / (1 - e) times as
// long as the surface. Bending and the support take a part, and the more, the less it is pressed.
TEST(WrinkleMesh, FoldsDeepenWithTheCompressionAndNeverBeyondTheLength) {
  const Sheet sheet;
  double last = 1.0;
  for (const float pressed : {0.1f, 0.2f, 0.3f}) {
    const double whole = 1.0 / (1.0 - static_cast<double>(pressed));
    const double arc = ArcOf(sheet.fine(), sheet.Press(pressed, Weightless()));
    EXPECT_GT(arc, last + 0.02) << pressed;
    EXPECT_LT(arc, whole) << pressed;
    last = arc;
  }
  EXPECT_GT(last - 1.0, 0.25 * (1.0 / 0.7 - 1.0));
}

// Gravity pulls along -y. Cloth that is too wide, but not too long, hangs in folds along it.
TEST(WrinkleMesh, HangsInFoldsAlongGravity) {
  const Sheet sheet;
  std::vector<float> room = sheet.Room();
  for (std::size_t v = 0; v < room.size(); ++v) {
    const float y = sheet.fine().positions()[v].y;
    if (y < 0.001f || y > kHeight - 0.001f) room[v] = 0.0f;
  }
  const auto share_across = [&](float hang) {
    WrinkleMesh::Options options = Weightless();
    options.ease = 0.15f;
    options.hang = hang;
    WrinkleMesh cloth(sheet.fine(), room, options);
    cloth.Step(sheet.Posed(glm::mat4(1.0f)), 300);
    double across = 0.0, along = 0.0;
    for (const WrinkleMesh::Fold& fold : cloth.Folds()) {
      across += static_cast<double>(std::abs(fold.gradient.x));
      along += static_cast<double>(std::abs(fold.gradient.y));
    }
    return across / (across + along);
  };
  EXPECT_GT(share_across(0.2f), 0.6);
  EXPECT_GT(share_across(0.2f), share_across(1.0f) + 0.1);
}

TEST(WrinkleMesh, FoldsWiderWhereAsked) {
  const Sheet sheet;
  const std::vector<float> wider(sheet.fine().vertices().size(), 1.5f);
  WrinkleMesh::Options options = Weightless();
  options.wavelength = 0.029f;
  const float narrow = WavelengthOf(sheet.fine(), sheet.Press(0.2f, options));
  options.wider = wider;
  const float wide = WavelengthOf(sheet.fine(), sheet.Press(0.2f, options));
  EXPECT_GT(wide, 1.2f * narrow);
}

TEST(WrinkleMesh, StaysSmoothWithoutCompression) {
  const Sheet sheet;
  WrinkleMesh::Options options = Weightless();
  options.dents = 0.0f;
  WrinkleMesh cloth(sheet.fine(), sheet.Room(), options);
  const glm::mat4 motion = glm::translate(
      glm::rotate(glm::mat4(1.0f), 1.1f, glm::normalize(vec3(1.0f, 2.0f, 3.0f))), vec3(1, 2, 3));
  cloth.Step(sheet.Posed(glm::mat4(1.0f)), 30);
  cloth.Step(sheet.Posed(motion), 30);
  for (const WrinkleMesh::Fold& fold : cloth.Folds()) {
    EXPECT_LT(std::abs(fold.height), 1e-5f);
    EXPECT_LT(glm::length(fold.gradient), 1e-2f);
  }
}

TEST(WrinkleMesh, KeepsWithinItsRoom) {
  const Sheet sheet;
  WrinkleMesh::Options options;
  options.weight = 0.0f;
  const std::vector<float> room = sheet.Room();
  const std::vector<WrinkleMesh::Fold> folds = sheet.Press(0.4f, options);
  float highest = 0.0f;
  for (std::size_t v = 0; v < folds.size(); ++v) {
    EXPECT_LE(folds[v].height, options.rise * options.wavelength + 1e-6f);
    EXPECT_GE(folds[v].height, -options.sink - 1e-6f);
    if (room[v] == 0.0f) {
      EXPECT_EQ(folds[v].height, 0.0f);
    }
    highest = std::max(highest, folds[v].height);
  }
  EXPECT_GT(highest, options.sink);
}

TEST(WrinkleMesh, GivesTheSameFoldsAgainAndOthersForAnotherSeed) {
  const Sheet sheet(0.01f);
  WrinkleMesh::Options options = Weightless();
  const auto first = sheet.Press(0.1f, options), again = sheet.Press(0.1f, options);
  options.seed = 2;
  const auto other = sheet.Press(0.1f, options);
  bool differs = false;
  for (std::size_t v = 0; v < first.size(); ++v) {
    EXPECT_EQ(first[v].height, again[v].height);
    differs = differs || first[v].height != other[v].height;
  }
  EXPECT_TRUE(differs);
}

// A sleeve with its axis along x: a tube of 29 cm round and 30 cm long, fixed at both ends.
class Tube {
 public:
  Tube()
      : mesh_(toys::Grid(20, 20, [](float u, float v) {
          const float angle = 2.0f * kPi * (u < 1.0f ? u : 0.0f);  // the seam closes exactly
          return toys::Point{
              .position = {kLength * v, kRadius * std::sin(angle), -kRadius * std::cos(angle)},
              .uv = {u, v}};
        })) {
    const character::Mesh* const meshes[] = {&mesh_};
    surface_ = std::make_unique<Surface>(meshes);
    fine_ = std::make_unique<FineMesh>(*surface_, kEdge);
  }

  // Hangs the cloth on the tube. Means are over its middle third.
  struct Hung {
    double height = 0.0;  // mean, metres
    double drop = 0.0;    // how much further the lower half is from the surface than the upper
    double slope = 0.0;   // root of the mean square
  };
  [[nodiscard]] Hung Hang(const WrinkleMesh::Options& options) const {
    std::vector<float> room;
    for (const vec3& p : fine_->positions()) {
      room.push_back(p.x > 0.001f && p.x < kLength - 0.001f ? 1.0f : 0.0f);
    }
    WrinkleMesh cloth(*fine_, room, options);
    const std::vector<glm::mat4> still(2, glm::mat4(1.0f));
    cloth.Step(PoseSurface(*surface_, still, surface_->positions()), 400);
    const std::vector<WrinkleMesh::Fold> folds = cloth.Folds();
    Hung hung;
    double count = 0.0, below = 0.0;
    for (std::size_t v = 0; v < folds.size(); ++v) {
      const vec3 p = fine_->positions()[v];
      if (std::abs(p.x - 0.5f * kLength) > kLength / 6.0f) continue;
      const auto height = static_cast<double>(folds[v].height);
      hung.height += height;
      hung.drop += p.y < 0.0f ? height : 0.0;
      hung.slope += static_cast<double>(glm::dot(folds[v].gradient, folds[v].gradient));
      below += p.y < 0.0f ? 1.0 : 0.0;
      count += 1.0;
    }
    hung.drop = hung.drop / below - (hung.height - hung.drop) / (count - below);
    hung.height /= count;
    hung.slope = std::sqrt(hung.slope / count);
    return hung;
  }

 private:
  static constexpr float kRadius = 0.046f, kLength = 0.3f;  // metres
  character::Mesh mesh_;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<FineMesh> fine_;
};

// A tube that is 15% wider than its surface could be 7 mm further out, and smooth.
TEST(WrinkleMesh, SleevesFoldInsteadOfGrowingRounder) {
  WrinkleMesh::Options options;
  options.variation = 0.0f;
  options.weight = 0.0f;
  const Tube::Hung hung = Tube().Hang(options);
  EXPECT_LT(std::abs(hung.height), 0.005);
  EXPECT_GT(hung.slope, 0.2);
}

// Nor does its weight draw it down as a whole.
TEST(WrinkleMesh, SleevesFoldInsteadOfHangingOffTheArm) {
  const std::vector<ClothEase> loose(1 << 16, ClothEase{.looser = 1.6f, .least = 0.6f});
  WrinkleMesh::Options options;
  options.eases = loose;
  const Tube::Hung hung = Tube().Hang(options);
  EXPECT_LT(hung.drop, 0.008);
  EXPECT_GT(hung.slope, 0.2);
}

TEST(WrinkleMesh, FoldsWhereABendPushesIt) {
  const Sheet sheet;
  WrinkleMesh::Options options = Weightless();
  std::vector<glm::mat3> slipped;
  for (const vec3& p : sheet.fine().positions()) {
    const bool beside = p.x > 0.5f * kWidth;
    slipped.push_back(glm::mat3(0.0f));
    slipped.back()[0][0] = beside ? 0.25f : 0.0f;
  }
  options.slipped = slipped;
  const auto steepness = [&](float way) {
    WrinkleMesh cloth(sheet.fine(), sheet.Room(), options);
    for (float part = 0.0f; part < 1.0f; part += 0.1f) {
      cloth.Step(sheet.Posed(glm::mat4(1.0f)), 30, part * way);
    }
    const std::vector<WrinkleMesh::Fold> folds = cloth.Folds();
    double sums[2] = {};
    for (std::size_t v = 0; v < folds.size(); ++v) {
      const float x = sheet.fine().positions()[v].x;
      if (std::abs(x - 0.5f * kWidth) < 0.04f) continue;
      sums[x > 0.5f * kWidth ? 1 : 0] += static_cast<double>(std::abs(folds[v].gradient.x));
    }
    return std::pair(sums[0], sums[1]);
  };
  const auto [calm, folded] = steepness(1.0f);
  EXPECT_GT(folded, 3.0 * calm);
  EXPECT_GT(folded, 2.0 * steepness(0.0f).second);
}

TEST(WrinkleMesh, HasNoTightPlacesWhereEaseHasALeast) {
  const Sheet sheet;
  const auto calm_share = [&](const ClothEase& ease) {
    const std::vector<ClothEase> eases(sheet.fine().vertices().size(), ease);
    WrinkleMesh::Options options;
    options.weight = 0.0f;
    options.eases = eases;
    WrinkleMesh cloth(sheet.fine(), sheet.Room(), options);
    cloth.Step(sheet.Posed(glm::mat4(1.0f)), 300);
    double calm = 0.0, count = 0.0;
    for (const WrinkleMesh::Fold& fold : cloth.Folds()) {
      calm += glm::length(fold.gradient) < 0.05f ? 1.0 : 0.0;
      count += 1.0;
    }
    return calm / count;
  };
  EXPECT_LT(calm_share({.least = 0.8f}), 0.6 * calm_share({.least = 0.0f}));
}

// A surface that collapses to a point, or turns inside out, gives finite folds.
TEST(WrinkleMesh, SurvivesBrokenSkinning) {
  const Sheet sheet(0.01f);
  for (const float scale : {0.0f, -0.5f, 8.0f}) {
    WrinkleMesh cloth(sheet.fine(), sheet.Room(), {});
    cloth.Step(sheet.Posed(glm::mat4(1.0f)), 20);
    cloth.Step(sheet.Posed(glm::scale(glm::mat4(1.0f), vec3(scale, 1.0f, 1.0f))), 60);
    for (const WrinkleMesh::Fold& fold : cloth.Folds()) {
      EXPECT_TRUE(std::isfinite(fold.height));
      EXPECT_TRUE(std::isfinite(glm::dot(fold.gradient, fold.gradient)));
    }
  }
}

}  // namespace
}  // namespace furrow::authoring
