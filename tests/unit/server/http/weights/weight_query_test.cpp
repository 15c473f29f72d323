// SPDX-License-Identifier: Apache-2.0
#include "server/http/weights/weight_query.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using testing::HasSubstr;

Result<WeightQuery> Parse(std::string_view target) { return WeightsOf(*ParseUrl(target)); }

TEST(WeightQuery, FollowsTheOldestSubjectByDefault) {
  const auto query = Parse("/weights");
  ASSERT_TRUE(query.ok());
  ASSERT_EQ(query->requests.size(), 1u);
  EXPECT_EQ(query->requests.front().subject, "");
  EXPECT_EQ(query->requests.front().pattern, "*");
  EXPECT_TRUE(query->requests.front().wait);
  EXPECT_EQ(Parse("/weights?pattern=")->requests.front().pattern, "*");
}

TEST(WeightQuery, ReadsSubjectsPatternAndRate) {
  const auto query = Parse("/weights?subject=ada&rate=29.97&subject=b%26b&pattern=brow_*,n*");
  ASSERT_TRUE(query.ok());
  ASSERT_EQ(query->requests.size(), 2u);
  EXPECT_EQ(query->requests[0].subject, "ada");
  EXPECT_EQ(query->requests[1].subject, "b&b");
  for (const auto& request : query->requests) {
    EXPECT_EQ(request.pattern, "brow_*,n*");
    EXPECT_FLOAT_EQ(request.max_rate_hz, 29.97f);
  }
}

TEST(WeightQuery, AsksForEveryFrameOnlyIfToldTo) {
  EXPECT_FALSE(Parse("/weights")->requests.front().every);
  EXPECT_TRUE(Parse("/weights?every=true")->requests.front().every);
  EXPECT_FALSE(Parse("/weights?every=true&every=false")->requests.front().every);
}

TEST(WeightQuery, ReadsTheLongestSilence) {
  EXPECT_EQ(Parse("/weights")->alive, std::chrono::seconds(10));
  EXPECT_EQ(Parse("/weights?alive=0.1")->alive, std::chrono::milliseconds(100));
  EXPECT_EQ(Parse("/weights?alive=60")->alive, std::chrono::minutes(1));
}

TEST(WeightQuery, NamesTheInvalidField) {
  for (const auto& [target, field] :
       {std::pair("/weights?rate=fast", "rate"), std::pair("/weights?rate=-1", "rate"),
        std::pair("/weights?rate=nan", "rate"), std::pair("/weights?rate=1001", "rate"),
        std::pair("/weights?rate=", "rate"), std::pair("/weights?every=1", "every"),
        std::pair("/weights?alive=0.09", "alive"), std::pair("/weights?alive=61", "alive"),
        std::pair("/weights?alive=nan", "alive"),
        std::pair("/weights?subject=a&subject=a", "subject"),
        std::pair("/weights?names=a", "names")}) {
    const auto query = Parse(target);
    ASSERT_FALSE(query.ok()) << target;
    EXPECT_EQ(query.status().where(), field);
  }
}

TEST(WeightQuery, LimitsLengths) {
  EXPECT_TRUE(Parse("/weights?subject=" + std::string(255, 's')).ok());
  EXPECT_EQ(Parse("/weights?subject=" + std::string(256, 's')).status().where(), "subject");
  EXPECT_TRUE(Parse("/weights?pattern=" + std::string(4096, 'p')).ok());
  EXPECT_EQ(Parse("/weights?pattern=" + std::string(4097, 'p')).status().where(), "pattern");
}

TEST(WeightQuery, LimitsTheSubjects) {
  std::string target = "/weights?rate=0";
  for (int i = 0; i < 64; ++i) target += "&subject=s" + std::to_string(i);
  EXPECT_EQ(Parse(target)->requests.size(), 64u);
  EXPECT_EQ(Parse(target + "&subject=more").status().where(), "subject");
}

}  // namespace
}  // namespace furrow::server
