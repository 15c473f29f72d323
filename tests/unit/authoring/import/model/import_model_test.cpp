// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/import_model.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "tests/unit/authoring/import/model/toy_body.h"
#include "tests/unit/gltf/gltf_testing.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;

class Folder : public TemporaryFolder {
 public:
  fs::path Write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path() / name, std::ios::binary) << bytes;
    return path() / name;
  }
};

// Model-space positions of all vertices with some joints turned. The key is the UV, because
// importers reorder vertices.
std::map<std::pair<int, int>, glm::vec3> Posed(const character::Character& character) {
  const auto turn = [](const std::string& name) {
    const glm::vec3 x(1, 0, 0), z(0, 0, 1);
    if (name == "leftLowerLeg") return glm::angleAxis(1.0f, x);
    if (name == "rightUpperArm") return glm::angleAxis(-0.7f, z);
    if (name == "neck") return glm::angleAxis(0.4f, glm::vec3(0, 1, 0));
    return glm::quat(1, 0, 0, 0);
  };
  const wrinkle::Skeleton& skeleton = character.skeleton;
  std::vector<glm::mat4> model(skeleton.num_joints());
  std::vector<glm::mat4> skin(skeleton.num_joints());
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    // About model axes, not the joint's own axes.
    const glm::quat rest = skeleton.rest_model_rotations()[j];
    wrinkle::Transform local = skeleton.rest_pose()[j];
    local.rotation = local.rotation * glm::inverse(rest) * turn(skeleton.joint_names()[j]) * rest;
    const int parent = skeleton.joint_parents()[j];
    model[j] = (parent < 0 ? glm::mat4(1) : model[parent]) * wrinkle::ToMatrix(local);
    skin[j] = model[j] * character.inverse_bind_matrices[j];
  }
  std::map<std::pair<int, int>, glm::vec3> posed;
  for (const character::Mesh& mesh : character.meshes) {
    for (const character::Vertex& v : mesh.vertices) {
      glm::vec4 p(0.0f);
      for (int i = 0; i < 4; ++i) {
        p += v.skin_weights[i] * (skin[v.joints[i]] * glm::vec4(v.position, 1.0f));
      }
      const auto key = std::pair(static_cast<int>(std::lround(v.uv.x * 1000)),
                                 static_cast<int>(std::lround(v.uv.y * 1000)));
      posed[key] = glm::vec3(p);
    }
  }
  return posed;
}

void ExpectSamePoses(const character::Character& seen, const character::Character& due) {
  const auto a = Posed(seen);
  const auto b = Posed(due);
  ASSERT_EQ(a.size(), b.size());
  float worst = 0.0f;
  for (const auto& [uv, position] : b) {
    const auto found = a.find(uv);
    ASSERT_NE(found, a.end()) << uv.first << " " << uv.second;
    worst = std::max(worst, glm::distance(found->second, position));
  }
  EXPECT_LT(worst, 1e-4f);
}

class ForeignFormat : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(ForeignFormat, BendsLikeTheOriginal) {
  const auto& [format, file] = GetParam();
  const character::Character body = ToyBody();
  const Folder folder;
  const auto imported =
      ImportModel(folder.Write(file, ConvertByAssimp(GlbOf(body), format)), VrmMaps());
  ASSERT_TRUE(imported.ok()) << imported.status().ToString();
  for (const std::string& name : body.skeleton.joint_names()) {
    EXPECT_NE(imported->character.skeleton.Find(name), wrinkle::kNoJoint) << name;
  }
  ExpectSamePoses(imported->character, body);
  ASSERT_FALSE(imported->character.materials.empty());
  const int used = imported->character.meshes[0].material;
  const character::Material& material =
      imported->character.materials[static_cast<std::size_t>(used)];
  EXPECT_EQ(material.kind, character::Material::Kind::kSkin) << material.name;
  EXPECT_NEAR(material.base_colour.g, 0.25f, 1e-3f);
}

INSTANTIATE_TEST_SUITE_P(Formats, ForeignFormat,
                         ::testing::Values(std::pair("fbxa", "ascii.fbx"),
                                           std::pair("collada", "body.DAE"),
                                           std::pair("glb2", "other.glb")),
                         [](const auto& format) { return std::string(format.param.first); });

// The toy body with two rigid meshes below its head: a "ball" that an animation turns, and a "hat".
std::string BodyWithRigidParts() {
  const std::string body = GlbOf(ToyBody());
  std::uint32_t length = 0;
  std::memcpy(&length, body.data() + 12, sizeof length);
  gltf::HandMadeGltf gltf;
  gltf.json = nlohmann::json::parse(body.substr(20, length));
  gltf.binary = body.substr(20 + length + 8);
  nlohmann::json rigid = gltf.json["meshes"][0];
  for (const char* attribute : {"JOINTS_0", "WEIGHTS_0"}) {
    rigid["primitives"][0]["attributes"].erase(attribute);
  }
  auto& nodes = gltf.json["nodes"];
  const auto head = static_cast<std::size_t>(ToyBody().skeleton.Find("head"));
  for (const char* name : {"ball", "hat"}) {
    rigid["name"] = std::string("mesh of ") + name;
    nodes[head]["children"].push_back(nodes.size());
    nodes.push_back({{"name", name}, {"mesh", gltf.json["meshes"].size()}});
    gltf.json["meshes"].push_back(rigid);
  }
  gltf.json["animations"] = {{{"name", "take"}, {"channels", nlohmann::json::array()}}};
  const float h = 0.70710678f;
  gltf.AddChannel(static_cast<int>(nodes.size()) - 2, "rotation", "LINEAR",
                  gltf.AddFloats({0, 1}, "SCALAR"),
                  gltf.AddFloats({0, 0, 0, 1, 0, 0, h, h}, "VEC4"));
  return gltf.Glb();
}

// assimp cannot write animations as Collada.
TEST(ImportModel, MovingRigidPartsAreJoints) {
  const Folder folder;
  for (const auto& [format, file] : {std::pair("fbxa", "body.fbx"), std::pair("glb2", "b.glb")}) {
    const auto imported =
        ImportModel(folder.Write(file, ConvertByAssimp(BodyWithRigidParts(), format)), VrmMaps());
    ASSERT_TRUE(imported.ok()) << imported.status().ToString();
    const character::Character& body = imported->character;
    const int ball = body.skeleton.Find("ball");
    ASSERT_NE(ball, wrinkle::kNoJoint) << format;
    EXPECT_EQ(body.skeleton.Find("hat"), wrinkle::kNoJoint) << format;
    std::set<int> followed;  // by meshes that follow one joint
    for (const character::Mesh& mesh : body.meshes) {
      const auto& vertices = mesh.vertices;
      const bool is_rigid = std::ranges::all_of(vertices, [&](const character::Vertex& v) {
        return v.skin_weights[0] == 1.0f && v.joints[0] == vertices[0].joints[0];
      });
      if (is_rigid) followed.insert(vertices[0].joints[0]);
    }
    EXPECT_EQ(followed, (std::set<int>{body.skeleton.Find("head"), ball})) << format;
  }
}

TEST(ImportModel, AMeshMayHaveTheNameOfABone) {
  const Folder folder;
  for (const char* bone : {"hips", "head", "leftHand"}) {
    character::Character body = ToyBody();
    body.meshes[0].name = bone;
    const auto imported =
        ImportModel(folder.Write("body.fbx", ConvertByAssimp(GlbOf(body), "fbxa")), VrmMaps());
    ASSERT_TRUE(imported.ok()) << imported.status().ToString();
    ExpectSamePoses(imported->character, ToyBody());
  }
}

TEST(ImportModel, RefusesRecordings) {
  const Folder folder;
  const char* const bvh =
      "HIERARCHY\nROOT hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
      "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.03\n0 0 0\n";
  const Status status = ImportModel(folder.Write("walk.bvh", bvh), VrmMaps()).status();
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_THAT(status.ToString(), HasSubstr("a recording, not a model"));
}

// A Collada file of `count` triangles, each with a material and a picture of its own.
std::string ColladaParts(int count) {
  std::string images, effects, materials, geometries, nodes;
  for (int i = 0; i < count; ++i) {
    const std::string n = std::to_string(i);
    images += "<image id='i" + n + "'><init_from>picture" + n + ".png</init_from></image>";
    effects += "<effect id='e" + n +
               "'><profile_COMMON><newparam sid='s'><surface type='2D'>"
               "<init_from>i" +
               n +
               "</init_from></surface></newparam><newparam sid='t'><sampler2D>"
               "<source>s</source></sampler2D></newparam><technique sid='c'><lambert><diffuse>"
               "<texture texture='t' texcoord='UV'/></diffuse></lambert></technique>"
               "</profile_COMMON></effect>";
    materials += "<material id='m" + n + "' name='material" + n + "'><instance_effect url='#e" + n +
                 "'/></material>";
    geometries += "<geometry id='g" + n + "' name='part" + n + "'><mesh><source id='p" + n +
                  "'><float_array id='a" + n +
                  "' count='9'>0 0 0 1 0 0 0 1 0</float_array>"
                  "<technique_common><accessor source='#a" +
                  n +
                  "' count='3' stride='3'>"
                  "<param name='X' type='float'/><param name='Y' type='float'/>"
                  "<param name='Z' type='float'/></accessor></technique_common></source>"
                  "<vertices id='v" +
                  n + "'><input semantic='POSITION' source='#p" + n +
                  "'/></vertices><triangles count='1' material='x'><input semantic='VERTEX' "
                  "source='#v" +
                  n + "' offset='0'/><p>0 1 2</p></triangles></mesh></geometry>";
    nodes += "<node id='n" + n + "' name='node" + n + "'><instance_geometry url='#g" + n +
             "'><bind_material><technique_common><instance_material symbol='x' target='#m" + n +
             "'/></technique_common></bind_material></instance_geometry></node>";
  }
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
         "version='1.4.1'><asset><up_axis>Y_UP</up_axis></asset><library_images>" +
         images + "</library_images><library_effects>" + effects +
         "</library_effects><library_materials>" + materials +
         "</library_materials><library_geometries>" + geometries +
         "</library_geometries><library_visual_scenes><visual_scene id='s'>" + nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>"
         "</COLLADA>";
}

// The first material adds the lists of textures and images to the document, which moves the others.
TEST(ImportModel, ReadsAllMaterialsWithTheirPictures) {
  const Folder folder;
  for (const int count : {1, 2, 5, 9}) {
    const auto opened = OpenModel(folder.Write("parts.dae", ColladaParts(count)));
    ASSERT_TRUE(opened.ok()) << opened.status().ToString();
    const character::Character& parts = opened->character;
    ASSERT_EQ(parts.meshes.size(), static_cast<std::size_t>(count));
    std::set<int> materials;
    for (const character::Mesh& part : parts.meshes) {
      ASSERT_LT(part.material, static_cast<int>(parts.materials.size())) << part.name;
      ASSERT_GE(part.material, 0) << part.name;
      materials.insert(part.material);
    }
    EXPECT_EQ(materials.size(), static_cast<std::size_t>(count));
  }
}

// glTF's default material.
TEST(ImportModel, MeshesWithoutAMaterialGetOne) {
  character::Character body = ToyBody();
  body.materials.clear();
  body.meshes[0].material = -1;
  const Folder folder;
  const auto imported = ImportModel(folder.Write("body.glb", GlbOf(body)), VrmMaps());
  ASSERT_TRUE(imported.ok()) << imported.status().ToString();
  ASSERT_EQ(imported->character.materials.size(), 1u);
  EXPECT_EQ(imported->character.meshes[0].material, 0);
  EXPECT_EQ(imported->character.materials[0].base_colour, glm::vec4(1.0f));
  EXPECT_EQ(imported->character.materials[0].roughness, 1.0f);
}

TEST(ImportModel, RecognisesGlbByContent) {
  const Folder folder;
  const auto imported = ImportModel(folder.Write("body.fbx", GlbOf(ToyBody())), VrmMaps());
  ASSERT_TRUE(imported.ok()) << imported.status().ToString();
  ExpectSamePoses(imported->character, ToyBody());
}

// A turned and scaled body is converted to Furrow's axes and units and poses as before.
class Space : public ::testing::TestWithParam<std::tuple<glm::mat3, float>> {};

TEST_P(Space, IsConverted) {
  character::Character body = ToyBody();
  const auto& [turn, scale] = GetParam();
  ASSERT_TRUE(MoveToSpace(turn, scale, &body).ok());
  const Folder folder;
  const auto imported = ImportModel(folder.Write("body.glb", GlbOf(body)), VrmMaps());
  ASSERT_TRUE(imported.ok()) << imported.status().ToString();
  ExpectSamePoses(imported->character, ToyBody());
  EXPECT_FALSE(imported->remarks.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, Space,
    ::testing::Values(std::tuple(glm::mat3(1, 0, 0, 0, 0, 1, 0, -1, 0), 1.0f),   // Z up
                      std::tuple(glm::mat3(-1, 0, 0, 0, 1, 0, 0, 0, -1), 1.0f),  // facing -Z
                      std::tuple(glm::mat3(1.0f), 100.0f),                       // centimetres
                      std::tuple(glm::mat3(0, 1, 0, 0, 0, 1, 1, 0, 0), 1000.0f)));

// The toy body with a shape that lifts everything above 1.4 m and a shape that moves its left hand.
character::Character MorphingBody() {
  character::Character body = ToyBody();
  body.shapes = {"lift", "wave"};
  std::vector<character::MorphDelta> lift, wave;
  character::Mesh& mesh = body.meshes[0];
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const glm::vec3& p = mesh.vertices[v].position;
    if (p.y > 1.4f) lift.push_back({v, glm::vec3(0, 0.05f, 0), {}, {}});
    if (p.x > 0.6f) wave.push_back({v, glm::vec3(0, 0.02f, 0.1f), {}, {}});
  }
  mesh.morph_targets = {{0, std::move(lift)}, {1, std::move(wave)}};
  return body;
}

// The deltas of a shape by the UVs of its vertices, because importers reorder vertices.
std::map<std::pair<int, int>, glm::vec3> DeltasOf(const character::Character& character,
                                                  const std::string& name) {
  std::map<std::pair<int, int>, glm::vec3> deltas;
  for (const character::Mesh& mesh : character.meshes) {
    for (const character::MorphTarget& target : mesh.morph_targets) {
      if (character.shapes[static_cast<std::size_t>(target.shape)] != name) continue;
      for (const character::MorphDelta& delta : target.deltas) {
        const glm::vec2 uv = mesh.vertices[delta.vertex].uv;
        if (delta.position == glm::vec3(0.0f)) continue;  // only its normal turns
        deltas[{static_cast<int>(std::lround(uv.x * 1000)),
                static_cast<int>(std::lround(uv.y * 1000))}] = delta.position;
      }
    }
  }
  return deltas;
}

void ExpectSameShapes(const character::Character& seen, const character::Character& due) {
  ASSERT_EQ(seen.shapes.size(), due.shapes.size());
  for (const std::string& name : due.shapes) {
    const auto a = DeltasOf(seen, name);
    const auto b = DeltasOf(due, name);
    ASSERT_EQ(a.size(), b.size()) << name;
    for (const auto& [uv, delta] : b) {
      const auto found = a.find(uv);
      ASSERT_NE(found, a.end()) << name;
      EXPECT_LT(glm::distance(found->second, delta), 1e-5f) << name;
    }
  }
}

TEST(ImportModel, TurnsAndScalesShapes) {
  const character::Character body = MorphingBody();
  character::Character moved = body;
  const glm::mat3 z_up(1, 0, 0, 0, 0, 1, 0, -1, 0);
  ASSERT_TRUE(MoveToSpace(z_up, 100.0f, &moved).ok());
  EXPECT_LT(glm::distance(moved.meshes[0].morph_targets[0].deltas[0].position, glm::vec3(0, 0, 5)),
            1e-4f);
  const Folder folder;
  const auto imported = ImportModel(folder.Write("body.glb", GlbOf(moved)), VrmMaps());
  ASSERT_TRUE(imported.ok()) << imported.status().ToString();
  ExpectSameShapes(imported->character, body);
}

TEST(ImportModel, ReadsShapesOfFbx) {
  const character::Character body = MorphingBody();
  const Folder folder;
  const auto imported =
      ImportModel(folder.Write("body.fbx", ConvertByAssimp(GlbOf(body), "fbxa")), VrmMaps());
  ASSERT_TRUE(imported.ok()) << imported.status().ToString();
  ExpectSameShapes(imported->character, body);
}

// The package keeps the note, so that the runtime knows.
TEST(ImportModel, NotesAMouthCloseThatContainsTheJaw) {
  character::Character body = ToyBody();
  body.shapes = {"jawOpen", "mouthClose"};
  const glm::vec3 down(0.0f, -0.03f, 0.0f);
  body.meshes[0].morph_targets = {
      {0, {{0, down, {}, {}}, {1, down, {}, {}}, {2, down, {}, {}}, {3, down, {}, {}}}},
      {1, {{0, down, {}, {}}, {1, down, {}, {}}, {2, down, {}, {}}, {3, down, {}, {}}}}};
  const Folder folder;
  const auto imported = ImportModel(folder.Write("body.glb", GlbOf(body)), VrmMaps());
  ASSERT_TRUE(imported.ok()) << imported.status().ToString();
  EXPECT_THAT(imported->remarks, Contains(HasSubstr("mouthClose opens the jaw itself")));
  const auto again = OpenModel(folder.Write("again.glb", GlbOf(imported->character)));
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  ASSERT_EQ(again->character.shape_rules.size(), 1u);
  EXPECT_EQ(again->character.shape_rules[0].shape, 1u);
  EXPECT_EQ(again->character.shape_rules[0].contains, 0u);
}

TEST(ImportModel, AcceptsAScale) {
  const Folder folder;
  const auto imported =
      ImportModel(folder.Write("body.glb", GlbOf(ToyBody())), VrmMaps(), {.scale = 2.0f});
  ASSERT_TRUE(imported.ok());
  const int head = imported->character.skeleton.Find("head");
  EXPECT_NEAR(imported->character.skeleton.rest_model()[head][3].y, 3.1f, 1e-4f);
}

Status StatusOf(const character::Character& character, const ModelOptions& options = {}) {
  const Folder folder;
  return ImportModel(folder.Write("bad.glb", GlbOf(character)), VrmMaps(), options).status();
}

TEST(ImportModel, TrianglesWithoutAreaAreRemoved) {
  character::Character body = ToyBody();
  const std::size_t indices = body.meshes[0].indices.size();
  body.meshes[0].vertices[1].position = body.meshes[0].vertices[0].position;
  const Folder folder;
  const auto imported = ImportModel(folder.Write("flat.glb", GlbOf(body)), VrmMaps());
  ASSERT_TRUE(imported.ok()) << imported.status().ToString();
  EXPECT_EQ(imported->character.meshes[0].indices.size(), indices - 3);
  EXPECT_THAT(imported->remarks, Contains(HasSubstr("without area: 1")));
}

TEST(ImportModel, UnskinnedVerticesAreAnErrorOrFollowTheirNeighbours) {
  character::Character body = ToyBody();
  const int vertex = 24 * 7 + 2;  // on the left hand
  for (float& weight : body.meshes[0].vertices[vertex].skin_weights) weight = 0.0f;
  const Status status = StatusOf(body);
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_THAT(status.what(), HasSubstr("1 vertex follows no joint"));
  const Folder folder;
  const auto repaired =
      ImportModel(folder.Write("bad.glb", GlbOf(body)), VrmMaps(), {.repair = true});
  ASSERT_TRUE(repaired.ok()) << repaired.status().ToString();
  EXPECT_EQ(repaired->character.meshes[0].vertices[vertex].joints[0],
            repaired->character.skeleton.Find("leftHand"));
}

TEST(ImportModel, OverlappingUvsAreAWarning) {
  character::Character body = ToyBody();
  for (std::size_t v = 0; v < 24; ++v) {
    body.meshes[0].vertices[v].uv = body.meshes[0].vertices[v + 24].uv;
  }
  const Folder folder;
  const auto imported = ImportModel(folder.Write("body.glb", GlbOf(body)), VrmMaps());
  ASSERT_TRUE(imported.ok());
  EXPECT_THAT(imported->warnings, Contains(HasSubstr("used twice")));
}

// Optimisers drop UVs that no texture uses, and low-poly models paint parts with one texel.
TEST(ImportModel, APartWithoutUvsStaysFlat) {
  character::Character body = ToyBody();
  body.materials.push_back(body.materials[0]);
  body.materials[1].name = "soles";
  body.meshes.push_back(body.meshes[0]);
  body.meshes[1].name = "soles";
  body.meshes[1].material = 1;
  for (character::Vertex& vertex : body.meshes[1].vertices) vertex.uv = {0.5f, 0.5f};
  const Folder folder;
  const auto imported = ImportModel(folder.Write("body.glb", GlbOf(body)), VrmMaps());
  ASSERT_TRUE(imported.ok()) << imported.status().ToString();
  EXPECT_TRUE(imported->character.materials[0].wrinkles);
  EXPECT_FALSE(imported->character.materials[1].wrinkles);
}

TEST(ImportModel, OtherFileTypesGiveOneClearError) {
  const Folder folder;
  const std::string fbx = ConvertByAssimp(GlbOf(ToyBody()), "fbxa");
  ASSERT_FALSE(fbx.empty());
  const std::pair<const char*, std::string> files[] = {
      {"picture.fbx", "\x89PNG\r\n\x1a\n" + std::string(200, 'x')},
      {"empty.fbx", ""},
      {"text.dae", "<html><body>no</body></html>"},
      {"cut.fbx", fbx.substr(0, fbx.size() / 3)},
      {"fbx.glb", fbx},
      {"notes.txt", "hello"}};
  for (const auto& [name, bytes] : files) {
    const Status status = ImportModel(folder.Write(name, bytes), VrmMaps()).status();
    EXPECT_FALSE(status.ok()) << name;
    EXPECT_THAT(status.where(), HasSubstr(name));
    EXPECT_THAT(status.what(), ::testing::Not(HasSubstr("\n"))) << name;
  }
  EXPECT_EQ(ImportModel("/no/such.fbx", VrmMaps()).status().code(), StatusCode::kNotFound);
}

// Truncated FBX files of every length return a status and never crash this process.
TEST(ImportModel, TruncatedFilesReturnAStatus) {
  const Folder folder;
  const std::string fbx = ConvertByAssimp(GlbOf(ToyBody()), "fbxa");
  for (std::size_t length = 0; length < fbx.size(); length += fbx.size() / 40 + 1) {
    const Status status = OpenModel(folder.Write("cut.fbx", fbx.substr(0, length))).status();
    EXPECT_FALSE(status.ok()) << length;
  }
}

// Those who play the package have neither the map nor the guess.
TEST(ImportModel, KeepsTheRolesOfTheJoints) {
  const Folder folder;
  const fs::path body = folder.Write("body.glb", GlbOf(ToyBody()));
  const auto imported = ImportModel(body, VrmMaps());
  ASSERT_TRUE(imported.ok()) << imported.status().ToString();
  const wrinkle::Skeleton& skeleton = imported->character.skeleton;
  ASSERT_EQ(imported->character.roles.size(), static_cast<std::size_t>(skeleton.num_joints()));
  for (std::size_t j = 0; j < imported->character.roles.size(); ++j) {
    EXPECT_EQ(wrinkle::ToString(imported->character.roles[j]), skeleton.joint_names()[j]);
  }
  EXPECT_THAT(imported->remarks, Contains(HasSubstr("roles by names of 'vrm'")));

  // They hold when the package is imported again without the map.
  character::Character odd = imported->character;
  std::swap(odd.roles[1], odd.roles[2]);
  const fs::path again = folder.Write("again.glb", GlbOf(odd));
  const rig::SkeletonMaps chosen_map = VrmMaps();
  const auto one = chosen_map.maps();
  const auto kept = ImportModel(again, rig::SkeletonMaps({one.begin(), one.end()}));
  ASSERT_TRUE(kept.ok()) << kept.status().ToString();
  EXPECT_EQ(kept->character.roles, odd.roles);
  EXPECT_THAT(kept->remarks, Contains(HasSubstr("roles stated by the file")));
  const auto chosen = ImportModel(again, chosen_map);
  ASSERT_TRUE(chosen.ok()) << chosen.status().ToString();
  EXPECT_EQ(chosen->character.roles, imported->character.roles) << "the user's choice wins";
}

}  // namespace
}  // namespace furrow::authoring
