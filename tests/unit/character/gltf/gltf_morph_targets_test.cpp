// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_morph_targets.h"

#include <functional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "character/package/package.h"
#include "gltf/limits.h"
#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::character {
namespace {

using gltf::HandMadeGltf;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// A node with a mesh: a square of two triangles with normals, facing +Z, and vertex 4 without a
// triangle.
HandMadeGltf SquareMesh() {
  HandMadeGltf gltf;
  gltf.json["nodes"] = {{{"name", "head"}, {"mesh", 0}}};
  const int position = gltf.AddFloats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 9, 9, 9}, "VEC3");
  const int normal = gltf.AddFloats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int indices =
      gltf.AddAccessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123, 1);
  gltf.json["meshes"] = {
      {{"name", "face"},
       {"primitives",
        {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"indices", indices}}}}}};
  return gltf;
}

json& Primitive(HandMadeGltf* gltf) { return gltf->json["meshes"][0]["primitives"][0]; }

// Adds a target to the first mesh.
void AddTarget(const std::string& name, const json& attributes, HandMadeGltf* gltf) {
  Primitive(gltf)["targets"].push_back(attributes);
  gltf->json["meshes"][0]["extras"]["targetNames"].push_back(name);
}

Result<Character> Parse(const HandMadeGltf& gltf, SourceNotes* notes = nullptr) {
  return ParseCharacter(gltf.Glb(), ".", {.notes = notes});
}

TEST(GltfMorphTargets, AreReadSparsely) {
  HandMadeGltf gltf = SquareMesh();
  const int position = gltf.AddFloats({0, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0, 0, 5, 5, 5}, "VEC3");
  const int normal = gltf.AddFloats({0, 0, 0, 0.1f, 0, 0, 0.2f, 0, 0, 0, 0, 0, 5, 5, 5}, "VEC3");
  AddTarget("still", {{"POSITION", gltf.AddFloats(std::vector<float>(15, 0.0f), "VEC3")}}, &gltf);
  AddTarget("jawOpen", {{"POSITION", position}, {"NORMAL", normal}}, &gltf);
  SourceNotes notes;
  const auto character = Parse(gltf, &notes);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_THAT(character->shapes, ElementsAre("jawOpen"));
  EXPECT_THAT(notes.idle_shapes, ElementsAre("still"));
  EXPECT_EQ(notes.meshes[0].morph_targets, 2);
  ASSERT_THAT(character->meshes[0].morph_targets, SizeIs(1));
  const MorphTarget& target = character->meshes[0].morph_targets[0];
  EXPECT_EQ(target.shape, 0);
  ASSERT_THAT(target.deltas, SizeIs(2)) << "vertex 4 has no triangle";
  EXPECT_EQ(target.deltas[0].vertex, 1u);
  EXPECT_EQ(target.deltas[0].position, glm::vec3(0, 0, 0.5f));
  EXPECT_EQ(target.deltas[0].normal, glm::vec3(0.1f, 0, 0));
  EXPECT_EQ(target.deltas[1].vertex, 2u);
  EXPECT_EQ(target.deltas[1].position, glm::vec3(0.0f));
  EXPECT_EQ(target.deltas[1].normal, glm::vec3(0.2f, 0, 0));
}

// An exporter's noise does not open a jaw. Shapes are compared in model space, whatever each node's unit.
TEST(GltfMorphTargets, FaintShapesAreIdle) {
  const auto moved = [](float length) {
    return std::vector<float>{0, 0, 0, 0, 0, length, length, 0, 0, 0, 0, 0, 0, 0, 0};
  };
  HandMadeGltf gltf = SquareMesh();
  AddTarget("noise", {{"POSITION", gltf.AddFloats(moved(0.9e-4f), "VEC3")}}, &gltf);
  AddTarget("small", {{"POSITION", gltf.AddFloats(moved(1.1e-4f), "VEC3")}}, &gltf);
  AddTarget("jawOpen", {{"POSITION", gltf.AddFloats(moved(0.2f), "VEC3")}}, &gltf);
  json teeth = gltf.json["meshes"][0];
  teeth["extras"]["targetNames"] = {"noise", "bite", "jawOpen"};
  gltf.json["meshes"].push_back(teeth);
  gltf.json["nodes"].push_back({{"mesh", 1}, {"scale", {0.1, 0.1, 0.1}}});
  SourceNotes notes;
  const auto character = Parse(gltf, &notes);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_THAT(character->shapes, ElementsAre("small", "jawOpen"));
  EXPECT_THAT(notes.idle_shapes, ElementsAre("noise", "bite"));
  ASSERT_THAT(character->meshes[0].morph_targets, SizeIs(2));
  EXPECT_EQ(character->meshes[0].morph_targets[0].shape, 0);
  ASSERT_THAT(character->meshes[1].morph_targets, SizeIs(1));
  EXPECT_EQ(character->meshes[1].morph_targets[0].shape, 1);
}

TEST(GltfMorphTargets, SparseAccessorsAgreeWithDenseOnes) {
  HandMadeGltf gltf = SquareMesh();
  const int dense = gltf.AddFloats({0, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0.25f, 0, 0, 0, 0, 0}, "VEC3");
  const int values = gltf.AddFloats({0, 0, 0.5f, 0.25f, 0, 0}, "VEC3");
  const int indices = gltf.AddAccessor(std::vector<std::uint8_t>{1, 3}, "SCALAR", 5121, 1);
  gltf.json["accessors"].push_back(
      {{"componentType", 5126},
       {"count", 5},
       {"type", "VEC3"},
       {"sparse",
        {{"count", 2},
         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
         {"values", {{"bufferView", values}}}}}});
  AddTarget("dense", {{"POSITION", dense}}, &gltf);
  AddTarget("sparse", {{"POSITION", gltf.json["accessors"].size() - 1}}, &gltf);
  const auto character = Parse(gltf);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  ASSERT_THAT(character->meshes[0].morph_targets, SizeIs(2));
  const auto& a = character->meshes[0].morph_targets[0].deltas;
  const auto& b = character->meshes[0].morph_targets[1].deltas;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].vertex, b[i].vertex);
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].normal, b[i].normal);
  }
}

// A quarter turn about +X of the edge at y = 1 tilts the square's normal to (0, -1, 1).
TEST(GltfMorphTargets, LackingNormalsAreComputed) {
  HandMadeGltf gltf = SquareMesh();
  const int position = gltf.AddFloats({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC3");
  AddTarget("tilt", {{"POSITION", position}}, &gltf);
  const auto character = Parse(gltf);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  const MorphTarget& target = character->meshes[0].morph_targets.at(0);
  ASSERT_THAT(target.deltas, SizeIs(4)) << "the edge at y = 0 turns as well";
  for (const MorphDelta& delta : target.deltas) {
    const glm::vec3 normal = glm::normalize(glm::vec3(0, 0, 1) + delta.normal);
    EXPECT_LT(glm::distance(normal, glm::normalize(glm::vec3(0, -1, 1))), 1e-5f) << delta.vertex;
  }
}

TEST(GltfMorphTargets, FollowTheirNode) {
  HandMadeGltf gltf = SquareMesh();
  gltf.json["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
  gltf.json["nodes"][0]["rotation"] = {0, 0, 0.70710678, 0.70710678};
  gltf.json["nodes"][0]["translation"] = {7, 8, 9};
  const int position = gltf.AddFloats({0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  const int normal = gltf.AddFloats({0, 0, 0, 0.5f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  AddTarget("a", {{"POSITION", position}, {"NORMAL", normal}}, &gltf);
  const auto character = Parse(gltf);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  const MorphDelta& delta = character->meshes[0].morph_targets.at(0).deltas.at(0);
  EXPECT_LT(glm::distance(delta.position, glm::vec3(0, 0.01f, 0)), 1e-6f);
  EXPECT_LT(glm::distance(delta.normal, glm::vec3(0, 0.5f, 0)), 1e-6f);
}

// Head and teeth both have jawOpen; the order is that of first appearance.
TEST(GltfMorphTargets, EqualNamesAreOneShape) {
  HandMadeGltf gltf = SquareMesh();
  const int position = gltf.AddFloats({0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  AddTarget("smile", {{"POSITION", position}}, &gltf);
  AddTarget("jawOpen", {{"POSITION", position}}, &gltf);
  json teeth = gltf.json["meshes"][0];
  teeth["name"] = "teeth";
  teeth["extras"]["targetNames"] = {"jawOpen", "bite"};
  gltf.json["meshes"].push_back(teeth);
  gltf.json["nodes"].push_back({{"name", "mouth"}, {"mesh", 1}});
  const auto character = Parse(gltf);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_THAT(character->shapes, ElementsAre("smile", "jawOpen", "bite"));
  EXPECT_EQ(character->meshes[1].morph_targets.at(0).shape, 1);
  EXPECT_EQ(character->meshes[1].morph_targets.at(1).shape, 2);
}

TEST(GltfMorphTargets, AscendByShape) {
  HandMadeGltf gltf = SquareMesh();
  const int position = gltf.AddFloats({0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  AddTarget("a", {{"POSITION", position}}, &gltf);
  AddTarget("b", {{"POSITION", position}}, &gltf);
  json other = gltf.json["meshes"][0];
  other["extras"]["targetNames"] = {"b", "a"};
  gltf.json["meshes"].push_back(other);
  gltf.json["nodes"].push_back({{"mesh", 1}});
  const auto character = Parse(gltf);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_EQ(character->meshes[1].morph_targets.at(0).shape, 0);
  EXPECT_EQ(character->meshes[1].morph_targets.at(1).shape, 1);
}

TEST(GltfMorphTargets, SurplusShapesAreLeftOut) {
  HandMadeGltf gltf = SquareMesh();
  const int position = gltf.AddFloats({0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  for (std::size_t i = 0; i < kMaxShapes + 3; ++i) {
    AddTarget("shape" + std::to_string(i), {{"POSITION", position}}, &gltf);
  }
  const auto character = Parse(gltf);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_THAT(character->shapes, SizeIs(kMaxShapes));
  EXPECT_THAT(character->meshes[0].morph_targets, SizeIs(kMaxShapes));
  EXPECT_THAT(character->warnings, ElementsAre(HasSubstr("left out: 3")));
}

TEST(GltfMorphTargets, ErrorsNameTheTarget) {
  const auto status = [](const std::function<json(HandMadeGltf*)>& accessor) {
    HandMadeGltf gltf = SquareMesh();
    AddTarget("a", {{"POSITION", accessor(&gltf)}}, &gltf);
    const Status s = Parse(gltf).status();
    EXPECT_EQ(s.where(), s.ok() ? "" : "meshes[0].primitives[0].targets[0].POSITION");
    return s.code();
  };
  EXPECT_EQ(status([](HandMadeGltf*) { return 1; }), StatusCode::kOk);
  EXPECT_EQ(status([](HandMadeGltf*) { return 99; }), StatusCode::kSchema);
  EXPECT_EQ(status([](HandMadeGltf*) { return 2; }), StatusCode::kSchema) << "the indices";
  EXPECT_EQ(status([](HandMadeGltf* g) {
              return g->AddFloats({0, 0, 1}, "VEC3");
            }),
            StatusCode::kSchema);
  EXPECT_EQ(status([](HandMadeGltf* g) {
              return g->AddFloats({0, 0, 1, NAN, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
            }),
            StatusCode::kNonFinite);
}

// A few bytes must not stand for many vertices: accessors without a buffer view have no size.
TEST(GltfMorphTargets, AreLimitedInAll) {
  HandMadeGltf gltf;
  gltf.json["nodes"] = {{{"name", "head"}, {"mesh", 0}}};
  const std::size_t vertices = 300'000;
  const int position = gltf.AddFloats(std::vector<float>(3 * vertices, 1.0f), "VEC3");
  const int indices = gltf.AddAccessor(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", 5123, 1);
  gltf.json["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"indices", indices}}}}}};
  for (int i = 0; i < 512; ++i) {
    Primitive(&gltf)["targets"].push_back({{"POSITION", position}});
  }
  EXPECT_EQ(Parse(gltf).status().code(), StatusCode::kLimit);
}

TEST(GltfMorphTargets, ReadBackEqual) {
  HandMadeGltf gltf = SquareMesh();
  const int position = gltf.AddFloats({0, 0, 1, 0, 0, 0, 0, 0, 0.25f, 0, 0, 0, 0, 0, 0}, "VEC3");
  const int normal = gltf.AddFloats({0, 0, 0, 0.5f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  AddTarget("jawOpen", {{"POSITION", position}}, &gltf);
  AddTarget("smile", {{"POSITION", position}, {"NORMAL", normal}}, &gltf);
  const auto first = Parse(gltf);
  ASSERT_TRUE(first.ok()) << first.status().ToString();
  const Result<std::string> glb = CharacterGlb(*first);
  ASSERT_TRUE(glb.ok()) << glb.status().ToString();
  const auto again = ParseCharacter(*glb, ".");
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_THAT(again->warnings, IsEmpty());
  EXPECT_EQ(again->shapes, first->shapes);
  const auto& a = first->meshes[0].morph_targets;
  const auto& b = again->meshes[0].morph_targets;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t t = 0; t < a.size(); ++t) {
    EXPECT_EQ(a[t].shape, b[t].shape);
    ASSERT_EQ(a[t].deltas.size(), b[t].deltas.size());
    for (std::size_t i = 0; i < a[t].deltas.size(); ++i) {
      EXPECT_EQ(a[t].deltas[i].vertex, b[t].deltas[i].vertex);
      EXPECT_EQ(a[t].deltas[i].position, b[t].deltas[i].position);
      EXPECT_EQ(a[t].deltas[i].normal, b[t].deltas[i].normal);
    }
  }
  EXPECT_EQ(*CharacterGlb(*again), *glb);
}

TEST(GltfMorphTargets, TangentsAreWritten) {
  auto character = Parse(SquareMesh());
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  character->shapes = {"a"};
  character->meshes[0].morph_targets = {{0, {{2, glm::vec3(0, 0, 1), {}, glm::vec3(0, 0.5f, 0)}}}};
  const auto again = ParseCharacter(*CharacterGlb(*character), ".");
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(again->meshes[0].morph_targets.at(0).deltas.at(0).tangent, glm::vec3(0, 0.5f, 0));
}

TEST(GltfMorphTargets, InvalidOnesAreNotWritten) {
  const auto code = [](std::vector<MorphTarget> targets) {
    auto character = Parse(SquareMesh());
    character->shapes = {"a", "b"};
    character->meshes[0].morph_targets = std::move(targets);
    return CharacterGlb(*character).status().code();
  };
  const MorphDelta delta{1, glm::vec3(1.0f), {}, {}};
  EXPECT_EQ(code({{0, {delta}}, {1, {delta}}}), StatusCode::kOk);
  EXPECT_EQ(code({{1, {delta}}, {0, {delta}}}), StatusCode::kInvalidArgument);
  EXPECT_EQ(code({{2, {delta}}}), StatusCode::kInvalidArgument);
  EXPECT_EQ(code({{0, {delta, delta}}}), StatusCode::kInvalidArgument);
  EXPECT_EQ(code({{0, {{9, glm::vec3(1.0f), {}, {}}}}}), StatusCode::kInvalidArgument);
  EXPECT_EQ(code({{0, {}}}), StatusCode::kInvalidArgument);
}

// Two targets that move vertices 1 and 2, and vertex 2.
HandMadeGltf VrmFace() {
  HandMadeGltf gltf = SquareMesh();
  AddTarget("m0",
            {{"POSITION", gltf.AddFloats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC3")}},
            &gltf);
  AddTarget("m1",
            {{"POSITION", gltf.AddFloats({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC3")}},
            &gltf);
  return gltf;
}

glm::vec3 MoveOf(const Character& character, const std::string& shape, std::uint32_t vertex) {
  for (const MorphTarget& target : character.meshes[0].morph_targets) {
    if (character.shapes[static_cast<std::size_t>(target.shape)] != shape) continue;
    for (const MorphDelta& delta : target.deltas) {
      if (delta.vertex == vertex) return delta.position;
    }
  }
  return glm::vec3(0.0f);
}

TEST(GltfMorphTargets, ExpressionsOfVrm0AreShapes) {
  HandMadeGltf gltf = VrmFace();
  gltf.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"] = {
      {{"presetName", "joy"},
       {"name", "Joy"},
       {"binds",
        {{{"mesh", 0}, {"index", 0}, {"weight", 50}},
         {{"mesh", 0}, {"index", 1}, {"weight", 100}}}}},
      {{"presetName", "unknown"},
       {"name", "Wink"},
       {"binds", {{{"mesh", 0}, {"index", 1}, {"weight", 100}}}}},
      {{"presetName", "a"}, {"name", "A"}, {"binds", json::array()}},
      {{"presetName", "o"}, {"binds", {{{"mesh", 7}, {"index", 1}, {"weight", 100}}}}},
      {{"presetName", "M1"}, {"binds", {{{"mesh", 0}, {"index", 0}, {"weight", 100}}}}}};
  const auto character = Parse(gltf);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_THAT(character->shapes, ElementsAre("m0", "m1", "joy", "Wink")) << "M1 is m1's own name";
  EXPECT_EQ(MoveOf(*character, "joy", 1), glm::vec3(0.5f, 0, 0));
  EXPECT_EQ(MoveOf(*character, "joy", 2), glm::vec3(0, 0.5f, 1));
  EXPECT_EQ(MoveOf(*character, "Wink", 2), glm::vec3(0, 0, 1));
  EXPECT_EQ(MoveOf(*character, "m0", 1), glm::vec3(1, 0, 0));
  EXPECT_THAT(character->warnings,
              ElementsAre(HasSubstr("1 ignored bind of expressions to morph targets")));
}

TEST(GltfMorphTargets, ExpressionsOfVrm1AreShapes) {
  HandMadeGltf gltf = VrmFace();
  gltf.json["extensions"]["VRMC_vrm"]["expressions"] = {
      {"preset",
       {{"happy",
         {{"isBinary", true},
          {"overrideMouth", "block"},
          {"overrideBlink", "none"},
          {"morphTargetBinds", {{{"node", 0}, {"index", 0}, {"weight", 0.25}}}},
          {"materialColorBinds", {{{"material", 0}}}}}}}},
      {"custom",
       {{"wink", {{"morphTargetBinds", {{{"node", 0}, {"index", 1}, {"weight", 9e99}}}}}}}}};
  const auto character = Parse(gltf);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_THAT(character->shapes, ElementsAre("m0", "m1", "happy", "wink"));
  EXPECT_EQ(MoveOf(*character, "happy", 1), glm::vec3(0.25f, 0, 0));
  EXPECT_EQ(MoveOf(*character, "wink", 2), glm::vec3(0, 0, 1)) << "weights end at 1";
  EXPECT_THAT(character->warnings,
              ElementsAre(HasSubstr("1 ignored bind of expressions to materials")));
  ASSERT_THAT(character->shape_rules, SizeIs(1));
  EXPECT_EQ(character->shape_rules[0].shape, 2u);
  EXPECT_TRUE(character->shape_rules[0].is_binary);
  EXPECT_EQ(character->shape_rules[0].limits[wrinkle::ShapeRule::kMouths],
            wrinkle::ShapeRule::Limits::kBlock);
}

// Anything may stand where VRM expects lists and numbers.
TEST(GltfMorphTargets, BrokenExpressionsAreIgnored) {
  for (const json& part :
       {json(1), json("x"), json::array({1, "x", nullptr}), json::object(),
        json::array({{{"presetName", 3}, {"binds", 4}}, {{"name", "n"}, {"binds", {1, nullptr}}}}),
        json::array(
            {{{"name", "n"}, {"binds", {{{"mesh", -1}, {"index", 1e300}, {"weight", "x"}}}}}})}) {
    HandMadeGltf gltf = VrmFace();
    gltf.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"] = part;
    const auto character = Parse(gltf);
    ASSERT_TRUE(character.ok()) << part << character.status().ToString();
    EXPECT_THAT(character->shapes, ElementsAre("m0", "m1")) << part;
    gltf = VrmFace();
    gltf.json["extensions"]["VRMC_vrm"]["expressions"] = {{"preset", part},
                                                          {"custom", {{"n", part}}}};
    const auto other = Parse(gltf);
    ASSERT_TRUE(other.ok()) << part << other.status().ToString();
    EXPECT_THAT(other->shapes, ElementsAre("m0", "m1")) << part;
  }
}

TEST(GltfMorphTargets, TooManyExpressionsAreAnError) {
  HandMadeGltf gltf = VrmFace();
  json& groups = gltf.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"];
  for (std::size_t i = 0; i <= gltf::kMaxVrmNodes; ++i) groups.push_back({{"name", "x"}});
  EXPECT_EQ(Parse(gltf).status().code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace furrow::character
