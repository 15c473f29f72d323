// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/address.h"

#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace furrow::client {
namespace {

using testing::HasSubstr;
using testing::Not;

Address Parsed(const std::string& text) {
  const auto address = ParseAddress(text);
  EXPECT_TRUE(address.ok()) << text << ": " << address.status().ToString();
  return address.ok() ? *address : Address{};
}

// All clients agree on these addresses and on the messages: client/js reads the same file.
TEST(Address, TextsOfAllClientsAreReadAlike) {
  std::ifstream file(FURROW_ADDRESSES);
  const auto cases = nlohmann::json::parse(file);
  ASSERT_GT(cases.size(), 50u);
  for (const auto& expected : cases) {
    const std::string text = expected["text"];
    const auto address = ParseAddress(text);
    if (expected.contains("error")) {
      ASSERT_FALSE(address.ok()) << text;
      EXPECT_EQ(address.status().ToString(), expected["error"]) << text;
      EXPECT_EQ(address.status().code(), expected["code"] == "unsupported"
                                             ? StatusCode::kUnsupported
                                             : StatusCode::kInvalidArgument)
          << text;
      continue;
    }
    ASSERT_TRUE(address.ok()) << text << ": " << address.status().ToString();
    EXPECT_EQ(address->host, expected["host"]) << text;
    EXPECT_EQ(address->port, expected["port"]) << text;
    EXPECT_EQ(address->subjects, expected["subjects"].get<std::vector<std::string>>()) << text;
    EXPECT_EQ(address->pattern, expected["pattern"]) << text;
    EXPECT_FLOAT_EQ(address->max_rate_hz, expected["rate"].get<float>()) << text;
    const std::string transport = !address->transport                         ? ""
                                  : address->transport == TransportKind::kTcp ? "tcp"
                                                                              : "udp";
    EXPECT_EQ(transport, expected["transport"]) << text;
    EXPECT_EQ(address->token, expected.value("token", "")) << text;
    EXPECT_EQ(address->tls, expected.value("tls", false)) << text;
    EXPECT_EQ(address->tls_files.authority, expected.value("tls-authority", "")) << text;
    EXPECT_EQ(address->tls_files.certificate, expected.value("tls-certificate", "")) << text;
    EXPECT_EQ(address->tls_files.key, expected.value("tls-key", "")) << text;
    EXPECT_EQ(address->token_in_clear, expected.value("token-in-clear", false)) << text;
  }
}

TEST(Address, ThePortDependsOnTheTransport) {
  EXPECT_EQ(Parsed("a").PortFor(TransportKind::kTcp), 7400);
  EXPECT_EQ(Parsed("a").PortFor(TransportKind::kUdp), 7401);
  EXPECT_EQ(Parsed("a:5").PortFor(TransportKind::kUdp), 5);
}

TEST(Address, ATokenDoesNotEndUpInALog) {
  for (const char* text : {"furrow://a?token=secret%", "furrow://a?token=secret&token=secret",
                           "furrow://a?token=secret%0A"}) {
    const auto address = ParseAddress(text);
    ASSERT_FALSE(address.ok()) << text;
    EXPECT_THAT(address.status().ToString(), Not(HasSubstr("secret")));
  }
  Address address = Parsed("furrow://a?token=frw1_secret");
  EXPECT_THAT(LoadTokenOf(address).status().ToString(), Not(HasSubstr("secret")));
  address.token = "/nowhere/secret.token";
  EXPECT_THAT(LoadTokenOf(address).status().ToString(), HasSubstr("/nowhere"));
  address.token.clear();
  EXPECT_FALSE(LoadTokenOf(address)->has_value());
}

TEST(Address, SizesAreBounded) {
  const std::string longest(255, 'a');
  EXPECT_EQ(Parsed("furrow://h?subject=" + longest).subjects[0], longest);
  EXPECT_FALSE(ParseAddress("furrow://h?subject=a" + longest).ok());
  EXPECT_FALSE(ParseAddress(std::string(256, 'h')).ok());
  EXPECT_FALSE(ParseAddress("furrow://h?pattern=" + std::string(4097, '*')).ok());
  std::string many = "furrow://h?subject=a";
  for (int i = 1; i < 256; ++i) many += "&subject=a";
  EXPECT_EQ(Parsed(many).subjects.size(), 256u);
  EXPECT_FALSE(ParseAddress(many + "&subject=a").ok());
  EXPECT_FALSE(ParseAddress(std::string(1 << 20, '&')).ok());
}

TEST(Address, EveryTruncationIsHandled) {
  const std::string whole = "furrow://[::1]:7401?subject=a%20b&rate=60&pattern=*&transport=udp";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    // The result does not matter, but each prefix is read from a buffer of its own size.
    (void)ParseAddress(std::string(whole, 0, size));
  }
  EXPECT_TRUE(ParseAddress(whole).ok());
}

}  // namespace
}  // namespace furrow::client
