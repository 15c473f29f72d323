// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/export_package.h"

#include <map>
#include <string>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "character/pictures/picture_file.h"
#include "render/wrinkles/derivative_map.h"
#include "tests/unit/authoring/export/small_face.h"

namespace furrow::authoring {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

using Files = std::map<std::string, std::string>;

Files Export(const character::Character& face, const ExportOptions& options) {
  Files files;
  const auto done =
      ExportCharacter(face, options, [&](const std::string& name, std::string_view bytes) {
        EXPECT_TRUE(files.emplace(name, bytes).second) << name << " is written twice";
        return Status();
      });
  EXPECT_TRUE(done.ok()) << done.status().ToString();
  EXPECT_EQ(done.ok() ? done->names.size() : 0, files.size());
  return files;
}

Files ExportFor(Engine engine) {
  ExportOptions options;
  options.engine = engine;
  options.generator = "furrow test";
  return Export(test::SmallFace(), options);
}

character::Picture Decoded(const Files& files, const std::string& name) {
  const std::string& bytes = files.at(name);
  auto picture = character::DecodePicture(
      name, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  EXPECT_TRUE(picture.ok()) << picture.status().ToString();
  return *picture;
}

class EveryEngine : public ::testing::TestWithParam<Engine> {};

TEST_P(EveryEngine, WrinklesJsonNamesFilesThatExist) {
  const Files files = ExportFor(GetParam());
  const Json json = Json::parse(files.at("wrinkles.json"));
  EXPECT_EQ(json["engine"], TraitsOf(GetParam()).name);
  int named = 0;
  const auto check = [&](const Json& name) {
    if (name.is_null()) return;
    EXPECT_EQ(files.count(name.get<std::string>()), 1u) << name;
    ++named;
  };
  for (const Json& map : json["maps"]) {
    for (const char* part : {"normal", "height", "colour", "cavity"}) check(map[part]);
  }
  for (const Json& mask : json["masks"]) check(mask["file"]);
  for (const Json& material : json["materials"]) check(material["shader"]);
  const bool has_shaders = GetParam() != Engine::kBlender;  // nodes.py builds them
  EXPECT_EQ(named, 3 + 3 + 2 + (has_shaders ? 2 : 0));
}

TEST_P(EveryEngine, NothingOfATemplateIsLeft) {
  ExportOptions options;
  options.engine = GetParam();
  for (const bool derivatives : {false, true}) {
    options.derivatives = derivatives;
    for (const auto& [name, text] : Export(test::SmallFace(), options)) {
      if (name.ends_with(".png")) continue;
      EXPECT_THAT(text, Not(HasSubstr("@{"))) << name;
      EXPECT_THAT(text, Not(HasSubstr("@each"))) << name;
      EXPECT_THAT(text, Not(HasSubstr("@end"))) << name;
      EXPECT_THAT(text, Not(HasSubstr("@if"))) << name;
      EXPECT_FALSE(text.empty()) << name;
    }
  }
}

// Rebuilds the normals of a map as README.md says, and compares them with the normal map.
void ExpectSameRelief(const Files& files, const Json& normal, const Json& derivative, float scale) {
  const character::Picture normals = Decoded(files, normal.get<std::string>());
  const character::Picture slopes = Decoded(files, derivative.get<std::string>());
  ASSERT_EQ(normals.width, slopes.width);
  ASSERT_EQ(normals.height, slopes.height);
  for (int y = 0; y < normals.height; ++y) {
    for (int x = 0; x < normals.width; ++x) {
      const auto unpack = [&](const character::Picture& picture, int c) {
        return 2.0f * render::Texel(picture, x, y, c) - 1.0f;
      };
      const glm::vec3 rebuilt =
          glm::normalize(glm::vec3(-scale * unpack(slopes, 0), -scale * unpack(slopes, 1), 1.0f));
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(rebuilt[c], unpack(normals, c), 2.0f / 255.0f) << derivative << " " << x << y;
      }
    }
  }
}

TEST_P(EveryEngine, DerivativesGiveTheNormals) {
  ExportOptions options;
  options.engine = GetParam();
  options.derivatives = true;
  character::Character face = test::SmallFace();
  // Slopes of many sizes and directions, as a base.
  face.materials[0].normal_texture = static_cast<int>(face.pictures.size());
  face.pictures.push_back(test::MakePicture("pores", 16, 16, 3, [](int x, int y, int c) {
    return c == 0 ? 20 + 14 * x : c == 1 ? 20 + 14 * y : 190;
  }));
  const Files files = Export(face, options);
  const Json json = Json::parse(files.at("wrinkles.json"));
  EXPECT_EQ(json["derivatives"]["bits"], 16);
  EXPECT_EQ(json["derivatives"]["green"], json["normals"]["green"]);
  for (const Json& map : json["maps"]) {
    ExpectSameRelief(files, map["normal"], map["derivative"], map["derivative_scale"]);
  }
  const Json& skin = json["materials"][0];
  ExpectSameRelief(files, skin["base_normal"], skin["base_derivative"],
                   skin["base_derivative_scale"]);
  EXPECT_THAT(files.at("README.md"), HasSubstr("normalize(-d.x, -d.y, 1)"));
}

TEST_P(EveryEngine, DerivativesAreOnlyWrittenOnRequest) {
  const Files files = ExportFor(GetParam());
  for (const auto& [name, text] : files) EXPECT_THAT(name, Not(HasSubstr("derivative")));
  EXPECT_THAT(files.at("wrinkles.json"), Not(HasSubstr("derivative")));
  EXPECT_THAT(files.at("README.md"), Not(HasSubstr("erivative")));
}

TEST_P(EveryEngine, ReadmeNamesTheWeights) {
  const std::string readme = ExportFor(GetParam()).at("README.md");
  EXPECT_THAT(readme, HasSubstr("brow_l.squash"));
  EXPECT_THAT(readme, HasSubstr(std::string(TraitsOf(GetParam()).title)));
  // Two normal maps, a colour, a cavity and a mask.
  EXPECT_THAT(readme, HasSubstr("`skin`, shader name `skin`, 5 textures:"));
}

TEST_P(EveryEngine, EqualInputsGiveEqualFiles) {
  EXPECT_EQ(ExportFor(GetParam()), ExportFor(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(ExportPackage, EveryEngine,
                         ::testing::Values(Engine::kGeneric, Engine::kUnity, Engine::kUnreal,
                                           Engine::kGodot, Engine::kBlender, Engine::kThree),
                         [](const auto& tested) {
                           return std::string(TraitsOf(tested.param).name);
                         });

TEST(ExportPackage, WeightsSayWhatRaisesThem) {
  const Json json = Json::parse(ExportFor(Engine::kGodot).at("wrinkles.json"));
  EXPECT_EQ(json["format"], "furrow-wrinkles");
  EXPECT_EQ(json["version"], 1);
  EXPECT_EQ(json["generator"], "furrow test");
  const Json& squash = json["weights"][1];
  EXPECT_EQ(squash["name"], "brow_l.squash");
  EXPECT_EQ(squash["index"], 1);
  EXPECT_EQ(squash["map"], 1);
  EXPECT_EQ(squash["mask"], 0);
  EXPECT_EQ(squash["channel"], "r");
  EXPECT_EQ(squash["strength"], 0.5);
  EXPECT_EQ(squash["parameter"], "furrow_brow_l_squash");
  EXPECT_EQ(squash["drivers"]["modulation"], "cosine");
  EXPECT_EQ(squash["drivers"]["sources"][0]["driver"], "brow");
  EXPECT_EQ(json["weights"][4]["drivers"]["angles"], Json::parse("[[12.0, 0.0], [45.0, 1.0]]"));
  EXPECT_TRUE(json["weights"][5]["map"].is_null());
  EXPECT_EQ(json["maps"][1]["height_mm"], 3.0);
  EXPECT_EQ(json["maps"][1]["colour_scale"], 1.25);
  EXPECT_TRUE(json["maps"][0]["height"].is_null());
  EXPECT_EQ(json["masks"][0]["channels"], Json::parse(R"(["brow_l", "brow_r", null, null])"));
}

TEST(ExportPackage, WeightsHaveTheirNamesInOtherSystems) {
  character::Character face = test::SmallFace();
  face.rig.exports = {{"own", "brow_r.squash", "Frown_R"}};
  const std::vector<rig::ExportProfile> profiles = {
      {"other", "", {{"down", {"brow_l.squash", "brow_r.squash"}}}}};
  ExportOptions options;
  options.profiles = profiles;
  const Json json = Json::parse(Export(face, options).at("wrinkles.json"));
  EXPECT_EQ(json["weights"][1]["names"], Json::parse(R"({"other": ["down"]})"));
  EXPECT_EQ(json["weights"][3]["names"], Json::parse(R"({"other": ["down"], "own": ["Frown_R"]})"));
  EXPECT_EQ(json["weights"][0]["names"], Json::object());
}

TEST(ExportPackage, NormalMapsFollowTheEngine) {
  const auto green = [](Engine engine) {
    return Decoded(ExportFor(engine), "textures/squash_normal.png");
  };
  const auto unity = green(Engine::kUnity);
  const auto unreal = green(Engine::kUnreal);
  ASSERT_EQ(unity.pixels.size(), unreal.pixels.size());
  EXPECT_EQ(unity.pixels[1], 54);
  EXPECT_EQ(unreal.pixels[1], 201);
  EXPECT_FALSE(green(Engine::kBlender).pixels16.empty());
  ExportOptions options;
  options.engine = Engine::kBlender;
  options.bits = 8;
  EXPECT_FALSE(
      Decoded(Export(test::SmallFace(), options), "textures/squash_normal.png").pixels.empty());
}

TEST(ExportPackage, ShadersSumTheWeightsOfEachMap) {
  const std::string glsl = ExportFor(Engine::kThree).at("shaders/furrow_skin.glsl");
  EXPECT_THAT(glsl, HasSubstr("#define FURROW_WEIGHTS 6\n"));
  EXPECT_THAT(glsl,
              HasSubstr("c += dot(mask0, vec4(furrowWeights[0], furrowWeights[2], 0.0, 0.0));"));
  EXPECT_THAT(glsl,
              HasSubstr("c += dot(mask0, vec4(furrowWeights[1], furrowWeights[3], 0.0, 0.0));"));
  EXPECT_THAT(glsl, HasSubstr("slope += 0.5 * c * furrowSlope(texture(furrowNormal1, uv).xyz);"));
  EXPECT_THAT(glsl, HasSubstr("1.25 * furrowLinear(texture(furrowColour1, uv).rgb)"));
  const std::string unreal = ExportFor(Engine::kUnreal).at("shaders/Furrow_skin.ush");
  EXPECT_THAT(unreal, HasSubstr("float4(Weights0.y, Weights0.w, 0.0, 0.0)"));
  const std::string unity = ExportFor(Engine::kUnity).at("shaders/Furrow_shirt.hlsl");
  EXPECT_THAT(unity, HasSubstr("float4(_FurrowWeights[4], 0.0, 0.0, 0.0)"));
  const std::string godot = ExportFor(Engine::kGodot).at("shaders/furrow_shirt.shader");
  EXPECT_THAT(godot, HasSubstr("uniform float furrow_knee_folds : hint_range(0.0, 1.0) = 0.0;"));
  EXPECT_THAT(godot, Not(HasSubstr("furrow_brow_l_squash")));
}

// Each engine's plug-in needs a file of its own, but there is one blend.
TEST(ExportPackage, UnityAndUnrealShareTheBlend) {
  EXPECT_EQ(ExportFor(Engine::kUnity).at("shaders/FurrowWrinkles.hlsl"),
            ExportFor(Engine::kUnreal).at("shaders/FurrowWrinkles.ush"));
}

TEST(ExportPackage, TilesOfAnAtlasMoveTheBaseTextures) {
  character::Character face = test::SmallFace();
  face.materials[0].normal_texture = 0;
  face.materials[0].texture_scale = {2.0f, 4.0f};
  face.materials[0].texture_offset = {0.0f, -0.5f};
  ExportOptions options;
  EXPECT_THAT(Export(face, options).at("shaders/furrow_skin.glsl"),
              HasSubstr("(uv * vec2(2.0, 4.0) + vec2(0.0, -0.5))"));
  // v from the bottom: 1 - (4 (1 - v) - 0.5) = 4 v - 2.5.
  options.engine = Engine::kUnity;
  EXPECT_THAT(Export(face, options).at("shaders/Furrow_skin.hlsl"),
              HasSubstr("(uv * float2(2.0, 4.0) + float2(0.0, -2.5))"));
}

// Godot's material is replaced as a whole.
TEST(ExportPackage, GodotKeepsBothSidesAndHoles) {
  character::Character face = test::SmallFace();
  face.materials[1].double_sided = true;
  face.materials[1].alpha_cutoff = 0.25f;
  ExportOptions options;
  options.engine = Engine::kGodot;
  const Files files = Export(face, options);
  for (const char* name : {"shaders/furrow_shirt.shader", "shaders/furrow_shirt.gdshader"}) {
    EXPECT_THAT(files.at(name), HasSubstr("shader_type spatial;\nrender_mode cull_disabled;\n"));
    EXPECT_THAT(files.at(name), HasSubstr("ALPHA = base_colour_factor.a;\n\tALPHA_SCISSOR"));
    EXPECT_THAT(files.at(name), HasSubstr(" = 0.25;\n"));
  }
  EXPECT_THAT(files.at("shaders/furrow_skin.shader"), Not(HasSubstr("cull_disabled")));
  EXPECT_THAT(files.at("shaders/furrow_skin.shader"), Not(HasSubstr("ALPHA")));
}

TEST(ExportPackage, RefusesWeightsThatShareAParameter) {
  character::Character face = test::SmallFace();
  face.rig.regions[1].name = "brow-l";
  const auto done =
      ExportCharacter(face, {}, [](const std::string&, std::string_view) { return Status(); });
  EXPECT_EQ(done.status().code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(done.status().what(), HasSubstr("furrow_brow_l_stretch"));
}

TEST(ExportPackage, StopsAtTheFirstErrorOfTheSink) {
  int calls = 0;
  const auto done =
      ExportCharacter(test::SmallFace(), {}, [&](const std::string&, std::string_view) {
        ++calls;
        return Status(StatusCode::kIo, "disk full");
      });
  EXPECT_EQ(done.status().code(), StatusCode::kIo);
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace furrow::authoring
