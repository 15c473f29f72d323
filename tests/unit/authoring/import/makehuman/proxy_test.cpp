// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/proxy.h"

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

// Two triangles: the corners of the first lie between base vertices, those of the second on them.
TEST(FitProxy, HidesFacesWhoseVerticesAreHidden) {
  Proxy proxy;
  proxy.obj.positions.resize(6);
  proxy.fit.vertices.resize(6);
  for (std::uint32_t v = 0; v < 6; ++v) {
    proxy.obj.corners.push_back({v, -1});
    Mhclo::GarmentVertex& vertex = proxy.fit.vertices[v];
    vertex.base = v < 3 ? std::array<std::uint32_t, 3>{v, (v + 1) % 3, 3}
                        : std::array<std::uint32_t, 3>{v - 3, v - 3, v - 3};
    vertex.weights =
        v < 3 ? std::array<float, 3>{0.5f, 0.25f, 0.25f} : std::array<float, 3>{1.0f, 0.0f, 0.0f};
  }
  proxy.obj.faces = {{0, 3, 0}, {3, 3, 0}};
  BaseMesh base;
  base.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  base.skin.vertices.resize(4);
  const auto drawn = [&](const std::vector<bool>& hidden) {
    const Result<FittedProxy> fitted = FitProxy(proxy, base, "shirt", hidden);
    EXPECT_TRUE(fitted.ok()) << fitted.status().ToString();
    return fitted.ok() ? fitted->mesh.indices.size() / 3 : 0;
  };
  EXPECT_EQ(drawn({}), 2u);
  EXPECT_EQ(drawn({true, true, false, false}), 2u);  // corners of both stay visible
  EXPECT_EQ(drawn({true, true, true, false}), 0u);
  // Of each corner of the first triangle, two of three base vertices are hidden.
  EXPECT_EQ(drawn({true, false, true, true}), 1u);
  EXPECT_EQ(drawn({false, false, false, true}), 2u);
}

TEST(FitProxy, RejectsVerticesFarAway) {
  Proxy proxy;
  proxy.obj.positions.resize(1);
  proxy.fit.vertices.resize(1);
  proxy.fit.vertices[0].weights = {1e30f, 0.0f, 0.0f};
  BaseMesh base;
  base.positions = {{1, 0, 0}};
  base.skin.vertices.resize(1);
  EXPECT_EQ(FitProxy(proxy, base, "shirt", {}).status().code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace furrow::authoring
