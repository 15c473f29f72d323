// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/shape_face.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/bake/bake_poses.h"
#include "authoring/bake/strokes_file.h"
#include "authoring/bake/surface/bake_surface.h"
#include "authoring/bake/surface/surface_check.h"
#include "authoring/generator/blend_shapes/blend_shape_face.h"
#include "authoring/generator/default_character.h"
#include "authoring/generator/head/head_shape.h"
#include "authoring/import/model/atlases.h"
#include "authoring/paint/surface_texels.h"
#include "authoring/shapes/region_masks.h"
#include "rig/rig_check.h"
#include "rig/rig_file.h"
#include "tests/unit/rig/shapes/shipped_shape_maps.h"
#include "wrinkle/solver/solver.h"

namespace furrow::authoring {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

wrinkle::Rig Shipped(const std::string& name) {
  auto rig = rig::LoadRig(std::filesystem::path(FURROW_SOURCE_DIR) / "rig/rigs" / (name + ".json"));
  EXPECT_TRUE(rig.ok()) << rig.status().ToString();
  return rig.ok() ? std::move(rig).value() : wrinkle::Rig();
}

ArkitFace ArkitFaceOf(const character::Character& character) {
  static const rig::ShapeMatcher matcher = rig::ShippedShapeMatcher();
  return ArkitFace(character, matcher);
}

// The default head as others would export it: shapes, textures and a body's joints, but no rig and
// no pictures of a rig.
class ShapeFaceTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    avatar_ =
        new character::Character(MakeDefaultCharacter(Shipped("default"), {.texture_size = 64}));
    ASSERT_TRUE(MakeBlendShapeFace(avatar_).ok());
    avatar_->rig = {};
    avatar_->rig_pictures.clear();
    for (character::Picture& picture : avatar_->pictures) picture.name = "texture";
  }
  static void TearDownTestSuite() { delete avatar_; }

  static character::Character Proposed(std::vector<std::string>* remarks = nullptr) {
    character::Character character = *avatar_;
    const auto said = ProposeShapeFace(Shipped("arkit"), ArkitFaceOf(character), 256, &character);
    EXPECT_TRUE(said.ok()) << said.status().ToString();
    if (remarks != nullptr && said.ok()) *remarks = *said;
    return character;
  }

  static character::Character* avatar_;
};
character::Character* ShapeFaceTest::avatar_ = nullptr;

// The mean place of a mask on the skin (head space, centimetres), and its largest value.
struct Spot {
  glm::vec3 centre{0.0f};
  float largest = 0.0f;
};

Spot SpotOf(const character::Character& c, const wrinkle::Region& region) {
  const character::Picture& picture = c.pictures[c.FindRigPicture(region.mask.texture)];
  Spot spot;
  float sum = 0.0f;
  for (const SurfaceTexel& texel : RasterizeSurface(c.meshes[0], picture.width, picture.height)) {
    const float value =
        picture.pixels[4 * (texel.y * picture.width + texel.x) + region.mask.channel] / 255.0f;
    sum += value;
    spot.centre += value * ModelToHead(texel.position);
    spot.largest = std::max(spot.largest, value);
  }
  if (sum > 0.0f) spot.centre /= sum;
  return spot;
}

void ExpectMasksInPlace(const character::Character& c) {
  const std::map<std::string, glm::vec3> places = {
      {"brow_l", {3.3f, 2.8f, 8.2f}},   {"brow_r", {-3.3f, 2.8f, 8.2f}},
      {"glabella", {0.0f, 2.0f, 9.3f}}, {"nose", {0.0f, -3.0f, 10.0f}},
      {"eye_l", {3.7f, -1.8f, 7.9f}},   {"eye_r", {-3.7f, -1.8f, 7.9f}},
      {"mouth_l", {2.2f, -6.9f, 8.6f}}, {"mouth_r", {-2.2f, -6.9f, 8.6f}}};
  int found = 0;
  for (const wrinkle::Region& region : c.rig.regions) {
    const auto place = places.find(region.name);
    if (place == places.end()) continue;
    SCOPED_TRACE(region.name);
    ASSERT_GE(c.FindRigPicture(region.mask.texture), 0);
    const Spot spot = SpotOf(c, region);
    EXPECT_LT(glm::distance(spot.centre, place->second), 1.6f)
        << spot.centre.x << " " << spot.centre.y << " " << spot.centre.z;
    EXPECT_GT(spot.largest, 0.75f);
    ++found;
  }
  EXPECT_EQ(found, 8);
}

TEST_F(ShapeFaceTest, MasksLieWhereTheirNamesSay) { ExpectMasksInPlace(Proposed()); }

// The smile hardly moves the skin beside the wing of the nose, where its fold begins.
TEST_F(ShapeFaceTest, TheMouthsMaskReachesTheFoldBesideTheNose) {
  const character::Character c = Proposed();
  const auto region = std::ranges::find(c.rig.regions, "mouth_l", &wrinkle::Region::name);
  ASSERT_NE(region, c.rig.regions.end());
  const character::Picture& picture = c.pictures[c.FindRigPicture(region->mask.texture)];
  const glm::vec3 beside(2.4f, -4.0f, 9.2f), temple(6.5f, 1.0f, 5.0f), back(2.4f, -4.0f, -9.0f);
  std::array<float, 3> nearest{9.0f, 9.0f, 9.0f}, value{};
  for (const SurfaceTexel& texel : RasterizeSurface(c.meshes[0], picture.width, picture.height)) {
    const glm::vec3 place = ModelToHead(texel.position);
    for (std::size_t i = 0; i < 3; ++i) {
      const float distance = glm::distance(place, std::array{beside, temple, back}[i]);
      if (distance >= nearest[i]) continue;
      nearest[i] = distance;
      value[i] =
          picture.pixels[4 * (texel.y * picture.width + texel.x) + region->mask.channel] / 255.0f;
    }
  }
  EXPECT_GT(value[0], 0.4f);
  EXPECT_EQ(value[1], 0.0f);
  EXPECT_EQ(value[2], 0.0f);
}

TEST_F(ShapeFaceTest, MasksAddUpToAtMostOne) {
  const character::Character c = Proposed();
  const character::Picture& a = c.pictures[c.FindRigPicture("face_masks_a")];
  const character::Picture& b = c.pictures[c.FindRigPicture("face_masks_b")];
  int most = 0;
  for (std::size_t i = 0; i + 3 < a.pixels.size(); i += 4) {
    int sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum += a.pixels[i + k] + b.pixels[i + k];
    most = std::max(most, sum);
  }
  EXPECT_LE(most, 255 + 8);  // each of eight bytes is rounded
  EXPECT_GT(most, 200);
}

TEST_F(ShapeFaceTest, TheRigHasTheDriversOfArkit) {
  std::vector<std::string> remarks;
  const character::Character c = Proposed(&remarks);
  EXPECT_TRUE(rig::CheckRig(c.rig).ok()) << rig::CheckRig(c.rig).ToString();
  EXPECT_EQ(c.rig.drivers.size(), Shipped("arkit").drivers.size());
  EXPECT_EQ(c.rig.regions.size(), 8u);
  EXPECT_TRUE(wrinkle::RigBinding::Create(c.rig, c.skeleton, c.shapes, {}).ok());
  EXPECT_THAT(remarks, IsEmpty());
}

// Clothing keeps the drivers of the body. Drivers of the face do not stay beside the shapes.
TEST_F(ShapeFaceTest, KeepsTheBodysDrivers) {
  character::Character c = *avatar_;
  c.rig = BlendShapeRig(Shipped("default"));
  for (wrinkle::Region& region : c.rig.regions) {
    region.mask = wrinkle::Mask{.kind = wrinkle::Mask::Kind::kSkinning, .texture = {}};
  }
  ASSERT_TRUE(ProposeShapeFace(Shipped("arkit"), ArkitFaceOf(c), 64, &c).ok());
  EXPECT_TRUE(rig::CheckRig(c.rig).ok()) << rig::CheckRig(c.rig).ToString();
  std::set<std::string> names;
  for (const wrinkle::Region& region : c.rig.regions) EXPECT_TRUE(names.insert(region.name).second);
  EXPECT_TRUE(names.contains("knee_l_inner"));
  EXPECT_TRUE(names.contains("brow_l"));
  const auto folds = std::find_if(c.rig.wrinkle_maps.begin(), c.rig.wrinkle_maps.end(),
                                  [](const auto& map) { return map.name == "folds"; });
  ASSERT_NE(folds, c.rig.wrinkle_maps.end());
  EXPECT_EQ(folds->surface, wrinkle::WrinkleMap::Surface::kCloth);
}

TEST_F(ShapeFaceTest, FindsShapesUnderOtherSpellings) {
  character::Character c = *avatar_;
  for (std::string& shape : c.shapes) {
    if (shape.ends_with("Left")) shape = "Face|" + shape.substr(0, shape.size() - 4) + "_L";
    if (shape.ends_with("Right")) shape = "Face|" + shape.substr(0, shape.size() - 5) + "_R";
  }
  const ArkitFace face = ArkitFaceOf(c);
  EXPECT_TRUE(HasShapeFace(face));
  EXPECT_EQ(face.Weights("mouthSmileLeft"), ArkitFaceOf(*avatar_).Weights("mouthSmileLeft"));
  EXPECT_FALSE(face.Has("mouthSmile"));
}

// The same face in Character Creator's vocabulary gets the same masks.
TEST_F(ShapeFaceTest, ReadsOtherVocabularies) {
  character::Character c = *avatar_;
  const std::map<std::string, std::string> kNames = {
      {"browInnerUp", "A01_Brow_Inner_Up"},        {"browDownLeft", "A02_Brow_Down_Left"},
      {"browDownRight", "A03_Brow_Down_Right"},    {"eyeBlinkLeft", "A14_Eye_Blink_Left"},
      {"eyeBlinkRight", "A15_Eye_Blink_Right"},    {"mouthSmileLeft", "A38_Mouth_Smile_Left"},
      {"mouthSmileRight", "A39_Mouth_Smile_Right"}};
  for (std::string& shape : c.shapes) {
    if (kNames.contains(shape)) shape = kNames.at(shape);
  }
  const ArkitFace face = ArkitFaceOf(c);
  EXPECT_THAT(face.description(), HasSubstr("'cc3'"));
  ASSERT_TRUE(ProposeShapeFace(Shipped("arkit"), face, 256, &c).ok());
  const character::Character same = Proposed();
  for (const char* name : {"face_masks_a", "face_masks_b"}) {
    EXPECT_EQ(c.pictures[c.FindRigPicture(name)].pixels,
              same.pictures[same.FindRigPicture(name)].pixels);
  }
}

TEST_F(ShapeFaceTest, SaysWhichShapesAreMissingOrStill) {
  character::Character c = *avatar_;
  const auto index = [&](const char* name) {
    return static_cast<int>(std::find(c.shapes.begin(), c.shapes.end(), name) - c.shapes.begin());
  };
  const int puff = index("cheekPuff");
  for (character::Mesh& mesh : c.meshes) {
    for (character::MorphTarget& target : mesh.morph_targets) {
      if (target.shape != puff) continue;
      for (character::MorphDelta& delta : target.deltas) delta.position *= 1e-6f;
    }
  }
  c.shapes[static_cast<std::size_t>(index("noseSneerLeft"))] = "other";
  const auto remarks = ProposeShapeFace(Shipped("arkit"), ArkitFaceOf(c), 64, &c);
  ASSERT_TRUE(remarks.ok());
  EXPECT_THAT(*remarks, Contains(HasSubstr("lacks the blend shapes noseSneerLeft;")));
  EXPECT_THAT(*remarks, Contains(HasSubstr("cheekPuff exist, but do not move")));
}

TEST_F(ShapeFaceTest, WithoutBrowsThereIsNoFace) {
  character::Character c = *avatar_;
  for (std::string& shape : c.shapes) {
    if (shape == "browDownLeft") shape = "other";
  }
  const auto remarks = ProposeShapeFace(Shipped("arkit"), ArkitFaceOf(c), 64, &c);
  EXPECT_EQ(remarks.status().code(), StatusCode::kNotFound);
  EXPECT_TRUE(c.rig.drivers.empty());
}

TEST_F(ShapeFaceTest, SingleShapesAndCombinationsArePosed) {
  const character::Character c = Proposed();
  const auto poses = CollectBakePoses(c, {}, ArkitFaceOf(c));
  ASSERT_TRUE(poses.ok()) << poses.status().ToString();
  EXPECT_THAT(poses->notes, IsEmpty());
  int several = 0, brow = 0;
  for (const BakePose& pose : poses->poses) {
    ASSERT_EQ(pose.shape_weights.size(), c.shapes.size());
    several += std::count_if(pose.shape_weights.begin(), pose.shape_weights.end(),
                             [](float w) { return w > 0.0f; }) > 1;
    brow += pose.region == "brow_l" && pose.map == "stretch";
  }
  EXPECT_GT(several, 10);
  EXPECT_EQ(brow, 3);  // browInnerUp, browOuterUpLeft and their combination
}

// Bakes the face. A map raises or lowers a part of the texels of each of its regions.
void ExpectFolds(character::Character c, int size) {
  const auto strokes =
      LoadStrokes(std::filesystem::path(FURROW_SOURCE_DIR) / "rig/rigs/default.strokes.json",
                  Shipped("default"));
  ASSERT_TRUE(strokes.ok()) << strokes.status().ToString();
  const auto said = BakeShapeFace(ArkitFaceOf(c), *strokes, size, 1.0f, {}, &c);
  ASSERT_TRUE(said.ok()) << said.status().ToString();
  EXPECT_TRUE(rig::CheckRig(c.rig).ok());
  const std::map<std::string, std::vector<std::string>> kFolds = {
      {"stretch", {"brow_l", "brow_r", "mouth_l", "mouth_r"}},
      {"squash", {"glabella", "nose", "eye_l", "eye_r", "mouth_l", "mouth_r"}}};
  for (const wrinkle::WrinkleMap& map : c.rig.wrinkle_maps) {
    if (!kFolds.contains(map.name)) continue;
    ASSERT_GE(c.FindRigPicture(map.height), 0) << map.name;
    EXPECT_GE(c.FindRigPicture(map.normal), 0) << map.name;
    EXPECT_GE(c.FindRigPicture(map.cavity), 0) << map.name;
    EXPECT_GE(c.FindRigPicture(map.colour), 0) << map.name;
    const character::Picture& heights = c.pictures[c.FindRigPicture(map.height)];
    for (const wrinkle::Region& region : c.rig.regions) {
      const auto& wanted = kFolds.at(map.name);
      if (std::find(wanted.begin(), wanted.end(), region.name) == wanted.end()) continue;
      const character::Picture& mask = c.pictures[c.FindRigPicture(region.mask.texture)];
      double folded = 0.0, inside = 0.0;
      for (const SurfaceTexel& texel : RasterizeSurface(c.meshes[0], size, size)) {
        const std::size_t at = static_cast<std::size_t>(texel.y * size + texel.x);
        const double share = mask.pixels[4 * at + static_cast<std::size_t>(region.mask.channel)];
        const double height = map.height_mm * (2.0 * heights.pixels16[at] / 65535.0 - 1.0);
        inside += share;
        folded += share * (std::abs(height) > 0.05 ? 1.0 : 0.0);
      }
      EXPECT_GT(folded, 0.05 * inside) << map.name << " in " << region.name;
    }
  }
}

TEST_F(ShapeFaceTest, FoldsLieInTheRegionsOfTheirShapes) { ExpectFolds(Proposed(), 256); }

// Adds a body that uses the same square of UVs as the head, as Ready Player Me exports them.
void AddOverlappingBody(character::Character* c) {
  character::Material body = c->materials[static_cast<std::size_t>(c->meshes[0].material)];
  body.name = "body";
  character::Mesh copy = c->meshes[0];
  copy.name = "body";
  copy.morph_targets.clear();
  copy.material = static_cast<int>(c->materials.size());
  for (character::Vertex& vertex : copy.vertices) vertex.position.z -= 1.0f;
  c->materials.push_back(body);
  c->meshes.push_back(copy);
}

TEST_F(ShapeFaceTest, OverlappingMaterialsLeaveTheFaceItsWrinkles) {
  character::Character c = *avatar_;
  const int face = c.meshes[0].material;
  AddOverlappingBody(&c);
  const auto remarks = ProposeShapeFace(Shipped("arkit"), ArkitFaceOf(c), 64, &c);
  ASSERT_TRUE(remarks.ok());
  EXPECT_THAT(*remarks, Contains(HasSubstr("no wrinkles on body")));
  EXPECT_TRUE(c.materials[static_cast<std::size_t>(face)].wrinkles);
  EXPECT_FALSE(c.materials.back().wrinkles);
  for (const int mesh : MeshesOn(c, false)) {
    EXPECT_EQ(c.meshes[static_cast<std::size_t>(mesh)].material, face);
  }
  std::vector<std::string> warnings;
  EXPECT_TRUE(CheckSurfaces(c, {}, &warnings).ok());
}

// The import moves head and body into tiles before it paints: both keep their wrinkles.
TEST_F(ShapeFaceTest, TiledSkinKeepsMasksAndFoldsInPlace) {
  constexpr int kSize = 384;  // the face has 60% of the texels
  character::Character c = *avatar_;
  AddOverlappingBody(&c);
  const ArkitFace face = ArkitFaceOf(c);
  EXPECT_EQ(MarkFace(face, &c), c.meshes[0].material);
  ASSERT_EQ(TileAtlas(false, c.meshes[0].material, &c).size(), 2u);
  const auto remarks = ProposeShapeFace(Shipped("arkit"), face, kSize, &c);
  ASSERT_TRUE(remarks.ok()) << remarks.status().ToString();
  EXPECT_THAT(*remarks, IsEmpty());
  EXPECT_TRUE(c.materials.back().wrinkles);
  std::vector<std::string> warnings;
  EXPECT_TRUE(CheckSurfaces(c, {}, &warnings).ok());
  EXPECT_THAT(warnings, ::testing::Not(Contains(HasSubstr("UVs overlap"))));
  ExpectMasksInPlace(c);
  // The body's tile has no mask of the face.
  const character::Picture& mask = c.pictures[c.FindRigPicture("face_masks_a")];
  for (const SurfaceTexel& texel : RasterizeSurface(c.meshes.back(), mask.width, mask.height)) {
    for (int k = 0; k < 4; ++k) {
      ASSERT_EQ(mask.pixels[4 * (texel.y * mask.width + texel.x) + k], 0) << texel.x << texel.y;
    }
  }
  ExpectFolds(std::move(c), kSize);
}

// Joints fold bare skin, by a map of its own. Skin that is not there, below clothes, does not fold.
TEST_F(ShapeFaceTest, JointsOfTheBodyFoldBareSkin) {
  character::Character c = *avatar_;
  c.rig = BlendShapeRig(Shipped("default"));
  for (wrinkle::Region& region : c.rig.regions) {
    region.mask = wrinkle::Mask{.kind = wrinkle::Mask::Kind::kSkinning, .texture = {}};
  }
  ASSERT_TRUE(ProposeShapeFace(Shipped("arkit"), ArkitFaceOf(c), 64, &c).ok());
  const auto feeds = [&](const std::string& name) {
    std::set<std::string> maps;
    for (const wrinkle::Region& region : c.rig.regions) {
      for (const wrinkle::Feed& feed : region.feeds) {
        if (region.name != name) continue;
        maps.insert(feed.map);
        for (const wrinkle::Feed::Source& source : feed.sources) {
          EXPECT_TRUE(feed.map != "skin_folds" || source.gain <= 1.0f) << name;
          EXPECT_TRUE(feed.map != "skin_folds" || feed.angles.empty()) << name;
        }
      }
    }
    return maps;
  };
  EXPECT_EQ(feeds("neck_left"), (std::set<std::string>{"folds", "skin_folds"}));
  EXPECT_EQ(feeds("knee_l_inner"), (std::set<std::string>{"slack", "onset", "folds"}));
  const auto map = std::find_if(c.rig.wrinkle_maps.begin(), c.rig.wrinkle_maps.end(),
                                [](const auto& m) { return m.name == "skin_folds"; });
  ASSERT_NE(map, c.rig.wrinkle_maps.end());
  EXPECT_EQ(map->surface, wrinkle::WrinkleMap::Surface::kSkin);
}

// Both halves of the face share texels: they fold alike, but no mask is lost.
TEST_F(ShapeFaceTest, MirroredHalvesShareTheirMasks) {
  character::Character c = *avatar_;
  for (character::Vertex& vertex : c.meshes[0].vertices) {
    const glm::vec3 p = ModelToHead(vertex.position);
    if (std::abs(p.x) > 12.0f) continue;
    vertex.uv = {0.05f + 0.28f * std::abs(std::atan2(p.x, p.z)), 0.5f - 0.02f * p.y};
  }
  ASSERT_TRUE(ProposeShapeFace(Shipped("arkit"), ArkitFaceOf(c), 128, &c).ok());
  for (const char* name : {"face_masks_a", "face_masks_b"}) {
    const character::Picture& mask = c.pictures[c.FindRigPicture(name)];
    const std::size_t first = std::string(name) == "face_masks_a" ? 0 : 2;
    int left = 0, right = 0;
    for (std::size_t i = 0; i + 3 < mask.pixels.size(); i += 4) {
      left = std::max<int>(left, mask.pixels[i + first]);
      right = std::max<int>(right, mask.pixels[i + first + 1]);
    }
    // Half of the full value each, except in texels that only one half covers.
    EXPECT_GT(std::min(left, right), 100) << name;
  }
}

}  // namespace
}  // namespace furrow::authoring
