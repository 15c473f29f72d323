// SPDX-License-Identifier: Apache-2.0
#include "character/package/package.h"

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "character/pictures/picture_file.h"
#include "gltf/container/glb.h"
#include "tests/temporary_folder.h"

namespace furrow::character {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

Vertex At(glm::vec3 position, glm::vec2 uv) {
  Vertex vertex;
  vertex.position = position;
  vertex.uv = uv;
  vertex.joints[1] = 1;
  vertex.skin_weights[0] = 0.75f;
  vertex.skin_weights[1] = 0.25f;
  return vertex;
}

// A square with two joints and a picture of two pixels.
Character Square() {
  Character c;
  c.name = "square";
  c.skeleton = *wrinkle::Skeleton::Create(
      {{"root", -1, {glm::vec3(0, 1, 0)}, {}},
       {"tip", 0, {glm::vec3(0, 0.5f, 0), glm::quat(0.6f, 0.8f, 0, 0)}, glm::vec3(0, 0.1f, 0.3f)}});
  for (const glm::mat4& rest : c.skeleton.rest_model()) {
    c.inverse_bind_matrices.push_back(glm::inverse(rest));
  }
  Mesh mesh;
  mesh.name = "face";
  mesh.material = 0;
  mesh.vertices = {At({0, 0, 0}, {0, 1}), At({1, 0, 0}, {1, 1}), At({1, 1, 0}, {1, 0}),
                   At({0, 1, 0}, {0, 0})};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  c.meshes.push_back(mesh);
  Material material;
  material.name = "anything";
  material.kind = Material::Kind::kCloth;
  material.base_colour = {0.5f, 0.25f, 1, 1};
  material.base_colour_texture = 0;
  material.double_sided = true;
  c.materials.push_back(material);
  Picture picture;
  picture.name = "mask.png";
  picture.width = 2;
  picture.height = 1;
  picture.pixels = {10, 20, 30, 0, 40, 50, 60, 128};
  c.pictures.push_back(picture);
  return c;
}

std::string GlbOf(const Character& character) {
  const TemporaryFolder folder;
  EXPECT_TRUE(SaveCharacterGlb(character, folder / "test.glb").ok());
  return *ReadFile(folder / "test.glb", 1u << 20);
}

std::string Words(std::initializer_list<std::size_t> words) {
  std::string bytes;
  for (const std::size_t word : words) {
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>((word >> shift) & 0xff);
  }
  return bytes;
}

// The square's file after `change` to its JSON and its buffer.
std::string Changed(const std::function<void(json&, std::string&)>& change) {
  const std::string glb = GlbOf(Square());
  const gltf::Container parts = *gltf::SplitContainer(glb);
  json root = json::parse(parts.json);
  std::string binary(parts.binary);
  change(root, binary);
  std::string text = root.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return "glTF" + Words({2, 12 + 8 + text.size() + 8 + binary.size(), text.size()}) + "JSON" +
         text + Words({binary.size()}) + std::string("BIN\0", 4) + binary;
}

// The offset in the buffer of an attribute of the first primitive.
std::size_t OffsetOf(const json& root, const char* attribute) {
  const int accessor = root["meshes"][0]["primitives"][0]["attributes"][attribute];
  return root["bufferViews"][root["accessors"][accessor]["bufferView"].get<int>()]["byteOffset"];
}

void PutFloat(std::string* binary, std::size_t at, float value) {
  binary->replace(at, 4, reinterpret_cast<const char*>(&value), 4);
}

TEST(Character, WrittenCharactersReadBackEqual) {
  const Character square = Square();
  const auto again = ParseCharacter(GlbOf(square), ".");
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(again->name, "square");
  EXPECT_EQ(again->skeleton.hash(), square.skeleton.hash());
  EXPECT_EQ(again->inverse_bind_matrices, square.inverse_bind_matrices);
  ASSERT_EQ(again->meshes.size(), 1u);
  EXPECT_EQ(again->meshes[0].name, "face");
  EXPECT_EQ(again->meshes[0].indices, square.meshes[0].indices);
  for (int v = 0; v < 4; ++v) {
    const Vertex& a = square.meshes[0].vertices[v];
    const Vertex& b = again->meshes[0].vertices[v];
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.normal, b.normal);
    EXPECT_EQ(a.tangent, b.tangent);
    EXPECT_EQ(a.uv, b.uv);
    EXPECT_EQ(b.joints[1], 1);
    EXPECT_EQ(b.skin_weights[0], 0.75f);
  }
  ASSERT_EQ(again->materials.size(), 1u);
  EXPECT_EQ(again->materials[0].kind, Material::Kind::kCloth);
  EXPECT_EQ(again->materials[0].base_colour, square.materials[0].base_colour);
  EXPECT_EQ(again->materials[0].base_colour_texture, 0);
  EXPECT_TRUE(again->materials[0].double_sided);
  ASSERT_EQ(again->pictures.size(), 1u);
  EXPECT_EQ(again->pictures[0].name, "mask.png");
  EXPECT_EQ(again->pictures[0].pixels, square.pictures[0].pixels)
      << "texels with alpha 0 keep their colours";
}

TEST(Character, KeepsTheRolesOfItsJoints) {
  Character square = Square();
  square.roles = {wrinkle::JointRole::kNeck, wrinkle::JointRole::kNone};
  const std::string glb = GlbOf(square);
  const auto again = ParseCharacter(glb, ".");
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(again->roles, square.roles);
  EXPECT_EQ(again->skeleton.hash(), square.skeleton.hash()) << "tails are extras, too";
  EXPECT_TRUE(ParseCharacter(GlbOf(Square()), ".")->roles.empty()) << "as in old packages";

  const TemporaryFolder folder;
  ASSERT_TRUE(SaveCharacterGlb(square, folder / "square.glb").ok());
  const auto roles = LoadCharacterRoles(folder / "square.glb");
  ASSERT_TRUE(roles.ok()) << roles.status().ToString();
  EXPECT_THAT(*roles, ElementsAre(std::pair("root", wrinkle::JointRole::kNeck),
                                  std::pair("tip", wrinkle::JointRole::kNone)));
  square.roles.pop_back();
  EXPECT_EQ(SaveCharacterGlb(square, folder / "square.glb").code(), StatusCode::kInvalidArgument);
}

// One error names the field, whoever reads the roles.
TEST(Character, RejectsRolesThatAreNone) {
  const TemporaryFolder folder;
  for (const json& role :
       {json("elbow"), json("none"), json(""), json(7), json(-1), json(1e300),
        json::array({"hips"}), json::object({{"hips", 1}}), json(true),
        json(std::string(100'000, 'x')), json(std::string("hips\0", 5)), json("Hips")}) {
    const std::string glb =
        Changed([&](json& r, std::string&) { r["nodes"][1]["extras"]["furrow_role"] = role; });
    const auto character = ParseCharacter(glb, ".");
    ASSERT_FALSE(character.ok()) << role;
    EXPECT_EQ(character.status().code(), StatusCode::kSchema);
    EXPECT_EQ(character.status().where(), "nodes[1].extras.furrow_role");
    EXPECT_LT(character.status().ToString().size(), 250u);
    ASSERT_TRUE(WriteFileAtomically(folder / "odd.glb", glb).ok());
    const auto roles = LoadCharacterRoles(folder / "odd.glb");
    ASSERT_FALSE(roles.ok()) << role;
    EXPECT_EQ(roles.status().code(), StatusCode::kSchema);
    EXPECT_THAT(roles.status().where(), HasSubstr("odd.glb: nodes[1].extras.furrow_role"));
  }
}

TEST(Character, WritesEqualBytesForEqualCharacters) {
  const std::string first = GlbOf(Square());
  EXPECT_EQ(first, GlbOf(Square()));
  EXPECT_EQ(first, GlbOf(*ParseCharacter(first, ".")));
}

TEST(Character, RejectsInvalidCharactersOnSave) {
  const TemporaryFolder folder;
  const fs::path path = folder / "broken.glb";
  Character broken = Square();
  broken.meshes[0].indices[0] = 4;
  const Status status = SaveCharacterGlb(broken, path);
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.where(), HasSubstr("indices"));
  broken = Square();
  broken.pictures[0].width = 3;
  EXPECT_EQ(SaveCharacterGlb(broken, path).code(), StatusCode::kInvalidArgument);
  broken = Square();
  broken.inverse_bind_matrices.pop_back();
  EXPECT_EQ(SaveCharacterGlb(broken, path).code(), StatusCode::kInvalidArgument);
  EXPECT_FALSE(fs::exists(path));
}

TEST(Character, RejectsEveryTruncation) {
  const std::string whole = GlbOf(Square());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string part(whole.data(), length);  // exact size, for the sanitizers
    const auto character = ParseCharacter(part, ".");
    ASSERT_FALSE(character.ok()) << length;
    ASSERT_EQ(character.status().code(), StatusCode::kParse) << character.status().ToString();
  }
  const auto longer = ParseCharacter(whole + '\0', ".");
  ASSERT_TRUE(longer.ok()) << longer.status().ToString();
  EXPECT_THAT(longer->warnings, ElementsAre("header.length: ignored 1 byte after the stated end"));
}

struct Wrong {
  const char* name;
  std::function<void(json&, std::string&)> change;
  StatusCode code;
  const char* where;
};

class CharacterErrors : public ::testing::TestWithParam<Wrong> {};

TEST_P(CharacterErrors, NameTheField) {
  const auto character = ParseCharacter(Changed(GetParam().change), ".");
  ASSERT_FALSE(character.ok());
  EXPECT_EQ(character.status().code(), GetParam().code) << character.status().ToString();
  EXPECT_EQ(character.status().where(), GetParam().where) << character.status().ToString();
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    All, CharacterErrors,
    ::testing::Values(
        Wrong{"cycle", [](json& r, std::string&) { r["nodes"][1]["children"] = {0}; },
              StatusCode::kCyclic, "nodes[0].children"},
        Wrong{"self", [](json& r, std::string&) { r["nodes"][2]["children"] = {2}; },
              StatusCode::kCyclic, "nodes[2].children"},
        Wrong{"child", [](json& r, std::string&) { r["nodes"][0]["children"] = {99}; },
              StatusCode::kSchema, "nodes[0].children"},
        Wrong{"rotation", [](json& r, std::string&) { r["nodes"][1]["rotation"] = {0, 0, 0, 0}; },
              StatusCode::kSchema, "nodes[1].rotation"},
        Wrong{"huge", [](json& r, std::string&) { r["nodes"][1]["translation"] = {0, 1e200, 0}; },
              StatusCode::kNonFinite, "nodes[1].translation"},
        Wrong{"skin joint", [](json& r, std::string&) { r["skins"][0]["joints"] = {0, 77}; },
              StatusCode::kSchema, "skins[0].joints"},
        Wrong{"bind", [](json& r, std::string& b) {
                PutFloat(&b, r["bufferViews"][0]["byteOffset"], kNan);
              }, StatusCode::kNonFinite, "skins[0].inverseBindMatrices"},
        Wrong{"mesh", [](json& r, std::string&) { r["nodes"][2]["mesh"] = 5; }, StatusCode::kSchema,
              "nodes[2].mesh"},
        Wrong{"view", [](json& r, std::string&) { r["bufferViews"][1]["byteLength"] = 1u << 30; },
              StatusCode::kSchema, "bufferViews[1].byteLength"},
        Wrong{"view offset", [](json& r, std::string&) { r["bufferViews"][1]["byteOffset"] = -4; },
              StatusCode::kSchema, "bufferViews[1].byteOffset"},
        Wrong{"buffer", [](json& r, std::string&) { r["bufferViews"][0]["buffer"] = 1; },
              StatusCode::kSchema, "bufferViews[0].buffer"},
        Wrong{"no bytes", [](json& r, std::string&) { r["buffers"][0]["byteLength"] = 0; },
              StatusCode::kSchema, "buffers[0].byteLength"},
        Wrong{"count", [](json& r, std::string&) { r["accessors"][1]["count"] = 1000000000u; },
              StatusCode::kLimit, "meshes[0].primitives[0].attributes.POSITION"},
        Wrong{"counts differ", [](json& r, std::string&) { r["accessors"][2]["count"] = 3; },
              StatusCode::kSchema, "meshes[0].primitives[0].attributes.NORMAL"},
        Wrong{"type", [](json& r, std::string&) { r["accessors"][1]["type"] = "VEC2"; },
              StatusCode::kSchema, "meshes[0].primitives[0].attributes.POSITION"},
        Wrong{"nan", [](json& r, std::string& b) { PutFloat(&b, OffsetOf(r, "POSITION"), kNan); },
              StatusCode::kNonFinite, "meshes[0].primitives[0].attributes.POSITION"},
        Wrong{"negative", [](json& r, std::string& b) {
                PutFloat(&b, OffsetOf(r, "WEIGHTS_0"), -1.0f);
              }, StatusCode::kInvalidArgument, "meshes[0].primitives[0].attributes.WEIGHTS_0"},
        Wrong{"no weight", [](json& r, std::string& b) {
                PutFloat(&b, OffsetOf(r, "WEIGHTS_0"), 0.0f);
                PutFloat(&b, OffsetOf(r, "WEIGHTS_0") + 4, 0.0f);
              }, StatusCode::kInvalidArgument, "meshes[0].primitives[0].attributes.WEIGHTS_0"},
        Wrong{"joint", [](json& r, std::string& b) { b[OffsetOf(r, "JOINTS_0")] = 9; },
              StatusCode::kSchema, "meshes[0].primitives[0].attributes.JOINTS_0"},
        Wrong{"index", [](json& r, std::string& b) {
                const int a = r["meshes"][0]["primitives"][0]["indices"];
                b[r["bufferViews"][r["accessors"][a]["bufferView"].get<int>()]["byteOffset"]
                      .get<std::size_t>()] = 4;
              }, StatusCode::kSchema, "meshes[0].primitives[0].indices"},
        Wrong{"lines", [](json& r, std::string&) { r["meshes"][0]["primitives"][0]["mode"] = 1; },
              StatusCode::kSchema, "nodes"},  // lines are left out, and nothing remains
        Wrong{"material", [](json& r, std::string&) {
                r["meshes"][0]["primitives"][0]["material"] = 3;
              }, StatusCode::kSchema, "meshes[0].primitives[0].material"},
        Wrong{"texture", [](json& r, std::string&) { r["textures"][0]["source"] = 8; },
              StatusCode::kSchema, "textures[0].source"},
        Wrong{"picture", [](json& r, std::string& b) {
                b[r["bufferViews"].back()["byteOffset"].get<std::size_t>()] = 'x';
              }, StatusCode::kUnsupported, "images[0]"},
        Wrong{"outside", [](json& r, std::string&) {
                r["images"][0] = {{"uri", "../../etc/passwd"}};
              }, StatusCode::kInvalidArgument, "images[0]"},
        Wrong{"draco", [](json& r, std::string&) {
                r["extensionsRequired"] = {"KHR_draco_mesh_compression"};
              }, StatusCode::kUnsupported, "extensionsRequired"},
        Wrong{"deep", [](json& r, std::string&) {
                json deep = 1;
                for (int i = 0; i < 100; ++i) deep = json::array({deep});
                r["extras"] = deep;
              }, StatusCode::kLimit, "json"}),
    [](const auto& test) {
      std::string name = test.param.name;
      for (char& c : name) c = c == ' ' ? '_' : c;
      return name;
    });

TEST(Character, LoadsDeviatingFilesWithWarnings) {
  const auto character =
      ParseCharacter(Changed([](json& r, std::string&) {
                       r["nodes"][1]["name"] = "root";
                       r["nodes"][1].erase("rotation");
                       r["nodes"][1].erase("translation");
                       r["nodes"][1]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1};
                       r["extensionsRequired"] = {"EXT_something"};
                     }),
                     ".");
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_THAT(character->skeleton.joint_names(), ElementsAre("root", "root_2"));
  EXPECT_EQ(character->skeleton.rest_pose()[1].translation, glm::vec3(0, 1, 0));
  EXPECT_THAT(character->warnings,
              ElementsAre(HasSubstr("extensionsRequired: the extension 'EXT_something'"),
                          HasSubstr("nodes[1].matrix: the matrix has shear"),
                          HasSubstr("nodes[1].name: several joints are called 'root'")));
}

TEST(Character, KeepsTheStrongestFourInfluences) {
  // Adds a second set of influences equal to the first.
  const auto character = ParseCharacter(Changed([](json& r, std::string& b) {
                                          const auto offset = OffsetOf(r, "WEIGHTS_0");
                                          for (int v = 0; v < 4; ++v) {
                                            for (int i = 0; i < 4; ++i)
                                              PutFloat(&b, offset + 16 * v + 4 * i, 0.1f * (i + 1));
                                          }
                                          auto& attributes =
                                              r["meshes"][0]["primitives"][0]["attributes"];
                                          attributes["JOINTS_1"] = attributes["JOINTS_0"];
                                          attributes["WEIGHTS_1"] = attributes["WEIGHTS_0"];
                                        }),
                                        ".");
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  const Vertex& vertex = character->meshes[0].vertices[0];
  // 0.4, 0.4, 0.3, 0.3 of 1.4.
  EXPECT_NEAR(vertex.skin_weights[0], 0.4 / 1.4, 1e-6);
  EXPECT_NEAR(vertex.skin_weights[3], 0.3 / 1.4, 1e-6);
}

TEST(Character, ComputesMissingNormalsAndTangents) {
  const auto character = ParseCharacter(Changed([](json& r, std::string&) {
                                          auto& attributes =
                                              r["meshes"][0]["primitives"][0]["attributes"];
                                          attributes.erase("NORMAL");
                                          attributes.erase("TANGENT");
                                        }),
                                        ".");
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  for (const Vertex& vertex : character->meshes[0].vertices) {
    EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
    // u increases along +X and v decreases along +Y, so the texture is not mirrored.
    EXPECT_EQ(vertex.tangent, glm::vec4(1, 0, 0, 1));
  }
}

// The meshes keep the UVs of the tile; viewers that know KHR_texture_transform find the texture.
TEST(Character, TilesOfAnAtlasReadBackEqual) {
  Character square = Square();
  Material& material = square.materials[0];
  material.texture_scale = {2.0f, 4.0f};
  material.texture_offset = {-1.0f, 0.25f};
  material.normal_texture = 0;
  material.thickness = 0.01f;
  material.thickness_texture = 0;
  const std::string glb = GlbOf(square);
  const auto again = ParseCharacter(glb, ".");
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(again->materials[0].texture_scale, material.texture_scale);
  EXPECT_EQ(again->materials[0].texture_offset, material.texture_offset);
  EXPECT_EQ(again->meshes[0].vertices[1].uv, square.meshes[0].vertices[1].uv);
  json root = json::parse(gltf::SplitContainer(glb)->json);
  EXPECT_THAT(root["extensionsUsed"],
              ::testing::ElementsAre("KHR_texture_transform", "KHR_materials_volume"));
  // Without the mark, the transform moves the UVs, as in any other file.
  const std::string plain = Changed([&](json& changed, std::string&) {
    changed["materials"] = root["materials"];
    changed["materials"][0]["extras"].erase("furrow_atlas_tile");
  });
  const auto moved = ParseCharacter(plain, ".");
  ASSERT_TRUE(moved.ok()) << moved.status().ToString();
  EXPECT_EQ(moved->materials[0].texture_scale, glm::vec2(1.0f));
  EXPECT_EQ(moved->meshes[0].vertices[1].uv, glm::vec2(1.0f, 4.25f));
}

TEST(Character, FindsThePicturesOfTheRig) {
  const fs::path folder = fs::temp_directory_path() / "furrow_character_rig";
  fs::create_directories(folder);
  ASSERT_TRUE(SaveCharacterGlb(Square(), folder / "square.glb").ok());
  ASSERT_TRUE(WriteFileAtomically(folder / "square.rig.json", R"({"name": "r",
    "drivers": [{"name": "d", "blend_shape": {"blend_shape": "jawOpen"}}],
    "regions": [{"name": "face", "mask": {"texture": "mask.png"},
                 "feeds": [{"map": "m", "sources": [{"from": "d.value"}]}]}],
    "wrinkle_maps": [{"name": "m", "normal": "beside.png", "cavity": "nowhere.png"}]})")
                  .ok());
  Picture picture = Square().pictures[0];
  ASSERT_TRUE(WriteFileAtomically(folder / "beside.png", *EncodePng(picture)).ok());
  const auto character = LoadCharacter(folder / "square.glb");
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_EQ(character->rig.name, "r");
  EXPECT_EQ(character->FindRigPicture("mask.png"), 0) << "expected the picture inside the file";
  EXPECT_EQ(character->FindRigPicture("beside.png"), 1);
  EXPECT_EQ(character->FindRigPicture("nowhere.png"), -1);
  EXPECT_THAT(character->missing_rig_pictures, ::testing::ElementsAre("nowhere.png"));

  ASSERT_TRUE(WriteFileAtomically(folder / "beside.png", "\x89PNG\r\n\x1a\n damaged").ok());
  const Status damaged = LoadCharacter(folder / "square.glb").status();
  EXPECT_EQ(damaged.code(), StatusCode::kParse);
  EXPECT_EQ(damaged.where(), (folder / "beside.png").string());

  // The damaged file is not read. The use of a picture decides how its stand-in looks.
  const auto draft = LoadCharacter(folder / "square.glb", {}, {}, Pictures::kColours);
  ASSERT_TRUE(draft.ok()) << draft.status().ToString();
  EXPECT_EQ(draft->pictures.front().pixels, picture.pixels) << "a base colour is decoded";
  EXPECT_EQ(draft->materials.front().base_colour_texture, 0);
  const Picture& flat =
      draft->pictures.at(static_cast<std::size_t>(draft->FindRigPicture("beside.png")));
  EXPECT_GT(flat.width, 1);
  EXPECT_EQ(flat.pixels[2], 255) << "a normal that points up";
  const auto stand_ins = LoadCharacter(folder / "square.glb", {}, {}, Pictures::kStandIns);
  ASSERT_TRUE(stand_ins.ok()) << stand_ins.status().ToString();
  EXPECT_EQ(stand_ins->pictures.size(), draft->pictures.size());
  EXPECT_EQ(stand_ins->pictures.front().pixels[0], 0) << "an empty mask";

  const auto alone = LoadCharacter(folder / "square.glb", {}, {}, Pictures::kLeaveOut);
  ASSERT_TRUE(alone.ok()) << alone.status().ToString();
  EXPECT_EQ(alone->rig.name, "r");
  EXPECT_EQ(alone->meshes.size(), character->meshes.size());
  EXPECT_TRUE(alone->pictures.empty());
  EXPECT_EQ(alone->materials.front().base_colour_texture, -1);
  fs::remove_all(folder);
}

TEST(Character, NamesTheFile) {
  EXPECT_EQ(LoadCharacter("no/such.glb").status().where(), "no/such.glb");
  const fs::path empty = fs::temp_directory_path() / "furrow_empty.glb";
  ASSERT_TRUE(WriteFileAtomically(empty, "").ok());
  const Status status = LoadCharacter(empty).status();
  fs::remove(empty);
  EXPECT_EQ(status.code(), StatusCode::kParse);
  EXPECT_EQ(status.where(), empty.string() + ": header");
  EXPECT_THAT(status.what(), HasSubstr("empty"));
}

TEST(Package, FindsShippedCharactersByName) {
  const TemporaryFolder folder;
  ASSERT_TRUE(SaveCharacterGlb(Square(), folder / "elder.glb").ok());
  setenv("FURROW_DATA_DIR", folder.path().c_str(), 1);
  EXPECT_EQ(FindCharacterFile("elder"), folder / "elder.glb");
  EXPECT_EQ(FindCharacterFile("elder.glb"), folder / "elder.glb");
  EXPECT_EQ(FindCharacterFile((folder / "elder.glb").string()), folder / "elder.glb");
  EXPECT_EQ(FindCharacterFile("./elder"), "./elder");
  EXPECT_EQ(FindCharacterFile("nobody"), "nobody");
  EXPECT_TRUE(LoadCharacter(FindCharacterFile("elder")).ok());
  const Status unknown = LoadCharacter(FindCharacterFile("eldr")).status();
  EXPECT_EQ(unknown.code(), StatusCode::kNotFound);
  EXPECT_THAT(unknown.ToString(), HasSubstr("did you mean 'elder'? shipped characters: elder"));
  EXPECT_EQ(LoadCharacter("no/such.glb").status().what(), "no such file");
  unsetenv("FURROW_DATA_DIR");
}

}  // namespace
}  // namespace furrow::character
