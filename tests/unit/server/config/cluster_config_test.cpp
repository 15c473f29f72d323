// SPDX-License-Identifier: Apache-2.0
#include "server/config/cluster_config.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/config/config.h"

namespace furrow::server {
namespace {

using testing::HasSubstr;

std::string Fault(const ClusterConfig& cluster, const std::string& name = "a",
                  const std::string& bind = "10.0.0.1") {
  return ValidateCluster(cluster, name, bind).what();
}

TEST(ValidateCluster, NeedsAName) {
  EXPECT_EQ(Fault({}, ""), "") << "no cluster";
  const ClusterConfig cluster{.store = "nats://10.0.0.5:4222"};
  EXPECT_EQ(Fault(cluster), "");
  for (const char* name : {"", "a b", "a.b"}) {
    EXPECT_THAT(Fault(cluster, name), HasSubstr("a cluster needs --name")) << name;
  }
}

TEST(ValidateCluster, ClientsNeedAnAddress) {
  ClusterConfig cluster{.store = "nats://10.0.0.5:4222"};
  for (const char* bind : {"0.0.0.0", "::"}) {
    EXPECT_THAT(Fault(cluster, "a", bind), HasSubstr("gives clients no address to go to"));
  }
  cluster.advertise = "stage-1.example";
  EXPECT_EQ(Fault(cluster, "a", "0.0.0.0"), "");
  cluster.advertise = "http://stage-1";
  EXPECT_THAT(Fault(cluster), HasSubstr("--cluster-advertise"));
}

TEST(ValidateCluster, ReadsTheAddressOfTheStore) {
  for (const char* url : {"nats://h:1", "tls://h.example:4222", "nats://[::1]:4222"}) {
    EXPECT_EQ(Fault({.store = url}), "") << url;
  }
  for (const char* url : {"h:1", "http://h:1", "nats://", "nats://h", "nats://:1", "nats://h:0",
                          "nats://h:x", "nats://user:secret@h:1", "nats://a:1,nats://b:1"}) {
    EXPECT_THAT(Fault({.store = url}), HasSubstr("nats://HOST:PORT")) << url;
    EXPECT_THAT(Fault({.store = url}), testing::Not(HasSubstr("secret")));
  }
}

TEST(ValidateCluster, AListHasThisNode) {
  EXPECT_EQ(Fault({.nodes = {"a=10.0.0.1", "b=10.0.0.2"}}), "");
  EXPECT_THAT(Fault({.nodes = {"b=10.0.0.2"}}), HasSubstr("no node named 'a'"));
  EXPECT_THAT(Fault({.nodes = {"a"}}), HasSubstr("'a' is not a node"));
  EXPECT_THAT(Fault({.store = "nats://h:1", .nodes = {"a=h"}}), HasSubstr("cannot be combined"));
}

TEST(ParseConfig, ReadsTheTableOfTheCluster) {
  Config config;
  const Status status = ParseConfig(R"([cluster]
store = "tls://h:1"
nodes = ["a=h"]
bucket = "show"
advertise = "h"
credentials = "nats.cred"
authority = "/ca.crt"
strict = true
)",
                                    "/etc/furrow/furrow.toml", &config);
  ASSERT_TRUE(status.ok()) << status.ToString();
  EXPECT_EQ(config.cluster, (ClusterConfig{.store = "tls://h:1",
                                           .nodes = {"a=h"},
                                           .bucket = "show",
                                           .advertise = "h",
                                           .credentials = "/etc/furrow/nats.cred",
                                           .authority = "/ca.crt",
                                           .strict = true}));
}

}  // namespace
}  // namespace furrow::server
