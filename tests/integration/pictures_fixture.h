// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <gtest/gtest.h>

#include "daemon_fixture.h"

namespace furrow::testing_net {

// A daemon that draws the default character, and a sender whose subject "ann" nods. Skips where
// there is no OpenGL 4.5 (llvmpipe does) or no character.
class PicturesTest : public testing::Test {
 protected:
  void SetUp() override;
  // Frames 0 to 19: the further, the deeper the nod.
  void SendPose(int frame);

  motion::Clip clip;
  protocol::SkeletonOffer offer;
  std::optional<DaemonThread> daemon;
  std::optional<TcpClient> sender;
};

}  // namespace furrow::testing_net
