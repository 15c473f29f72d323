// SPDX-License-Identifier: Apache-2.0
// libfurrow.so receives weights from a daemon that the test controls.
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api_testing.h"

namespace furrow::capi {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(CApiTest, WeightsArriveWithTheirNames) {
  Connect("?subject=ada&pattern=brow_*&rate=60");
  EXPECT_EQ(daemon_->subscriptions[0].subject, "ada");
  EXPECT_EQ(daemon_->subscriptions[0].pattern, "brow_*");
  EXPECT_EQ(daemon_->subscriptions[0].max_rate_hz, 60.0f);
  float values[3] = {9, 9, 9};
  furrow_frame frame = NewFrame();
  EXPECT_EQ(furrow_weights(c(), "ada", values, 3, &frame), FURROW_NO_DATA);
  ASSERT_TRUE(Receive(8, {0.25f, 0.75f}));
  EXPECT_EQ(furrow_weights(c(), "ada", values, 3, &frame), FURROW_OK);
  EXPECT_THAT(values, ElementsAre(0.25f, 0.75f, 9.0f));
  EXPECT_EQ(frame.count, 2u);
  EXPECT_EQ(frame.capture_time_us, 8000);

  std::uint32_t count = 0;
  std::uint64_t layout = 0;
  EXPECT_EQ(furrow_layout(c(), "ada", &count, &layout), FURROW_OK);
  EXPECT_EQ(count, 2u);
  EXPECT_EQ(layout, frame.layout);
  char name[FURROW_NAME_SIZE];
  EXPECT_EQ(furrow_weight_name(c(), "ada", 1, name, sizeof name), FURROW_OK);
  EXPECT_STREQ(name, "brow_l.stretch");
  EXPECT_EQ(furrow_weight_name(c(), "ada", 2, name, sizeof name), FURROW_NOT_FOUND);
  std::uint32_t index = 9;
  EXPECT_EQ(furrow_find_weight(c(), "ada", "brow_l.stretch", &index), FURROW_OK);
  EXPECT_EQ(index, 1u);
  EXPECT_EQ(furrow_find_weight(c(), "ada", "nose", &index), FURROW_NOT_FOUND);
}

TEST_F(CApiTest, SmallBuffersGetNothing) {
  Connect();
  ASSERT_TRUE(Receive(1, {0.5f, 0.5f}));
  float values[2] = {9, 9};
  furrow_frame frame = NewFrame();
  EXPECT_EQ(furrow_weights(c(), "ada", values, 1, &frame), FURROW_BUFFER_TOO_SMALL);
  EXPECT_EQ(values[0], 9.0f);
  EXPECT_EQ(frame.count, 2u);
  EXPECT_EQ(furrow_weights(c(), "ada", nullptr, 2, &frame), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, nullptr), FURROW_OK);
  char name[14] = "unchanged";
  EXPECT_EQ(furrow_weight_name(c(), "ada", 0, name, 13), FURROW_BUFFER_TOO_SMALL);
  EXPECT_STREQ(name, "");
  EXPECT_THAT(LastError(c()), HasSubstr("14 bytes"));
  EXPECT_EQ(furrow_weight_name(c(), "ada", 0, name, 14), FURROW_OK);
  EXPECT_STREQ(name, "brow_l.squash");
  EXPECT_EQ(furrow_weight_name(c(), "ada", 0, name, 0), FURROW_INVALID_ARGUMENT);
}

TEST_F(CApiTest, AFrameOfAnOlderProgramIsFilledPartly) {
  Connect();
  ASSERT_TRUE(Receive(5, {0.5f, 0.5f}));
  furrow_frame frame{};
  frame.layout = 42;
  frame.struct_size = offsetof(furrow_frame, layout);
  float values[2];
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, &frame), FURROW_OK);
  EXPECT_EQ(frame.sequence, 5u);
  EXPECT_EQ(frame.layout, 42u) << "beyond the older struct";
  frame.struct_size = 0;
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, &frame), FURROW_INVALID_ARGUMENT);
}

TEST_F(CApiTest, SeveralSubjectsHaveTheirOwnWeights) {
  Connect("?subject=ada");
  furrow_subscription more{};
  more.struct_size = sizeof more;
  more.subject = "bob";
  more.flags = FURROW_SUBSCRIBE_8_BIT | FURROW_SUBSCRIBE_DRIVERS;
  EXPECT_EQ(furrow_subscribe(c(), &more), FURROW_OK);
  EXPECT_EQ(furrow_subscribe(c(), &more), FURROW_INVALID_ARGUMENT) << "twice";
  ASSERT_TRUE(Polled([&] { return furrow_layout(c(), "bob", nullptr, nullptr) == FURROW_OK; }));
  EXPECT_EQ(daemon_->subscriptions[1].format, protocol::WeightFormat::kU8);
  EXPECT_EQ(daemon_->subscriptions[1].source, protocol::WeightSource::kDriverValues);
  EXPECT_TRUE(daemon_->subscriptions[1].wait);
  daemon_->SendWeights(2, 3, {1.0f, 0.0f});
  ASSERT_TRUE(Receive(3, {0.0f, 1.0f}));
  float values[2];
  EXPECT_EQ(furrow_weights(c(), "bob", values, 2, nullptr), FURROW_OK);
  EXPECT_THAT(values, ElementsAre(1.0f, 0.0f));
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, nullptr), FURROW_OK);
  EXPECT_THAT(values, ElementsAre(0.0f, 1.0f));
  EXPECT_EQ(InfoOf(c()).subjects, 2u);
  EXPECT_EQ(furrow_unsubscribe(c(), "ada"), FURROW_OK);
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, nullptr), FURROW_NOT_FOUND);
  ASSERT_TRUE(Polled([&] { return daemon_->unsubscribed == 1; }));
}

TEST_F(CApiTest, TheOldestSubjectIsFoundByBothNames) {
  Connect("");
  char name[FURROW_NAME_SIZE];
  EXPECT_EQ(furrow_subject_name(c(), 0, name, sizeof name), FURROW_OK);
  EXPECT_STREQ(name, "ada");
  for (const char* subject : {"", "ada", static_cast<const char*>(nullptr)}) {
    EXPECT_EQ(furrow_weights(c(), subject, nullptr, 0, nullptr), FURROW_NO_DATA);
  }
  EXPECT_EQ(furrow_subject_name(c(), 1, name, sizeof name), FURROW_NOT_FOUND);
}

TEST_F(CApiTest, ARejectedPatternIsReportedAndRequestedAgain) {
  daemon_->reject = protocol::ErrorCode::kNoMatch;
  connection_ = Open(daemon_->address("?subject=ada&pattern=nose"));
  float values[2];
  ASSERT_TRUE(
      Polled([&] { return furrow_weights(c(), "ada", values, 2, nullptr) == FURROW_NO_MATCH; }));
  EXPECT_EQ(LastError(c()), "rejected by the test");
  daemon_->reject = {};
  ASSERT_TRUE(Polled([&] { return furrow_layout(c(), "ada", nullptr, nullptr) == FURROW_OK; }));
}

TEST_F(CApiTest, AnotherRigChangesTheLayout) {
  Connect();
  std::uint64_t before = 0;
  EXPECT_EQ(furrow_layout(c(), "ada", nullptr, &before), FURROW_OK);
  daemon_->names = {"brow_l.stretch", "brow_l.squash"};
  daemon_->SendReply(1, daemon_->requests[0], "ada");
  std::uint64_t after = 0;
  ASSERT_TRUE(Polled(
      [&] { return furrow_layout(c(), "ada", nullptr, &after) == FURROW_OK && after != before; }));
  std::uint32_t index = 9;
  EXPECT_EQ(furrow_find_weight(c(), "ada", "brow_l.squash", &index), FURROW_OK);
  EXPECT_EQ(index, 1u);
}

TEST_F(CApiTest, ARestartedDaemonIsFoundAgain) {
  Connect();
  ASSERT_TRUE(Receive(100, {0.5f, 0.5f}));
  EXPECT_EQ(InfoOf(c()).state, FURROW_CONNECTED);
  const std::uint16_t port = daemon_->port();
  daemon_.reset();
  ASSERT_TRUE(Until([&] {
    EXPECT_GE(furrow_poll(c(), 1), FURROW_OK);
    return InfoOf(c()).state == FURROW_DISCONNECTED;
  }));
  EXPECT_THAT(LastError(c()), HasSubstr("no connection to 127.0.0.1"));
  float values[2];
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, nullptr), FURROW_OK) << "the last weights";
  daemon_ = std::make_unique<FakeDaemon>(port, 78);
  ASSERT_TRUE(Polled([&] { return InfoOf(c()).connects == 2 && !daemon_->requests.empty(); }));
  EXPECT_EQ(daemon_->subscriptions[0].subject, "ada");
  ASSERT_TRUE(Receive(0, {1.0f, 0.0f}));
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, nullptr), FURROW_OK);
  EXPECT_THAT(values, ElementsAre(1.0f, 0.0f));
}

TEST_F(CApiTest, HostileMessagesChangeNothing) {
  Connect();
  ASSERT_TRUE(Receive(1, {0.25f, 0.5f}));
  protocol::WeightFrame frame;
  frame.names_hash = protocol::NamesHash(daemon_->names);
  frame.values = {1.0f, 1.0f};
  std::vector<std::uint8_t> whole;
  protocol::Encoder().Encode({.session = 77, .stream = 1, .sequence = 2}, frame, whole);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    daemon_->SendBytes(std::span(whole).first(size));
    if (size % 16 == 0) (void)furrow_poll(c(), 0);
  }
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> bytes = whole;
    // After the envelope, so that the decoders of the payload see them too.
    for (int flips = 0; flips < 3; ++flips) bytes[32 + random() % (bytes.size() - 32)] = random();
    bytes[8] ^= 1;  // from another session, so that an intact one would only start over
    daemon_->SendBytes(bytes);
    (void)furrow_poll(c(), 0);
  }
  frame.names_hash = 1;
  daemon_->Send({.stream = 1, .sequence = 3}, frame);
  frame.values.resize(1);
  daemon_->Send({.stream = 9, .sequence = 3}, frame);
  EXPECT_GT(InfoOf(c()).malformed, 100u);
  // The connection still works. It has asked again, because other sessions seemed to answer.
  std::uint32_t sequence = 50;
  ASSERT_TRUE(Polled([&] {
    daemon_->SendWeights(static_cast<std::uint16_t>(daemon_->requests.size()), ++sequence,
                         {0.75f, 0.5f});
    float values[2];
    return furrow_weights(c(), "ada", values, 2, nullptr) == FURROW_OK && values[0] == 0.75f;
  }));
}

}  // namespace
}  // namespace furrow::capi
