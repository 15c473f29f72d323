// SPDX-License-Identifier: Apache-2.0
#include "server/http/upload/upload.h"

#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using testing::HasSubstr;

Url UrlOf(const std::string& query) { return *ParseUrl("/api/playback" + query); }

TEST(UploadName, LeavesFoldersOutAndRefusesWhatIsNoName) {
  EXPECT_EQ(*UploadName(UrlOf("?name=walk.bvh")), "walk.bvh");
  EXPECT_EQ(*UploadName(UrlOf("?name=..%2F..%2Fetc%2Fwalk.bvh")), "walk.bvh");
  EXPECT_EQ(*UploadName(UrlOf("?name=C%3A%5Ctakes%5Cwalk.bvh")), "walk.bvh");
  EXPECT_EQ(*UploadName(UrlOf("?name=take%23ada.mcap")), "take#ada.mcap");
  for (const std::string query :
       {"", "?name=", "?name=walk%2F", "?name=a%0Ab.bvh", "?name=a%00.bvh"}) {
    EXPECT_EQ(UploadName(UrlOf(query)).status().where(), "name") << query;
  }
  EXPECT_TRUE(UploadName(UrlOf("?name=" + std::string(255, 'a'))).ok());
  EXPECT_FALSE(UploadName(UrlOf("?name=" + std::string(256, 'a'))).ok());
}

class RefuseUploadTest : public testing::Test {
 protected:
  std::optional<ApiReply> Refuse(std::optional<std::uint64_t> size, std::uint64_t most = 64'000'000,
                                 const Access& access = Access::Everything(),
                                 const std::string& query = "?name=walk.bvh") {
    return RefuseUpload(UrlOf(query), access, size, most, &metrics);
  }
  static Access Token(Role role, const std::string& subjects) {
    protocol::secure::Grant grant;
    grant.roles = protocol::secure::Roles(role);
    grant.subjects = subjects;
    return Access::Of(grant, 1, FromSeconds(3600));
  }
  Metrics metrics;
};

TEST_F(RefuseUploadTest, TheLimitIsTheLastSizeThatIsTaken) {
  EXPECT_FALSE(Refuse(64'000'000));
  EXPECT_FALSE(Refuse(0));
  const auto refusal = Refuse(64'000'001);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->status, 413);
  EXPECT_THAT(refusal->body, HasSubstr("the limit is 64 MB (http.max_upload_megabytes)"));
  EXPECT_EQ(Refuse(~std::uint64_t{0})->status, 413);
  EXPECT_EQ(Refuse(std::nullopt)->status, 411);
  EXPECT_EQ(Refuse(1, 0)->status, 403);
}

TEST_F(RefuseUploadTest, TheRoleComesBeforeTheSize) {
  const auto watcher = Refuse(~std::uint64_t{0}, 64'000'000, Token(Role::kWatch, "*"));
  ASSERT_TRUE(watcher);
  EXPECT_EQ(watcher->status, 403);
  EXPECT_THAT(watcher->body, HasSubstr("needs the role direct"));
  EXPECT_EQ(metrics.Get(Counter::kRefusedDirect), 1u);
  EXPECT_FALSE(Refuse(1, 64'000'000, Token(Role::kDirect, "walk")));
  const auto other = Refuse(1, 64'000'000, Token(Role::kDirect, "stage-*"));
  ASSERT_TRUE(other);
  EXPECT_EQ(other->status, 403);
  EXPECT_THAT(other->body, HasSubstr("not permitted to play 'walk'"));
}

TEST_F(RefuseUploadTest, TheNameIsChecked) {
  const auto refusal = Refuse(1, 64'000'000, Access::Everything(), "");
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->status, 400);
  EXPECT_THAT(refusal->body, HasSubstr("\"field\":\"name\""));
}

TEST(UploadDeadline, FollowsWhatHasArrived) {
  const Time begun = FromSeconds(100);
  EXPECT_EQ(UploadDeadline(begun, 0), FromSeconds(110));
  EXPECT_EQ(UploadDeadline(begun, 1'000'000), FromSeconds(120));
}

TEST(UnreadableReply, IsNeverTakenForAnUnknownRoute) {
  const ApiReply reply =
      UnreadableReply({StatusCode::kNotFound, "the take has no poses", "a.mcap"});
  EXPECT_EQ(reply.status, 400);
  EXPECT_THAT(reply.body, HasSubstr("a.mcap"));
  EXPECT_EQ(UnreadableReply({StatusCode::kUnavailable, "not enough memory"}).status, 503);
}

}  // namespace
}  // namespace furrow::server
