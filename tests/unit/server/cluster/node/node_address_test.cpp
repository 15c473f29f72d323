// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/node/node_address.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

TEST(ParseNode, ReadsNamesHostsAndPorts) {
  EXPECT_EQ(*ParseNode("b=10.0.0.2"), (NodeAddress{"b", "10.0.0.2", 7400, 7401, 7480}));
  EXPECT_EQ(*ParseNode("b=node-b:1:2:3"), (NodeAddress{"b", "node-b", 1, 2, 3}));
  EXPECT_EQ(*ParseNode("b=[::1]:1:2"), (NodeAddress{"b", "::1", 1, 2, 7480}));
}

TEST(ParseNode, RefusesOtherText) {
  for (const char* text : {"", "b", "=h", "b=", "b c=h", "b=h:0", "b=h:x", "b=h:1:2:3:4",
                           "b=h:65536", "b=[::1", "b=h/x", "b=u@h", "b=h ", "b=[::1]x"}) {
    EXPECT_FALSE(ParseNode(text).ok()) << text;
  }
}

TEST(WebAddressOf, IsAUrlThatBrowsersOpen) {
  NodeAddress node{"b", "10.0.0.2", 7400, 7401, 7480};
  EXPECT_EQ(WebAddressOf(node), "http://10.0.0.2:7480");
  node.https = true;
  EXPECT_EQ(WebAddressOf(node), "https://10.0.0.2:7480");
  node.host = "::1";
  EXPECT_EQ(WebAddressOf(node), "https://[::1]:7480");
  node.host = "fe80::1%eth0";
  EXPECT_EQ(WebAddressOf(node), "") << "browsers know no zones";
  node = {"b", "node-b", 7400, 7401, 0};
  EXPECT_EQ(WebAddressOf(node), "") << "it has no web port";
}

TEST(IsNodeName, AllowsWhatFitsIntoATokenAndAKey) {
  EXPECT_TRUE(IsNodeName("Stage_1-b"));
  EXPECT_TRUE(IsNodeName(std::string(47, 'a')));
  for (const auto& name :
       {std::string(), std::string("a b"), std::string("a.b"), std::string(48, 'a')}) {
    EXPECT_FALSE(IsNodeName(name)) << name;
  }
}

}  // namespace
}  // namespace furrow::server
