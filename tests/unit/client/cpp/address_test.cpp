// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/address.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::client {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Address Parsed(const std::string& text) {
  const auto address = ParseAddress(text);
  EXPECT_TRUE(address.ok()) << text << ": " << address.status().ToString();
  return address.ok() ? *address : Address{};
}

TEST(Address, StatesAHostAndPerhapsAPort) {
  struct Case {
    const char* text;
    const char* host;
    int port;
  };
  for (const Case& c :
       {Case{"localhost", "localhost", 0}, Case{"10.0.0.1:80", "10.0.0.1", 80},
        Case{"::1", "::1", 0}, Case{"[::1]", "::1", 0}, Case{"[::1]:9", "::1", 9},
        Case{"furrow://localhost", "localhost", 0}, Case{"furrow://localhost/", "localhost", 0},
        Case{"furrow://localhost?", "localhost", 0},
        Case{"furrow://[fe80::1%eth0]:65535", "fe80::1%eth0", 65535}}) {
    const Address address = Parsed(c.text);
    EXPECT_EQ(address.host, c.host) << c.text;
    EXPECT_EQ(address.port, c.port) << c.text;
    EXPECT_FALSE(address.transport.has_value()) << c.text;
    EXPECT_THAT(address.subjects, IsEmpty()) << c.text;
  }
}

TEST(Address, StatesSubjectsPatternRateAndTransport) {
  const Address address = Parsed(
      "furrow://stage:7000?subject=ada&rate=59.94&pattern=brow_*,mouth_?.*&transport=tcp&subject="
      "b%26b%25");
  EXPECT_EQ(address.host, "stage");
  EXPECT_EQ(address.port, 7000);
  EXPECT_THAT(address.subjects, ElementsAre("ada", "b&b%"));
  EXPECT_FLOAT_EQ(address.max_rate_hz, 59.94f);
  EXPECT_EQ(address.pattern, "brow_*,mouth_?.*");
  EXPECT_EQ(address.transport, TransportKind::kTcp);
}

TEST(Address, ThePortDependsOnTheTransport) {
  EXPECT_EQ(Parsed("a").PortFor(TransportKind::kTcp), 7400);
  EXPECT_EQ(Parsed("a").PortFor(TransportKind::kUdp), 7401);
  EXPECT_EQ(Parsed("a:5").PortFor(TransportKind::kUdp), 5);
}

TEST(Address, InvalidTextIsRejected) {
  for (const char* text : {"",
                           ":80",
                           "a:",
                           "a:0",
                           "a:65536",
                           "a:80x",
                           "a:-1",
                           "[::1",
                           "[::1]9",
                           "[::1]:",
                           "[]",
                           "a b",
                           "a/b",
                           "a?subject=b",
                           "user@a",
                           "http://a",
                           "furrow://",
                           "furrow://?subject=a",
                           "furrow://a/b",
                           "furrow://a:x",
                           "furrow://a#b",
                           "furrow://a?subject",
                           "furrow://a?subject=",
                           "furrow://a?subject=%",
                           "furrow://a?subject=%4",
                           "furrow://a?subject=%GG",
                           "furrow://a?subject=%0A",
                           "furrow://a?subject=%FF",
                           "furrow://a?nonsense=1",
                           "furrow://a?Subject=b",
                           "furrow://a?rate=0",
                           "furrow://a?rate=-1",
                           "furrow://a?rate=1001",
                           "furrow://a?rate=nan",
                           "furrow://a?rate=1&rate=2",
                           "furrow://a?pattern=a&pattern=b",
                           "furrow://a?transport=quic",
                           "furrow://a?transport=udp&transport=udp"}) {
    const auto address = ParseAddress(text);
    ASSERT_FALSE(address.ok()) << text;
    EXPECT_EQ(address.status().code(), StatusCode::kInvalidArgument) << text;
    EXPECT_THAT(address.status().ToString(), HasSubstr("address: ")) << text;
  }
}

TEST(Address, ReservedKeysAreNotIgnored) {
  for (const char* text : {"furrow://a?token=secret", "furrow://a?key=AA", "furrow://a?tls",
                           "furrow://a?transport=shm"}) {
    const auto address = ParseAddress(text);
    ASSERT_FALSE(address.ok()) << text;
    EXPECT_EQ(address.status().code(), StatusCode::kUnsupported) << text;
    // A token must not end up in a log.
    EXPECT_THAT(address.status().ToString(), Not(HasSubstr("secret")));
  }
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
