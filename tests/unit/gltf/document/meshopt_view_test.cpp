// SPDX-License-Identifier: Apache-2.0
#include "gltf/document/meshopt_view.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <meshoptimizer.h>

namespace furrow::gltf {
namespace {

std::vector<std::uint8_t> Encode(const std::vector<float>& values) {
  std::vector<std::uint8_t> bytes(meshopt_encodeVertexBufferBound(values.size(), 4));
  meshopt_encodeVertexVersion(0);
  bytes.resize(
      meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), values.size(), 4));
  return bytes;
}

StatusCode CodeOf(const MeshoptView& view) { return DecodeMeshopt(view, "here").status().code(); }

TEST(MeshoptView, DecodesWhatTheLibraryEncodes) {
  const std::vector<float> values = {1, 2, 3, 4.5f};
  const std::vector<std::uint8_t> bytes = Encode(values);
  const auto decoded = DecodeMeshopt({bytes, 4, 4, "ATTRIBUTES", ""}, "here");
  ASSERT_TRUE(decoded.ok()) << decoded.status().ToString();
  EXPECT_TRUE(std::equal(decoded->begin(), decoded->end(),
                         reinterpret_cast<const std::uint8_t*>(values.data())));
}

TEST(MeshoptView, RejectsEveryTruncation) {
  const std::vector<std::uint8_t> bytes = Encode(std::vector<float>(300, 0.25f));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::vector<std::uint8_t> part(bytes.begin(),
                                         bytes.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_NE(CodeOf({part, 300, 4, "ATTRIBUTES", ""}), StatusCode::kOk) << length;
  }
}

TEST(MeshoptView, RejectsWhatTheLibraryAsserts) {
  const std::vector<std::uint8_t> bytes = Encode({1, 2, 3, 4});
  EXPECT_EQ(CodeOf({bytes, 4, 4, "ATTRIBUTES", "NONE"}), StatusCode::kOk);
  EXPECT_EQ(CodeOf({bytes, 4, 4, "POINTS", ""}), StatusCode::kSchema);
  EXPECT_EQ(CodeOf({bytes, 4, 0, "ATTRIBUTES", ""}), StatusCode::kSchema);
  EXPECT_EQ(CodeOf({bytes, 4, 6, "ATTRIBUTES", ""}), StatusCode::kSchema);
  EXPECT_EQ(CodeOf({bytes, 4, 260, "ATTRIBUTES", ""}), StatusCode::kSchema);
  EXPECT_EQ(CodeOf({bytes, 4, 4, "ATTRIBUTES", "QUATERNION"}), StatusCode::kSchema);
  EXPECT_EQ(CodeOf({bytes, 4, 4, "ATTRIBUTES", "MAGIC"}), StatusCode::kSchema);
  EXPECT_EQ(CodeOf({bytes, 4, 4, "TRIANGLES", ""}), StatusCode::kSchema);
  EXPECT_EQ(CodeOf({bytes, 3, 3, "INDICES", ""}), StatusCode::kSchema);
  EXPECT_EQ(CodeOf({bytes, 3, 4, "TRIANGLES", ""}), StatusCode::kParse);
  EXPECT_EQ(CodeOf({bytes, 0, 4, "ATTRIBUTES", ""}), StatusCode::kSchema);
  EXPECT_EQ(CodeOf({bytes, 1ull << 60, 4, "ATTRIBUTES", ""}), StatusCode::kSchema);
}

}  // namespace
}  // namespace furrow::gltf
