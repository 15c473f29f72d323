// SPDX-License-Identifier: Apache-2.0
#include "base/json_index.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace furrow {
namespace {

constexpr std::string_view kIndexed = R"({
  // a comment
  "drivers": [
    {"name": "a", "hinge": {"axis": [1, 0, 0]}},
    {"name": "b"}
  ]
})";

TEST(JsonIndex, KnowsLinesAndPaths) {
  const Result<JsonIndex> index = JsonIndex::Create(kIndexed);
  ASSERT_TRUE(index.ok()) << index.status().ToString();
  EXPECT_EQ(index->Where(""), "1");
  EXPECT_EQ(index->Where("drivers[0].hinge.axis[2]"), "4: drivers[0].hinge.axis[2]");
  EXPECT_EQ(index->Where("drivers[1].name"), "5: drivers[1].name");
  // A missing field is reported at the object that should hold it.
  EXPECT_EQ(index->Where("drivers[1].hinge.axis"), "5: drivers[1].hinge.axis");
  EXPECT_EQ(index->PathAt(4, 20), "drivers[0].hinge");
  EXPECT_EQ(index->PathClosedBefore(6, 2), "drivers[1]");
}

TEST(JsonIndex, RejectsEveryTruncation) {
  for (std::size_t length = 0; length < kIndexed.size(); ++length) {
    // A buffer of exactly this length, so that a read past its end is seen by sanitizers.
    const auto cut = std::make_unique<char[]>(length);
    kIndexed.copy(cut.get(), length);
    const Result<JsonIndex> index = JsonIndex::Create({cut.get(), length});
    ASSERT_FALSE(index.ok()) << length;
    EXPECT_EQ(index.status().code(), StatusCode::kParse) << length;
  }
}

TEST(JsonIndex, RejectsWhatJsonDoesNotAllow) {
  const std::pair<const char*, StatusCode> kCases[] = {
      {"[1]", StatusCode::kParse},
      {"{} x", StatusCode::kParse},
      {R"({"a": 01})", StatusCode::kParse},
      {R"({"a": 1.})", StatusCode::kParse},
      {R"({"a": inf})", StatusCode::kParse},
      {R"({"a": nan})", StatusCode::kParse},
      {R"({"a": 1e39})", StatusCode::kNonFinite},
      {R"({"a": 1,})", StatusCode::kParse},
      {R"({a: 1})", StatusCode::kParse},
      {R"({"a": 1, "a": 2})", StatusCode::kSchema},
      {"{\"a\": \"\n\"}", StatusCode::kParse},
  };
  for (const auto& [text, code] : kCases) {
    EXPECT_EQ(JsonIndex::Create(text).status().code(), code) << text;
  }
  EXPECT_TRUE(JsonIndex::Create(R"({"a": 1e-999, "b": -0.5E+2, "c": null})").ok());
}

TEST(JsonIndex, BoundsDepthAndCounts) {
  const auto nested = [](int depth) {
    return "{\"a\":" + std::string(depth, '[') + std::string(depth, ']') + "}";
  };
  EXPECT_TRUE(JsonIndex::Create(nested(JsonIndex::kMaxDepth - 1)).ok());
  EXPECT_EQ(JsonIndex::Create(nested(JsonIndex::kMaxDepth + 1)).status().ok(), false);
  EXPECT_EQ(JsonIndex::Create("{\"a\":" + std::string(100'000, '[')).status().code(),
            StatusCode::kLimit);
  std::string fields = "{\"f0\":0";
  for (int i = 1; i <= 64; ++i) fields += ",\"f" + std::to_string(i) + "\":0";
  EXPECT_EQ(JsonIndex::Create(fields + "}").status().code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace furrow
