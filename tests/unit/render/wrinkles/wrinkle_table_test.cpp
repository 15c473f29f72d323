// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/wrinkle_table.h"

#include <gtest/gtest.h>

#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

class WrinkleTableTest : public testing::Test {
 protected:
  void Make(const character::Character& character) {
    WrinkleLayout layout;
    layout.masks = {{"masks.png", 0}};
    layout.map_layers = {0, 1, 2};
    auto tables = WrinkleTables::Create(character, layout);
    ASSERT_TRUE(tables.ok()) << tables.status().ToString();
    tables_ = std::move(*tables);
  }
  Status Update(const test::Subject& subject) {
    FrameRequest request;
    request.binding = &subject.binding;
    request.wrinkle_weights = subject.weights;
    request.filtered_values = subject.driver_values;
    request.settings = settings_;
    return tables_->Update(request);
  }
  // A subject with its brow bent by `radians`.
  test::Subject Bent(float radians) const {
    test::Subject subject(head_);
    subject.pose.joints[2].rotation = glm::angleAxis(radians, glm::vec3(1, 0, 0));
    subject.Solve();
    return subject;
  }
  const WrinkleTable& Skin() const { return tables_->table(WrinkleGroup::kSkin); }
  const WrinkleTable& Cloth() const { return tables_->table(WrinkleGroup::kCloth); }

  character::Character head_ = test::MakeHead();
  Settings settings_;
  std::unique_ptr<WrinkleTables> tables_;
};

TEST_F(WrinkleTableTest, ANeutralFaceNeedsNoMap) {
  Make(head_);
  ASSERT_TRUE(Update(test::Subject(head_)).ok());
  EXPECT_TRUE(Skin().maps.empty());
  EXPECT_FALSE(Skin().uses_texture);
  EXPECT_FALSE(Skin().uses_dynamic);
}

TEST_F(WrinkleTableTest, ListsActiveMapsWithWeightsByChannel) {
  Make(head_);
  test::Subject subject(head_);
  subject.Set("l_squash", 0.25f);
  subject.Set("r_squash", 0.75f);
  subject.Solve();
  settings_.wrinkle_strength = 2.0f;
  ASSERT_TRUE(Update(subject).ok());
  ASSERT_EQ(Skin().maps.size(), 1u);
  EXPECT_EQ(Skin().maps[0].map, 1);
  EXPECT_EQ(Skin().maps[0].layer, 1);
  EXPECT_FLOAT_EQ(Skin().maps[0].amplitude, 2.0f);
  ASSERT_EQ(Skin().mask_weights.size(), 1u);
  EXPECT_EQ(Skin().mask_weights[0], glm::vec4(0.25f, 0.75f, 0.0f, 0.0f));
  EXPECT_TRUE(Skin().uses_texture);
  EXPECT_FALSE(Skin().uses_dynamic);
}

TEST_F(WrinkleTableTest, AHingeActivatesADynamicMap) {
  Make(head_);
  const test::Subject subject = Bent(1.2f);
  ASSERT_TRUE(Update(subject).ok());
  ASSERT_EQ(Skin().maps.size(), 1u);
  EXPECT_EQ(Skin().maps[0].map, 2);
  EXPECT_TRUE(Skin().uses_dynamic);
  ASSERT_EQ(tables_->mask_columns(), 1);
  const float brow = tables_->influences()[2];
  EXPECT_GT(brow, 0.1f);
  settings_.mask_mode = MaskMode::kTexture;
  ASSERT_TRUE(Update(subject).ok());
  EXPECT_TRUE(Skin().maps.empty());
}

TEST_F(WrinkleTableTest, AJointAlmostAtRestNeedsNoMap) {
  Make(head_);
  ASSERT_TRUE(Update(Bent(0.02f)).ok());
  EXPECT_GT(tables_->influences()[2], 0.0f);
  EXPECT_TRUE(Skin().maps.empty());
}

// A map that one subject needs is listed for all, each with its own weights and masks.
TEST_F(WrinkleTableTest, ACrowdListsTheMapsThatAnySubjectNeeds) {
  Make(head_);
  test::Subject squashed(head_);
  squashed.Set("r_squash", 0.5f);
  squashed.Solve();
  const test::Subject bent = Bent(1.2f);
  FrameRequest request;
  request.binding = &squashed.binding;
  request.wrinkle_weights = squashed.weights;
  request.filtered_values = squashed.driver_values;
  PosedSubject other;
  other.binding = &bent.binding;
  other.wrinkle_weights = bent.weights;
  other.filtered_values = bent.driver_values;
  request.others = std::span(&other, 1);
  ASSERT_TRUE(tables_->Update(request).ok());
  ASSERT_EQ(Skin().maps.size(), 2u);
  EXPECT_EQ(Skin().maps[0].map, 2);  // maps with vertex masks come first
  EXPECT_EQ(Skin().maps[1].map, 1);
  EXPECT_EQ(Skin().num_dynamic, 1u);
  EXPECT_FALSE(Skin().paints_dynamic);
  EXPECT_EQ(Skin().mask_weights[0], glm::vec4(0.0f));
  EXPECT_EQ(Skin().mask_weights[1], glm::vec4(0.0f, 0.5f, 0.0f, 0.0f));
  EXPECT_EQ(Skin().mask_weights[2], glm::vec4(0.0f));
  EXPECT_EQ(Skin().first_masks, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(Skin().dynamic_masks[0].slot, 0);
  EXPECT_EQ(tables_->influences().size(), 2 * head_.skeleton.joint_names().size());
}

TEST_F(WrinkleTableTest, MapsAreDrawnOnTheSurfaceThatTheRigNames) {
  using Surface = wrinkle::WrinkleMap::Surface;
  head_.rig.wrinkle_maps[0].surface = Surface::kSkin;
  head_.rig.wrinkle_maps[2].surface = Surface::kCloth;
  character::Material cloth;
  cloth.kind = character::Material::Kind::kCloth;
  head_.materials.push_back(cloth);
  Make(head_);
  test::Subject subject = Bent(1.2f);
  subject.Set("l_stretch", 1.0f);
  subject.Solve();
  ASSERT_TRUE(Update(subject).ok());
  ASSERT_EQ(Skin().maps.size(), 1u);
  EXPECT_EQ(Skin().maps[0].map, 0);
  ASSERT_EQ(Cloth().maps.size(), 1u);
  EXPECT_EQ(Cloth().maps[0].map, 2);
  // Maps without a stated surface are drawn on both.
  for (wrinkle::WrinkleMap& map : head_.rig.wrinkle_maps) map.surface = Surface::kAny;
  Make(head_);
  ASSERT_TRUE(Update(subject).ok());
  EXPECT_EQ(Skin().maps.size(), 2u);
  EXPECT_EQ(Cloth().maps.size(), 2u);
}

TEST_F(WrinkleTableTest, ClothMapsAreDrawnOnSkinWithoutCloth) {
  head_.rig.wrinkle_maps[2].surface = wrinkle::WrinkleMap::Surface::kCloth;
  Make(head_);
  const test::Subject subject = Bent(1.2f);
  ASSERT_TRUE(Update(subject).ok());
  EXPECT_EQ(Skin().maps.size(), 1u);
}

// A stream with its own skeleton and rig: values that both rigs name are matched, the others
// ignored.
TEST_F(WrinkleTableTest, ValuesOfAnotherRigAreMatchedByName) {
  Make(head_);
  character::Character other = head_;
  std::swap(other.rig.regions[0], other.rig.regions[1]);
  other.rig.regions.pop_back();
  test::Subject subject(other);
  subject.Set("l_squash", 0.5f);
  subject.Solve();
  ASSERT_TRUE(Update(subject).ok());
  ASSERT_EQ(Skin().maps.size(), 1u);
  EXPECT_EQ(Skin().mask_weights[0], glm::vec4(0.5f, 0.0f, 0.0f, 0.0f));
  // Values are matched again for a binding with the character's own order.
  test::Subject own(head_);
  own.Set("r_squash", 1.0f);
  own.Solve();
  ASSERT_TRUE(Update(own).ok());
  EXPECT_EQ(Skin().mask_weights[0], glm::vec4(0.0f, 1.0f, 0.0f, 0.0f));
}

TEST_F(WrinkleTableTest, ShortSpansAreReportedByName) {
  Make(head_);
  test::Subject subject(head_);
  subject.weights.pop_back();
  EXPECT_EQ(Update(subject).where(), "wrinkle_weights");
  subject.weights.push_back(0.0f);
  subject.driver_values.pop_back();
  EXPECT_EQ(Update(subject).where(), "filtered_values");
}

TEST_F(WrinkleTableTest, EveryTexturedRegionHasItsOwnColour) {
  for (wrinkle::WrinkleMap& map : head_.rig.wrinkle_maps) {
    map.surface = wrinkle::WrinkleMap::Surface::kSkin;
  }
  Make(head_);
  const auto palette = tables_->mask_palette(WrinkleGroup::kSkin);
  ASSERT_EQ(palette.size(), 4u);
  EXPECT_NE(palette[0], palette[1]);
  EXPECT_EQ(palette[2], glm::vec4(0.0f));
  EXPECT_EQ(tables_->mask_bits(WrinkleGroup::kSkin), 1u);
  for (const WrinkleGroup group : {WrinkleGroup::kCloth, WrinkleGroup::kNone}) {
    for (const glm::vec4& colour : tables_->mask_palette(group)) EXPECT_EQ(colour, glm::vec4(0.0f));
    EXPECT_EQ(tables_->mask_bits(group), 0u);  // its layer is sampled on skin only
  }
}

}  // namespace
}  // namespace furrow::render
