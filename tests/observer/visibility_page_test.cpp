// SPDX-License-Identifier: Apache-2.0
#include "tests/observer/visibility_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::observer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr char kPage[] =
    "# Title\n\nProse.\n\n<!-- table: 0 -->\n\n## More\n\n<!-- table: 1 -->\n\nThe end.\n";

std::vector<PageTable> Tables() {
  return {{{"fold", "V"}, {{{"a"}, {"20.0"}}, {{"b"}, {"0.0"}}}},
          {{"bend", "view", "V", "share"},
           {{{"c", "front"}, {"12.0", "40%"}}, {{"c", "side"}, {"hidden", "hidden"}}}}};
}

TEST(VisibilityPage, HoldsItsTables) {
  EXPECT_EQ(PageWithTables(kPage, Tables()),
            "# Title\n\nProse.\n\n"
            "<!-- table: 0 -->\n\n| fold | V |\n|---|---|\n| a | 20.0 |\n| b | 0.0 |\n\n"
            "## More\n\n"
            "<!-- table: 1 -->\n\n| bend | view | V | share |\n|---|---|---|---|\n"
            "| c | front | 12.0 | 40% |\n| c | side | hidden | hidden |\n\nThe end.\n");
}

TEST(VisibilityPage, ReplacesOldTables) {
  std::vector<PageTable> old = Tables();
  old[0].rows.push_back({{"gone"}, {"1.0"}});
  old[1].rows.clear();
  EXPECT_EQ(PageWithTables(PageWithTables(kPage, old), Tables()), PageWithTables(kPage, Tables()));
}

TEST(VisibilityPage, DiffersOnlyBeyondTheTolerance) {
  const std::string page = PageWithTables(kPage, Tables());
  EXPECT_THAT(DifferencesFromPage(page, Tables()), IsEmpty());
  std::vector<PageTable> tables = Tables();
  tables[0].rows[0].cells = {"22.4"};
  tables[1].rows[0].cells = {"11.0", "47%"};
  EXPECT_THAT(DifferencesFromPage(page, tables), IsEmpty());
  tables[0].rows[0].cells = {"23.0"};
  tables[0].rows[1].cells = {"0.6"};
  tables[1].rows[0].cells = {"hidden", "49%"};
  tables[1].rows[1].cells = {"hidden", "1%"};
  EXPECT_THAT(DifferencesFromPage(page, tables),
              ElementsAre(HasSubstr("a: V is 23.0, the page says '20.0'"), HasSubstr("b: V is 0.6"),
                          HasSubstr("c, front: V is hidden"), HasSubstr("c, front: share is 49%"),
                          HasSubstr("c, side: share is 1%")));
}

TEST(VisibilityPage, ListsMissingAndSurplusRows) {
  const std::string page = PageWithTables(kPage, Tables());
  std::vector<PageTable> tables = Tables();
  tables[0].rows[0].labels = {"new"};
  tables[1].rows.pop_back();
  EXPECT_THAT(
      DifferencesFromPage(page, tables),
      ElementsAre("new: the page lacks the row", "a: the page has a row that was not measured",
                  "c, side: the page has a row that was not measured"));
  EXPECT_THAT(
      DifferencesFromPage("", Tables()),
      ElementsAre(HasSubstr("a: the page lacks"), HasSubstr("b: the page lacks"),
                  HasSubstr("c, front: the page lacks"), HasSubstr("c, side: the page lacks")));
}

}  // namespace
}  // namespace furrow::observer
