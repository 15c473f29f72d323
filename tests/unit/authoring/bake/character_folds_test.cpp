// SPDX-License-Identifier: Apache-2.0
//
// Repeats checks of folds_test.cpp with the surfaces and poses of whole characters: the default
// character, and MakeHuman's if its data is available.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/bake/bake_poses.h"
#include "authoring/bake/surface/bake_surface.h"
#include "authoring/generator/default_character.h"
#include "authoring/import/makehuman/makehuman.h"
#include "base/status.h"
#include "motion/pose_source.h"
#include "rig/rig_file.h"
#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

constexpr int kMapSize = 512;
constexpr int kTextureSize = 128;

const std::filesystem::path kRigs = std::filesystem::path(FURROW_SOURCE_DIR) / "rig/rigs";
const std::filesystem::path kMakeHuman = std::filesystem::path(FURROW_SHARED_DATA) / "makehuman";

BakeOptions ExactSkin() {
  BakeOptions options = toys::Exact();
  options.size = kMapSize;
  options.threads = 2;
  options.skin.wavelength_mm = 9.0f;
  options.skin.threshold = 0.02f;
  options.skin.crossing = 0.0f;
  options.wavelengths.clear();
  return options;
}

Result<character::Character> DefaultCharacter() {
  auto rig = rig::LoadRig(kRigs / "default.json");
  FURROW_RETURN_IF_ERROR(rig);
  return MakeDefaultCharacter(*rig, {.texture_size = kTextureSize});
}

Result<character::Character> MakeHumanCharacter() {
  ImportOptions options;
  options.rig = kRigs / "makehuman.json";
  options.poses = motion::CachedPoseSource();
  options.texture_size = kTextureSize;
  return ImportMakeHuman(kMakeHuman, options);
}

// The skin of a character, the strain of one pose on all of it, and the map baked from that pose.
struct Folded {
  std::unique_ptr<character::Character> character;
  std::unique_ptr<BakeSurface> surface;
  std::vector<Tensor2> strain;
  BakePose pose;
  BakedMap map;
};

Result<Folded> Fold(character::Character character) {
  Folded folded;
  folded.character = std::make_unique<character::Character>(std::move(character));
  auto poses = CollectBakePoses(*folded.character, {});
  FURROW_RETURN_IF_ERROR(poses);
  const auto pose = std::find_if(poses->poses.begin(), poses->poses.end(), [](const BakePose& p) {
    return p.map == "squash" && p.region == "mouth_l";
  });
  if (pose == poses->poses.end()) return Status(StatusCode::kNotFound, "no pose of mouth_l");
  pose->region.clear();
  BakeProgress progress({});
  auto surface = BakeSurface::Create(*folded.character, false, ExactSkin(), &progress);
  FURROW_RETURN_IF_ERROR(surface);
  folded.surface = std::move(*surface);
  folded.strain = folded.surface->solver()
                      .Solve(pose->skin_matrices, {}, ExactSkin().skin.max_compression)
                      .tensors;
  folded.pose = *pose;
  folded.map = toys::BakeFolds(*folded.character, {folded.pose}, ExactSkin());
  return folded;
}

struct Subject {
  const char* name;
  Result<character::Character> (*make)();
  std::filesystem::path needs;  // empty if no files are needed
};

class CharacterFolds : public ::testing::TestWithParam<Subject> {
 protected:
  void SetUp() override {
    const Subject& subject = GetParam();
    if (!subject.needs.empty() && !std::filesystem::exists(subject.needs))
      GTEST_SKIP() << subject.needs << " is missing";
    // Cached, because a bake takes seconds.
    static std::map<std::string, Folded> made;
    auto found = made.find(subject.name);
    if (found == made.end()) {
      Result<character::Character> character = subject.make();
      ASSERT_TRUE(character.ok()) << character.status().ToString();
      Result<Folded> folded = Fold(std::move(*character));
      ASSERT_TRUE(folded.ok()) << folded.status().ToString();
      found = made.emplace(subject.name, std::move(*folded)).first;
    }
    folded_ = &found->second;
  }

  // A texel at which folds are fully developed.
  struct Place {
    float compression;
    vec3 across;  // unit vector
    vec3 slope;   // gradient of the height, in the surface
  };
  [[nodiscard]] std::vector<Place> FoldedPlaces(const BakedMap& map) const {
    const Surface& surface = folded_->surface->surface();
    const std::vector<float>& derivative = map.derivative;
    std::vector<Place> places;
    for (const SurfaceTexel& t : folded_->surface->texels()) {
      const SurfacePoint point{t.triangle, t.corners, t.position};
      const Principal2 strain = PrincipalOf(surface.Interpolate(folded_->strain, point));
      if (strain.large < 0.1f) continue;
      const wrinkle::SurfaceAxes& axes = surface.triangles()[t.triangle].axes;
      const std::size_t i = toys::At(map, t.x, t.y);
      places.push_back({strain.large, axes.x * strain.direction.x + axes.y * strain.direction.y,
                        -derivative[2 * i] * t.tangent - derivative[2 * i + 1] * t.bitangent});
    }
    return places;
  }

  // The height at a UV, interpolated between four texels.
  [[nodiscard]] float HeightAt(const vec2& uv) const {
    const vec2 at = uv * static_cast<float>(kMapSize) - 0.5f;
    const vec2 low = glm::floor(at), part = at - low;
    const auto texel = [&](int dx, int dy) {
      const int x = std::clamp(static_cast<int>(low.x) + dx, 0, kMapSize - 1);
      const int y = std::clamp(static_cast<int>(low.y) + dy, 0, kMapSize - 1);
      return folded_->map.height_mm[toys::At(folded_->map, x, y)];
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), part.x),
                    glm::mix(texel(0, 1), texel(1, 1), part.x), part.y);
  }

  const Folded* folded_ = nullptr;
};

INSTANTIATE_TEST_SUITE_P(Of, CharacterFolds,
                         ::testing::Values(Subject{"default", DefaultCharacter, {}},
                                           Subject{"makehuman", MakeHumanCharacter, kMakeHuman}),
                         [](const auto& subject) { return std::string(subject.param.name); });

// A mouth has room for some dozens of folds, whose mean length varies by 1.5% from seed to seed.
TEST_P(CharacterFolds, KeepTheArcLength) {
  double arc = 0.0, count = 0.0;
  for (const std::uint32_t seed : {1u, 2u, 3u, 4u, 5u}) {
    BakeOptions options = ExactSkin();
    options.seed = seed;
    const std::vector<Place> places =
        FoldedPlaces(toys::BakeFolds(*folded_->character, {folded_->pose}, options));
    ASSERT_GT(places.size(), 500u);
    for (const Place& place : places) {
      arc += static_cast<double>(
          std::hypot(1.0f - place.compression, glm::dot(place.slope, place.across)));
    }
    count += static_cast<double>(places.size());
  }
  RecordProperty("arc", std::to_string(arc / count));
  EXPECT_NEAR(arc / count, 1.0, 0.02);
}

TEST_P(CharacterFolds, RunAcrossTheCompression) {
  std::vector<float> angles;
  for (const Place& place : FoldedPlaces(folded_->map)) {
    const float length = glm::length(place.slope);
    if (length < 0.05f) continue;
    const float cosine = std::min(std::abs(glm::dot(place.slope, place.across)) / length, 1.0f);
    angles.push_back(glm::degrees(std::acos(cosine)));
  }
  ASSERT_GT(angles.size(), 500u);
  std::nth_element(angles.begin(), angles.begin() + angles.size() / 2, angles.end());
  EXPECT_LT(angles[angles.size() / 2], 10.0f);
}

float Largest(std::vector<float> jumps, double share) {
  const auto place =
      jumps.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(jumps.size() - 1));
  std::nth_element(jumps.begin(), place, jumps.end());
  return *place;
}

TEST_P(CharacterFolds, AreContinuousAcrossUvSeams) {
  const character::Mesh& mesh = folded_->surface->surface().mesh();
  const auto triangles = folded_->surface->surface().triangles();
  std::vector<float> seam, interior;
  const auto corner = [&](std::uint32_t t, std::uint32_t welded) {
    const auto& v = triangles[t].vertices;
    const auto k = static_cast<std::size_t>(std::find(v.begin(), v.end(), welded) - v.begin());
    return mesh.vertices[mesh.indices[3 * t + k]].uv;
  };
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t n = triangles[t].neighbours[k];
      if (n == kNoTriangle || n < t) continue;
      const std::uint32_t a = triangles[t].vertices[k], b = triangles[t].vertices[(k + 1) % 3];
      const bool is_seam = corner(t, a) != corner(n, a) || corner(t, b) != corner(n, b);
      for (float at = 0.05f; at < 1.0f; at += 0.1f) {
        const vec2 here = glm::mix(corner(t, a), corner(t, b), at);
        const float height = HeightAt(here);
        if (std::abs(height) < 0.002f) continue;
        // Inside an island, compare with the next texel.
        const vec2 there = is_seam ? glm::mix(corner(n, a), corner(n, b), at)
                                   : here + vec2(1.0f / static_cast<float>(kMapSize), 0.0f);
        (is_seam ? seam : interior).push_back(std::abs(height - HeightAt(there)));
      }
    }
  }
  ASSERT_GT(seam.size(), 20u);
  ASSERT_GT(interior.size(), 200u);
  EXPECT_LE(Largest(seam, 0.95), 2.0f * Largest(interior, 0.95));
}

}  // namespace
}  // namespace furrow::authoring
