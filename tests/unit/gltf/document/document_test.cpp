// SPDX-License-Identifier: Apache-2.0
#include "gltf/document/document.h"

#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf/limits.h"
#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Status OpenError(const std::function<void(json&)>& change,
                 Contents contents = Contents::kCharacter) {
  HandMadeGltf gltf = TwoJoints();
  change(gltf.json);
  return Document::Open(gltf.Glb(), {.contents = contents}).status();
}

TEST(Document, HoldsWhatTheFileHas) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["scenes"] = {{{"name", "stage"}}};
  gltf.json["images"] = {{{"name", "skin"}, {"bufferView", 1}}, {{"uri", "a.png"}}};
  const std::string glb = gltf.Glb();
  const Result<Document> document = Document::Open(glb, {});
  ASSERT_TRUE(document.ok()) << document.status().ToString();
  EXPECT_EQ(document->SceneName(), "stage");
  ASSERT_EQ(document->views().size(), 3u);
  EXPECT_EQ(document->views()[0].bytes.size(), 8u);
  EXPECT_EQ(document->views()[1].bytes.data(),
            reinterpret_cast<const std::uint8_t*>(glb.data() + glb.size() - gltf.binary.size()) + 8)
      << "the binary chunk is not copied";
  ASSERT_EQ(document->images().size(), 2u);
  EXPECT_EQ(document->images()[0].view, 1);
  EXPECT_EQ(document->images()[1].uri, "a.png");
  EXPECT_TRUE(document->warnings().empty());
}

TEST(Document, NamesMorphTargets) {
  HandMadeGltf gltf = TwoJoints();
  const json target = json::object();
  gltf.json["meshes"] = {{{"name", "face"},
                          {"extras", {{"targetNames", {"jawOpen", "", "extra", "extra"}}}},
                          {"primitives", {{{"targets", {target, target}}}}}},
                         {{"primitives", {{{"targets", {target}}}}}}};
  const std::string glb = gltf.Glb();
  const Result<Document> document = Document::Open(glb, {.contents = Contents::kAnimation});
  ASSERT_TRUE(document.ok()) << document.status().ToString();
  EXPECT_EQ(document->num_meshes(), 2u);
  EXPECT_THAT(document->MorphTargetNames(0), ElementsAre("jawOpen", "face.1"));
  EXPECT_THAT(document->MorphTargetNames(1), ElementsAre("mesh_1.0"));
  EXPECT_TRUE(document->MorphTargetNames(-1).empty());
  EXPECT_EQ(document->NumMorphTargets(7), 0u);
}

TEST(Document, ChecksBuffersAndViews) {
  EXPECT_EQ(OpenError([](json& j) { j["bufferViews"] = 3; }).where(), "bufferViews");
  EXPECT_EQ(OpenError([](json& j) { j["bufferViews"][0] = 3; }).where(), "bufferViews[0]");
  EXPECT_EQ(OpenError([](json& j) { j["bufferViews"][1].erase("buffer"); }).where(),
            "bufferViews[1].buffer");
  EXPECT_EQ(OpenError([](json& j) { j["bufferViews"][1]["byteLength"] = 0; }).where(),
            "bufferViews[1].byteLength");
  EXPECT_EQ(OpenError([](json& j) { j["bufferViews"][1]["byteOffset"] = ~0ull; }).where(),
            "bufferViews[1].byteLength");
  EXPECT_EQ(OpenError([](json& j) { j["bufferViews"][1]["byteStride"] = 253; }).where(),
            "bufferViews[1].byteStride");
  EXPECT_EQ(OpenError([](json& j) {
              j["images"] = {{{"bufferView", 9}}};
            }).where(),
            "images[0].bufferView");
}

TEST(Document, DecidesAboutRequiredExtensions) {
  const auto with = [](const char* name) {
    return [name](json& j) { j["extensionsRequired"] = {name}; };
  };
  for (const Contents contents : {Contents::kAnimation, Contents::kCharacter}) {
    EXPECT_TRUE(OpenError(with("EXT_meshopt_compression"), contents).ok());
    EXPECT_TRUE(OpenError(with("KHR_mesh_quantization"), contents).ok());
    EXPECT_TRUE(OpenError(with("EXT_unknown"), contents).ok());
  }
  EXPECT_TRUE(OpenError(with("KHR_draco_mesh_compression"), Contents::kAnimation).ok());
  const Status draco = OpenError(with("KHR_draco_mesh_compression"));
  EXPECT_EQ(draco.code(), StatusCode::kUnsupported);
  EXPECT_EQ(draco.where(), "extensionsRequired");
}

TEST(Document, LimitsListsAndWarnings) {
  EXPECT_EQ(OpenError([](json& j) { j["images"] = json(kMaxImages + 1, json::object()); }).code(),
            StatusCode::kLimit);
  EXPECT_EQ(OpenError(
                [](json& j) {
                  j["meshes"] = {{{"primitives",
                                   {{{"targets", json(kMaxMorphTargets + 1, json::object())}}}}}};
                },
                Contents::kAnimation)
                .code(),
            StatusCode::kLimit);
  const std::string glb = TwoJoints().Glb();
  Result<Document> document = Document::Open(glb, {});
  ASSERT_TRUE(document.ok());
  for (std::size_t i = 0; i < kMaxWarnings + 5; ++i) document->Warn("field", "what");
  EXPECT_EQ(document->warnings().size(), kMaxWarnings + 1);
  EXPECT_EQ(document->warnings().front(), "field: what");
  EXPECT_EQ(document->warnings().back(), "5 more warnings");
}

TEST(Document, SurvivesMembersOfTheWrongType) {
  for (const char* part : {"nodes", "skins", "meshes", "accessors", "materials", "textures",
                           "scenes", "images", "buffers", "extensionsRequired"}) {
    for (const json& value : {json(5), json("x"), json::array({5}), json::object({{"a", 1}}),
                              json::array({json::array()}), json(nullptr)}) {
      const Status status = OpenError([&](json& j) { j[part] = value; });
      EXPECT_TRUE(status.ok() || !status.where().empty()) << part << " " << value;
    }
  }
}

TEST(Document, NamesTheVersionAndWhatToDo) {
  const Status old = OpenError([](json& j) { j["asset"]["version"] = "1.1"; });
  EXPECT_EQ(old.code(), StatusCode::kUnsupported);
  EXPECT_THAT(old.what(), HasSubstr("it states '1.1'"));
  EXPECT_THAT(old.todo(), HasSubstr("gltf-pipeline"));
}

TEST(Document, SaysWhatToDoAboutAnExtension) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensionsRequired"] = {
      "EXT_mesh_gpu_instancing", "KHR_texture_basisu", "KHR_materials_clearcoat",
      "KHR_lights_punctual",     "VENDOR_thing",       "KHR_mesh_quantization"};
  const std::string glb = gltf.Glb();
  const Result<Document> document = Document::Open(glb, {});
  ASSERT_TRUE(document.ok()) << document.status().ToString();
  EXPECT_THAT(
      document->warnings(),
      ElementsAre(HasSubstr("(export each instance as a node of its own)"),
                  HasSubstr("(export PNG, JPEG or WebP textures)"),
                  HasSubstr("(materials look different;"), HasSubstr("(lights are not imported)"),
                  HasSubstr("'VENDOR_thing' is not supported and is ignored (if")));
}

}  // namespace
}  // namespace furrow::gltf
