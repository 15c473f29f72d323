// SPDX-License-Identifier: Apache-2.0
#include "gltf/document/accessor.h"

#include <cmath>
#include <cstdint>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::FloatEq;

// Owns the bytes that the document refers to.
struct Opened {
  explicit Opened(const HandMadeGltf& gltf)
      : bytes(gltf.Glb()), document(Document::Open(bytes, {})) {
    EXPECT_TRUE(document.ok()) << document.status().ToString();
  }
  std::string bytes;
  Result<Document> document;
};

template <class T>
Result<std::vector<float>> Read(const std::vector<T>& values, int component_type, bool normalized) {
  HandMadeGltf gltf;
  const int accessor = gltf.AddAccessor(values, "SCALAR", component_type, 1);
  gltf.json["accessors"][0]["normalized"] = normalized;
  const Opened opened(gltf);
  std::size_t budget = 100;
  return ReadFloats(*opened.document, accessor, ElementType::kScalar, "here", &budget);
}

TEST(Accessor, NormalisesEveryIntegerType) {
  EXPECT_THAT(*Read<std::int8_t>({-128, -127, 0, 127}, 5120, true), ElementsAre(-1, -1, 0, 1));
  EXPECT_THAT(*Read<std::uint8_t>({0, 51, 255}, 5121, true), ElementsAre(0, FloatEq(0.2f), 1));
  EXPECT_THAT(*Read<std::int16_t>({-32768, 0, 32767}, 5122, true), ElementsAre(-1, 0, 1));
  EXPECT_THAT(*Read<std::uint16_t>({0, 13107, 65535}, 5123, true),
              ElementsAre(0, FloatEq(0.2f), 1));
  EXPECT_THAT(*Read<float>({-2.5f, 7.0f}, 5126, false), ElementsAre(-2.5f, 7.0f));
}

TEST(Accessor, ReadFloatsRejectsPlainIntegersAndNaN) {
  EXPECT_EQ(Read<std::uint16_t>({1, 2}, 5123, false).status().code(), StatusCode::kSchema);
  EXPECT_EQ(Read<std::uint32_t>({1, 2}, 5125, true).status().code(), StatusCode::kSchema);
  EXPECT_EQ(Read<float>({1.0f, NAN}, 5126, false).status().code(), StatusCode::kNonFinite);
}

TEST(Accessor, ReadFloatsSpendsTheBudget) {
  HandMadeGltf gltf;
  const int accessor = gltf.AddFloats({1, 2, 3, 4, 5, 6}, "VEC3");
  const Opened opened(gltf);
  std::size_t budget = 11;
  EXPECT_TRUE(ReadFloats(*opened.document, accessor, ElementType::kVec3, "a", &budget).ok());
  EXPECT_EQ(budget, 5u);
  EXPECT_EQ(
      ReadFloats(*opened.document, accessor, ElementType::kVec3, "a", &budget).status().code(),
      StatusCode::kLimit);
}

TEST(Accessor, ReadsIndicesAndStrides) {
  HandMadeGltf gltf;
  const int indices =
      gltf.AddAccessor(std::vector<std::uint16_t>{7, 0, 8, 0, 9, 0}, "SCALAR", 5123, 2);
  gltf.json["bufferViews"][0]["byteStride"] = 4;
  const Opened opened(gltf);
  const Result<Accessor> accessor =
      Accessor::Create(*opened.document, indices, ElementType::kScalar, "indices");
  ASSERT_TRUE(accessor.ok()) << accessor.status().ToString();
  EXPECT_TRUE(accessor->is_unsigned());
  EXPECT_FALSE(accessor->is_real());
  ASSERT_EQ(accessor->size(), 3u);
  EXPECT_EQ(accessor->Unsigned(0), 7u);
  EXPECT_EQ(accessor->Unsigned(2), 9u);
  EXPECT_EQ(accessor->Float(1, 0), 8.0f);
}

// Four elements of VEC3, of which a sparse part states two.
struct SparseGltf : HandMadeGltf {
  template <class Index>
  explicit SparseGltf(const std::vector<Index>& indices, int index_type) {
    AddFloats({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, "VEC3");
    AddAccessor(indices, "SCALAR", index_type, 1);
    AddFloats({-1, -2, -3, -4, -5, -6}, "VEC3");
    json["accessors"][0]["sparse"] = {
        {"count", indices.size()},
        {"indices", {{"bufferView", 1}, {"componentType", index_type}}},
        {"values", {{"bufferView", 2}}}};
  }
  [[nodiscard]] Result<std::vector<float>> Values() const {
    const Opened opened(*this);
    std::size_t budget = 100;
    return ReadFloats(*opened.document, 0, ElementType::kVec3, "here", &budget);
  }
};

TEST(Accessor, SparseElementsReplaceOthers) {
  const std::vector<float> due = {1, 2, 3, -1, -2, -3, 7, 8, 9, -4, -5, -6};
  EXPECT_EQ(*SparseGltf(std::vector<std::uint8_t>{1, 3}, 5121).Values(), due);
  EXPECT_EQ(*SparseGltf(std::vector<std::uint16_t>{1, 3}, 5123).Values(), due);
  EXPECT_EQ(*SparseGltf(std::vector<std::uint32_t>{1, 3}, 5125).Values(), due);
}

TEST(Accessor, WithoutBufferViewIsZero) {
  SparseGltf gltf(std::vector<std::uint16_t>{0, 2}, 5123);
  gltf.json["accessors"][0].erase("bufferView");
  EXPECT_THAT(*gltf.Values(), ElementsAre(-1, -2, -3, 0, 0, 0, -4, -5, -6, 0, 0, 0));
  const Opened opened(gltf);
  const auto accessor = Accessor::Create(*opened.document, 0, ElementType::kVec3, "here");
  ASSERT_TRUE(accessor.ok());
  ASSERT_EQ(accessor->num_candidates(), 2u);
  EXPECT_EQ(accessor->Candidate(1), 2u);
  gltf.json["accessors"][0].erase("sparse");
  EXPECT_THAT(*gltf.Values(), ::testing::Each(0.0f));
}

TEST(Accessor, SparseValuesHaveTheAccessorsType) {
  HandMadeGltf gltf;
  gltf.AddAccessor(std::vector<std::int8_t>{127, 0, -127, 0}, "SCALAR", 5120, 1);
  gltf.AddAccessor(std::vector<std::uint16_t>{1}, "SCALAR", 5123, 1);
  gltf.AddAccessor(std::vector<std::int8_t>{-127}, "SCALAR", 5120, 1);
  gltf.json["accessors"][0]["normalized"] = true;
  gltf.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                                         {"values", {{"bufferView", 2}}}};
  const Opened opened(gltf);
  std::size_t budget = 100;
  EXPECT_THAT(*ReadFloats(*opened.document, 0, ElementType::kScalar, "here", &budget),
              ElementsAre(1, -1, -1, 0));
}

TEST(Accessor, RejectsSparsePartsThatLie) {
  using Indices = std::vector<std::uint16_t>;
  EXPECT_EQ(SparseGltf(Indices{3, 1}, 5123).Values().status().code(), StatusCode::kSchema);
  EXPECT_EQ(SparseGltf(Indices{1, 1}, 5123).Values().status().code(), StatusCode::kSchema);
  EXPECT_EQ(SparseGltf(Indices{1, 4}, 5123).Values().status().code(), StatusCode::kSchema);
  const auto changed = [](const std::function<void(json&)>& change) {
    SparseGltf gltf(Indices{1, 3}, 5123);
    change(gltf.json["accessors"][0]["sparse"]);
    return gltf.Values().status().code();
  };
  EXPECT_EQ(changed([](json&) {}), StatusCode::kOk);
  EXPECT_EQ(changed([](json& s) { s["count"] = 3; }), StatusCode::kSchema);
  EXPECT_EQ(changed([](json& s) { s["count"] = 5; }), StatusCode::kSchema);
  EXPECT_EQ(changed([](json& s) { s["count"] = -1; }), StatusCode::kSchema);
  EXPECT_EQ(changed([](json& s) { s["indices"]["bufferView"] = 9; }), StatusCode::kSchema);
  EXPECT_EQ(changed([](json& s) { s["indices"]["byteOffset"] = 2; }), StatusCode::kSchema);
  EXPECT_EQ(changed([](json& s) { s["indices"]["componentType"] = 5126; }), StatusCode::kSchema);
  EXPECT_EQ(changed([](json& s) { s["values"]["bufferView"] = -1; }), StatusCode::kSchema);
  EXPECT_EQ(changed([](json& s) { s["values"]["byteOffset"] = -4; }), StatusCode::kSchema);
  EXPECT_EQ(changed([](json& s) { s["values"]["byteOffset"] = 4; }), StatusCode::kSchema);
}

TEST(Accessor, RejectsWhatItCannotRead) {
  const auto error = [](const std::function<void(json&)>& change, int index = 0) {
    HandMadeGltf gltf;
    gltf.AddFloats({1, 2, 3, 4, 5, 6}, "VEC3");
    change(gltf.json);
    const Opened opened(gltf);
    const Status status =
        Accessor::Create(*opened.document, index, ElementType::kVec3, "here").status();
    EXPECT_EQ(status.where(), status.ok() ? "" : "here");
    return status.code();
  };
  const auto set = [](const char* member, const json& value) {
    return [=](json& j) { j["accessors"][0][member] = value; };
  };
  EXPECT_EQ(error([](json&) {}), StatusCode::kOk);
  EXPECT_EQ(error([](json&) {}, 1), StatusCode::kSchema);
  EXPECT_EQ(error([](json&) {}, -1), StatusCode::kSchema);
  EXPECT_EQ(error(set("type", "VEC2")), StatusCode::kSchema);
  EXPECT_EQ(error(set("componentType", 5130)), StatusCode::kSchema);
  EXPECT_EQ(error(set("bufferView", 1)), StatusCode::kSchema);
  EXPECT_EQ(error(set("count", 0)), StatusCode::kSchema);
  EXPECT_EQ(error(set("count", 3)), StatusCode::kSchema);
  EXPECT_EQ(error(set("count", 4'000'000'000u)), StatusCode::kLimit);
  EXPECT_EQ(error(set("byteOffset", 4)), StatusCode::kSchema);
  EXPECT_EQ(error(set("byteOffset", ~0ull)), StatusCode::kSchema);
  EXPECT_EQ(error([](json& j) { j["bufferViews"][0]["byteStride"] = 8; }), StatusCode::kSchema);
  EXPECT_EQ(error([](json& j) { j["bufferViews"][0]["byteStride"] = 16; }), StatusCode::kSchema);
}

}  // namespace
}  // namespace furrow::gltf
