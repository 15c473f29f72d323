// SPDX-License-Identifier: Apache-2.0
#include "pictures_fixture.h"

#include <cstdint>
#include <filesystem>

#include <sys/socket.h>

#include "character/package/package.h"
#include "motion/pose_source.h"

namespace furrow::testing_net {
namespace {

// A clip of the character: the head nods further with every frame. Cameras follow the
// subject's body, so a turn of the whole body would not be visible.
motion::Clip NoddingClip(const character::Character& character, int num_frames) {
  motion::Clip clip;
  clip.skeleton = character.skeleton;
  const auto rest = character.skeleton.rest_pose();
  const int head = character.skeleton.Find("head");
  EXPECT_NE(head, wrinkle::kNoJoint);
  for (int frame = 0; frame < num_frames; ++frame) {
    clip.times.push_back(frame / 30.0);
    for (int j = 0; j < character.skeleton.num_joints(); ++j) {
      clip.locals.push_back(rest[j]);
      if (j == head) {
        clip.locals.back().rotation =
            glm::angleAxis(0.05f * static_cast<float>(frame), glm::vec3(1, 0, 0)) *
            clip.locals.back().rotation;
      }
    }
  }
  return clip;
}

}  // namespace

void PicturesTest::SetUp() {
  const std::filesystem::path glb = FURROW_LIGHT_CHARACTER;
  server::Config config;
  config.character = glb;
  config.tcp = config.udp = 0;
  config.http.port = 0;
  // Rendering may be slow here, and the decay of a lost subject must not request pictures.
  config.limits.loss_seconds = config.limits.idle_seconds = 3600;
  Configure(&config);
  auto loaded = character::LoadCharacter(glb, {}, motion::CachedPoseSource());
  ASSERT_TRUE(loaded.ok()) << loaded.status().ToString();
  clip = NoddingClip(*loaded, 20);
  daemon.emplace(config);
  ASSERT_TRUE(daemon->serves());
  if (!daemon->ready().render) GTEST_SKIP() << "no OpenGL 4.5 here";
  sender.emplace(ConnectSender());
  offer = OfferOf(clip, "ann");
  Offer(*sender, offer);
}

Connected PicturesTest::ConnectSender() {
  return {ConnectSocket(SOCK_STREAM, daemon->ready().tcp)};
}

void PicturesTest::SendPose(int frame) {
  sender->Send(PoseOf(clip, frame, offer), 1, static_cast<std::uint32_t>(frame),
               1000 * static_cast<std::int64_t>(frame));
}

}  // namespace furrow::testing_net
