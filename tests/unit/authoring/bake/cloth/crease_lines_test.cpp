// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/crease_lines.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr float kCreasedWidth = 0.6f, kCreasedHeight = 0.4f;  // metres
constexpr float kSpacing = 0.04f;

// A sheet in the plane z = 0 whose creases run along y.
class Creases : public testing::Test {
 protected:
  Creases() : mesh_(toys::Sheet(kCreasedWidth, kCreasedHeight, 30, 20)) {
    const character::Mesh* const meshes[] = {&mesh_};
    surface_ = std::make_unique<Surface>(meshes);
    fine_ = std::make_unique<FineMesh>(*surface_, 0.007f);
  }

  // `excess`: a function of the place.
  template <class Excess>
  [[nodiscard]] CreaseField FieldOf(const Excess& excess) const {
    CreaseField field;
    for (const vec3& p : fine_->positions()) {
      field.along.emplace_back(0.0f, 1.0f, 0.0f);
      field.excess.push_back(excess(p));
      field.spacing.push_back(kSpacing);
      field.tilt.push_back(0.0f);
    }
    return field;
  }
  [[nodiscard]] std::vector<Crease> Lay(const CreaseField& field,
                                        const CreaseOptions& options = {}) const {
    return LayCreases(*fine_, field, field.excess, options);
  }
  [[nodiscard]] static float LengthOf(const Crease& crease) {
    float length = 0.0f;
    for (std::size_t i = 1; i < crease.points.size(); ++i) {
      length += glm::distance(crease.points[i].place, crease.points[i - 1].place);
    }
    return length;
  }

  character::Mesh mesh_;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<FineMesh> fine_;
};

TEST_F(Creases, NeedExcess) {
  const CreaseOptions options;
  EXPECT_TRUE(Lay(FieldOf([](const vec3&) { return 0.0f; })).empty());
  EXPECT_TRUE(Lay(FieldOf([&](const vec3&) { return 0.99f * options.start; })).empty());
  const auto left = [](const vec3& p) { return p.x < 0.3f ? 0.2f : 0.0f; };
  const std::vector<Crease> creases = Lay(FieldOf(left));
  EXPECT_FALSE(creases.empty());
  for (const Crease& crease : creases) {
    for (const Crease::Point& point : crease.points) EXPECT_LT(point.place.x, 0.31f);
  }
}

TEST_F(Creases, RunAlongTheField) {
  const std::vector<Crease> creases = Lay(FieldOf([](const vec3&) { return 0.2f; }));
  EXPECT_GT(creases.size(), 8u);
  for (const Crease& crease : creases) {
    for (const Crease::Point& point : crease.points) EXPECT_GT(std::abs(point.along.y), 0.8f);
  }
}

// Cloth is stiff along a crest: one that leaves the hollow of a bend goes on.
TEST_F(Creases, HideTheirExcessEvenlyAlongTheirWay) {
  const auto half = [](const vec3& p) { return p.y < 0.2f ? 0.5f : 0.1f; };
  int crossing = 0;
  for (const Crease& crease : Lay(FieldOf(half))) {
    float sum = 0.0f, laid = 0.0f, beyond = 0.0f;
    for (const Crease::Point& point : crease.points) {
      sum += point.excess;
      laid += point.laid;
      if (point.place.y > 0.22f && point.place.y < 0.24f) beyond = point.excess;
    }
    EXPECT_NEAR(sum, laid, 0.02f * laid);
    const auto [low, high] =
        std::minmax(crease.points.front().place.y, crease.points.back().place.y);
    if (low > 0.15f || high < 0.25f) continue;
    ++crossing;
    EXPECT_GT(beyond, 0.15f);
  }
  EXPECT_GT(crossing, 3);
}

// Where the row at `y` crosses creases, in order.
std::vector<float> CrossingsAt(const std::vector<Crease>& creases, float y) {
  std::vector<float> places;
  for (const Crease& crease : creases) {
    for (std::size_t i = 1; i < crease.points.size(); ++i) {
      const vec3 &a = crease.points[i - 1].place, &b = crease.points[i].place;
      if ((a.y < y) != (b.y < y)) places.push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
    }
  }
  std::sort(places.begin(), places.end());
  return places;
}

// Equal distances would look like corrugated iron.
TEST_F(Creases, LieAboutASpacingApartAndVary) {
  const std::vector<Crease> creases = Lay(FieldOf([](const vec3&) { return 0.2f; }));
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (float y = 0.05f; y < kCreasedHeight - 0.05f; y += 0.02f) {
    const std::vector<float> places = CrossingsAt(creases, y);
    for (std::size_t i = 1; i < places.size(); ++i) {
      const auto gap = static_cast<double>(places[i] - places[i - 1]);
      sum += gap;
      squares += gap * gap;
      count += 1.0;
    }
  }
  ASSERT_GT(count, 30.0);
  const double mean = sum / count;
  const double deviation = std::sqrt(squares / count - mean * mean);
  EXPECT_GT(mean, 0.8 * static_cast<double>(kSpacing));
  EXPECT_LT(mean, 2.0 * static_cast<double>(kSpacing));
  EXPECT_GT(deviation, 0.15 * mean);
  EXPECT_LT(deviation, 0.6 * mean);
}

TEST_F(Creases, AreNeitherShortNorEndless) {
  const CreaseOptions options;
  for (const Crease& crease : Lay(FieldOf([](const vec3&) { return 0.2f; }))) {
    EXPECT_GE(LengthOf(crease), options.shortest * kSpacing);
    EXPECT_LE(LengthOf(crease), 1.5f * options.longest * kSpacing);
  }
}

// A single weak spot would be a scar.
TEST_F(Creases, AreNeverAloneAndWeak) {
  const auto spot = [](const vec3& p) {
    return 0.1f * std::exp(-glm::dot(p - vec3(0.3f, 0.2f, 0.0f), p - vec3(0.3f, 0.2f, 0.0f)) /
                           (2.0f * 0.02f * 0.02f));
  };
  EXPECT_TRUE(Lay(FieldOf(spot)).empty());
}

TEST_F(Creases, FadeAtLooseEnds) {
  const auto band = [](const vec3& p) { return std::abs(p.y - 0.2f) < 0.1f ? 0.2f : 0.0f; };
  const std::vector<Crease> creases = Lay(FieldOf(band), {.longest = 20.0f});
  ASSERT_FALSE(creases.empty());
  int loose = 0;
  for (const Crease& crease : creases) {
    float strongest = 0.0f;
    for (const Crease::Point& point : crease.points) {
      strongest = std::max(strongest, point.strength);
    }
    EXPECT_GT(strongest, 0.5f);
    loose += crease.points.front().strength == 0.0f && crease.points.back().strength == 0.0f;
  }
  EXPECT_GT(2 * loose, static_cast<int>(creases.size()));
}

TEST_F(Creases, AreTheSameAgainAndOthersForAnotherSeed) {
  const CreaseField field = FieldOf([](const vec3& p) { return 0.1f + 0.2f * p.x; });
  const std::vector<Crease> first = Lay(field), again = Lay(field), other = Lay(field, {.seed = 2});
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t c = 0; c < first.size(); ++c) {
    ASSERT_EQ(first[c].points.size(), again[c].points.size());
    EXPECT_EQ(first[c].points.front().place, again[c].points.front().place);
    EXPECT_EQ(first[c].points.back().place, again[c].points.back().place);
  }
  ASSERT_FALSE(other.empty());
  EXPECT_TRUE(first.size() != other.size() ||
              first[0].points.front().place != other[0].points.front().place);
}

}  // namespace
}  // namespace furrow::authoring
