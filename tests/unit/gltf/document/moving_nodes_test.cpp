// SPDX-License-Identifier: Apache-2.0
#include "gltf/document/moving_nodes.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Two nodes, of which node 1 is 2 m to the side and turned by 180 degrees.
class MovingNodes : public testing::Test {
 protected:
  MovingNodes() {
    gltf.json["nodes"] = {{{"name", "a"}},
                          {{"name", "b"}, {"translation", {2, 0, 0}}, {"rotation", {0, 1, 0, 0}}}};
  }
  // Adds a channel of node 1 with two keys.
  void Add(const char* path, const std::vector<float>& keys, const char* interpolation = "LINEAR") {
    const int times = gltf.AddFloats({0, 1}, "SCALAR");
    const int values = gltf.AddFloats(keys, keys.size() % 3 == 0 ? "VEC3" : "VEC4");
    gltf.AddChannel(1, path, interpolation, times, values);
  }
  [[nodiscard]] std::vector<int> List() const {
    std::vector<BufferView> views;
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(gltf.binary.data());
    for (const auto& view : gltf.json.value("bufferViews", nlohmann::json::array())) {
      views.push_back({std::span(bytes, gltf.binary.size())
                           .subspan(view["byteOffset"].get<std::size_t>(),
                                    view["byteLength"].get<std::size_t>()),
                       view.value("byteStride", std::size_t{0})});
    }
    return ListMovingNodes(nlohmann::json::parse(gltf.json.dump()), views);
  }

  HandMadeGltf gltf;
};

TEST_F(MovingNodes, AKeyOutOfTheRestMoves) {
  EXPECT_THAT(List(), IsEmpty());
  Add("scale", {1, 1, 1, 1, 1, 1.01f});
  EXPECT_THAT(List(), ElementsAre(1));
  Add("translation", {2, 0, 0, 2, 0, 1});
  EXPECT_THAT(List(), ElementsAre(1)) << "once";
}

TEST_F(MovingNodes, AConstantPoseOutOfTheRestMoves) {
  Add("translation", {3, 0, 0, 3, 0, 0});
  EXPECT_THAT(List(), ElementsAre(1));
}

TEST_F(MovingNodes, ChannelsThatRepeatTheRestMoveNothing) {
  Add("translation", {2, 0, 0, 2.00001f, 0, 0});
  Add("rotation", {0, 1, 0, 0, 0, -1, 0, 0}, "STEP");
  Add("scale", {1, 1, 1, 1, 1, 1});
  EXPECT_THAT(List(), IsEmpty());
  Add("rotation", {0, 1, 0, 0, 0, 0.9999f, 0.0141f, 0});
  EXPECT_THAT(List(), ElementsAre(1));
}

TEST_F(MovingNodes, KeysThatCannotBeReadMove) {
  Add("translation", {2, 0, 0, 2, 0, 0});
  const HandMadeGltf good = gltf;
  ASSERT_THAT(List(), IsEmpty());
  const std::vector<std::pair<const char*, nlohmann::json>> faults = {
      {"count", 3},       {"count", -1},           {"byteOffset", 1ull << 40}, {"bufferView", 9},
      {"type", "SCALAR"}, {"componentType", 5120}, {"sparse", {{"count", 1}}}};
  for (const auto& [key, value] : faults) {
    gltf = good;
    gltf.json["accessors"][1][key] = value;
    EXPECT_THAT(List(), ElementsAre(1)) << key;
  }
  gltf = good;
  gltf.json["nodes"][1]["translation"] = {2, "0", 0};
  EXPECT_THAT(List(), ElementsAre(1));
  gltf = good;
  gltf.json["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE";
  EXPECT_THAT(List(), ElementsAre(1)) << "tangents";
  gltf = good;
  gltf.json["animations"][0]["channels"][0].erase("sampler");
  EXPECT_THAT(List(), ElementsAre(1));
}

}  // namespace
}  // namespace furrow::gltf
