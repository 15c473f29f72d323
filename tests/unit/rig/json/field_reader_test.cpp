// SPDX-License-Identifier: Apache-2.0
#include "rig/json/field_reader.h"

#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/checked_json.h"
#include "tests/unit/rig/json/sample_fields.h"

namespace furrow::rig {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Reads `json`, which must conform to kSampleSchema, as T.
template <class T>
std::pair<Status, T> Read(const std::string& json, const std::string& type = "test.Sample") {
  const auto checked = CheckedJson::Parse(json, "a.json", {kSampleSchema, "Sample", "sample.fbs"});
  EXPECT_TRUE(checked.ok()) << checked.status().ToString();
  const SchemaTypes types(kSampleSchema);
  const auto* root = flatbuffers::GetRoot<flatbuffers::Table>(checked->buffer());
  T result;
  Status status = ReadFields(types.Describe(root, type), "drivers[3].sample", &result);
  return {std::move(status), std::move(result)};
}

TEST(FieldReader, ReadsEveryType) {
  const auto [status, sample] = Read<Sample>(kFullSample);
  ASSERT_TRUE(status.ok()) << status.ToString();
  EXPECT_EQ(sample.title, "a \"title\"");
  EXPECT_EQ(sample.centre, glm::vec3(0, -0.25f, 1e20f));
  EXPECT_THAT(sample.names, ElementsAre("x", ""));
  ASSERT_EQ(sample.parts.size(), 2u);
  EXPECT_EQ(sample.parts[0].label, "p");
  EXPECT_EQ(sample.parts[0].size, 2.0f);
  EXPECT_EQ(sample.parts[0].shade, Shade::kDark);
  EXPECT_EQ(sample.parts[1].label, "q");
  EXPECT_EQ(sample.parts[1].size, -1.0f);
  EXPECT_EQ(sample.parts[1].shade, Shade::kBlack);
  EXPECT_EQ(sample.note, "n");
  EXPECT_EQ(sample.ratio, 0.1f);
  EXPECT_EQ(sample.count, -2147483647 - 1);
  EXPECT_FALSE(sample.on);
  EXPECT_EQ(sample.place, glm::vec3(0));
  EXPECT_EQ(sample.axis, glm::vec3(0, 0, 1));
  EXPECT_EQ(sample.shade, Shade::kDark);
  EXPECT_THAT(sample.more_names, ElementsAre("y"));
  EXPECT_THAT(sample.numbers, ElementsAre(3, -1));
  EXPECT_THAT(sample.shares, ElementsAre(0.333f, 2.0f));
  EXPECT_EQ(sample.part.label, "r");
  EXPECT_EQ(sample.part.shade, Shade::kLight);
  ASSERT_EQ(sample.more_parts.size(), 1u);
  EXPECT_EQ(sample.more_parts[0].label, "s");
}

TEST(FieldReader, KeepsDefaultsOfOmittedFields) {
  const auto [status, sample] = Read<Sample>(kLeastSample);
  ASSERT_TRUE(status.ok()) << status.ToString();
  EXPECT_EQ(sample.note, "");
  EXPECT_EQ(sample.ratio, 0.5f);
  EXPECT_EQ(sample.count, -3);
  EXPECT_TRUE(sample.on);
  EXPECT_EQ(sample.place, glm::vec3(1, 2, 3));
  EXPECT_EQ(sample.axis, std::nullopt);
  EXPECT_EQ(sample.shade, Shade::kLight);
  EXPECT_THAT(sample.more_names, IsEmpty());
  EXPECT_THAT(sample.numbers, IsEmpty());
  EXPECT_THAT(sample.shares, IsEmpty());
  EXPECT_EQ(sample.part.size, 2.0f);
  EXPECT_THAT(sample.more_parts, IsEmpty());
}

// FlatBuffers accepts a choice that is any number of a byte.
TEST(FieldReader, RejectsChoicesOutOfRange) {
  for (const char* number : {"3", "-1", "127", "-128"}) {
    const auto json = [&](const std::string& extra) {
      return std::string(kLeastSample).substr(0, sizeof(kLeastSample) - 2) + ", " + extra + "}";
    };
    const std::string shade = std::string("\"shade\": ") + number;
    const Status own = Read<Sample>(json(shade)).first;
    EXPECT_EQ(own.code(), StatusCode::kInvalidArgument) << number;
    EXPECT_EQ(own.what(), "invalid choice");
    EXPECT_EQ(own.where(), "drivers[3].sample.shade");
    const Status nested = Read<Sample>(json(R"("part": {"label": "a", )" + shade + "}")).first;
    EXPECT_EQ(nested.where(), "drivers[3].sample.part.shade") << number;
    const Status listed =
        Read<Sample>(json(R"("more_parts": [{"label": "a"}, {"label": "b", )" + shade + "}]"))
            .first;
    EXPECT_EQ(listed.where(), "drivers[3].sample.more_parts[1].shade") << number;
  }
}

TEST(FieldReader, ReportsTheFirstErrorOfTheList) {
  const auto [status, sample] = Read<Sample>(R"({"title": "a", "centre": [0, 0, 0], "names": [],
      "parts": [{"label": "a", "shade": 7}, {"label": "b", "shade": 8}], "shade": 9})");
  EXPECT_EQ(status.where(), "drivers[3].sample.parts[0].shade");
  EXPECT_EQ(sample.parts.size(), 1u);
}

// A struct that lists one field of kSampleSchema under `name` as T.
template <class T>
struct OneField {
  static inline const char* name = "";
  T value{};

  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Optional(name, &OneField::value);
  }
};

struct OneChoice {
  Shade value = Shade::kLight;

  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Choice("count", &OneChoice::value, {"light"});
  }
};

template <class T>
Status ReadOne(const char* name, const std::string& type = "test.Sample") {
  OneField<T>::name = name;
  return Read<OneField<T>>(kFullSample, type).first;
}

TEST(FieldReader, ReportsFieldsThatDifferFromTheSchema) {
  ASSERT_TRUE(ReadOne<std::string>("title").ok());
  const Status misspelled = ReadOne<std::string>("titel");
  EXPECT_EQ(misspelled.code(), StatusCode::kInternal);
  EXPECT_EQ(misspelled.where(), "drivers[3].sample.titel");
  EXPECT_EQ(ReadOne<std::string>("title", "test.Sampel").code(), StatusCode::kInternal);

  for (const Status& status :
       {ReadOne<std::string>("ratio"), ReadOne<float>("title"), ReadOne<float>("count"),
        ReadOne<int>("ratio"), ReadOne<int>("shade"), ReadOne<bool>("shade"),
        ReadOne<glm::vec3>("turn"), ReadOne<glm::vec3>("part"), ReadOne<glm::vec3>("title"),
        ReadOne<std::optional<glm::vec3>>("turn"), ReadOne<std::vector<std::string>>("parts"),
        ReadOne<std::vector<std::string>>("title"), ReadOne<std::vector<int>>("shares"),
        ReadOne<std::vector<float>>("numbers"), ReadOne<Part>("centre"), ReadOne<Part>("parts"),
        ReadOne<std::vector<Part>>("names"), ReadOne<std::vector<Part>>("part"),
        Read<OneChoice>(kFullSample).first}) {
    EXPECT_EQ(status.code(), StatusCode::kInternal) << status.ToString();
  }
}

TEST(FieldReader, HasNoTypesWithoutAValidSchema) {
  flatbuffers::FlatBufferBuilder builder;
  builder.Finish(flatbuffers::Offset<flatbuffers::Table>(builder.EndTable(builder.StartTable())));
  const auto* root = flatbuffers::GetRoot<flatbuffers::Table>(builder.GetBufferPointer());
  const SchemaTypes types("table {");
  Sample sample;
  const Status status = ReadFields(types.Describe(root, "test.Sample"), "sample", &sample);
  EXPECT_EQ(status.code(), StatusCode::kInternal);
  EXPECT_EQ(status.where(), "sample.title");
}

}  // namespace
}  // namespace furrow::rig
