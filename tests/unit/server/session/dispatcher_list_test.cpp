// SPDX-License-Identifier: Apache-2.0
// ListSubjects: once, and with follow.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using Names = std::vector<std::string>;

class DispatcherListTest : public HubTest {
 protected:
  void SetUp() override {
    HubTest::SetUp();
    Connect(&sender);
    Connect(&asker);
  }
  void Come(const std::string& name, std::uint16_t stream) {
    Send(sender, Offer(name), stream);
    sender.inbox.clear();
  }
  FakePeer sender;
  FakePeer asker;
};

TEST_F(DispatcherListTest, ListsNamesInOrderOfArrival) {
  Send(asker, protocol::ListSubjects{});
  const auto nobody = asker.Take<protocol::Subjects>();
  ASSERT_TRUE(nobody);
  EXPECT_TRUE(nobody->message.names.empty());
  Come("zoe", 1);
  Come("ada", 2);
  hub->Tick(now);
  EXPECT_TRUE(asker.inbox.empty()) << "it asked once";
  Send(asker, protocol::ListSubjects{});
  const auto both = asker.Take<protocol::Subjects>();
  ASSERT_TRUE(both);
  EXPECT_EQ(both->message.names, (Names{"zoe", "ada"}));
  EXPECT_EQ(both->message.total, 2u);
}

TEST_F(DispatcherListTest, AFollowerReceivesChanges) {
  Send(asker, protocol::ListSubjects{.follow = true});
  ASSERT_TRUE(asker.Take<protocol::Subjects>());
  Come("ada", 1);
  Come("bob", 2);
  hub->Tick(now);
  const auto both = asker.Take<protocol::Subjects>();
  ASSERT_TRUE(both);
  EXPECT_EQ(both->message.names, (Names{"ada", "bob"}));
  EXPECT_TRUE(asker.inbox.empty()) << "once for both";
  hub->Tick(now);
  EXPECT_TRUE(asker.inbox.empty()) << "nothing has changed";
  Send(sender, protocol::Goodbye{}, 1);
  now += std::chrono::seconds(60);
  hub->Tick(now);
  hub->Tick(now);
  const auto gone = asker.Take<protocol::Subjects>();
  ASSERT_TRUE(gone);
  EXPECT_TRUE(gone->message.total < 2);
  Send(asker, protocol::ListSubjects{.follow = false});
  ASSERT_TRUE(asker.Take<protocol::Subjects>());
  Come("eve", 3);
  hub->Tick(now);
  EXPECT_TRUE(asker.inbox.empty()) << "it follows no longer";
}

TEST_F(DispatcherListTest, IsUnavailableOverUdp) {
  FakePeer udp;
  Connect(&udp, Transport::kUdp);
  Send(udp, protocol::ListSubjects{});
  const auto error = udp.Take<protocol::ErrorMessage>();
  ASSERT_TRUE(error);
  EXPECT_EQ(error->message.code, protocol::ErrorCode::kNeedsTcp);
}

}  // namespace
}  // namespace furrow::server
