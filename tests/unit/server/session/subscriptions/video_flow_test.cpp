// SPDX-License-Identifier: Apache-2.0
// Which picture must be a key picture. A small model of encoder, network and decoder checks the
// rule: nothing is decoded after a loss before a key picture, and decoding always goes on.
#include "server/session/subscriptions/video_flow.h"

#include <cstdint>
#include <deque>
#include <random>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

constexpr Time kNow = FromSeconds(1.0);

protocol::FrameAck Ack(std::uint32_t number, bool needs_key) {
  return {.number = number, .needs_key = needs_key};
}

TEST(VideoFlow, AKeyIsRequestedOnce) {
  VideoFlow flow;
  EXPECT_FALSE(flow.Target().key) << "an encoder begins with one anyway";
  flow.Sent(1, 900, true, kNow);
  flow.Sent(2, 90, false, kNow);
  flow.Acknowledge(Ack(2, true), kNow);
  EXPECT_TRUE(flow.Target().key);
  flow.Sent(3, 900, true, kNow);
  EXPECT_FALSE(flow.Target().key);
}

TEST(VideoFlow, AnOldRequestIsAnsweredByTheKeyUnderWay) {
  VideoFlow flow;
  flow.Sent(1, 900, true, kNow);
  flow.Sent(2, 90, false, kNow);
  flow.Acknowledge(Ack(1, true), kNow);
  flow.Sent(3, 900, true, kNow);
  flow.Acknowledge(Ack(2, true), kNow);
  EXPECT_FALSE(flow.Target().key);
  flow.Acknowledge(Ack(3, true), kNow);  // not even this one can be decoded
  EXPECT_TRUE(flow.Target().key);
}

TEST(VideoFlow, ALostPictureIsFollowedByAKey) {
  VideoFlow flow;
  flow.Sent(1, 900, true, kNow);
  flow.Lose();
  EXPECT_TRUE(flow.Target().key);
  flow.Sent(2, 90, false, kNow);  // encoded before the loss was known
  EXPECT_TRUE(flow.Target().key);
}

TEST(VideoFlow, DecodingGoesOnAfterAnyLoss) {
  std::mt19937 random(5);
  const auto one_in = [&random](int n) { return random() % static_cast<unsigned>(n) == 0; };
  VideoFlow flow;
  struct Sent {
    std::uint32_t number;
    bool key;
    std::uint32_t encoded;  // counts the pictures that went through the encoder
  };
  std::deque<Sent> network;
  std::uint32_t number = 0xFFFFFF00u;  // wraps around
  std::uint32_t encoded = 0;
  std::uint32_t decoded = 0;  // the last one
  std::uint32_t seen = number;
  bool needs_key = false;
  int shown = 0;
  for (int step = 0; step < 20'000; ++step) {
    const bool key = flow.Target().key || encoded == 0;
    ++encoded;
    if (one_in(50)) {
      flow.Lose();  // such as a picture that is too large
    } else {
      flow.Sent(++number, 100, key, kNow);
      network.push_back({number, key, encoded});
      if (one_in(40)) network.pop_back();  // nobody notices but the viewer
    }
    while (network.size() > (one_in(3) ? 0u : 1u)) {
      const Sent picture = network.front();
      network.pop_front();
      if (picture.number != seen + 1) needs_key = true;
      seen = picture.number;
      if (picture.key) needs_key = false;
      if (!needs_key) {
        ASSERT_TRUE(picture.key || picture.encoded == decoded + 1) << step;
        decoded = picture.encoded;
        ++shown;
      }
      flow.Acknowledge(Ack(picture.number, needs_key), kNow);
    }
  }
  EXPECT_GT(shown, 20'000 * 0.85);
}

}  // namespace
}  // namespace furrow::server
