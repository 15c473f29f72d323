// SPDX-License-Identifier: Apache-2.0
#include "gltf/write/builder.h"

#include <cstdint>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf/container/glb.h"
#include "gltf/document/accessor.h"
#include "gltf/scene/joints.h"
#include "gltf/write/scene_json.h"

namespace furrow::gltf {
namespace {

std::string Build(const std::string& name) {
  Builder builder;
  builder.AddView("abc", 3, Builder::kNoTarget);
  builder.AddAccessor(std::vector<std::uint16_t>{1, 2, 3}, Builder::kUnsignedShort, "SCALAR",
                      Builder::kElementBuffer);
  builder.AddAccessor(std::vector<float>{1, 2, 3, 4, 5, 6}, Builder::kFloat, "VEC3",
                      Builder::kArrayBuffer, 2);
  Builder::Json nodes = Builder::Json::array();
  Builder::Json roots = Builder::Json::array();
  AddJointNodes(std::vector<Joint>{{name, kNone, {}, glm::vec3(1, 2, 3), 0},
                                   {"b", 0, {{0, 1, 0}, {0.6f, 0.8f, 0, 0}, glm::vec3(2)}, {}, 1}},
                &nodes, &roots);
  builder.root()["nodes"] = std::move(nodes);
  builder.root()["scenes"] = Builder::Json::array({{{"nodes", std::move(roots)}}});
  const Result<std::string> glb = builder.Finish();
  EXPECT_TRUE(glb.ok()) << glb.status().ToString();
  return glb.ok() ? *glb : std::string();
}

TEST(Builder, WritesWhatTheReaderReads) {
  const std::string glb = Build("a");
  EXPECT_EQ(glb, Build("a"));
  Result<Document> document = Document::Open(glb, {});
  ASSERT_TRUE(document.ok()) << document.status().ToString();
  EXPECT_TRUE(document->warnings().empty());
  const Result<Accessor> indices = Accessor::Create(*document, 0, ElementType::kScalar, "");
  ASSERT_TRUE(indices.ok()) << indices.status().ToString();
  EXPECT_EQ(indices->Unsigned(2), 3u);
  const Result<Accessor> vectors = Accessor::Create(*document, 1, ElementType::kVec3, "");
  ASSERT_TRUE(vectors.ok()) << vectors.status().ToString();
  EXPECT_EQ(vectors->Float(1, 2), 6.0f);
  const Result<NodeForest> forest = ReadNodes(&*document);
  ASSERT_TRUE(forest.ok()) << forest.status().ToString();
  ASSERT_EQ(forest->nodes.size(), 2u);
  EXPECT_EQ(forest->nodes[0].tail, glm::vec3(1, 2, 3));
  EXPECT_EQ(forest->nodes[1].parent, 0);
  EXPECT_EQ(forest->nodes[1].local.rotation, glm::quat(0.6f, 0.8f, 0, 0));
  EXPECT_EQ(forest->nodes[1].local.scale, glm::vec3(2));
}

TEST(Builder, ReplacesBytesThatAreNotUtf8) {
  const std::string glb = Build("a\xFF");
  Result<Document> document = Document::Open(glb, {});
  ASSERT_TRUE(document.ok()) << document.status().ToString();
  EXPECT_EQ(ReadNodes(&*document)->nodes[0].name, "a\xEF\xBF\xBD");
}

}  // namespace
}  // namespace furrow::gltf
