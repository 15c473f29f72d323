// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion/gltf/gltf_animation.h"
#include "tests/unit/gltf/gltf_testing.h"
#include "tests/unit/motion/clip_testing.h"

namespace furrow::motion {
namespace {

using gltf::HandMadeGltf;
using gltf::TwoJoints;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

Clip Parse(const std::string& glb, const GltfOptions& options = {}, ClipReport* report = nullptr) {
  Result<Clip> clip = ParseGltfAnimation(glb, "t.glb", options, report);
  EXPECT_TRUE(clip.ok()) << clip.status().ToString();
  return clip.ok() ? std::move(*clip) : Clip();
}

StatusCode CodeOf(const std::string& glb) {
  const Result<Clip> clip = ParseGltfAnimation(glb, "t.glb");
  EXPECT_EQ(clip.ok(), clip.status().ok());
  if (!clip.ok()) {
    EXPECT_THAT(clip.status().where(), HasSubstr("t.glb"));
  }
  return clip.status().code();
}

TEST(GltfReader, ReadsTheAnimatedTree) {
  const Clip clip = Parse(TwoJoints().Glb(), {.load = {.sample_rate = 2.0}});
  EXPECT_EQ(clip.name, "take");
  EXPECT_THAT(clip.skeleton.joint_names(), ElementsAre("root", "child"));
  EXPECT_THAT(clip.times, ElementsAre(0.0, 0.5, 1.0));
  EXPECT_NEAR(ModelPosition(clip, 1, "child").x, 1.0f, 1e-6f);
  // Half-way through a quarter turn about Z: 45 degrees.
  EXPECT_NEAR(2.0f * std::asin(clip.locals[3].rotation.z), M_PI / 4.0, 1e-5);
}

TEST(GltfReader, FramesAreTheKeysOfAllSamplers) {
  HandMadeGltf gltf = TwoJoints();
  const int times = gltf.AddFloats({0.25f, 1.5f}, "SCALAR");
  gltf.AddChannel(1, "scale", "STEP", times, gltf.AddFloats({1, 1, 1, 2, 2, 2}, "VEC3"));
  const Clip clip = Parse(gltf.Glb());
  EXPECT_THAT(clip.times, ElementsAre(0.0, 0.25, 1.0, 1.5));
  EXPECT_EQ(clip.locals[2 * 2 + 1].scale.x, 1.0f);
  EXPECT_EQ(clip.locals[3 * 2 + 1].scale.x, 2.0f);
}

TEST(GltfReader, ScaleIsForLengths) {
  const Clip clip = Parse(TwoJoints().Glb(), {.load = {.scale = 100.0f}});
  EXPECT_NEAR(ModelPosition(clip, 1, "child").x, 200.0f, 1e-3f);
  EXPECT_NEAR(ModelPosition(clip, 1, "child").y, 100.0f, 1e-3f);
}

TEST(GltfReader, JointsAreTheSkinsAndTheirAncestors) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["nodes"] = {{{"name", "armature"}, {"children", {1, 3}}, {"rotation", {0, 0, 1, 0}}},
                        {{"name", "hip"}, {"children", {2}}},
                        {{"name", "knee"}},
                        {{"name", "body"}},
                        {{"name", "prop"}}};
  gltf.json["skins"] = {{{"joints", {2, 1}}}};
  EXPECT_THAT(Parse(gltf.Glb()).skeleton.joint_names(), ElementsAre("armature", "hip", "knee"));
}

// The node moves along X, with the times of TwoJoints().
void Move(int node, HandMadeGltf* gltf) {
  const int times = gltf->json["animations"][0]["samplers"][0]["input"];
  gltf->AddChannel(node, "translation", "LINEAR", times,
                   gltf->AddFloats({0, 0, 0, 3, 0, 0}, "VEC3"));
}

// No vertex follows eyes and helpers, so no skin lists them.
TEST(GltfReader, JointsAreAlsoWhatMovesBelowThoseOfSkins) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["nodes"] = {{{"name", "scene"}, {"children", {1, 7}}},
                        {{"name", "hips"}, {"children", {2, 5}}},
                        {{"name", "head"}, {"children", {3, 8}}},
                        {{"name", "socket"}, {"children", {4}}},
                        {{"name", "eye"}},
                        {{"name", "leg"}},
                        {{"name", "unused"}},
                        {{"name", "camera"}},
                        {{"name", "hair"}}};
  gltf.json["skins"] = {{{"joints", {1, 2, 5}}}};
  Move(4, &gltf);
  Move(7, &gltf);
  const Clip clip = Parse(gltf.Glb());
  EXPECT_THAT(clip.skeleton.joint_names(),
              ElementsAre("scene", "hips", "head", "socket", "eye", "leg"))
      << "nothing moves the hair, and the camera is elsewhere";
  // The scene moves by 2 along X, and the hips turn the eye's 3 to Y.
  EXPECT_NEAR(ModelPosition(clip, 1, "eye").x, 2.0f, 1e-5f);
  EXPECT_NEAR(ModelPosition(clip, 1, "eye").y, 3.0f, 1e-5f);
}

// The import of avatars takes the nodes of moving rigid meshes for joints, too.
TEST(GltfReader, JointsAreAlsoWhatMovesRigidMeshes) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["nodes"] = {{{"name", "scene"}, {"children", {1, 3, 5}}},
                        {{"name", "hips"}, {"children", {2}}},
                        {{"name", "head"}},
                        {{"name", "sword"}, {"children", {4}}},
                        {{"name", "blade"}, {"mesh", 0}},
                        {{"name", "camera"}},
                        {{"name", "car"}, {"mesh", 0}}};
  gltf.json["meshes"] = {{{"primitives", json::array()}}};
  gltf.json["skins"] = {{{"joints", {1, 2}}}};
  for (const int node : {3, 5, 6}) Move(node, &gltf);
  EXPECT_THAT(Parse(gltf.Glb()).skeleton.joint_names(),
              ElementsAre("scene", "hips", "head", "sword"));
}

// Hips without vertices of their own are in no skin. Their tail moves with them.
TEST(GltfReader, HipsThatNoSkinListsHoldTheBodyTogether) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["nodes"] = {{{"name", "armature"}, {"children", {1, 5}}},
                        {{"name", "hips"}, {"children", {2, 3, 4}}},
                        {{"name", "leg_l"}},
                        {{"name", "leg_r"}},
                        {{"name", "tail"}},
                        {{"name", "prop"}}};
  gltf.json["skins"] = {{{"joints", {2, 3}}}};
  Move(4, &gltf);
  Move(5, &gltf);
  EXPECT_THAT(Parse(gltf.Glb()).skeleton.joint_names(),
              ElementsAre("armature", "hips", "leg_l", "leg_r", "tail"));
}

// The skin of a head alone. A limb has at least three moving nodes in a row.
TEST(GltfReader, LimbsOfABodyWithoutASkinComeAlong) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["nodes"] = {{{"name", "hips"}, {"children", {1, 2, 5}}},
                        {{"name", "head"}},
                        {{"name", "thigh"}, {"children", {3}}},
                        {{"name", "shin"}, {"children", {4}}},
                        {{"name", "foot"}},
                        {{"name", "tail"}}};
  gltf.json["skins"] = {{{"joints", {1}}}};
  for (const int node : {2, 3, 5}) Move(node, &gltf);
  EXPECT_THAT(Parse(gltf.Glb()).skeleton.joint_names(), ElementsAre("hips", "head"));
  Move(4, &gltf);
  EXPECT_THAT(Parse(gltf.Glb()).skeleton.joint_names(),
              ElementsAre("hips", "head", "thigh", "shin", "foot", "tail"));
}

TEST(GltfReader, WhatMovesBelowSkinsGivesWayToTheirJoints) {
  HandMadeGltf gltf = TwoJoints();
  json children = json::array();
  gltf.json["nodes"] = {{{"name", "root"}}};
  for (int i = 1; i <= wrinkle::kMaxJoints; ++i) {
    gltf.json["nodes"].push_back(json::object());
    children.push_back(i);
    Move(i, &gltf);
  }
  gltf.json["nodes"][0]["children"] = children;
  gltf.json["skins"] = {{{"joints", {0}}}};
  ClipReport report;
  EXPECT_THAT(Parse(gltf.Glb(), {}, &report).skeleton.joint_names(), ElementsAre("root"));
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("left out 1024 moving nodes below the")));
}

TEST(GltfReader, NamesNamelessJointsAndRenamesDuplicates) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["nodes"] = {{{"children", {1}}}, {{"name", "a"}, {"children", {2}}}, {{"name", "a"}}};
  ClipReport report;
  EXPECT_THAT(Parse(gltf.Glb(), {}, &report).skeleton.joint_names(),
              ElementsAre("node_0", "a", "a_2"));
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("t.glb: nodes[2].name: several joints")));
}

TEST(GltfReader, DropsShearWithAWarning) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["nodes"][1] = {{"name", "child"},
                           {"matrix", {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}};
  ClipReport report;
  const Clip clip = Parse(gltf.Glb(), {}, &report);
  EXPECT_NEAR(clip.skeleton.rest_pose()[1].translation.z, 7.0f, 1e-6f);
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("nodes[1].matrix: the matrix has shear")));
}

// Exporters list children before their parents.
TEST(GltfReader, KeepsTheFilesOrderOfJoints) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["nodes"] = {
      {{"name", "knee"}}, {{"name", "arm"}}, {{"name", "hips"}, {"children", {0, 1}}}};
  EXPECT_THAT(Parse(gltf.Glb()).skeleton.joint_names(), ElementsAre("hips", "knee", "arm"));
}

// Mesh compression moves vertices, which a clip does not need.
TEST(GltfReader, IgnoresRequiredExtensionsOfMeshes) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression", "EXT_something"};
  gltf.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 99}}}, {"indices", 98}}}}}};
  ClipReport report;
  Parse(gltf.Glb(), {}, &report);
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("'EXT_something'")));
}

TEST(GltfReader, ReportsAllAnimations) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["animations"][0]["name"] = "Walk";
  gltf.json["animations"].push_back(gltf.json["animations"][0]);
  gltf.json["animations"][1]["name"] = "Jump";
  const int times = gltf.json["animations"][0]["samplers"][0]["input"];
  gltf.json["accessors"][static_cast<std::size_t>(times)]["max"] = {2.5};
  const int unstated = gltf.AddFloats({0.0f, 1.0f}, "SCALAR");
  for (auto& sampler : gltf.json["animations"][1]["samplers"]) sampler["input"] = unstated;
  ClipReport report;
  LoadOptions load;
  load.animation = "Walk";
  const auto clip = ParseGltfAnimation(gltf.Glb(), "t.glb", {.load = load}, &report);
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  ASSERT_EQ(report.animations.size(), 2u);
  EXPECT_EQ(report.animations[0].name, "Walk");
  EXPECT_EQ(report.animations[0].seconds, 2.5);
  EXPECT_EQ(report.animations[1].name, "Jump");
  EXPECT_EQ(report.animations[1].seconds, 0.0);  // the file does not state it
}

TEST(GltfReader, DecomposesMatrices) {
  HandMadeGltf gltf = TwoJoints();
  // Scale by 2, a quarter turn about Z, then (5, 6, 7); column-major.
  gltf.json["nodes"][1] = {{"name", "child"},
                           {"matrix", {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1}}};
  const Clip clip = Parse(gltf.Glb());
  const wrinkle::Transform& rest = clip.skeleton.rest_pose()[1];
  EXPECT_NEAR(rest.scale.y, 2.0f, 1e-6f);
  EXPECT_NEAR(rest.translation.z, 7.0f, 1e-6f);
  EXPECT_NEAR(std::abs(rest.rotation.z), std::sqrt(0.5f), 1e-6f);
}

TEST(GltfReader, ReadsNormalisedIntegers) {
  HandMadeGltf gltf = TwoJoints();
  const std::vector<std::int16_t> turns = {0, 0, 0, 32767, 0, 0, 23170, 23170};
  const int values = gltf.AddAccessor(turns, "VEC4", 5122, 4);
  gltf.json["animations"][0]["samplers"][0]["output"] = values;
  EXPECT_EQ(CodeOf(gltf.Glb()), StatusCode::kSchema);  // not marked as normalised
  gltf.json["accessors"][static_cast<std::size_t>(values)]["normalized"] = true;
  EXPECT_NEAR(Parse(gltf.Glb()).locals[3].rotation.z, std::sqrt(0.5f), 1e-4f);
}

TEST(GltfReader, ReadsMorphWeightsByName) {
  HandMadeGltf gltf;
  gltf.json["nodes"] = {{{"name", "face"}, {"mesh", 0}}};
  gltf.json["meshes"] = {{{"name", "face"},
                          {"extras", {{"targetNames", {"jawOpen", ""}}}},
                          {"primitives", {{{"targets", {json::object(), json::object()}}}}}}};
  const int times = gltf.AddFloats({0.0f, 1.0f, 2.0f}, "SCALAR");
  gltf.AddChannel(0, "weights", "LINEAR", times, gltf.AddFloats({0, 1, 0.5, 0.5, 1, 0}, "SCALAR"));
  const Clip clip = Parse(gltf.Glb());
  EXPECT_EQ(clip.skeleton.num_joints(), 0);
  EXPECT_THAT(clip.blend_shape_names, ElementsAre("jawOpen", "face.1"));
  EXPECT_THAT(clip.blend_shapes, ElementsAre(0.0f, 1.0f, 0.5f, 0.5f, 1.0f, 0.0f));
}

TEST(GltfReader, ReadsDataUrisAndFilesInItsFolderOnly) {
  HandMadeGltf gltf = TwoJoints();
  json whole = gltf.json;
  TemporaryFolder folder;
  std::ofstream(folder.path() / "a.bin", std::ios::binary) << gltf.binary;
  std::ofstream(folder.path().parent_path() / "furrow-outside.bin", std::ios::binary)
      << gltf.binary;
  const auto code = [&](const std::string& uri, bool with_folder) {
    whole["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", uri}}};
    GltfOptions options;
    if (with_folder) options.folder = folder.path();
    return ParseGltfAnimation(whole.dump(), "t.gltf", options).status().code();
  };
  EXPECT_EQ(code("a.bin", true), StatusCode::kOk);
  EXPECT_EQ(code("a.bin", false), StatusCode::kUnsupported);
  EXPECT_EQ(code("none.bin", true), StatusCode::kNotFound);
  for (const char* uri : {"../furrow-outside.bin", "/etc/hostname", "..", "", "http://a/b",
                          "%2e%2e/furrow-outside.bin", "%2Fetc%2Fhostname", "a.bin%00", "%2"}) {
    EXPECT_EQ(code(uri, true), StatusCode::kInvalidArgument) << uri;
  }
  EXPECT_EQ(code("sub/a.bin", true), StatusCode::kNotFound);
  std::filesystem::create_directory(folder.path() / "sub");
  std::ofstream(folder.path() / "sub" / "a b.bin", std::ios::binary) << gltf.binary;
  EXPECT_EQ(code("sub/a%20b.bin", true), StatusCode::kOk);
  EXPECT_EQ(code("data:application/octet-stream;base64,AAAA", false), StatusCode::kSchema);
  std::filesystem::remove(folder.path().parent_path() / "furrow-outside.bin");
}

TEST(GltfReader, ReadsVrmAnimation) {
  const std::filesystem::path path = SharedFile("vrma/test.vrma");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  ClipReport report;
  const Clip clip = Parse(ReadAll(path), {}, &report);
  EXPECT_THAT(std::vector<std::string>(clip.skeleton.joint_names().begin(),
                                       clip.skeleton.joint_names().end()),
              IsSupersetOf({"hips", "head", "leftUpperArm", "rightLittleDistal"}));
  EXPECT_EQ(clip.num_frames(), 7);
  EXPECT_DOUBLE_EQ(clip.duration(), 3.0);
  ASSERT_EQ(clip.blend_shape_names.size(), 1u);  // one expression, which reaches 1
  EXPECT_EQ(*std::max_element(clip.blend_shapes.begin(), clip.blend_shapes.end()), 1.0f);
  EXPECT_EQ(*std::min_element(clip.blend_shapes.begin(), clip.blend_shapes.end()), 0.0f);
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("lookAt")));
  // Only the right upper arm turns in this file.
  const auto arm = static_cast<std::size_t>(clip.skeleton.Find("rightUpperArm"));
  const auto joints = static_cast<std::size_t>(clip.skeleton.num_joints());
  float turned = 0.0f;
  for (std::size_t f = 0; f < 7; ++f) {
    for (std::size_t j = 0; j < joints; ++j) {
      const float dot = std::abs(
          glm::dot(clip.locals[f * joints + j].rotation, clip.skeleton.rest_pose()[j].rotation));
      if (j == arm) turned = std::max(turned, 1.0f - dot);
      if (j != arm) {
        EXPECT_GT(dot, 0.9999f) << clip.skeleton.joint_names()[j];
      }
    }
  }
  EXPECT_GT(turned, 0.01f);
}

// The file's humanoid says which node is which bone, so the nodes' own names do not matter.
TEST(GltfReader, BonesOfVrmAnimationsMayHaveNamesOfTheirOwn) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["nodes"] = {{{"name", "Hips"}, {"children", {1}}},
                        {{"name", "Bone.000"}, {"children", {2}}},
                        {{"name", "spine"}, {"children", {3}}},
                        {{"name", "Bone.001"}}};
  json& bones = gltf.json["extensions"]["VRMC_vrm_animation"]["humanoid"]["humanBones"];
  bones["hips"]["node"] = 1;
  bones["spine"]["node"] = 3;
  ClipReport report;
  EXPECT_THAT(Parse(gltf.Glb(), {}, &report).skeleton.joint_names(),
              ElementsAre("Hips_2", "hips", "spine_2", "spine"));
  EXPECT_THAT(report.warnings, ElementsAre());
}

TEST(GltfReader, RejectsInvalidFiles) {
  using Change = void (*)(json&);
  const std::pair<Change, StatusCode> kCases[] = {
      {[](json& j) { j["asset"]["version"] = "1.0"; }, StatusCode::kUnsupported},
      {[](json& j) { j.erase("asset"); }, StatusCode::kUnsupported},
      {[](json& j) { j.erase("animations"); }, StatusCode::kSchema},
      {[](json& j) { j["nodes"][1]["children"] = {0}; }, StatusCode::kCyclic},
      {[](json& j) { j["nodes"][1]["children"] = {1}; }, StatusCode::kCyclic},
      {[](json& j) {
         j["nodes"][0]["children"] = {1, 1};
       },
       StatusCode::kCyclic},
      {[](json& j) { j["nodes"][0]["children"] = {7}; }, StatusCode::kSchema},
      {[](json& j) { j["nodes"][0]["children"] = {-1}; }, StatusCode::kSchema},
      {[](json& j) { j["nodes"][0]["mesh"] = 3; }, StatusCode::kSchema},
      {[](json& j) {
         j["nodes"][0]["rotation"] = {0, 0, 0, 0};
       },
       StatusCode::kSchema},
      {[](json& j) {
         j["nodes"][0]["translation"] = {0, 0};
       },
       StatusCode::kSchema},
      {[](json& j) {
         j["nodes"][0]["translation"] = {0, 0, 1e200};
       },
       StatusCode::kNonFinite},
      {[](json& j) { j["nodes"] = 5; }, StatusCode::kSchema},
      {[](json& j) {
         j["skins"] = {{{"joints", {99}}}};
       },
       StatusCode::kSchema},
      {[](json& j) { j["accessors"][0]["count"] = 3; }, StatusCode::kSchema},
      {[](json& j) { j["accessors"][0]["count"] = 0; }, StatusCode::kSchema},
      {[](json& j) { j["accessors"][0]["count"] = 4000000000u; }, StatusCode::kLimit},
      {[](json& j) { j["accessors"][0]["byteOffset"] = 4; }, StatusCode::kSchema},
      {[](json& j) { j["accessors"][0]["byteOffset"] = 0xFFFFFFFFFFFFFFF0u; }, StatusCode::kSchema},
      {[](json& j) { j["accessors"][0]["componentType"] = 5125; }, StatusCode::kSchema},
      {[](json& j) { j["accessors"][0]["type"] = "VEC2"; }, StatusCode::kSchema},
      {[](json& j) { j["accessors"][0]["bufferView"] = 17; }, StatusCode::kSchema},
      {[](json& j) { j["accessors"][0].erase("bufferView"); }, StatusCode::kSchema},
      {[](json& j) {
         j["accessors"][0]["sparse"] = {{"count", 3},
                                        {"indices", {{"bufferView", 0}, {"componentType", 5123}}},
                                        {"values", {{"bufferView", 0}}}};
       },
       StatusCode::kSchema},
      {[](json& j) { j["bufferViews"][0]["buffer"] = 1; }, StatusCode::kSchema},
      {[](json& j) { j["bufferViews"][0]["byteLength"] = 1 << 20; }, StatusCode::kSchema},
      {[](json& j) { j["bufferViews"][0]["byteOffset"] = 1 << 20; }, StatusCode::kSchema},
      {[](json& j) { j["bufferViews"][0]["byteStride"] = 252; }, StatusCode::kSchema},
      {[](json& j) { j["animations"][0]["channels"][0]["sampler"] = 9; }, StatusCode::kSchema},
      {[](json& j) { j["animations"][0]["channels"][0]["target"]["node"] = 9; },
       StatusCode::kSchema},
      {[](json& j) { j["animations"][0]["channels"][1] = j["animations"][0]["channels"][0]; },
       StatusCode::kSchema},
      {[](json& j) { j["animations"][0]["samplers"][0]["input"] = 44; }, StatusCode::kSchema},
      {[](json& j) { j["animations"][0]["samplers"][0]["output"] = 0; }, StatusCode::kSchema},
      {[](json& j) { j["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE"; },
       StatusCode::kSchema},
      {[](json& j) { j["animations"][0]["samplers"][0]["interpolation"] = "MAGIC"; },
       StatusCode::kSchema},
      {[](json& j) { j["animations"][0]["channels"][0]["target"]["path"] = "weights"; },
       StatusCode::kSchema},
      {[](json& j) {
         j["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                                         {"byteLength", 8},
                                                                         {"byteStride", 4},
                                                                         {"count", 2},
                                                                         {"mode", "ATTRIBUTES"}};
       },
       StatusCode::kParse},
      {[](json& j) {
         j["extensions"]["VRMC_vrm_animation"]["humanoid"]["humanBones"]["hips"] = {{"node", 99}};
       },
       StatusCode::kSchema}};
  int index = 0;
  for (const auto& [change, code] : kCases) {
    HandMadeGltf gltf = TwoJoints();
    change(gltf.json);
    EXPECT_EQ(CodeOf(gltf.Glb()), code) << "case " << index;
    ++index;
  }
}

TEST(GltfReader, ReadsTheChosenAnimation) {
  HandMadeGltf gltf = TwoJoints();
  json second = gltf.json["animations"][0];
  second["name"] = "run";
  second["channels"].erase(0);
  gltf.json["animations"].push_back(second);
  const std::string glb = gltf.Glb();
  const auto read = [&](const std::string& choice) {
    return ParseGltfAnimation(glb, "a.glb", {.load = {.animation = choice}, .folder = {}});
  };
  EXPECT_EQ(read("")->name, "take");
  EXPECT_EQ(read("run")->name, "run");
  EXPECT_EQ(read("0")->name, "take");
  EXPECT_EQ(read("1")->name, "run");
  const Status none = read("2").status();
  EXPECT_EQ(none.code(), StatusCode::kNotFound);
  EXPECT_THAT(none.todo(), HasSubstr("0 'take', 1 'run'"));
}

TEST(GltfReader, RejectsBadNumbers) {
  const auto with_times = [](const std::vector<float>& times) {
    HandMadeGltf gltf = TwoJoints();
    gltf.json["animations"][0]["samplers"][0]["input"] = gltf.AddFloats(times, "SCALAR");
    return gltf.Glb();
  };
  EXPECT_EQ(CodeOf(with_times({0.0f, 1.0f})), StatusCode::kOk);
  EXPECT_EQ(CodeOf(with_times({1.0f, 1.0f})), StatusCode::kSchema);
  EXPECT_EQ(CodeOf(with_times({1.0f, 0.5f})), StatusCode::kSchema);
  EXPECT_EQ(CodeOf(with_times({0.0f, NAN})), StatusCode::kNonFinite);
  EXPECT_EQ(CodeOf(with_times({0.0f, INFINITY})), StatusCode::kNonFinite);
  HandMadeGltf zero = TwoJoints();
  zero.json["animations"][0]["samplers"][0]["output"] =
      zero.AddFloats({0, 0, 0, 0, 0, 0, 0, 1}, "VEC4");
  EXPECT_EQ(CodeOf(zero.Glb()), StatusCode::kSchema);
  // The keys are finite, but the spline between them leaves the range of a float.
  HandMadeGltf huge = TwoJoints();
  const float big = std::numeric_limits<float>::max();
  huge.json["animations"][0]["samplers"][1]["output"] = huge.AddFloats(
      {0, 0, 0, big, big, big, big, big, big, 0, 0, 0, big, big, big, 0, 0, 0}, "VEC3");
  huge.json["animations"][0]["samplers"][1]["interpolation"] = "CUBICSPLINE";
  EXPECT_EQ(
      ParseGltfAnimation(huge.Glb(), "t.glb", {.load = {.sample_rate = 10.0}}).status().code(),
      StatusCode::kNonFinite);
}

TEST(GltfReader, BoundsFramesJointsAndDepth) {
  HandMadeGltf gltf = TwoJoints();
  EXPECT_EQ(
      ParseGltfAnimation(gltf.Glb(), "t.glb", {.load = {.sample_rate = 1e12}}).status().code(),
      StatusCode::kLimit);
  json nodes = json::array();
  for (int i = 0; i <= wrinkle::kMaxJoints; ++i) nodes.push_back({{"children", {i + 1}}});
  nodes.push_back(json::object());
  gltf.json["nodes"] = nodes;
  EXPECT_EQ(CodeOf(gltf.Glb()), StatusCode::kLimit);
  const std::string deep = R"({"asset":{"version":"2.0"},"x":)" + std::string(100'000, '[');
  EXPECT_EQ(ParseGltfAnimation(deep, "t.glb").status().code(), StatusCode::kLimit);
  // Brackets in a string do not count.
  gltf = TwoJoints();
  gltf.json["extras"] = std::string(1000, '[') + "\\\"";
  EXPECT_EQ(CodeOf(gltf.Glb()), StatusCode::kOk);
}

TEST(GltfReader, RejectsEveryTruncation) {
  const std::string whole = TwoJoints().Glb();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    const Result<Clip> clip = ParseGltfAnimation({cut.data(), cut.size()}, "t.glb");
    ASSERT_FALSE(clip.ok()) << length;
    EXPECT_EQ(clip.status().code(), StatusCode::kParse) << length;
  }
  ClipReport report;
  EXPECT_TRUE(ParseGltfAnimation(whole + "trailing", "t.glb", {}, &report).ok());
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("ignored 8 bytes after the stated end")));
}

TEST(GltfReader, RejectsFalseChunkSizes) {
  const std::string whole = TwoJoints().Glb();
  for (const std::size_t at : {4u, 8u, 12u, 16u}) {
    for (const std::uint32_t value : {0u, 1u, 7u, 0x7FFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFF0u}) {
      std::string glb = whole;
      glb.replace(at, 4, gltf::U32(value));
      EXPECT_FALSE(ParseGltfAnimation(glb, "t.glb").ok()) << at << " " << value;
    }
  }
}

TEST(GltfReader, SurvivesGarbage) {
  std::uint32_t state = 3;
  const std::string good = TwoJoints().Glb();
  for (int round = 0; round < 3000; ++round) {
    std::string glb = good;
    for (int i = 0; i < 3; ++i) {
      state = state * 1664525u + 1013904223u;
      glb[(state >> 8) % glb.size()] = static_cast<char>(state >> 24);
    }
    const Result<Clip> clip = ParseGltfAnimation(glb, "t.glb");
    if (!clip.ok()) continue;
    for (const wrinkle::Transform& local : clip->locals) EXPECT_TRUE(wrinkle::IsValid(local));
  }
}

}  // namespace
}  // namespace furrow::motion
