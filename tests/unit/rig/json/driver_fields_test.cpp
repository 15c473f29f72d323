// SPDX-License-Identifier: Apache-2.0
// Compares the fields that each driver kind lists with the rig's schema.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <flatbuffers/idl.h>
#include <glm/vec3.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rig/rig_file.h"
#include "tests/unit/rig/json/sample_fields.h"
#include "wrinkle/drivers/driver_kinds.h"
#include "wrinkle/fields/field_list.h"

namespace furrow::rig {
namespace {

using ::testing::ContainerEq;
using ::testing::Not;

// The path of a field, "points.kind", and its type, default and attributes:
// "tail|origin|offset = tail".
using Descriptions = std::map<std::string, std::string>;

// Describes the fields that structs list.
template <class T>
class ListDescriber {
 public:
  ListDescriber(std::string at, Descriptions* to) : at_(std::move(at)), to_(to) {}

  template <class Member>
  void Required(const char* name, Member T::*member) {
    Add(name, Type(name, usual_.*member) + " (required)");
  }
  template <class Member>
  void Optional(const char* name, Member T::*member) {
    Add(name, Type(name, usual_.*member) + Default(usual_.*member));
  }
  template <class Enum>
  void Choice(const char* name, Enum T::*member, std::initializer_list<const char*> names) {
    std::string choices;
    for (const char* choice : names) choices += (choices.empty() ? "" : "|") + std::string(choice);
    const auto usual = static_cast<std::size_t>(usual_.*member);
    Add(name, choices + " = " + names.begin()[usual]);
  }

 private:
  void Add(const std::string& name, const std::string& description) {
    EXPECT_TRUE(to_->emplace(at_ + name, description).second) << at_ << name << " is listed twice";
  }

  std::string Type(const char*, const std::string&) { return "string"; }
  std::string Type(const char*, float) { return "float"; }
  std::string Type(const char*, int) { return "int"; }
  std::string Type(const char*, bool) { return "bool"; }
  std::string Type(const char*, const glm::vec3&) { return "Vec3"; }
  std::string Type(const char*, const std::optional<glm::vec3>&) { return "Vec3"; }
  template <class Item>
  std::string Type(const char* name, const std::vector<Item>&) {
    return "[" + Type(name, Item()) + "]";
  }
  template <wrinkle::ListsFields Nested>
  std::string Type(const char* name, const Nested&) {
    ListDescriber<Nested> nested(at_ + name + ".", to_);
    Nested::ListFields(nested);
    return "table";
  }

  // The schema can only state defaults of numbers. The other members must be empty by default,
  // except vectors, of which a comment in the schema states the default.
  static std::string Default(float value) { return " = " + ::testing::PrintToString(value); }
  static std::string Default(int value) { return " = " + std::to_string(value); }
  static std::string Default(bool value) { return value ? " = true" : " = false"; }
  static std::string Default(const std::string& value) {
    return value.empty() ? "" : " = " + value;
  }
  static std::string Default(const glm::vec3&) { return ""; }
  static std::string Default(const std::optional<glm::vec3>& value) {
    return value.has_value() ? " = set" : "";
  }
  template <class Item>
  static std::string Default(const std::vector<Item>& value) {
    return value.empty() ? "" : " = not empty";
  }
  template <wrinkle::ListsFields Nested>
  static std::string Default(const Nested&) {
    return "";
  }

  std::string at_;
  Descriptions* to_;
  const T usual_{};
};

template <class T>
Descriptions DescribeList() {
  Descriptions descriptions;
  ListDescriber<T> describer("", &descriptions);
  T::ListFields(describer);
  return descriptions;
}

// Describes the fields of a table as the parser of schemas sees them.
class SchemaDescriber {
 public:
  explicit SchemaDescriber(const char* text) { EXPECT_TRUE(parser_.Parse(text)) << parser_.error_; }

  // `table` is a full name. Empty if the schema has no such table.
  Descriptions Describe(const std::string& table) {
    Descriptions descriptions;
    const flatbuffers::StructDef* found = parser_.structs_.Lookup(table);
    if (found != nullptr) Add(*found, "", &descriptions);
    return descriptions;
  }

 private:
  static void Add(const flatbuffers::StructDef& table, const std::string& at, Descriptions* to) {
    for (const flatbuffers::FieldDef* field : table.fields.vec) {
      const flatbuffers::Type& type = field->value.type;
      const std::string name = at + field->name;
      const bool is_list = type.base_type == flatbuffers::BASE_TYPE_VECTOR;
      const flatbuffers::Type own = is_list ? type.VectorType() : type;
      std::string text = Type(own);
      if (text == "table") Add(*own.struct_def, name + ".", to);
      if (is_list) text = "[" + text + "]";
      if (!is_list && flatbuffers::IsScalar(own.base_type)) text += " = " + Default(*field);
      if (field->IsRequired()) text += " (required)";
      (*to)[name] = text;
    }
  }

  static std::string Type(const flatbuffers::Type& type) {
    if (type.enum_def != nullptr) return Choices(*type.enum_def);
    if (type.struct_def != nullptr) return type.struct_def->fixed ? type.struct_def->name : "table";
    return flatbuffers::kTypeNames[type.base_type];
  }

  // The names, with the number of an entry that is not in its place.
  static std::string Choices(const flatbuffers::EnumDef& choices) {
    std::string text = choices.underlying_type.base_type == flatbuffers::BASE_TYPE_CHAR ? "" : "?";
    std::int64_t place = 0;
    for (const flatbuffers::EnumVal* choice : choices.Vals()) {
      text += (place == 0 ? "" : "|") + choice->name;
      if (choice->GetAsInt64() != place) text += "=" + std::to_string(choice->GetAsInt64());
      ++place;
    }
    return text;
  }

  static std::string Default(const flatbuffers::FieldDef& field) {
    const std::string& constant = field.value.constant;
    const flatbuffers::Type& type = field.value.type;
    if (type.enum_def != nullptr) {
      const flatbuffers::EnumVal* usual = type.enum_def->FindByValue(constant);
      return usual == nullptr ? constant : usual->name;
    }
    if (type.base_type == flatbuffers::BASE_TYPE_BOOL) return constant == "0" ? "false" : "true";
    if (type.base_type != flatbuffers::BASE_TYPE_FLOAT) return constant;
    return ::testing::PrintToString(std::stof(constant));
  }

  flatbuffers::Parser parser_;
};

TEST(DriverFields, OfEveryKindAreThoseOfTheSchema) {
  SchemaDescriber schema(std::string(RigSchemaText()).c_str());
  Descriptions driver = {{"name", "string (required)"}};
#define FURROW_CHECK_KIND(Name, field)                                                        \
  {                                                                                           \
    SCOPED_TRACE("wrinkle/drivers/" #field "/" #field ".fbs and " #field "_fields.h differ"); \
    const Descriptions fields = schema.Describe("furrow.rig.schema." #Name "Driver");         \
    EXPECT_FALSE(fields.empty());                                                             \
    EXPECT_THAT(DescribeList<wrinkle::Name##Driver>(), ContainerEq(fields));                  \
    driver[#field] = "table";                                                                 \
    for (const auto& [name, text] : fields) driver[#field "." + name] = text;                 \
  }
  FURROW_DRIVER_KINDS(FURROW_CHECK_KIND)
#undef FURROW_CHECK_KIND
  EXPECT_THAT(schema.Describe("furrow.rig.schema.Driver"), ContainerEq(driver));
}

// ---- The comparison itself. ----

// The sample's schema has one more field than Sample lists.
TEST(DriverFields, FindAFieldThatIsNotListed) {
  Descriptions fields = SchemaDescriber(kSampleSchema).Describe("test.Sample");
  EXPECT_THAT(DescribeList<Sample>(), Not(ContainerEq(fields)));
  EXPECT_EQ(fields.erase("turn"), 1u);
  EXPECT_THAT(DescribeList<Sample>(), ContainerEq(fields));
}

// Each change of the schema of a part makes it differ from Part.
TEST(DriverFields, FindEveryOtherDifference) {
  const std::string part = "label: string (required); size: float = 2; shade: Shade = dark;";
  const auto describe = [&](const std::string& from, const std::string& to) {
    std::string text = "enum Shade : byte { light, dark, black } table Part { " + part + " }";
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return SchemaDescriber(text.replace(at, from.size(), to).c_str()).Describe("Part");
  };
  const Descriptions listed = DescribeList<Part>();
  EXPECT_THAT(describe("", ""), ContainerEq(listed));
  EXPECT_THAT(describe("label", "lable"), Not(ContainerEq(listed)));
  EXPECT_THAT(describe("size: float = 2;", ""), Not(ContainerEq(listed)));
  EXPECT_THAT(describe("= 2", "= 3"), Not(ContainerEq(listed)));
  EXPECT_THAT(describe("float", "int"), Not(ContainerEq(listed)));
  EXPECT_THAT(describe(" (required)", ""), Not(ContainerEq(listed)));
  EXPECT_THAT(describe(": string", ": [string]"), Not(ContainerEq(listed)));
  EXPECT_THAT(describe("= dark", "= black"), Not(ContainerEq(listed)));
  EXPECT_THAT(describe("black }", "noir }"), Not(ContainerEq(listed)));
  EXPECT_THAT(describe("black }", "black, white }"), Not(ContainerEq(listed)));
  EXPECT_THAT(describe("light, dark", "dark, light"), Not(ContainerEq(listed)));
  EXPECT_THAT(describe("light, dark", "light = -1, dark"), Not(ContainerEq(listed)));
  EXPECT_THAT(describe(": byte", ": short"), Not(ContainerEq(listed)));
}

}  // namespace
}  // namespace furrow::rig
