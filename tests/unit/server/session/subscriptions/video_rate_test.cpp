// SPDX-License-Identifier: Apache-2.0
// The bit rate over a simulated link, in simulated time.
#include "server/session/subscriptions/video_rate.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

// A link that sends one picture after the other, a viewer that acknowledges, and an encoder that
// fills its target. As with ViewerFlow, at most two pictures are under way.
class Link {
 public:
  double kbps = 5000.0;     // that the link carries
  double delay_s = 0.02;    // there and back, without waiting
  double jitter_s = 0.0;    // at most, added to each acknowledgement
  double held_s = 0.0;      // by the viewer
  bool admits_held = true;  // the viewer says so
  double hz = 30.0;         // poses
  double needs_kbps = 1e9;  // what the pictures need at full quality
  double now_s = 1.0;
  int shown = 0;  // pictures
  int due = 0;
  double worst_trip_s = 0.0;  // since the last call of Run()

  explicit Link(std::uint32_t first = 1) : next_(first) {}

  void Run(double seconds) {
    worst_trip_s = 0.0;
    const double end = now_s + seconds;
    while (now_s < end) {
      Acknowledge(now_s);
      ++due;
      if (acks_.size() < 2) Send();
      now_s += 1.0 / hz;
    }
  }
  VideoRate rate;

 private:
  struct Ack {
    std::uint32_t number;
    double sent_s, at_s;
  };
  void Send() {
    const double needed = std::min<double>(rate.PictureBits(), needs_kbps * 1e3 / hz);
    const double bits = needed * std::uniform_real_distribution(0.8, 1.2)(random_);
    rate.Sent(next_, static_cast<std::size_t>(bits / 8.0), FromSeconds(now_s));
    free_s_ = std::max(free_s_, now_s) + bits / (kbps * 1e3);
    const double jitter = std::uniform_real_distribution(0.0, 1.0)(random_) * jitter_s;
    last_s_ = std::max(last_s_, free_s_ + delay_s + held_s + jitter);  // they keep their order
    acks_.push_back({next_++, now_s, last_s_});
  }
  void Acknowledge(double until) {
    while (!acks_.empty() && acks_.front().at_s <= until) {
      const Ack ack = acks_.front();
      acks_.pop_front();
      ++shown;
      worst_trip_s = std::max(worst_trip_s, ack.at_s - ack.sent_s);
      rate.Acknowledged(ack.number, FromSeconds(admits_held ? held_s : 0.0), FromSeconds(ack.at_s));
    }
  }

  std::mt19937 random_{7};
  std::uint32_t next_;
  double free_s_ = 0.0;
  double last_s_ = 0.0;
  std::deque<Ack> acks_;
};

TEST(VideoRate, FallsBelowWhatTheLinkCarries) {
  for (const double kbps : {250.0, 500.0, 1000.0, 2000.0}) {
    for (const double delay_s : {0.005, 0.05, 0.2}) {
      Link link;
      link.kbps = kbps;
      link.delay_s = delay_s;
      link.Run(4.0);
      // On a long way, two pictures under way do not fill the link, whatever the rate.
      if (delay_s < 0.1) {
        EXPECT_LE(link.rate.kbps(), kbps * 1.1) << kbps << " kbit/s, " << delay_s << " s";
      }
      EXPECT_GE(link.rate.kbps(), kbps * 0.35) << kbps << " kbit/s, " << delay_s << " s";
      EXPECT_LE(link.worst_trip_s, delay_s + 1.0) << kbps << " kbit/s, " << delay_s << " s";
    }
  }
}

TEST(VideoRate, StaysNearTheLinkAndKeepsQueuesShort) {
  for (const double kbps : {500.0, 1500.0, 6000.0}) {
    Link link;
    link.kbps = kbps;
    link.Run(10.0);
    double sum = 0.0;
    double worst_s = 0.0;
    for (int second = 0; second < 60; ++second) {
      link.Run(1.0);
      sum += link.rate.kbps();
      worst_s = std::max(worst_s, link.worst_trip_s);
    }
    EXPECT_GE(sum / 60, 0.55 * kbps) << kbps;
    EXPECT_LE(sum / 60, 1.1 * kbps) << kbps;
    EXPECT_LE(worst_s, link.delay_s + 0.25) << kbps;
  }
}

TEST(VideoRate, FallsQuicklyAndRisesSlowly) {
  Link link;
  link.kbps = 8000.0;
  link.Run(30.0);
  const int high = link.rate.kbps();
  EXPECT_GT(high, 4000);
  link.kbps = 600.0;
  link.Run(3.0);
  EXPECT_LE(link.rate.kbps(), 700);
  link.kbps = 8000.0;
  const int low = link.rate.kbps();
  link.Run(1.0);
  EXPECT_LE(link.rate.kbps(), 1.7 * low);
  link.Run(60.0);
  EXPECT_GE(link.rate.kbps(), 4000);
}

TEST(VideoRate, NeverLeavesItsBounds) {
  std::mt19937 random(3);
  Link link(0xFFFFFFF0u);  // numbers wrap around
  for (int i = 0; i < 300; ++i) {
    link.kbps = std::exp(std::uniform_real_distribution(1.0, 12.0)(random));
    link.delay_s = std::uniform_real_distribution(0.0, 0.5)(random);
    link.jitter_s = std::uniform_real_distribution(0.0, 0.3)(random);
    link.held_s = std::uniform_real_distribution(0.0, 0.3)(random);
    link.hz = std::uniform_real_distribution(1.0, 120.0)(random);
    link.Run(1.0);
    ASSERT_GE(link.rate.kbps(), VideoRate::kMinKbps);
    ASSERT_LE(link.rate.kbps(), VideoRate::kMaxKbps);
    ASSERT_GT(link.rate.PictureBits(), 0);
  }
}

TEST(VideoRate, AViewerThatKeepsItsPicturesIsNoSlowLink) {
  Link link;
  link.kbps = 20'000.0;
  link.held_s = 0.2;
  link.Run(20.0);
  EXPECT_GE(link.rate.kbps(), VideoRate::kStartKbps);
}

TEST(VideoRate, DelaysThatDoNotComeFromTheBitsAreForgiven) {
  Link link;
  link.kbps = 50'000.0;
  link.needs_kbps = 800.0;
  link.Run(5.0);
  // A busy machine: every acknowledgement is late, whatever its picture weighs.
  link.held_s = 0.15;
  link.admits_held = false;
  link.Run(10.0);
  EXPECT_GE(link.rate.kbps(), 800);
}

TEST(VideoRate, JitterIsForgiven) {
  for (const double jitter_s : {0.03, 0.06, 0.1}) {
    Link link;
    link.kbps = 20'000.0;
    link.jitter_s = jitter_s;
    double sum = 0.0;
    for (int second = 0; second < 60; ++second) {
      link.Run(1.0);
      sum += link.rate.kbps() / 60.0;
    }
    EXPECT_GE(sum, 1500) << jitter_s;
  }
}

TEST(VideoRate, ASingleLatePictureMeansNothing) {
  VideoRate rate;
  double now_s = 1.0;
  for (std::uint32_t number = 1; number <= 300; ++number) {
    rate.Sent(number, 5000, FromSeconds(now_s));
    const double trip_s = number % 3 == 0 ? 0.4 : 0.02;
    now_s += trip_s;
    rate.Acknowledged(number, Time{0}, FromSeconds(now_s));
  }
  EXPECT_GE(rate.kbps(), VideoRate::kStartKbps);
}

TEST(VideoRate, AnUnusedRateDoesNotRise) {
  Link link;
  link.kbps = 1e6;
  link.needs_kbps = 500.0;
  link.Run(60.0);
  EXPECT_EQ(link.rate.kbps(), VideoRate::kStartKbps);
}

TEST(VideoRate, APictureGetsItsShareOfTheRate) {
  for (const double hz : {10.0, 30.0, 60.0}) {
    Link link;
    link.kbps = 1e6;
    link.needs_kbps = 500.0;
    link.hz = hz;
    link.Run(10.0);
    EXPECT_NEAR(link.rate.PictureBits(), VideoRate::kStartKbps * 1e3 / hz, 2e3) << hz;
  }
}

TEST(VideoRate, SurvivesAcknowledgementsOfEveryKind) {
  VideoRate rate;
  rate.Acknowledged(7, Time{0}, FromSeconds(1.0));
  for (std::uint32_t number = 1; number < 100; ++number) {  // a viewer that never acknowledges
    rate.Sent(number, 1 << 24, FromSeconds(1.0));
  }
  rate.Acknowledged(1, FromSeconds(1e6), FromSeconds(2.0));    // long forgotten
  rate.Acknowledged(99, FromSeconds(1e6), FromSeconds(2.0));   // kept longer than it took
  rate.Acknowledged(99, FromSeconds(-5.0), FromSeconds(2.0));  // twice
  EXPECT_GE(rate.kbps(), VideoRate::kMinKbps);
  EXPECT_LE(rate.kbps(), VideoRate::kMaxKbps);
}

}  // namespace
}  // namespace furrow::server
