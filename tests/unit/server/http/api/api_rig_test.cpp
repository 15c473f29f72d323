// SPDX-License-Identifier: Apache-2.0
// GET /api/rig.
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/http/api/api.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

class ApiRigTest : public HubTest {
 protected:
  FakePeer sender;
};

TEST_F(ApiRigTest, EveryKindOfMaskIsShown) {
  using Kind = wrinkle::Mask::Kind;
  wrinkle::Rig rig = MakeRig(/*filter=*/false);
  wrinkle::Driver& ball = rig.drivers.emplace_back();
  ball.name = "shoulder";
  ball.kind = wrinkle::Driver::Kind::kBall;
  ball.ball.parent = "chest";
  ball.ball.joint = "arm";
  rig.regions.push_back(rig.regions.front());
  rig.regions.back().name = "arm";
  rig.regions[0].mask = {.kind = Kind::kTexture, .texture = "face.png", .channel = 2};
  rig.regions[1].mask = {.kind = Kind::kSkinning};
  rig.regions[2].mask = {.kind = Kind::kSliding, .driver = "shoulder"};
  MakeWith(std::move(rig));
  Connect(&sender);
  Publish(sender, "ann");
  Api api{{}};
  const ApiReply reply =
      api.Answer({.method = "GET", .url = {.path = "/api/rig", .values = {}}}, *hub, now);
  ASSERT_EQ(reply.status, 200) << reply.body;
  const Json regions = Json::parse(reply.body)["regions"];
  EXPECT_EQ(regions[0]["mask"].dump(), R"({"kind":"texture","texture":"face.png","channel":"b"})");
  EXPECT_EQ(regions[1]["mask"].dump(), R"({"kind":"skinning"})");
  EXPECT_EQ(regions[2]["mask"].dump(), R"({"kind":"sliding","driver":"shoulder"})");
}

}  // namespace
}  // namespace furrow::server
