// SPDX-License-Identifier: Apache-2.0
#include "server/playback/playback.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

// A recording with 11 frames at 10 Hz; the brow rises from 0 to 1.
std::unique_ptr<Player> MakePlayer(const std::string& subject) {
  motion::Clip clip;
  clip.name = subject;
  clip.blend_shape_names = {"brow", "nose"};
  for (int frame = 0; frame <= 10; ++frame) {
    clip.times.push_back(0.1 * frame);
    clip.blend_shapes.insert(clip.blend_shapes.end(), {0.1f * static_cast<float>(frame), 0.0f});
  }
  return std::make_unique<Player>(std::move(clip), subject + ".csv");
}

class PlaybackTest : public HubTest {
 protected:
  void Start() {
    playback.Start(
        hub.get(), now, [this] { ++changes; },
        [this](std::unique_ptr<Player> player) { released.push_back(std::move(player)); });
  }
  void PlayFor(double seconds) {
    const Time end = now + FromSeconds(seconds);
    while (now < end) {
      now = std::min(end, std::min(playback.Advance(now), now + FromSeconds(0.01)));
      hub->Tick(now);
    }
  }
  std::string Subjects() { return hub->subjects().Names(Access::Everything()); }
  std::string File() { return playback.player()->state(now).file; }

  int changes = 0;
  std::vector<std::unique_ptr<Player>> released;
  Playback playback;
};

TEST_F(PlaybackTest, NothingPlaysUntilARecordingIsUploaded) {
  Start();
  EXPECT_EQ(playback.player(), nullptr);
  EXPECT_EQ(playback.Advance(now), Playback::kNever);
  EXPECT_FALSE(playback.Close(now));
  ASSERT_TRUE(playback.Play(MakePlayer("ada"), now).ok());
  EXPECT_EQ(changes, 1);
  EXPECT_TRUE(playback.is_uploaded());
  PlayFor(0.35);
  EXPECT_EQ(Subjects(), "ada");
  EXPECT_EQ(playback.player()->state(now).frame, 3);
  EXPECT_TRUE(playback.Close(now));
  EXPECT_EQ(changes, 2);
  EXPECT_EQ(playback.player(), nullptr);
  EXPECT_EQ(released.size(), 1u);
  PlayFor(5.0);
  EXPECT_EQ(Subjects(), "");
}

TEST_F(PlaybackTest, TheRecordingOfTheConfigurationGoesOnWhereItWas) {
  playback.SetConfigured(MakePlayer("show"));
  Start();
  PlayFor(0.45);
  ASSERT_TRUE(playback.Play(MakePlayer("ada"), now).ok());
  EXPECT_TRUE(hub->FindSubject("show")->ended);
  PlayFor(5.0);
  EXPECT_EQ(Subjects(), "ada");
  ASSERT_TRUE(playback.Close(now));
  EXPECT_FALSE(playback.is_uploaded());
  EXPECT_EQ(File(), "show.csv");
  EXPECT_NEAR(playback.player()->state(now).position, 0.45, 1e-6);
  PlayFor(0.2);
  EXPECT_EQ(playback.player()->state(now).frame, 6);
  EXPECT_FALSE(hub->FindSubject("show")->ended);
  EXPECT_FALSE(playback.Close(now));
}

TEST_F(PlaybackTest, AnUploadReplacesTheFormerOneAlsoUnderItsName) {
  Start();
  for (const char* name : {"ada", "bob", "bob"}) {
    ASSERT_TRUE(playback.Play(MakePlayer(name), now).ok()) << name;
    PlayFor(0.5);
    EXPECT_FALSE(hub->FindSubject(name)->ended);
  }
  EXPECT_EQ(released.size(), 2u);
  PlayFor(5.0);
  EXPECT_EQ(Subjects(), "bob");
  EXPECT_EQ(playback.player()->refusal(), "");
}

TEST_F(PlaybackTest, TheSubjectOfAnotherSenderIsNotTaken) {
  playback.SetConfigured(MakePlayer("show"));
  Start();
  PlayFor(0.3);
  FakePeer other;
  Connect(&other);
  Publish(other, "ada");
  Send(other, Pose(1), 1, 1);
  const Status status = playback.Play(MakePlayer("ada"), now);
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
  EXPECT_NE(status.what().find("another sender is sending 'ada'"), std::string::npos)
      << status.what();
  EXPECT_EQ(released.size(), 1u);
  EXPECT_EQ(changes, 0);
  EXPECT_EQ(File(), "show.csv");
  EXPECT_FALSE(hub->FindSubject("show")->ended);
  EXPECT_EQ(hub->FindSubject("ada")->owner.peer, other.id);
  PlayFor(0.35);
  EXPECT_EQ(playback.player()->state(now).frame, 6);
}

TEST_F(PlaybackTest, ARefusedRecordingLeavesTheFormerOneOfItsNamePlaying) {
  Start();
  ASSERT_TRUE(playback.Play(MakePlayer("ada"), now).ok());
  PlayFor(0.3);
  // Another sender takes the subject over while the recording is paused by a stall.
  Advance(5.0);
  FakePeer other;
  Connect(&other);
  Publish(other, "ada");
  Send(other, Pose(1), 1, 1);
  EXPECT_FALSE(playback.Play(MakePlayer("ada"), now).ok());
  EXPECT_TRUE(playback.is_uploaded());
  Send(other, protocol::Goodbye{}, 1);
  PlayFor(3.0);
  EXPECT_NE(hub->FindSubject("ada")->owner.peer, other.id) << "it has regained its subject";
}

}  // namespace
}  // namespace furrow::server
