// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <gtest/gtest.h>

#include "daemon_fixture.h"

namespace furrow::testing_net {

// A daemon that renders the default character, and a sender whose subject "ann" nods. Skips the
// test without OpenGL 4.5 (llvmpipe is enough) or without the character.
class PicturesTest : public testing::Test {
 protected:
  void SetUp() override;
  // Changes the configuration of the daemon.
  virtual void Configure(server::Config* /*config*/) {}
  // The stream of the sender, which is connected to the daemon.
  virtual Connected ConnectSender();
  // Frames 0 to 19; the nod deepens with the frame number.
  void SendPose(int frame);

  motion::Clip clip;
  protocol::SkeletonOffer offer;
  std::optional<DaemonThread> daemon;
  std::optional<TcpClient> sender;
};

}  // namespace furrow::testing_net
