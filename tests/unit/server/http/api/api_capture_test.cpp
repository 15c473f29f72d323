// SPDX-License-Identifier: Apache-2.0
// Captures, previews and undo.
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/http/api/api.h"
#include "tests/unit/rig/shapes/shipped_shape_maps.h"
#include "tests/unit/rig/shipped_matcher.h"
#include "tests/unit/server/session/fake_cluster.h"
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
  // Offers the same subject with one more blend shape.
  void OfferAnew() {
    protocol::SkeletonOffer offer = Offer("ann");
    offer.blend_shape_names.push_back("jaw");
    offer.skeleton_hash = protocol::SkeletonHash(offer);
    Send(sender, offer, 1);
    ASSERT_TRUE(sender.Take<protocol::SkeletonReply>().has_value());
  }
  SubjectPipeline& pipeline() { return *hub->RequireAllDrivers("ann")->pipeline; }
  float brow() { return pipeline().wrinkle_weights()[0]; }

  Api api{{}};
  std::uint32_t sequence = 0;
};

TEST_F(ApiCaptureTest, UndoRestoresThePreviousNeutral) {
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

TEST_F(ApiCaptureTest, APartOfTheNeutralIsCaptured) {
  EXPECT_EQ(Capture("neutral")["part"], "face") << "the stream has blend shapes";
  EXPECT_NEAR(brow(), 0.0f, 1e-5f);
  Undo();
  const Json body = {{"subject", "ann"}, {"pose", "neutral"}, {"part", "body"}};
  EXPECT_EQ(Ask("/api/capture", body)["part"], "body");
  EXPECT_NEAR(brow(), 0.5f, 1e-5f) << "the face keeps its neutral";
}

TEST_F(ApiCaptureTest, UnknownPartsAreRefused) {
  for (const Json& part : {Json("arms"), Json(1), Json(true)}) {
    const Json body = {{"subject", "ann"}, {"pose", "neutral"}, {"part", part}};
    EXPECT_EQ(Ask("/api/capture", body, 400)["error"]["field"], "part");
  }
  const Json other = {{"subject", "ann"}, {"pose", "squash"}, {"part", "face"}};
  EXPECT_EQ(Ask("/api/capture", other, 400)["error"]["field"], "part");
  EXPECT_FALSE(pipeline().neutral_pose().has_value());
}

// Undo would put back a rig without them.
TEST_F(ApiCaptureTest, CapturesThatArriveEmptyTheHistory) {
  Capture("smile");
  std::vector<std::uint8_t> state;
  ASSERT_TRUE(hub->WriteState("ann", 1, state));
  FakeCluster nodes;
  nodes.expects.kind = Place::Kind::kPending;
  cluster = &nodes;
  Make({});
  Connect(&sender);
  hub->OnMessage(sender.id, state, now);
  EXPECT_EQ(hub->num_rig_replacements(), 1u);
  EXPECT_EQ(hub->num_added_poses(), 1);
  Ask("/api/capture/undo", Json::object(), 409);
  hub.reset();
}

// Undo would put back the rig of the former file.
TEST_F(ApiCaptureTest, ARigFromItsFileEmptiesTheHistory) {
  Capture("smile");
  EXPECT_TRUE(hub->has_captured_rig());
  const auto rig = std::make_shared<const wrinkle::Rig>(MakeRig(/*filter=*/false));
  ASSERT_TRUE(hub->SetRigAndMaps(rig, {}, now).ok());
  EXPECT_FALSE(hub->has_captured_rig());
  EXPECT_EQ(hub->num_added_poses(), 0);
  EXPECT_TRUE(hub->RequireAllDrivers("ann")->captures.empty());
  Ask("/api/capture/undo", Json::object(), 409);
  EXPECT_EQ(hub->shared_rig(), rig);
  // Other maps leave the captured poses in place.
  Capture("smile");
  ASSERT_TRUE(hub->SetRigAndMaps(hub->shared_rig(), {}, now).ok());
  EXPECT_TRUE(hub->has_captured_rig());
  EXPECT_TRUE(Undo()["captures"].empty());
  EXPECT_EQ(hub->shared_rig(), rig);
}

TEST_F(ApiCaptureTest, TheRigStaysChangedAfterManyCapturesOfNeutrals) {
  Capture("smile");
  for (int i = 0; i < 70; ++i) Capture("neutral");
  EXPECT_TRUE(hub->has_captured_rig());
}

TEST_F(ApiCaptureTest, UndoIgnoresTheNeutralOfAnotherSkeleton) {
  Capture("neutral");
  Capture("neutral");
  OfferAnew();  // the old neutral has fewer values than the new skeleton
  EXPECT_EQ(Undo()["captures"].size(), 1u);
  EXPECT_FALSE(pipeline().neutral_pose().has_value());
}

TEST_F(ApiCaptureTest, ADeeplyNestedBodyIsRejected) {
  constexpr std::size_t kDepth = 30'000;  // fits into a request; copying recurses once per level
  const std::string body =
      R"({"subject":)" + std::string(kDepth, '[') + std::string(kDepth, ']') + "}";
  const ApiReply reply = api.Answer(
      {.method = "POST", .url = {.path = "/api/capture", .values = {}}, .body = body}, *hub, now);
  EXPECT_EQ(reply.status, 400);
  EXPECT_EQ(Json::parse(reply.body)["error"]["field"], "body");
}

TEST_F(ApiCaptureTest, APreviewChangesNothing) {
  Make({}, /*filter=*/true);
  Connect(&sender);
  Connect(&viewer);
  Publish(sender, "ann");
  ASSERT_NE(Watch(viewer, {.subject = "ann"}), 0);  // evaluates its weights
  SendPose(0.0f);
  SendPose(1.0f);  // the filter has not reached it yet
  const float live = brow();
  ASSERT_LT(live, 0.99f);
  const Json weight = Capture("neutral", /*preview=*/true)["weights"][0];
  EXPECT_EQ(weight["name"], "brow.squash");
  EXPECT_FLOAT_EQ(weight["before"].get<float>(), live);
  EXPECT_EQ(weight["after"].get<float>(), 0.0f);
  EXPECT_EQ(brow(), live);
  SendPose(1.0f);
  EXPECT_LT(brow(), 0.99f) << "its filter has restarted";
}

TEST_F(ApiCaptureTest, TheNumberOfAddedPosesIsBounded) {
  const auto capture = [&](int number, int status) {
    return Ask("/api/capture",
               {{"subject", "ann"}, {"pose", "pose" + std::to_string(number)}, {"preview", false}},
               status);
  };
  for (int i = 0; i < 32; ++i) capture(i, 200);
  EXPECT_EQ(capture(32, 409)["error"]["field"], "pose");
  capture(31, 200);  // again, instead of another one
  Undo();
  capture(32, 409);
  Undo();  // the one that added pose 31
  capture(32, 200);
}

TEST_F(ApiCaptureTest, TheNumberOfUndoStepsIsBounded) {
  Json reply;
  for (int i = 0; i < 70; ++i) reply = Capture("neutral");
  EXPECT_EQ(reply["captures"].size(), 64u);
  EXPECT_EQ(Undo()["captures"].size(), 63u);
}

// Drivers that measure blend shapes against the reference pose "frown".
class ApiShapeCaptureTest : public HubTest {
 protected:
  static wrinkle::Rig FrownRig(const std::vector<std::string>& shapes) {
    wrinkle::Rig rig = MakeRig(/*filter=*/false);
    rig.reference_poses = {{.name = "frown", .shapes = {{shapes[0], 1.0f}}}};
    wrinkle::Driver& driver = rig.drivers.emplace_back();
    driver.name = "face";
    for (const std::string& shape : shapes) {
      driver.pose.points.push_back(
          {.joint = "", .kind = wrinkle::ControlPoint::Kind::kBlendShape, .blend_shape = shape});
    }
    driver.pose.values = {{"frown", "frown"}};
    rig.regions[0].feeds[0].sources = {{"face", "frown", 1.0f}};
    return rig;
  }
  void Play(const wrinkle::Rig& rig, const std::vector<std::string>& names,
            const std::vector<float>& values) {
    Hub::Parts parts;
    parts.rig = std::make_shared<const wrinkle::Rig>(rig);
    parts.shape_matcher = rig::ShippedShapeMatcher();
    parts.metrics = &metrics;
    parts.random = [] { return 1; };
    hub = std::make_unique<Hub>(std::move(parts));
    Connect(&sender);
    protocol::SkeletonOffer offer;
    offer.subject = "ann";
    offer.blend_shape_names = names;
    offer.skeleton_hash = protocol::SkeletonHash(offer);
    Send(sender, offer, 1);
    protocol::PoseFrame pose;
    pose.skeleton_hash = offer.skeleton_hash;
    pose.num_blend_shapes = static_cast<std::uint16_t>(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      pose.blend_shape_indices.push_back(static_cast<std::uint16_t>(i));
    }
    pose.blend_shapes = values;
    Send(sender, pose, 1, 1);
  }
  Json Capture(const std::string& pose) {
    const ApiReply reply = api.Answer({.method = "POST",
                                       .url = {.path = "/api/capture", .values = {}},
                                       .body = Json({{"pose", pose}}).dump()},
                                      *hub, now);
    EXPECT_EQ(reply.status, 200) << reply.body;
    return Json::parse(reply.body);
  }
  const wrinkle::ReferencePose& pose(std::size_t i) { return hub->rig().reference_poses[i]; }

  FakePeer sender;
  Api api{{}};
};

TEST_F(ApiShapeCaptureTest, APhoneCapturesAReferencePose) {
  Play(FrownRig({"browDownLeft", "noseSneerLeft"}),
       {"BrowDownLeft", "NoseSneerLeft", "JawOpen", "HeadYaw"}, {0.5f, 0.25f, 0.0f, 0.4f});
  const Json weight = Capture("frown")["weights"][0];
  // 0.5 of 1; then the pose itself.
  EXPECT_NEAR(weight["before"].get<float>(), 0.5f, 1e-5f);
  EXPECT_NEAR(weight["after"].get<float>(), 1.0f, 1e-5f);
  EXPECT_EQ(pose(0).shapes,
            (std::vector<wrinkle::ShapeValue>{{"BrowDownLeft", 0.5f}, {"NoseSneerLeft", 0.25f}}));
  EXPECT_NEAR(hub->RequireAllDrivers("ann")->pipeline->wrinkle_weights()[0], 1.0f, 1e-5f);
}

TEST_F(ApiShapeCaptureTest, JointsOfAPoseStayIfTheStreamHasNone) {
  wrinkle::Rig rig = FrownRig({"browDownLeft"});
  rig.reference_poses[0].joints = {{.joint = "brow_l", .rotation = {1, 0, 0, 0}}};
  rig.reference_poses[0].source_size = 2.0f;
  Play(rig, {"browDownLeft"}, {0.5f});
  Capture("frown");
  EXPECT_EQ(pose(0).joints.size(), 1u);
  EXPECT_EQ(pose(0).source_size, 2.0f);
  EXPECT_EQ(pose(0).shapes, (std::vector<wrinkle::ShapeValue>{{"browDownLeft", 0.5f}}));
}

// VRM's presets become the names that the drivers read.
TEST_F(ApiShapeCaptureTest, TranslatedNamesAreThoseOfTheRig) {
  Play(FrownRig({"mouthSmileLeft", "jawOpen"}), {"Joy", "A", "Blink", "Fun", "Sorrow"},
       {1.0f, 0.5f, 0, 0, 0});
  EXPECT_NEAR(Capture("frown")["weights"][0]["after"].get<float>(), 1.0f, 1e-5f);
  ASSERT_EQ(pose(0).shapes.size(), 2u);
  EXPECT_EQ(pose(0).shapes[0].blend_shape, "mouthSmileLeft");
  EXPECT_EQ(pose(0).shapes[1].blend_shape, "jawOpen");
}

// A hinge with joint names of a game engine, and a stream with those of Mixamo.
class ApiForeignCaptureTest : public HubTest {
 protected:
  void SetUp() override {
    auto matcher = rig::ShippedMatcher();
    ASSERT_TRUE(matcher.ok()) << matcher.status().ToString();
    wrinkle::Rig rig = MakeRig(/*filter=*/false);
    for (const char* side : {"l", "r"}) {
      wrinkle::Driver& driver = rig.drivers.emplace_back();
      driver.name = std::string("knee_") + side;
      driver.kind = wrinkle::Driver::Kind::kHinge;
      driver.hinge = {.parent = std::string("upper_leg_") + side,
                      .joint = std::string("lower_leg_") + side,
                      .end = std::string("foot_") + side};
    }
    rig.regions[0].feeds[0].sources = {{"knee_l", "flexed", 1.0f}};
    Hub::Parts parts;
    parts.rig = std::make_shared<const wrinkle::Rig>(std::move(rig));
    parts.skeletons = *std::move(matcher);
    parts.metrics = &metrics;
    parts.random = [] { return 1; };
    hub = std::make_unique<Hub>(std::move(parts));
    Connect(&sender);
  }
  static protocol::SkeletonOffer Legs() {
    protocol::SkeletonOffer offer;
    offer.subject = "ann";
    const std::pair<const char*, int> joints[] = {
        {"Hips", -1},      {"LeftUpLeg", 0}, {"LeftLeg", 1},  {"LeftFoot", 2},
        {"RightUpLeg", 0}, {"RightLeg", 4},  {"RightFoot", 5}};
    for (const auto& [name, parent] : joints) {
      protocol::OfferedJoint& joint = offer.joints.emplace_back();
      joint.name = std::string("mixamorig:") + name;
      joint.parent = static_cast<std::int16_t>(parent);
      joint.rest_translation = {parent == 0 ? (name[0] == 'L' ? 0.1f : -0.1f) : 0.0f,
                                parent < 0 ? 1.0f : -0.4f, 0.0f};
    }
    offer.skeleton_hash = protocol::SkeletonHash(offer);
    return offer;
  }

  FakePeer sender;
};

TEST_F(ApiForeignCaptureTest, APoseIsStoredWithTheJointNamesOfTheRig) {
  const protocol::SkeletonOffer offer = Legs();
  Send(sender, offer, 1);
  protocol::PoseFrame pose;
  pose.skeleton_hash = offer.skeleton_hash;
  pose.num_joints = static_cast<std::uint16_t>(offer.joints.size());
  pose.rotation_joints = {2};
  pose.rotations = {{std::sin(0.6f), 0.0f, 0.0f, std::cos(0.6f)}};
  Send(sender, pose, 1, 1);
  Subject& subject = *hub->RequireAllDrivers("ann");
  const float bent = subject.pipeline->wrinkle_weights()[0];
  ASSERT_GT(bent, 0.1f);

  Api api{{}};
  const ApiReply reply = api.Answer({.method = "POST",
                                     .url = {.path = "/api/capture", .values = {}},
                                     .body = R"({"pose":"crouch"})"},
                                    *hub, now);
  ASSERT_EQ(reply.status, 200) << reply.body;
  const Json weight = Json::parse(reply.body)["weights"][0];
  EXPECT_FLOAT_EQ(weight["before"].get<float>(), bent);
  EXPECT_FLOAT_EQ(weight["after"].get<float>(), bent) << "a pose that no driver reads";
  ASSERT_EQ(hub->rig().reference_poses.size(), 1u);
  const auto& joints = hub->rig().reference_poses[0].joints;
  ASSERT_EQ(joints.size(), 1u);
  EXPECT_EQ(joints[0].joint, "lower_leg_l");
}

}  // namespace
}  // namespace furrow::server
