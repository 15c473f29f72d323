// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/elsewhere.h"

#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "protocol/secure/token/roles.h"
#include "tests/unit/server/session/fake_cluster.h"

namespace furrow::server {
namespace {

class SendElsewhereTest : public ::testing::Test {
 protected:
  SendElsewhereTest() {
    NodeAddress node = FakeCluster::kOther;
    node.http = 7480;
    cluster.places["ada"] = FakeCluster::At(node);
    cluster.places["bob"] = FakeCluster::Here(FromSeconds(9.0), 1);
  }
  [[nodiscard]] std::string LocationOf(const std::string& target,
                                       const Access& access = Access::Everything(),
                                       bool is_https = false) const {
    const auto reply = SendElsewhere(&cluster, *ParseUrl(target), access, is_https, Time{0});
    EXPECT_EQ(reply ? reply->status : 307, 307);
    return reply ? reply->location : "";
  }

  FakeCluster cluster;
};

TEST_F(SendElsewhereTest, TheSamePathAndQueryAtTheOtherNode) {
  EXPECT_EQ(LocationOf("/mjpeg?subject=ada&width=320"),
            "http://host-b:7480/mjpeg?subject=ada&width=320");
  EXPECT_EQ(LocationOf("/weights?pattern=brow_*&subject=ada"),
            "http://host-b:7480/weights?pattern=brow_%2A&subject=ada");
}

TEST_F(SendElsewhereTest, ThisDaemonAnswersForItsOwnAndForUnknownSubjects) {
  for (const char* target : {"/mjpeg?subject=bob", "/mjpeg?subject=cyd", "/mjpeg",
                             "/mjpeg?subject=", "/weights?subject=ada&subject=bob"}) {
    EXPECT_EQ(LocationOf(target), "") << target;
  }
  EXPECT_FALSE(SendElsewhere(nullptr, *ParseUrl("/mjpeg?subject=ada"), Access::Everything(),
                             /*is_https=*/false, {}));
}

TEST_F(SendElsewhereTest, ANodeWithoutAWebServerIsNoPlaceToGo) {
  cluster.places["ada"].node.http = 0;
  EXPECT_EQ(LocationOf("/mjpeg?subject=ada"), "");
}

TEST_F(SendElsewhereTest, NeverFromHttpsToHttp) {
  const auto location = [this](bool is_https) {
    return LocationOf("/mjpeg?subject=ada", Access::Everything(), is_https);
  };
  EXPECT_EQ(location(/*is_https=*/true), "");
  cluster.places["ada"].node.https = true;
  EXPECT_EQ(location(/*is_https=*/true), "https://host-b:7480/mjpeg?subject=ada");
  EXPECT_EQ(location(/*is_https=*/false), "https://host-b:7480/mjpeg?subject=ada");
}

TEST_F(SendElsewhereTest, NoTokenGoesAlong) {
  EXPECT_EQ(LocationOf("/mjpeg?token=a&subject=ada&token=b&tokens=2"),
            "http://host-b:7480/mjpeg?subject=ada&tokens=2");
}

TEST_F(SendElsewhereTest, WhoMayNotWatchTheSubjectLearnsNothing) {
  EXPECT_EQ(LocationOf("/mjpeg?subject=ada", Access()), "");
}

// Nothing of the request can leave its place in the URL or add a header field.
TEST_F(SendElsewhereTest, TheRequestCannotChangeWhereItLeads) {
  EXPECT_EQ(LocationOf("/mjpeg?subject=ada&x=%0d%0aSet-Cookie:%20a"),
            "http://host-b:7480/mjpeg?subject=ada&x=%0D%0ASet-Cookie%3A%20a");
  EXPECT_EQ(LocationOf("//evil.example/?subject=ada&u=@x"),
            "http://host-b:7480//evil.example/?subject=ada&u=%40x");
}

TEST(TargetOf, IsReadAsTheSameUrl) {
  for (const char* target : {"/", "/a/b", "/a?b=", "/a%20b?c%26=d%3D&e=%C3%A5+f&c=%25"}) {
    const Url url = *ParseUrl(target);
    const Url again = *ParseUrl(TargetOf(url));
    EXPECT_EQ(again.path, url.path) << target;
    EXPECT_EQ(again.values, url.values) << target;
  }
}

}  // namespace
}  // namespace furrow::server
