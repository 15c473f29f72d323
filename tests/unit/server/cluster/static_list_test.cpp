// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/static_list.h"

#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

std::vector<NodeAddress> Nodes(int count) {
  std::vector<NodeAddress> nodes;
  for (int i = 0; i < count; ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    nodes.push_back({name, "host-" + name, 7400, 7401, 7480});
  }
  return nodes;
}

TEST(StaticList, AllNodesAgreeAndOneServes) {
  std::vector<StaticList> lists;
  for (const NodeAddress& node : Nodes(3)) {
    lists.emplace_back(node.name, Nodes(3));
    ASSERT_TRUE(lists.back().Start(node).ok());
  }
  std::map<std::string, int> served;
  for (int i = 0; i < 300; ++i) {
    const std::string subject = "performer-" + std::to_string(i);
    int here = 0;
    const std::string owner = lists[0].Find(subject, Time{0}).node.name;
    for (StaticList& list : lists) {
      const Place place = list.Ask(subject, Time{0});
      EXPECT_EQ(place.node.name, owner);
      here += place.kind == Place::Kind::kHere ? 1 : 0;
    }
    EXPECT_EQ(here, 1);
    ++served[owner];
  }
  for (const auto& [name, count] : served) EXPECT_GT(count, 60) << name;
}

TEST(StaticList, ANodeMoreMovesOnlyWhatItGets) {
  StaticList three("a", Nodes(3));
  StaticList four("a", Nodes(4));
  for (int i = 0; i < 300; ++i) {
    const std::string subject = "performer-" + std::to_string(i);
    const std::string before = three.Find(subject, Time{0}).node.name;
    const std::string after = four.Find(subject, Time{0}).node.name;
    EXPECT_TRUE(after == before || after == "d") << subject;
  }
}

// A node without a web server may have a certificate, for its TCP port.
TEST(StaticList, TheOtherNodesSpeakHttpsIfThisOneHasTls) {
  for (const bool https : {false, true}) {
    StaticList list("a", Nodes(3));
    NodeAddress self = Nodes(1).front();
    self.http = 0;
    self.https = https;
    ASSERT_TRUE(list.Start(self).ok());
    EXPECT_EQ(list.Others().size(), 2u);
    for (const NodeAddress& other : list.Others()) EXPECT_EQ(other.https, https) << other.name;
  }
}

TEST(StaticList, ADrainingNodeTakesNothing) {
  StaticList list("a", Nodes(1));
  EXPECT_EQ(list.Ask("ada", Time{0}).kind, Place::Kind::kHere);
  list.SetDraining();
  EXPECT_EQ(list.Ask("ada", Time{0}).kind, Place::Kind::kNowhere);
}

}  // namespace
}  // namespace furrow::server
