// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/arkit_face.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/rig/shapes/shipped_shape_maps.h"

namespace furrow::authoring {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// One vertex, which every shape moves.
character::Character FaceWith(std::vector<std::string> shapes) {
  character::Character character;
  character::Mesh& mesh = character.meshes.emplace_back();
  mesh.vertices.resize(1);
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    character::MorphTarget& target = mesh.morph_targets.emplace_back();
    target.shape = static_cast<int>(s);
    target.deltas.push_back({.vertex = 0, .position = {0.01f, 0.0f, 0.0f}});
  }
  character.shapes = std::move(shapes);
  return character;
}

TEST(ArkitFace, WithoutShapesHasNothing) {
  const ArkitFace none;
  EXPECT_FALSE(none.Has("jawOpen"));
  EXPECT_THAT(none.Weights("jawOpen"), IsEmpty());
  EXPECT_FALSE(HasShapeFace(none));
}

TEST(ArkitFace, EqualNamesNeedNoMaps) {
  const ArkitFace face(FaceWith({"JAWOPEN", "other", "browInnerUp"}), rig::ShapeMatcher());
  EXPECT_THAT(face.Weights("jawOpen"), ElementsAre(1.0f, 0.0f, 0.0f));
  EXPECT_TRUE(face.Has("JawOpen"));
  EXPECT_FALSE(face.Has("other"));
  EXPECT_THAT(face.description(), IsEmpty());
}

TEST(ArkitFace, SpellingsOfArkitAreKnown) {
  const ArkitFace face(FaceWith({"Head|browDown_L", "browDown_R", "mouth-smile-l", "jawOpen.001"}),
                       rig::ShippedShapeMatcher());
  EXPECT_THAT(face.Weights("browDownLeft"), ElementsAre(1.0f, 0.0f, 0.0f, 0.0f));
  EXPECT_THAT(face.Weights("mouthSmileLeft"), ElementsAre(0.0f, 0.0f, 1.0f, 0.0f));
  EXPECT_THAT(face.Weights("jawOpen"), ElementsAre(0.0f, 0.0f, 0.0f, 1.0f));
}

TEST(ArkitFace, OtherVocabulariesGiveTheirGains) {
  const ArkitFace face(
      FaceWith({"Fcl_MTH_A", "Fcl_BRW_Angry", "Fcl_EYE_Close_L", "Fcl_EYE_Close_R"}),
      rig::ShippedShapeMatcher());
  EXPECT_TRUE(face.Has("jawOpen"));
  EXPECT_TRUE(face.Has("browDownLeft"));
  EXPECT_FALSE(face.Has("noseSneerLeft"));
  EXPECT_THAT(face.Weights("eyeBlinkRight"), ElementsAre(0.0f, 0.0f, 0.0f, 1.0f));
  EXPECT_THAT(face.description(), HasSubstr("'vroid'"));
}

// VRM's Joy smiles and squints: where it moves skin is neither the mouth nor the eyes.
TEST(ArkitFace, ShapesOfSeveralPartsShowNoPlace) {
  const ArkitFace face(FaceWith({"Joy", "Sorrow", "A", "Blink_L", "Blink_R"}),
                       rig::ShippedShapeMatcher());
  EXPECT_FALSE(face.Has("mouthSmileLeft"));
  EXPECT_FALSE(face.Has("browInnerUp"));
  EXPECT_TRUE(face.Has("eyeBlinkLeft"));
  EXPECT_FALSE(HasShapeFace(face));
}

// A name without a morph target proves nothing.
TEST(ArkitFace, ShapesWithoutTargetsMoveNothing) {
  character::Character character = FaceWith({"jawOpen", "browInnerUp"});
  character.meshes[0].morph_targets.pop_back();
  const ArkitFace face(character, rig::ShapeMatcher());
  EXPECT_TRUE(face.Has("jawOpen"));
  EXPECT_FALSE(face.Has("browInnerUp"));
}

// Combined coefficients move correctives, which single ones do not.
TEST(ArkitFace, CombinationsMoveCorrectives) {
  const ArkitFace face(FaceWith({"jawOpen", "mouthSmileLeft", "jawOpen_mouthSmileLeft"}),
                       rig::ShippedShapeMatcher());
  EXPECT_THAT(face.Weights("jawOpen"), ElementsAre(1.0f, 0.0f, 0.0f));
  const std::vector<ArkitFace::Coefficient> both = {{"jawOpen", 1.0f}, {"mouthSmileLeft", 0.5f}};
  EXPECT_THAT(face.Weights(both), ElementsAre(1.0f, 0.5f, 0.5f));
}

TEST(ArkitFace, RigsMayNameShapesOfTheirOwn) {
  character::Character character = FaceWith({"scar"});
  EXPECT_FALSE(ArkitFace(character, rig::ShapeMatcher()).Has("scar"));
  wrinkle::Driver& driver = character.rig.drivers.emplace_back();
  driver.kind = wrinkle::Driver::Kind::kBlendShape;
  driver.blend_shape.blend_shape = "Scar";
  EXPECT_TRUE(ArkitFace(character, rig::ShapeMatcher()).Has("scar"));
}

TEST(ArkitFace, CoefficientsThatAreNotFiniteMoveNothing) {
  const ArkitFace face(FaceWith({"jawOpen"}), rig::ShapeMatcher());
  const ArkitFace::Coefficient bad("jawOpen", std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(face.Weights(std::span(&bad, 1)), Each(0.0f));
}

}  // namespace
}  // namespace furrow::authoring
