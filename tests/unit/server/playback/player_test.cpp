// SPDX-License-Identifier: Apache-2.0
#include "server/playback/player.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

// A recording with 11 frames at 10 Hz; the brow rises from 0 to 1.
motion::Clip RisingBrow() {
  motion::Clip clip;
  clip.name = "take";
  clip.blend_shape_names = {"brow", "nose"};
  for (int frame = 0; frame <= 10; ++frame) {
    clip.times.push_back(5.0 + 0.1 * frame);  // the first frame need not be at 0
    clip.blend_shapes.insert(clip.blend_shapes.end(), {0.1f * static_cast<float>(frame), 0.0f});
  }
  return clip;
}

class PlayerTest : public HubTest {
 protected:
  void SetUp() override {
    HubTest::SetUp();
    player = std::make_unique<Player>(RisingBrow(), "take.csv");
    player->Start(hub.get(), now);
  }
  // Calls Advance() at the requested times for `seconds`.
  void PlayFor(double seconds) {
    const Time end = now + FromSeconds(seconds);
    for (Time due = player->Advance(now); due <= end; due = player->Advance(now)) {
      ASSERT_GT(due, now);
      now = due;
    }
    now = end;
    player->Advance(now);
  }
  Subject& subject() { return *hub->RequireAllDrivers("take"); }
  float brow() { return subject().pipeline->wrinkle_weights()[0]; }

  std::unique_ptr<Player> player;
};

TEST_F(PlayerTest, EveryFrameIsSentAtItsTime) {
  EXPECT_EQ(subject().pipeline->sequence(), 0u);
  EXPECT_EQ(subject().pipeline->capture_time_us(), 1);  // 0 means no capture time
  PlayFor(0.5);
  EXPECT_NEAR(brow(), 0.5f, 1e-5f);
  EXPECT_EQ(subject().pipeline->capture_time_us(), 500'001);
  EXPECT_EQ(player->state(now).frame, 5);
  EXPECT_NEAR(player->state(now).position, 0.5, 1e-9);
  EXPECT_NEAR(player->state(now).rate_hz, 10.0, 1e-9);
  EXPECT_EQ(Count(Counter::kPosesInvalid), 0u);
}

TEST_F(PlayerTest, LoopsRestartAndOtherwisePlaybackStopsAtTheEnd) {
  PlayFor(1.25);  // the last frame is shown for 0.1 s, too
  EXPECT_NEAR(brow(), 0.1f, 1e-5f);
  ASSERT_TRUE(player->Apply({.loop = false}, now).ok());
  PlayFor(3.0);
  EXPECT_FALSE(player->state(now).playing);
  EXPECT_NEAR(brow(), 1.0f, 1e-5f);
  ASSERT_TRUE(player->Apply({.playing = true}, now).ok());  // from the start
  EXPECT_NEAR(brow(), 0.0f, 1e-5f);
}

TEST_F(PlayerTest, APausedSubjectIsNotLost) {
  PlayFor(0.3);
  ASSERT_TRUE(player->Apply({.playing = false}, now).ok());
  for (int i = 0; i < 500; ++i) {
    PlayFor(0.01);
    hub->Tick(now);
  }
  EXPECT_FALSE(subject().lost);
  EXPECT_NEAR(brow(), 0.3f, 1e-5f);
  EXPECT_EQ(subject().pipeline->capture_time_us(), 300'001);
}

TEST_F(PlayerTest, SeekAndSpeedTakeEffectAtOnce) {
  ASSERT_TRUE(player->Apply({.playing = false, .position = 0.82}, now).ok());
  EXPECT_NEAR(brow(), 0.8f, 1e-5f);
  ASSERT_TRUE(player->Apply({.playing = true, .speed = 0.5, .position = 0.0}, now).ok());
  PlayFor(0.8);
  EXPECT_NEAR(brow(), 0.4f, 1e-5f);
  ASSERT_TRUE(player->Apply({.position = 99.0}, now).ok());
  EXPECT_NEAR(player->state(now).position, 1.0, 1e-9);
}

TEST_F(PlayerTest, AForgottenSubjectIsOfferedAgain) {
  PlayFor(2.0);
  Advance(60.0);  // as after suspending the machine
  hub->Tick(now);
  ASSERT_EQ(hub->num_subjects(), 0u);
  PlayFor(0.5);
  ASSERT_EQ(hub->num_subjects(), 1u);
  PlayFor(0.2);
  EXPECT_NEAR(brow(), 0.1f * static_cast<float>(player->state(now).frame), 1e-5f);
}

TEST_F(PlayerTest, PlaybackRegainsItsSubjectWhenTheOtherSenderLeaves) {
  Advance(1.0);  // playback stands still, as when the daemon is busy
  FakePeer other;
  Connect(&other);
  Publish(other, "take");
  const StreamKey taken = subject().owner;
  for (std::uint32_t i = 0; i < 30; ++i) {
    Send(other, Pose(1), 1, i);
    PlayFor(0.1);
  }
  EXPECT_EQ(subject().owner, taken) << "it does not fight for it";
  Send(other, protocol::Goodbye{}, 1);
  hub->Tick(now);
  PlayFor(2.0);
  ASSERT_EQ(hub->num_subjects(), 1u);
  EXPECT_NE(subject().owner, taken);
}

TEST_F(PlayerTest, LoadingRejectsWhatTheWireCannotCarry) {
  const auto path = std::filesystem::path(testing::TempDir()) / "furrow_player_latin1.bvh";
  std::ofstream(path, std::ios::binary)
      << "HIERARCHY\nROOT H\xFC"
         "fte\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation "
         "Yrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: "
         "0.1\n0 0 0\n";
  const auto loaded = Player::Load(path);
  std::filesystem::remove(path);
  ASSERT_FALSE(loaded.ok());
  EXPECT_EQ(loaded.status().code(), StatusCode::kInvalidArgument);
  EXPECT_NE(loaded.status().what().find("not UTF-8"), std::string::npos)
      << loaded.status().ToString();
}

TEST_F(PlayerTest, AnInvalidChangeNamesItsFieldAndChangesNothing) {
  for (const double speed : {0.0, -1.0, 9.0, std::nan("")}) {
    const Status status = player->Apply({.playing = false, .speed = speed}, now);
    EXPECT_EQ(status.where(), "speed");
    EXPECT_TRUE(player->state(now).playing);
  }
  EXPECT_EQ(player->Apply({.position = std::nan("")}, now).where(), "position_s");
}

}  // namespace
}  // namespace furrow::server
