// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_map.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/rig/shapes/shipped_shape_maps.h"

namespace furrow::rig {
namespace {

constexpr char kToyShapes[] = R"({
  // a comment
  "version": 1, "name": "toy", "title": "Toys", "prefixes": ["T_"],
  "sides": {"left": "L", "right": "R"},
  "shapes": {
    "grin*": "mouthSmile*",
    "gape": {"from": ["0.5 jawOpen", "-0.5 mouthClose 1-jawForward"], "aliases": ["yawn"]},
    "squeeze": {"from": {"any": [{"mean": ["eyeBlinkLeft", "eyeBlinkRight"]}, "eyeSquintLeft"]},
                "unless": "grinL"},
    "other": []
  },
  "arkit": {"jawOpen": "gape", "mouthDimple*": "0.5 grin*"}
})";

ShapeMap ToyShapes() { return ParseShapeMap(kToyShapes, "toy.json").value(); }

const MapShape& ShapeOf(const ShapeMap& map, const std::string& name) {
  return *std::ranges::find(map.shapes, name, &MapShape::name);
}

TEST(ShapeMap, ReadsFormulas) {
  const ShapeMap map = ToyShapes();
  EXPECT_EQ(map.name, "toy");
  ASSERT_EQ(map.shapes.size(), 5u);
  EXPECT_EQ(ShapeOf(map, "grinR").from_arkit.at(0).RenamedShape(),
            FindArkitShape("mouthSmileRight"));
  const MapFormula& gape = ShapeOf(map, "gape").from_arkit.at(0);
  ASSERT_EQ(gape.sum.size(), 2u);
  EXPECT_EQ(gape.sum[0].gain, 0.5f);
  EXPECT_EQ(gape.sum[1].gain, -0.5f);
  EXPECT_TRUE(gape.sum[1].product.at(1).rest);
  EXPECT_EQ(gape.RenamedShape(), -1);
  const MapShape& squeeze = ShapeOf(map, "squeeze");
  ASSERT_EQ(squeeze.from_arkit.size(), 2u);
  EXPECT_TRUE(squeeze.from_arkit[0].mean);
  EXPECT_EQ(map.shapes.at(static_cast<std::size_t>(squeeze.unless.at(0))).name, "grinL");
  EXPECT_TRUE(ShapeOf(map, "other").from_arkit.empty());
}

TEST(ShapeMap, DerivesTheWayBack) {
  const ShapeMap map = ToyShapes();
  const auto& smile = map.to_arkit[FindArkitShape("mouthSmileLeft")];
  ASSERT_EQ(smile.size(), 1u);
  EXPECT_EQ(map.shapes.at(static_cast<std::size_t>(smile[0].RenamedShape())).name, "grinL");
  // A shape for both eyes gives each eye.
  EXPECT_EQ(map.to_arkit[FindArkitShape("eyeBlinkRight")].size(), 1u);
  EXPECT_EQ(map.to_arkit[FindArkitShape("mouthDimpleRight")].at(0).sum.at(0).gain, 0.5f);
  EXPECT_TRUE(map.to_arkit[FindArkitShape("tongueOut")].empty());
}

struct BadMap {
  const char* from;  // in kToyShapes
  const char* to;
  StatusCode code;
};

TEST(ShapeMap, ReportsEveryFault) {
  const BadMap kBad[] = {
      {"\"version\": 1", "\"version\": 2", StatusCode::kUnsupported},
      {"\"version\": 1,", "", StatusCode::kSchema},
      {"\"name\": \"toy\"", "\"name\": \"\"", StatusCode::kSchema},
      {"\"name\": \"toy\"", "\"name\": 3", StatusCode::kSchema},
      {"\"title\"", "\"titel\"", StatusCode::kSchema},
      {"[\"T_\"]", "[\"*\"]", StatusCode::kSchema},
      {"[\"T_\"]", "[3]", StatusCode::kSchema},
      {"\"right\": \"R\"", "\"right\": \"L\"", StatusCode::kSchema},
      {"\"right\"", "\"wrong\"", StatusCode::kSchema},
      {"\"sides\": {\"left\": \"L\", \"right\": \"R\"},", "", StatusCode::kSchema},
      {"\"mouthSmile*\"", "\"mouthSmirk*\"", StatusCode::kSchema},
      {"\"mouthSmile*\"", "\"0.5\"", StatusCode::kSchema},
      {"\"mouthSmile*\"", "\"\"", StatusCode::kSchema},
      {"\"mouthSmile*\"", "3", StatusCode::kSchema},
      {"\"mouthSmile*\"", "{\"mean\": []}", StatusCode::kLimit},
      {"\"mouthSmile*\"", "{\"any\": []}", StatusCode::kSchema},
      {"\"mouthSmile*\"", "{\"form\": 1}", StatusCode::kSchema},
      {"\"mouthSmile*\"", "\"1-mouthSmile*\"", StatusCode::kSchema},
      {"\"mouthSmile*\"", "\"20 mouthSmile*\"", StatusCode::kInvalidArgument},
      {"\"mouthSmile*\"", "\"nan mouthSmile*\"", StatusCode::kInvalidArgument},
      {"\"mouthSmile*\"", "{\"mean\": [\"-1 mouthSmile*\"]}", StatusCode::kInvalidArgument},
      {"\"0.5 jawOpen\"", "\"jaw*\"", StatusCode::kSchema},
      {"0.5 jawOpen", "jawOpen jawOpen jawOpen jawOpen jawOpen jawOpen jawOpen jawOpen jawOpen",
       StatusCode::kLimit},
      {"\"yawn\"", "\"other\"", StatusCode::kSchema},   // means two shapes
      {"\"yawn\"", "\"Grin_L\"", StatusCode::kSchema},  // the same, in another spelling
      {"\"yawn\"", "\"yawn*\"", StatusCode::kSchema},
      {"\"other\"", "\"grinL\"", StatusCode::kSchema},  // duplicate, because of "grin*"
      {"\"unless\": \"grinL\"", "\"unless\": \"grin\"", StatusCode::kSchema},
      {"\"unless\": \"grinL\"", "\"unless\": \"squeeze\"", StatusCode::kSchema},
      {"\"jawOpen\": \"gape\"", "\"jawOpen\": \"gap\"", StatusCode::kSchema},
      {"\"jawOpen\": \"gape\"", "\"jaw\": \"gape\"", StatusCode::kSchema},
      {"\"jawOpen\": \"gape\"", "\"mouthDimpleLeft\": \"gape\"", StatusCode::kSchema},
      {"\"other\"", "other", StatusCode::kParse},
  };
  for (const BadMap& bad : kBad) {
    std::string text = kToyShapes;
    const std::size_t at = text.find(bad.from);
    ASSERT_NE(at, std::string::npos) << bad.from;
    text.replace(at, std::string(bad.from).size(), bad.to);
    const auto map = ParseShapeMap(text, "toy.json");
    ASSERT_FALSE(map.ok()) << bad.from << " -> " << bad.to;
    EXPECT_EQ(map.status().code(), bad.code) << bad.to << ": " << map.status().ToString();
    EXPECT_THAT(map.status().where(), testing::StartsWith("toy.json"));
  }
}

TEST(ShapeMap, RejectsTruncatedAndOversizedInput) {
  const std::string whole = kToyShapes;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_FALSE(ParseShapeMap(whole.substr(0, length), "toy").ok()) << length;
  }
  EXPECT_EQ(ParseShapeMap(std::string((1 << 20) + 1, ' '), "toy").status().code(),
            StatusCode::kLimit);
  std::string many = R"({"version": 1, "name": "many", "shapes": {)";
  for (int i = 0; i <= 2048; ++i) {
    many += (i == 0 ? "\"x" : ",\"x") + std::to_string(i) + "\": []";
  }
  EXPECT_EQ(ParseShapeMap(many + "}}", "many").status().code(), StatusCode::kLimit);
  // Nested so deeply that recursion would overflow the stack. Tried at every value.
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  for (const char* value : {"\"toy\"", "\"Toys\"", "\"T_\"", "\"L\"", "\"mouthSmile*\"", "\"yawn\"",
                            "\"0.5 jawOpen\"", "\"grinL\"", "\"gape\", \"mouthDimple"}) {
    std::string nested = whole;
    const std::string_view wanted = std::string_view(value).substr(0, std::string(value).find(','));
    nested.replace(nested.find(value), wanted.size(), deep);
    EXPECT_FALSE(ParseShapeMap(nested, "toy").ok()) << value;
  }
}

TEST(ShapeMap, ShipsElevenMaps) {
  const std::vector<ShapeMap> maps = ShippedShapeMaps();
  std::vector<std::string> names;
  for (const ShapeMap& map : maps) names.push_back(map.name);
  EXPECT_THAT(names,
              testing::ElementsAre("arkit", "cc3", "cc4", "facs", "metahuman", "oculus-visemes",
                                   "sranipal", "unified", "vrm0", "vrm1", "vroid"));
  const ShapeMap& arkit = maps.front();
  for (int shape = 0; shape < kNumArkitShapes; ++shape) {
    ASSERT_FALSE(arkit.to_arkit[static_cast<std::size_t>(shape)].empty()) << ArkitShapes()[shape];
    const int own = arkit.to_arkit[static_cast<std::size_t>(shape)][0].RenamedShape();
    ASSERT_GE(own, 0);
    EXPECT_EQ(arkit.shapes[static_cast<std::size_t>(own)].name, ArkitShapes()[shape]);
  }
}

TEST(ShapeMap, LoadsByNameOrFile) {
  setenv("FURROW_DATA_DIR", FURROW_SOURCE_DIR "/rig", 1);
  EXPECT_EQ(LoadShapeMap("vrm0").value().name, "vrm0");
  EXPECT_EQ(LoadShapeMap(FURROW_SOURCE_DIR "/rig/shape_maps/cc4.json").value().name, "cc4");
  EXPECT_EQ(LoadShapeMap("nobody").status().code(), StatusCode::kNotFound);
  EXPECT_EQ(LoadShapeMap("no/such/file.json").status().code(), StatusCode::kNotFound);
  unsetenv("FURROW_DATA_DIR");
}

}  // namespace
}  // namespace furrow::rig
