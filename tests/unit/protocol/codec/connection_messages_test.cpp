// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

using test::Encoded;
using test::OpenAndDecode;

TEST(ConnectionMessages, RoundTrip) {
  Hello hello;
  ASSERT_EQ(OpenAndDecode(Encoded(Hello{"prog/1.0", 77}), hello), DecodeStatus::kOk);
  EXPECT_EQ(hello.client, "prog/1.0");
  EXPECT_EQ(hello.token, 77u);
  EXPECT_FALSE(hello.bundles);
  ASSERT_EQ(OpenAndDecode(Encoded(Hello{"", 0, true}), hello), DecodeStatus::kOk);
  EXPECT_TRUE(hello.bundles);
  EXPECT_EQ(hello.access, "");
  ASSERT_EQ(OpenAndDecode(Encoded(Hello{"", 0, false, "frw1_token"}), hello), DecodeStatus::kOk);
  EXPECT_EQ(hello.access, "frw1_token");
  const std::string longest(kMaxAccessBytes, 'x');
  ASSERT_EQ(OpenAndDecode(Encoded(Hello{"", 0, false, longest}), hello), DecodeStatus::kOk);
  EXPECT_EQ(OpenAndDecode(Encoded(Hello{"", 0, false, longest + "x"}), hello),
            DecodeStatus::kLimit);
  Welcome welcome;
  ASSERT_EQ(OpenAndDecode(Encoded(Welcome{"furrowd/9", 78}), welcome), DecodeStatus::kOk);
  EXPECT_EQ(welcome.server, "furrowd/9");
  EXPECT_EQ(welcome.token, 78u);
  Pong pong;
  ASSERT_EQ(OpenAndDecode(Encoded(Pong{-3, 5}), pong), DecodeStatus::kOk);
  EXPECT_EQ(pong.time_us, -3);
  EXPECT_EQ(pong.server_time_us, 5);
  Goodbye goodbye;
  ASSERT_EQ(OpenAndDecode(Encoded(Goodbye{GoodbyeReason::kDraining}), goodbye), DecodeStatus::kOk);
  EXPECT_EQ(goodbye.reason, GoodbyeReason::kDraining);
  ErrorMessage error;
  ASSERT_EQ(OpenAndDecode(Encoded(ErrorMessage{ErrorCode::kNeedsTcp, "use TCP"}), error),
            DecodeStatus::kOk);
  EXPECT_EQ(error.code, ErrorCode::kNeedsTcp);
  EXPECT_EQ(error.message, "use TCP");
  ASSERT_EQ(OpenAndDecode(Encoded(ErrorMessage{ErrorCode::kNotPermitted, ""}), error),
            DecodeStatus::kOk);
}

TEST(ConnectionMessages, AnErrorNamesTheWebServerOfAnotherServer) {
  ErrorMessage error;
  const ErrorMessage sent{ErrorCode::kUnknownSubject, "", "node-b", 7400, 7401, 7480, true};
  ASSERT_EQ(OpenAndDecode(Encoded(sent), error), DecodeStatus::kOk);
  EXPECT_EQ(error.host, "node-b");
  EXPECT_EQ(error.web, 7480);
  EXPECT_TRUE(error.web_tls);
  // The message before is forgotten.
  ASSERT_EQ(OpenAndDecode(Encoded(ErrorMessage{ErrorCode::kLimit, ""}), error), DecodeStatus::kOk);
  EXPECT_EQ(error.web, 0);
  EXPECT_FALSE(error.web_tls);
}

TEST(ConnectionMessages, WelcomeIsNeverLargerThanHello) {
  const std::string longest(kMaxProgramBytes, 'x');
  for (const std::string& name : {std::string(), std::string("a"), longest}) {
    EXPECT_GE(Encoded(Hello{name, 0}).size(), kHelloBytes);
    EXPECT_GE(Encoded(Hello{name, ~0ULL, true}).size(), kHelloBytes);
  }
  EXPECT_LE(Encoded(Welcome{longest, ~0ULL}).size(), kHelloBytes);
  EXPECT_LE(Encoded(Hello{longest, ~0ULL, true}).size(), kMaxDatagramBytes);
}

TEST(ConnectionMessages, RejectsUnknownValuesAndBadText) {
  Goodbye goodbye;
  EXPECT_EQ(OpenAndDecode(Encoded(Goodbye{static_cast<GoodbyeReason>(4)}), goodbye),
            DecodeStatus::kBadValue);
  ErrorMessage error;
  EXPECT_EQ(OpenAndDecode(Encoded(ErrorMessage{static_cast<ErrorCode>(17), ""}), error),
            DecodeStatus::kBadValue);
  EXPECT_EQ(OpenAndDecode(Encoded(ErrorMessage{static_cast<ErrorCode>(0), ""}), error),
            DecodeStatus::kBadValue);
  EXPECT_EQ(OpenAndDecode(Encoded(ErrorMessage{ErrorCode::kLimit, std::string(1025, 'x')}), error),
            DecodeStatus::kLimit);
  Hello hello;
  EXPECT_EQ(OpenAndDecode(Encoded(Hello{std::string(65, 'x'), 0}), hello), DecodeStatus::kLimit);
  for (const char* bad : {"\xff", "a\nb", "\xc0\x80", "\xed\xa0\x80", "\xe2\x82", "\x7f",
                          "\xf4\x90\x80\x80", "\x80", "\xf0\x80\x80\x80"}) {
    EXPECT_EQ(OpenAndDecode(Encoded(Hello{bad, 0}), hello), DecodeStatus::kBadText) << bad;
  }
  for (const char* good : {"\u00e5", "\u30db", "\U0001f600", "a b"}) {
    EXPECT_EQ(OpenAndDecode(Encoded(Hello{good, 0}), hello), DecodeStatus::kOk) << good;
    EXPECT_EQ(hello.client, good);
  }
}

}  // namespace
}  // namespace furrow::protocol
