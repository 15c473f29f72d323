// SPDX-License-Identifier: Apache-2.0
// Avatars that the VRM Add-on for Blender wrote; see fixtures/make_vrm.py, which states the values.
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "character/package/package.h"
#include "character/source_notes.h"

namespace furrow::character {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using wrinkle::ShapeRule;

// A version of VRM: VRM 0.x faces -Z.
struct Version {
  const char* file;
  float front;
  const char* joy;
  const char* mouth;
  const char* blink;
};

class ForeignVrm : public ::testing::TestWithParam<Version> {
 protected:
  void SetUp() override {
    const std::filesystem::path folder = FURROW_SOURCE_DIR "/tests/unit/character/gltf/fixtures";
    const auto bytes = ReadFile(folder / GetParam().file, 1 << 20);
    ASSERT_TRUE(bytes.ok()) << bytes.status().ToString();
    auto character = ParseCharacter(*bytes, folder, {.notes = &notes_});
    ASSERT_TRUE(character.ok()) << character.status().ToString();
    avatar_ = std::move(*character);
    ASSERT_EQ(avatar_.meshes.size(), 1u);
  }

  // The vertex at a column and row of the face's grid of 4 x 4.
  [[nodiscard]] std::uint32_t VertexAt(int column, int row) const {
    const auto head = static_cast<std::size_t>(avatar_.skeleton.Find("head"));
    const float x = static_cast<float>(column) - 1.5f;
    const glm::vec3 place(
        GetParam().front * 0.06f * x,
        avatar_.skeleton.rest_model()[head][3].y + 0.05f * static_cast<float>(row),
        GetParam().front * (0.08f - 0.005f * x * x));
    std::uint32_t best = 0;
    const auto& vertices = avatar_.meshes[0].vertices;
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
      if (glm::distance(vertices[v].position, place) <
          glm::distance(vertices[best].position, place)) {
        best = v;
      }
    }
    EXPECT_LT(glm::distance(vertices[best].position, place), 1e-5f) << column << " " << row;
    return best;
  }

  [[nodiscard]] int ShapeNamed(const std::string& name) const {
    const auto found = std::find(avatar_.shapes.begin(), avatar_.shapes.end(), name);
    EXPECT_NE(found, avatar_.shapes.end()) << name;
    return static_cast<int>(found - avatar_.shapes.begin());
  }

  // Millimetres by which a shape moves a vertex to the front.
  [[nodiscard]] float Moves(const std::string& name, int column, int row) const {
    const std::uint32_t vertex = VertexAt(column, row);
    for (const MorphTarget& target : avatar_.meshes[0].morph_targets) {
      if (target.shape != ShapeNamed(name)) continue;
      for (const MorphDelta& delta : target.deltas) {
        if (delta.vertex == vertex) return 1000.0f * GetParam().front * delta.position.z;
      }
    }
    return 0.0f;
  }

  Character avatar_;
  SourceNotes notes_;
};

TEST_P(ForeignVrm, HumanBonesGiveRoles) {
  using wrinkle::JointRole;
  ASSERT_EQ(avatar_.roles.size(), static_cast<std::size_t>(avatar_.skeleton.num_joints()));
  EXPECT_THAT(avatar_.roles, IsSupersetOf({JointRole::kHips, JointRole::kHead,
                                           JointRole::kLeftUpperArm, JointRole::kRightFoot}));
  const auto joint = [&](JointRole role) {
    return static_cast<std::size_t>(std::ranges::find(avatar_.roles, role) - avatar_.roles.begin());
  };
  const auto& rest = avatar_.skeleton.rest_model();
  EXPECT_GT(rest[joint(JointRole::kLeftUpperArm)][3].x * GetParam().front, 0.0f) << "its own left";
  EXPECT_GT(rest[joint(JointRole::kHead)][3].y, rest[joint(JointRole::kHips)][3].y);
}

TEST_P(ForeignVrm, HasItsShapeKeys) {
  EXPECT_THAT(avatar_.warnings, IsEmpty());
  EXPECT_NEAR(Moves("Jaw", 0, 0), 10.0f, 1e-3f);
  EXPECT_NEAR(Moves("Lids_L", 3, 0), 10.0f, 1e-3f);
  EXPECT_NEAR(Moves("Lids_R", 0, 3), 10.0f, 1e-3f);
  EXPECT_NEAR(Moves("Grin", 3, 3), 10.0f, 1e-3f);
  EXPECT_EQ(Moves("Grin", 0, 0), 0.0f);
}

TEST_P(ForeignVrm, ExpressionsAddUpTheirBinds) {
  EXPECT_NEAR(Moves(GetParam().joy, 3, 3), 10.0f, 1e-3f);
  EXPECT_NEAR(Moves(GetParam().joy, 0, 0), 2.5f, 1e-3f);
  EXPECT_EQ(Moves(GetParam().joy, 3, 0), 0.0f);
  EXPECT_NEAR(Moves(GetParam().mouth, 0, 0), 5.0f, 1e-3f);
  EXPECT_NEAR(Moves(GetParam().blink, 3, 0), 10.0f, 1e-3f);
  EXPECT_NEAR(Moves("smirk", 3, 3), 5.0f, 1e-3f);
  EXPECT_EQ(avatar_.shapes.size(), 9u);  // those without binds do not count
}

TEST_P(ForeignVrm, ExpressionsKeepTheirRules) {
  const auto rule_of = [&](const char* name) {
    const auto shape = static_cast<std::size_t>(ShapeNamed(name));
    const auto found = std::find_if(avatar_.shape_rules.begin(), avatar_.shape_rules.end(),
                                    [&](const ShapeRule& rule) { return rule.shape == shape; });
    return found == avatar_.shape_rules.end() ? ShapeRule{} : *found;
  };
  EXPECT_TRUE(rule_of(GetParam().blink).is_binary);
  const ShapeRule joy = rule_of(GetParam().joy);
  EXPECT_FALSE(joy.is_binary);
  using Limits = ShapeRule::Limits;
  const bool vrm1 = GetParam().front > 0.0f;  // VRM 0.x has no overrides
  EXPECT_EQ(joy.limits[ShapeRule::kBlinks], vrm1 ? Limits::kBlock : Limits::kNothing);
  EXPECT_EQ(joy.limits[ShapeRule::kMouths], vrm1 ? Limits::kBlend : Limits::kNothing);
  EXPECT_EQ(joy.limits[ShapeRule::kLooks], Limits::kNothing);
}

TEST_P(ForeignVrm, ExpressionsChangeMaterials) {
  ASSERT_EQ(avatar_.material_binds.size(), 1u);
  const MaterialBind& bind = avatar_.material_binds[0];
  EXPECT_EQ(bind.shape, static_cast<std::uint32_t>(ShapeNamed("blush")));
  EXPECT_EQ(bind.material, static_cast<std::uint32_t>(avatar_.meshes[0].material));
  // The colour of VRM 0.x is sRGB.
  const bool vrm1 = GetParam().front > 0.0f;
  const glm::vec3 target =
      vrm1 ? glm::vec3(1.0f, 0.5f, 0.25f) : glm::vec3(1.0f, 0.21404f, 0.05088f);
  EXPECT_LT(glm::distance(glm::vec3(bind.base_colour), target - 0.8f), 1e-4f);
  EXPECT_EQ(bind.base_colour.a, 0.0f);
  EXPECT_LT(glm::distance(bind.emission, glm::vec3(0.25f, 0.5f, 1.0f)), 1e-5f);
  // From uv / 2 + (0.25, 0.5) to (uv.x / 4, uv.y / 2) + (0.5, 0.25).
  EXPECT_LT(glm::distance(bind.uv_scale, glm::vec2(-0.5f, 0.0f)), 1e-5f);
  EXPECT_LT(glm::distance(bind.uv_offset, glm::vec2(0.375f, -0.25f)), 1e-5f);
}

TEST_P(ForeignVrm, EyesFollowTheirRanges) {
  ASSERT_TRUE(notes_.look_at.has_value());
  EXPECT_NEAR(notes_.look_at->inner.output, 20.0f, 1e-4f);
  EXPECT_NEAR(notes_.look_at->outer.output, 40.0f, 1e-4f);
  EXPECT_NEAR(notes_.look_at->down.output, 15.0f, 1e-4f);
  EXPECT_NEAR(notes_.look_at->up.output, 10.0f, 1e-4f);
  EXPECT_NEAR(notes_.look_at->inner.input, 90.0f, 1e-4f);
}

// MToon states the picture and its transform: half of the square, in its lower middle.
TEST_P(ForeignVrm, TheFaceHasMToonsPicture) {
  const Material& material =
      avatar_.materials[static_cast<std::size_t>(avatar_.meshes[0].material)];
  EXPECT_EQ(material.kind, Material::Kind::kSkin);
  EXPECT_NEAR(material.base_colour.x, 0.8f, 1e-4f);
  ASSERT_GE(material.base_colour_texture, 0);
  const Picture& picture = avatar_.pictures[static_cast<std::size_t>(material.base_colour_texture)];
  ASSERT_EQ(picture.width, 8);
  EXPECT_EQ(picture.pixels[0], 0);    // red grows with x
  EXPECT_EQ(picture.pixels[1], 255);  // green with y, which points up in Blender
  const glm::vec2 low = avatar_.meshes[0].vertices[VertexAt(0, 0)].uv;
  const glm::vec2 high = avatar_.meshes[0].vertices[VertexAt(3, 3)].uv;
  EXPECT_LT(glm::distance(low, glm::vec2(0.25f, 1.0f)), 1e-5f);
  EXPECT_LT(glm::distance(high, glm::vec2(0.75f, 0.5f)), 1e-5f);
}

INSTANTIATE_TEST_SUITE_P(
    Each, ForeignVrm,
    ::testing::Values(Version{"avatar_vrm0.vrm", -1.0f, "joy", "a", "blink_l"},
                      Version{"avatar_vrm1.vrm", 1.0f, "happy", "aa", "blinkLeft"}),
    [](const auto& version) { return std::filesystem::path(version.param.file).stem().string(); });

}  // namespace
}  // namespace furrow::character
