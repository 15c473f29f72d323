// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/text_template.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

TemplateData Data() {
  TemplateData data;
  data.texts = {{"name", "outer"}, {"empty", ""}};
  data.lists["none"] = {};
  data.lists["maps"] = {{{{"name", "a"}, {"file", "a.png"}}, {}},
                        {{{"name", "b"}, {"file", ""}}, {}}};
  data.lists["maps"][0].lists["terms"] = {{{{"mask", "0"}}, {}}, {{{"mask", "3"}}, {}}};
  data.lists["maps"][1].lists["terms"] = {};
  return data;
}

std::string Expanded(const std::string& text) {
  const auto result = ExpandTemplate(text, Data(), "t");
  return result.ok() ? *result : result.status().ToString();
}

TEST(TextTemplate, ReplacesNames) {
  EXPECT_EQ(Expanded("a @{name} b @{name}@{empty}."), "a outer b outer.\n");
  EXPECT_EQ(Expanded(""), "");
  EXPECT_EQ(Expanded("me@example.com @each"), "me@example.com @each\n");
}

TEST(TextTemplate, RepeatsBlocksWithInnerNamesFirst) {
  EXPECT_EQ(
      Expanded(
          "// @each maps\n@{name}\n// @each terms\n  @{name}@{mask}\n// @end\n// @end\n@{name}\n"),
      "a\n  a0\n  a3\nb\nouter\n");
  EXPECT_EQ(Expanded("# @each none\nx\n# @end\n"), "");
}

TEST(TextTemplate, KeepsBlocksByTextsAndLists) {
  EXPECT_EQ(Expanded("<!-- @if name -->\nx\n<!-- @end -->\n"), "x\n");
  EXPECT_EQ(Expanded("// @if empty\nx\n// @end\n// @unless empty\ny\n// @end\n"), "y\n");
  EXPECT_EQ(Expanded("// @if none\nx\n// @end\n// @if maps\ny\n// @end\n"), "y\n");
  EXPECT_EQ(Expanded("// @each maps\n// @if file\n@{file}\n// @end\n// @end\n"), "a.png\n");
}

TEST(TextTemplate, ReportsFaultsWithTheirLine) {
  const struct {
    const char* text;
    const char* where;
  } cases[] = {{"x\n@{missing}\n", "t:2"},        {"@{name\n", "t:1"},
               {"\n// @each maps\n", "t:2"},      {"// @end\n", "t:1"},
               {"// @each name\n// @end", "t:1"}, {"// @if missing\n// @end", "t:1"}};
  for (const auto& c : cases) {
    const auto result = ExpandTemplate(c.text, Data(), "t");
    ASSERT_FALSE(result.ok()) << c.text;
    EXPECT_EQ(result.status().code(), StatusCode::kParse);
    EXPECT_EQ(result.status().where(), c.where) << c.text;
  }
}

}  // namespace
}  // namespace furrow::authoring
