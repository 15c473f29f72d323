// SPDX-License-Identifier: Apache-2.0
#include "gltf/document/draco_primitives.h"

#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf/document/accessor.h"
#include "gltf/document/document.h"
#include "gltf/scene/meshes.h"
#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* kDraco = "KHR_draco_mesh_compression";

std::vector<std::uint8_t> Bytes(const std::vector<float>& values) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
  return {first, first + values.size() * sizeof(float)};
}

// A quad with positions (id 7) and joints (id 3).
DracoMesh Quad() {
  return {.num_points = 4,
          .indices = {0, 1, 2, 0, 2, 3},
          .attributes = {{7, 5126, 3, Bytes({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})},
                         {3, 5121, 4, {1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0}}}};
}

// Two primitives of one compressed mesh. The second has a colour of its own that is not compressed.
HandMadeGltf Compressed() {
  HandMadeGltf gltf;
  gltf.AddAccessor(std::vector<std::uint8_t>(10, 9), "SCALAR", 5121, 1);  // view 0: the mesh
  const int colour = gltf.AddFloats({5, 5, 5, 6, 6, 6, 7, 7, 7, 8, 8, 8}, "VEC3");
  const auto add = [&](const char* type, int component_type, int count) {
    gltf.json["accessors"].push_back(
        {{"type", type}, {"componentType", component_type}, {"count", count}});
    return static_cast<int>(gltf.json["accessors"].size()) - 1;
  };
  const int position = add("VEC3", 5126, 4);
  const int joints = add("VEC4", 5123, 4);
  const int indices = add("SCALAR", 5123, 6);
  const Json draco = {
      {kDraco, {{"bufferView", 0}, {"attributes", {{"POSITION", 7}, {"JOINTS_0", 3}}}}}};
  Json plain = {{"attributes", {{"POSITION", position}, {"JOINTS_0", joints}}},
                {"indices", indices},
                {"extensions", draco}};
  Json coloured = plain;
  coloured["attributes"]["COLOR_0"] = colour;
  gltf.json["meshes"] = {{{"name", "quad"}, {"primitives", {plain, coloured}}}};
  gltf.json["extensionsRequired"] = {kDraco};
  return gltf;
}

// Opens the file with a decoder that returns `mesh` for each compressed one.
Result<Document> Open(const std::string& glb, const DracoMesh& mesh = Quad(),
                      std::size_t* calls = nullptr) {
  const DracoDecoder decode = [&](auto meshes) -> Result<std::vector<DracoMesh>> {
    if (calls != nullptr) *calls += meshes.size();
    return std::vector<DracoMesh>(meshes.size(), mesh);
  };
  return Document::Open(glb, {.draco = &decode});
}

TEST(DracoPrimitives, BecomePlainOnes) {
  const std::string glb = Compressed().Glb();
  std::size_t calls = 0;
  Result<Document> document = Open(glb, Quad(), &calls);
  ASSERT_TRUE(document.ok()) << document.status().ToString();
  EXPECT_EQ(calls, 1u) << "shared by both primitives";
  const auto meshes = ReadMeshes(&*document);
  ASSERT_TRUE(meshes.ok());
  ASSERT_EQ((*meshes)[0].primitives.size(), 2u);
  for (const Primitive& primitive : (*meshes)[0].primitives) {
    const auto position =
        Accessor::Create(*document, primitive.attributes.at("POSITION"), ElementType::kVec3, "");
    ASSERT_TRUE(position.ok()) << position.status().ToString();
    EXPECT_EQ(position->size(), 4u);
    EXPECT_EQ(position->Float(2, 1), 1.0f);
    const auto joints =
        Accessor::Create(*document, primitive.attributes.at("JOINTS_0"), ElementType::kVec4, "");
    ASSERT_TRUE(joints.ok()) << joints.status().ToString();
    EXPECT_EQ(joints->Unsigned(3), 4u) << "in the type of the compressed mesh";
    const auto indices = Accessor::Create(*document, primitive.indices, ElementType::kScalar, "");
    ASSERT_TRUE(indices.ok()) << indices.status().ToString();
    EXPECT_EQ(indices->Unsigned(5), 3u);
  }
  const auto colour = Accessor::Create(
      *document, (*meshes)[0].primitives[1].attributes.at("COLOR_0"), ElementType::kVec3, "");
  ASSERT_TRUE(colour.ok());
  EXPECT_EQ(colour->Float(3, 0), 8.0f);
}

TEST(DracoPrimitives, AreIgnoredByReadersOfAnimations) {
  const std::string glb = Compressed().Glb();
  EXPECT_TRUE(Document::Open(glb, {.contents = Contents::kAnimation}).ok());
}

TEST(DracoPrimitives, AreRefusedWithoutADecoder) {
  const std::string glb = Compressed().Glb();
  const auto document = Document::Open(glb, {});
  EXPECT_EQ(document.status().code(), StatusCode::kUnsupported);
  EXPECT_THAT(document.status().todo(), HasSubstr("import"));
}

// The extension without a requirement means that the file has the plain data, too.
TEST(DracoPrimitives, WithPlainDataNeedNoDecoder) {
  HandMadeGltf gltf = Compressed();
  gltf.json.erase("extensionsRequired");
  for (const int accessor : {2, 3, 4}) gltf.json["accessors"][accessor]["bufferView"] = 1;
  const std::string glb = gltf.Glb();
  const auto document = Document::Open(glb, {});
  EXPECT_TRUE(document.ok()) << document.status().ToString();
}

// Some exporters forget the requirement.
TEST(DracoPrimitives, AreDecodedWithoutARequirement) {
  HandMadeGltf gltf = Compressed();
  gltf.json.erase("extensionsRequired");
  const std::string glb = gltf.Glb();
  std::size_t calls = 0;
  EXPECT_TRUE(Open(glb, Quad(), &calls).ok());
  EXPECT_EQ(calls, 1u);
}

struct Fault {
  const char* name;
  std::function<void(Json*, DracoMesh*)> make;
  const char* where;
};

class DracoFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(DracoFaults, AreErrorsThatNameTheField) {
  HandMadeGltf gltf = Compressed();
  DracoMesh mesh = Quad();
  GetParam().make(&gltf.json, &mesh);
  const std::string glb = gltf.Glb();
  const auto document = Open(glb, mesh);
  EXPECT_EQ(document.status().code(), StatusCode::kSchema);
  EXPECT_THAT(document.status().where(), HasSubstr(GetParam().where))
      << document.status().ToString();
}

Json& Extension(Json* root) { return (*root)["meshes"][0]["primitives"][0]["extensions"][kDraco]; }

INSTANTIATE_TEST_SUITE_P(
    Each, DracoFaults,
    ::testing::Values(
        Fault{"View", [](Json* j, DracoMesh*) { Extension(j)["bufferView"] = 99; },
              "primitives[0].extensions.KHR_draco_mesh_compression.bufferView"},
        Fault{"NoView", [](Json* j, DracoMesh*) { Extension(j).erase("bufferView"); },
              "bufferView"},
        Fault{"NotAnObject", [](Json* j, DracoMesh*) { Extension(j) = 5; }, "bufferView"},
        Fault{"NoAttributes", [](Json* j, DracoMesh*) { Extension(j).erase("attributes"); },
              "attributes"},
        Fault{"Id", [](Json* j, DracoMesh*) { Extension(j)["attributes"]["POSITION"] = 8; },
              "attributes.POSITION"},
        Fault{"NoAccessor", [](Json* j, DracoMesh*) { Extension(j)["attributes"]["NORMAL"] = 7; },
              "attributes.NORMAL"},
        Fault{"Vertices", [](Json*, DracoMesh* m) { m->num_points = 5; }, "attributes."},
        Fault{"Type", [](Json* j, DracoMesh*) { (*j)["accessors"][2]["type"] = "VEC2"; },
              "attributes.POSITION"},
        Fault{"Triangles", [](Json*, DracoMesh* m) { m->indices.resize(3); }, "primitives[0]"},
        Fault{"NoAccessors", [](Json* j, DracoMesh*) { (*j)["accessors"] = "none"; }, "accessors"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace furrow::gltf
