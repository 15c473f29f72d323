// SPDX-License-Identifier: Apache-2.0
#include "rig/json/field_writer.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/rig/json/sample_fields.h"

namespace furrow::rig {
namespace {

Sample FullSample() {
  return {.title = "a \"title\"",
          .centre = {0, -0.25f, 1e20f},
          .names = {"x", ""},
          .parts = {{.label = "p"}, {.label = "q", .size = -1.0f, .shade = Shade::kBlack}},
          .note = "n",
          .ratio = 0.1f,
          .count = -2147483647 - 1,
          .on = false,
          .place = {0, 0, 0},
          .axis = glm::vec3(0, 0, 1),
          .shade = Shade::kDark,
          .more_names = {"y"},
          .numbers = {3, -1},
          .shares = {0.333f, 2.0f},
          .part = {.label = "r", .shade = Shade::kLight},
          .more_parts = {{.label = "s"}}};
}

TEST(FieldWriter, WritesEveryType) { EXPECT_EQ(FieldsToJson(FullSample()), kFullSample); }

TEST(FieldWriter, OmitsDefaultsOfOptionalFields) {
  Sample sample;
  sample.title = "a";
  EXPECT_EQ(FieldsToJson(sample), kLeastSample);
}

TEST(FieldWriter, WritesRequiredFieldsThatAreEmpty) {
  EXPECT_EQ(FieldsToJson(Part()), R"({"label": ""})");
}

TEST(FieldWriter, WritesLongListsOfNumbersOnOneLine) {
  Sample sample;
  sample.numbers.assign(100, 7);
  sample.shares.assign(100, 0.5f);
  const std::string json = FieldsToJson(sample);
  EXPECT_EQ(std::count(json.begin(), json.end(), '\n'), 7) << json;  // one per field and bracket
}

}  // namespace
}  // namespace furrow::rig
