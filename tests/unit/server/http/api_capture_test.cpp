// SPDX-License-Identifier: Apache-2.0
// Captures: what they change, what a preview does not, and what can be taken back.
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/http/api.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

class ApiCaptureTest : public HubPeersTest {
 protected:
  void SetUp() override {
    HubPeersTest::SetUp();
    Publish(sender, "ann");
    SendPose(0.5f);
  }
  Json Ask(const std::string& path, const Json& body, int status = 200) {
    const ApiReply reply = api.Answer(
        {.method = "POST", .url = {.path = path, .values = {}}, .body = body.dump()}, *hub, now);
    EXPECT_EQ(reply.status, status) << reply.body;
    return Json::parse(reply.body);
  }
  Json Capture(const std::string& pose, bool preview = false) {
    return Ask("/api/capture", {{"subject", "ann"}, {"pose", pose}, {"preview", preview}});
  }
  Json Undo() { return Ask("/api/capture/undo", Json::object()); }
  void SendPose(float brow) {
    ++sequence;
    Send(sender, Pose(brow), 1, sequence, std::int64_t{10'000} * sequence);
  }
  // The same sender with one blend shape more.
  void OfferAnew() {
    protocol::SkeletonOffer offer = Offer("ann");
    offer.blend_shape_names.push_back("jaw");
    offer.skeleton_hash = protocol::SkeletonHash(offer);
    Send(sender, offer, 1);
    ASSERT_TRUE(sender.Take<protocol::SkeletonReply>().has_value());
  }
  SubjectPipeline& pipeline() { return *hub->FindSubject("ann")->pipeline; }
  float brow() { return pipeline().wrinkle_weights()[0]; }

  Api api{{}};
  std::uint32_t sequence = 0;
};

TEST_F(ApiCaptureTest, ANeutralIsTakenBackToTheOneBeforeIt) {
  Capture("neutral");
  SendPose(0.75f);
  EXPECT_NEAR(brow(), 0.25f, 1e-5f);
  Capture("neutral");
  EXPECT_NEAR(brow(), 0.0f, 1e-5f);
  EXPECT_EQ(Undo()["captures"].size(), 1u);
  EXPECT_NEAR(brow(), 0.25f, 1e-5f);
  EXPECT_TRUE(Undo()["captures"].empty());
  EXPECT_NEAR(brow(), 0.75f, 1e-5f);
}

TEST_F(ApiCaptureTest, ANeutralOfAnotherSkeletonIsNotTakenBack) {
  Capture("neutral");
  Capture("neutral");
  OfferAnew();  // fewer values than it now has would be read from the former neutral
  EXPECT_EQ(Undo()["captures"].size(), 1u);
  EXPECT_FALSE(pipeline().neutral_pose().has_value());
}

TEST_F(ApiCaptureTest, ANeutralThatIsPreviewedLeavesTheSubjectAlone) {
  Make({}, /*filter=*/true);
  Connect(&sender);
  Connect(&viewer);
  Publish(sender, "ann");
  ASSERT_NE(Watch(viewer, {.subject = "ann"}), 0);  // so that its weights are evaluated
  SendPose(0.0f);
  SendPose(1.0f);  // the filter is still on its way there
  const float live = brow();
  ASSERT_LT(live, 0.99f);
  const Json weight = Capture("neutral", /*preview=*/true)["weights"][0];
  EXPECT_EQ(weight["name"], "brow.squash");
  EXPECT_FLOAT_EQ(weight["before"].get<float>(), live);
  EXPECT_EQ(weight["after"].get<float>(), 0.0f);
  EXPECT_EQ(brow(), live);
  SendPose(1.0f);
  EXPECT_LT(brow(), 0.99f) << "its filter began anew";
}

}  // namespace
}  // namespace furrow::server
