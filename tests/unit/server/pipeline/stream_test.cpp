// SPDX-License-Identifier: Apache-2.0
// From wire structs to a solved subject: adapter, shared definitions, pipeline.
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/pipeline/stream_definition.h"
#include "server/pipeline/subject_pipeline.h"
#include "server/pipeline/wire_adapter.h"
#include "tests/log_capture.h"
#include "tests/unit/rig/shapes/shipped_shape_maps.h"
#include "tests/unit/rig/shipped_matcher.h"

namespace furrow::server {
namespace {

using testing::Each;
using testing::FloatEq;
using testing::FloatNear;
using testing::HasSubstr;
using testing::Not;
using testing::Pointwise;

// A knee, straight along -Y at rest, with full weight at a bend of 150 degrees.
std::shared_ptr<const wrinkle::Rig> KneeRig(bool filter = false) {
  auto rig = std::make_shared<wrinkle::Rig>();
  rig->name = "knee";
  rig->filter.enabled = filter;
  rig->wrinkle_maps.push_back({.name = "folds"});
  wrinkle::Driver driver;
  driver.name = "knee";
  driver.kind = wrinkle::Driver::Kind::kHinge;
  driver.hinge.parent = "thigh";
  driver.hinge.joint = "shin";
  driver.hinge.axis = glm::vec3(1, 0, 0);
  rig->drivers.push_back(driver);
  wrinkle::Region region;
  region.name = "knee";
  region.modulation = wrinkle::Modulation::kLinear;
  region.feeds.push_back({"folds", {{"knee", "flexed", 1.0f}}});
  rig->regions.push_back(region);
  return rig;
}

protocol::SkeletonOffer KneeOffer() {
  protocol::SkeletonOffer offer;
  offer.subject = "ann";
  for (const auto& [name, parent, y] : {std::tuple{"hips", -1, 1.0f},
                                        {"thigh", 0, -0.1f},
                                        {"shin", 1, -0.4f},
                                        {"foot", 2, -0.4f}}) {
    protocol::OfferedJoint joint;
    joint.name = name;
    joint.parent = static_cast<std::int16_t>(parent);
    joint.rest_translation = {0.0f, y, 0.0f};
    offer.joints.push_back(joint);
  }
  return offer;
}

protocol::PoseFrame Bend(float radians) {
  protocol::PoseFrame pose;
  pose.num_joints = 4;
  pose.rotation_joints = {2};
  pose.rotations = {{std::sin(radians / 2), 0.0f, 0.0f, std::cos(radians / 2)}};
  return pose;
}

std::shared_ptr<const StreamDefinition> Define(std::shared_ptr<const wrinkle::Rig> rig) {
  StreamDefinitions definitions(std::move(rig), {}, 4);
  auto definition = definitions.Get(ToStreamOffer(KneeOffer()));
  EXPECT_TRUE(definition.ok()) << definition.status().ToString();
  return *std::move(definition);
}
std::shared_ptr<const StreamDefinition> Define(bool filter = false) {
  return Define(KneeRig(filter));
}

TEST(WireAdapter, ConvertsNamesParentsRestAndTails) {
  protocol::SkeletonOffer offer = KneeOffer();
  offer.joints[3].has_tail = true;
  offer.joints[3].tail = {0.0f, 0.0f, 0.2f};
  offer.blend_shape_names = {"a"};
  const StreamOffer result = ToStreamOffer(offer);
  ASSERT_EQ(result.joints.size(), 4u);
  EXPECT_EQ(result.joints[0].parent, wrinkle::kNoJoint);
  EXPECT_EQ(result.joints[3].parent, 2);
  EXPECT_EQ(result.joints[2].name, "shin");
  EXPECT_FLOAT_EQ(result.joints[2].rest.translation.y, -0.4f);
  EXPECT_FALSE(result.joints[2].tail.has_value());
  EXPECT_FLOAT_EQ(result.joints[3].tail->z, 0.2f);
  EXPECT_EQ(result.blend_shapes.size(), 1u);
}

TEST(WireAdapter, TranslationsAreOffsetsFromRest) {
  const auto stream = Define();
  wrinkle::LocalPose pose;
  pose.SetRest(stream->skeleton);
  protocol::PoseFrame frame = Bend(1.0f);
  frame.translation_joints = {0};
  frame.translations = {{0.5f, 0.25f, 0.0f}};
  frame.scale_joints = {3};
  frame.scales = {{2.0f, 2.0f, 2.0f}};
  ASSERT_TRUE(PoseFits(frame, *stream));
  ApplyPose(frame, *stream, &pose);
  EXPECT_FLOAT_EQ(pose.joints[0].translation.x, 0.5f);
  EXPECT_FLOAT_EQ(pose.joints[0].translation.y, 1.25f);
  EXPECT_FLOAT_EQ(pose.joints[3].scale.x, 2.0f);
  EXPECT_NEAR(pose.joints[2].rotation.x, std::sin(0.5f), 1e-6);

  protocol::PoseFrame partial;
  partial.num_joints = 4;
  partial.partial = true;
  ApplyPose(partial, *stream, &pose);
  EXPECT_NEAR(pose.joints[2].rotation.x, std::sin(0.5f), 1e-6);
  partial.partial = false;
  ApplyPose(partial, *stream, &pose);
  EXPECT_FLOAT_EQ(pose.joints[2].rotation.x, 0.0f);
  EXPECT_FLOAT_EQ(pose.joints[0].translation.y, 1.0f);
}

TEST(WireAdapter, RejectsPosesOfOtherStreams) {
  const auto stream = Define();
  protocol::PoseFrame frame = Bend(1.0f);
  frame.num_joints = 5;
  EXPECT_FALSE(PoseFits(frame, *stream));
  frame = Bend(1.0f);
  frame.rotation_joints = {4};
  EXPECT_FALSE(PoseFits(frame, *stream));
  frame = Bend(1.0f);
  frame.num_blend_shapes = 1;
  EXPECT_FALSE(PoseFits(frame, *stream));
  frame = Bend(1.0f);
  frame.rotation_joints.clear();
  frame.rotations.resize(5);
  EXPECT_FALSE(PoseFits(frame, *stream));
}

TEST(StreamDefinitions, EqualStreamsShareADefinitionAndTheOldestIsEvicted) {
  StreamDefinitions definitions(KneeRig(), {}, 2);
  const auto get = [&](const protocol::SkeletonOffer& offer) {
    return definitions.Get(ToStreamOffer(offer)).value();
  };
  protocol::SkeletonOffer longer = KneeOffer();
  longer.joints[3].rest_translation.y = -0.5f;
  protocol::SkeletonOffer shapes = KneeOffer();
  shapes.blend_shape_names = {"smile"};
  const auto first = get(KneeOffer());
  EXPECT_EQ(first, get(KneeOffer()));
  EXPECT_NE(first, get(longer));
  EXPECT_EQ(first, get(KneeOffer()));  // used again, so now the newest
  EXPECT_NE(first, get(shapes));       // evicts `longer`
  EXPECT_EQ(first, get(KneeOffer()));
}

TEST(StreamDefinitions, ASkeletonThatIsNotATreeIsRejected) {
  StreamDefinitions definitions(KneeRig(), {}, 2);
  StreamOffer offer = ToStreamOffer(KneeOffer());
  offer.joints[1].parent = 2;
  const auto result = definitions.Get(std::move(offer));
  EXPECT_EQ(result.status().code(), StatusCode::kCyclic);
}

wrinkle::Skeleton Head(const char* joint) {
  return wrinkle::Skeleton::Create({{.name = joint, .parent = wrinkle::kNoJoint}}).value();
}

TEST(StreamDefinitions, AStreamThatMatchesNothingIsLoggedOnce) {
  const wrinkle::Skeleton character = Head("head");
  StreamDefinitions definitions(KneeRig(), {.skeleton = &character}, 4);
  StreamOffer offer;
  offer.joints = {{.name = "tail_01", .parent = wrinkle::kNoJoint}};
  LogCapture log;
  ASSERT_TRUE(definitions.Get(offer).ok());
  EXPECT_THAT(log.text(), HasSubstr("all weights stay at rest"));
  EXPECT_THAT(log.text(), HasSubstr("pictures show the rest pose"));
  EXPECT_THAT(log.text(), HasSubstr("ignored: tail_01"));
  const std::string once = log.text();
  ASSERT_TRUE(definitions.Get(offer).ok());
  EXPECT_EQ(log.text(), once);
}

TEST(StreamDefinitions, BlendShapesMoveTheCharactersShapes) {
  const wrinkle::Skeleton character = Head("neck");
  const std::vector<std::string> shapes = {"cheekPuff", "jawOpen"};
  StreamOffer offer;
  offer.blend_shapes = {"JawOpen", "tongueOut"};
  LogCapture log;
  StreamDefinitions definitions(KneeRig(), {.skeleton = &character, .shapes = shapes}, 4);
  const auto definition = definitions.Get(offer);
  ASSERT_TRUE(definition.ok()) << definition.status().ToString();
  EXPECT_THAT(log.text(), Not(HasSubstr("pictures show the rest pose")));
  SubjectPipeline subject(*definition);
  subject.mutable_pose()->blend_shapes = {0.5f, 1.0f};
  ASSERT_EQ(subject.Solve(1, 1000), wrinkle::JobStatus::kOk);
  const auto snapshot = subject.TakeSnapshot(0);
  ASSERT_NE(snapshot->shape_program, nullptr);
  std::vector<float> weights(2);
  ASSERT_EQ(snapshot->shape_program->Run(snapshot->blend_shapes, weights), wrinkle::JobStatus::kOk);
  EXPECT_EQ(weights, (std::vector<float>{0.0f, 0.5f}));
  // Without shapes nothing of the character moves, which is said.
  StreamDefinitions none(KneeRig(), {.skeleton = &character}, 4);
  ASSERT_TRUE(none.Get(offer).ok());
  EXPECT_THAT(log.text(), HasSubstr("pictures show the rest pose"));
}

// The character's face has the limits of a drawn face; the rig reads the stream as it is.
TEST(StreamDefinitions, TheDrawnFaceKeepsItsLimits) {
  const wrinkle::Skeleton character = Head("neck");
  const std::vector<std::string> shapes = {"jawOpen", "mouthClose", "eyeSquintLeft",
                                           "eyeBlinkLeft"};
  const std::vector<wrinkle::ShapeRule> rules = {{.shape = 1, .contains = 0}};
  StreamDefinitions definitions(
      KneeRig(), {.skeleton = &character, .shapes = shapes, .shape_rules = rules}, 4);
  const auto definition = definitions.Get({.joints = {}, .blend_shapes = shapes});
  ASSERT_TRUE(definition.ok()) << definition.status().ToString();
  SubjectPipeline subject(*definition);
  const std::vector<float> sent = {0.75f, 0.25f, 1.0f, 0.5f};
  subject.mutable_pose()->blend_shapes = sent;
  ASSERT_EQ(subject.Solve(1, 1000), wrinkle::JobStatus::kOk);
  const auto snapshot = subject.TakeSnapshot(0);
  EXPECT_EQ(snapshot->blend_shapes, sent);
  std::vector<float> weights(4);
  ASSERT_EQ(snapshot->shape_program->Run(snapshot->blend_shapes, weights), wrinkle::JobStatus::kOk);
  EXPECT_EQ(weights, (std::vector<float>{0.5f, 0.25f, 0.6f, 0.5f}));
}

// A face without jawOpen opens its mouth by a viseme, which the log says.
TEST(StreamDefinitions, FallbacksOfTheFaceAreLogged) {
  const wrinkle::Skeleton character = Head("neck");
  const std::vector<std::string> shapes = {"browInnerUp", "mouthSmileLeft", "mouthSmileRight",
                                           "viseme_aa"};
  StreamDefinitions definitions(KneeRig(), {.skeleton = &character, .shapes = shapes}, 4,
                                {{}, rig::ShippedShapeMatcher()});
  LogCapture log;
  ASSERT_TRUE(
      definitions
          .Get({.joints = {},
                .blend_shapes = {"browInnerUp", "mouthSmileLeft", "mouthSmileRight", "jawOpen"}})
          .ok());
  EXPECT_THAT(log.text(), HasSubstr("face: shape map 'arkit': 4 of 4 blend shapes; by fallback: "
                                    "viseme_aa for jawOpen"));
}

// A phone sends a face without joints. The default character's rig also reads joints of a body.
TEST(StreamDefinitions, WarningsOfTheBindingAreLogged) {
  auto rig = std::make_shared<wrinkle::Rig>(*KneeRig());
  wrinkle::Driver elbow = rig->drivers[0];  // a hinge
  ASSERT_EQ(elbow.kind, wrinkle::Driver::Kind::kHinge);
  for (int i = 0; i < 10; ++i) {
    elbow.name = "knee_" + std::to_string(i);
    elbow.hinge.end = elbow.hinge.parent;  // not below the joint
    rig->drivers.push_back(elbow);
  }
  StreamDefinitions definitions(rig, {}, 4);
  LogCapture log;
  ASSERT_TRUE(definitions.Get(ToStreamOffer(KneeOffer())).ok());
  EXPECT_THAT(log.text(), HasSubstr("driver 'knee_0'")) << log.text();
  EXPECT_THAT(log.text(), Not(HasSubstr("driver 'knee_9'")));
  EXPECT_THAT(log.text(), HasSubstr("2 more warnings"));
}

TEST(StreamDefinitions, AFaceWithoutJointsLacksNothing) {
  auto rig = std::make_shared<wrinkle::Rig>(*KneeRig());
  wrinkle::Driver jaw;
  jaw.name = "jaw";
  jaw.kind = wrinkle::Driver::Kind::kBlendShape;
  jaw.blend_shape.blend_shape = "jawOpen";
  rig->drivers.push_back(jaw);
  StreamDefinitions definitions(rig, {}, 4);
  LogCapture log;
  ASSERT_TRUE(definitions.Get({.joints = {}, .blend_shapes = {"jawOpen"}}).ok());
  EXPECT_THAT(log.text(), Not(HasSubstr("lacks"))) << log.text();
}

TEST(StreamDefinitions, IgnoredJointsAreLogged) {
  const wrinkle::Skeleton character = Head("foot");
  for (const wrinkle::Skeleton* drawn :
       {static_cast<const wrinkle::Skeleton*>(nullptr), &character}) {
    StreamDefinitions definitions(KneeRig(), {.skeleton = drawn}, 4);
    LogCapture log;
    ASSERT_TRUE(definitions.Get(ToStreamOffer(KneeOffer())).ok());
    EXPECT_THAT(log.text(), HasSubstr(drawn == nullptr ? "ignored: hips, foot" : "ignored: hips"));
    EXPECT_THAT(log.text(), Not(HasSubstr("thigh"))) << "the rig reads it";
    const std::string ignored = log.text().substr(log.text().find("ignored"));
    EXPECT_THAT(ignored, Not(HasSubstr("rest"))) << log.text();
  }
}

wrinkle::Skeleton LegsCalled(const std::vector<std::string>& names) {
  const int parents[] = {-1, 0, 1, 2, 0, 4, 5};
  const glm::vec3 offsets[] = {{0, 1, 0},         {0.1f, -0.1f, 0}, {0, -0.4f, 0}, {0, -0.4f, 0},
                               {-0.1f, -0.1f, 0}, {0, -0.4f, 0},    {0, -0.4f, 0}};
  std::vector<wrinkle::JointDesc> joints;
  for (std::size_t i = 0; i < names.size(); ++i) {
    wrinkle::JointDesc joint;
    joint.name = names[i];
    joint.parent = parents[i];
    joint.rest.translation = offsets[i];
    joints.push_back(joint);
  }
  return wrinkle::Skeleton::Create(std::move(joints)).value();
}

// The rig and the character use upper_leg_l, the stream mixamorig:LeftUpLeg.
TEST(StreamDefinitions, AForeignStreamFeedsTheRigAndMovesTheCharacter) {
  const auto matcher = rig::ShippedMatcher();
  ASSERT_TRUE(matcher.ok()) << matcher.status().ToString();
  auto rig = std::make_shared<wrinkle::Rig>(*KneeRig());
  wrinkle::Driver right = rig->drivers[0];
  rig->drivers[0].hinge = {.parent = "upper_leg_l", .joint = "lower_leg_l", .end = "foot_l"};
  right.name = "right";
  right.hinge = {.parent = "upper_leg_r", .joint = "lower_leg_r", .end = "foot_r"};
  rig->drivers.push_back(right);
  const wrinkle::Skeleton character = LegsCalled(
      {"hips", "upper_leg_l", "lower_leg_l", "foot_l", "upper_leg_r", "lower_leg_r", "foot_r"});
  const wrinkle::Skeleton stream = LegsCalled(
      {"mixamorig:Hips", "mixamorig:LeftUpLeg", "mixamorig:LeftLeg", "mixamorig:LeftFoot",
       "mixamorig:RightUpLeg", "mixamorig:RightLeg", "mixamorig:RightFoot"});
  StreamOffer offer;
  for (int i = 0; i < stream.num_joints(); ++i) {
    offer.joints.push_back(
        {stream.joint_names()[i], stream.joint_parents()[i], stream.rest_pose()[i], {}});
  }
  StreamDefinitions definitions(rig, {.skeleton = &character}, 4, {*matcher, {}});
  LogCapture log;
  const auto definition = definitions.Get(offer);
  ASSERT_TRUE(definition.ok()) << definition.status().ToString();
  EXPECT_THAT(log.text(), HasSubstr(": 7 roles, 7 of 7 joints; missing: spine"));
  EXPECT_THAT(log.text(), Not(HasSubstr("ignored")));
  EXPECT_TRUE((*definition)->binding->missing_joints().empty());
  EXPECT_TRUE((*definition)->retarget->by_role());

  SubjectPipeline subject(*definition);
  subject.mutable_pose()->joints[2].rotation = glm::angleAxis(1.5f, glm::vec3(1, 0, 0));
  ASSERT_EQ(subject.Solve(1, 1000), wrinkle::JobStatus::kOk);
  const auto snapshot = subject.TakeSnapshot(0);
  EXPECT_GT(snapshot->wrinkle_weights[0], 0.1f);
  std::vector<wrinkle::Transform> drawn(7);
  ASSERT_EQ(snapshot->retarget->Run(snapshot->joints, drawn), wrinkle::JobStatus::kOk);
  EXPECT_NEAR(glm::angle(drawn[2].rotation), 1.5f, 1e-4f);
}

// A rig of one driver, which reads a blend shape of ARKit.
std::shared_ptr<const wrinkle::Rig> FaceRig(const char* blend_shape) {
  auto rig = std::make_shared<wrinkle::Rig>();
  rig->name = "face";
  rig->filter.enabled = false;
  rig->wrinkle_maps.push_back({.name = "folds"});
  wrinkle::Driver& driver = rig->drivers.emplace_back();
  driver.name = "face";
  driver.kind = wrinkle::Driver::Kind::kBlendShape;
  driver.blend_shape.blend_shape = blend_shape;
  wrinkle::Region region;
  region.name = "face";
  region.modulation = wrinkle::Modulation::kLinear;
  region.feeds.push_back({"folds", {{"face", "value", 1.0f}}});
  rig->regions.push_back(region);
  return rig;
}

TEST(SubjectPipeline, PresetsMoveARigOfArkit) {
  StreamDefinitions definitions(FaceRig("mouthSmileLeft"), {}, 4, {{}, rig::ShippedShapeMatcher()});
  LogCapture log;
  const auto definition = definitions.Get({.joints = {}, .blend_shapes = {"Joy", "A", "Blink"}});
  ASSERT_TRUE(definition.ok()) << definition.status().ToString();
  EXPECT_THAT(log.text(), HasSubstr("shape map 'vrm0' to 'arkit': 1 of 1 blend shape"));
  EXPECT_THAT(log.text(), Not(HasSubstr("lacks")));
  EXPECT_THAT(log.text(), Not(HasSubstr("at rest")));

  SubjectPipeline subject(*definition);
  protocol::PoseFrame frame;
  frame.num_blend_shapes = 3;
  frame.blend_shapes = {0.5f, 0.25f, 0.0f};
  ASSERT_TRUE(PoseFits(frame, subject.stream()));
  ApplyPose(frame, subject.stream(), subject.mutable_pose());
  ASSERT_EQ(subject.Solve(1, 1000), wrinkle::JobStatus::kOk);
  EXPECT_FLOAT_EQ(subject.wrinkle_weights()[0], 0.5f);
  // Subscribers receive the coefficients as they were sent.
  protocol::PoseFrame relayed;
  ToWholePose(subject.pose(), subject.stream(), &relayed);
  EXPECT_EQ(relayed.num_blend_shapes, 3);
  EXPECT_EQ(relayed.blend_shapes, frame.blend_shapes);

  // The relaxed face counts as neutral, also after the rig has changed.
  ASSERT_TRUE(subject.SetNeutral(subject.pose()));
  EXPECT_FLOAT_EQ(subject.wrinkle_weights()[0], 0.0f);
  definitions.SetRig(FaceRig("jawOpen"));
  subject.SetStream(definitions.Rebind(subject.stream()).value());
  EXPECT_FLOAT_EQ(subject.wrinkle_weights()[0], 0.0f);
  ASSERT_TRUE(subject.SetNeutral(std::nullopt));
  EXPECT_FLOAT_EQ(subject.wrinkle_weights()[0], 0.2f);
}

// A phone that is held low sees a turned head and lowered eyes. They are the rest of a captured
// face, in weights and in pictures.
TEST(SubjectPipeline, PicturesShowTheFaceRelativeToItsNeutral) {
  StreamDefinitions definitions(FaceRig("browDown"), {}, 4);
  const auto definition =
      definitions.Get({.joints = {}, .blend_shapes = {"browDown", "HeadPitch", "eyeLookDownLeft"}});
  ASSERT_TRUE(definition.ok()) << definition.status().ToString();
  SubjectPipeline subject(*definition);
  const auto drawn = [&](const std::vector<float>& coefficients) {
    std::ranges::copy(coefficients, subject.mutable_pose()->blend_shapes.begin());
    EXPECT_EQ(subject.Solve(subject.sequence() + 1, 1000), wrinkle::JobStatus::kOk);
    return subject.TakeSnapshot(0)->blend_shapes;
  };
  EXPECT_THAT(drawn({0.25f, -0.3f, 0.2f}), Pointwise(FloatEq(), std::vector{0.25f, -0.3f, 0.2f}));
  ASSERT_TRUE(subject.SetNeutral(subject.pose()));
  EXPECT_THAT(drawn({0.25f, -0.3f, 0.2f}), Each(0.0f));
  // A full lowering stays full, and half of the way is half. Angles only shift.
  EXPECT_THAT(drawn({1.0f, 0.2f, 0.6f}),
              Pointwise(FloatNear(1e-6f), std::vector{1.0f, 0.5f, 0.5f}));
  EXPECT_NEAR(subject.wrinkle_weights()[0], 0.75f, 1e-6f);
  EXPECT_THAT(drawn({0.15f, -0.4f, 0.0f}),
              Pointwise(FloatNear(1e-6f), std::vector{-0.1f, -0.1f, -0.2f}));
  // Subscribers receive the coefficients as they were sent.
  EXPECT_FLOAT_EQ(subject.pose().blend_shapes[0], 0.15f);
}

TEST(SubjectPipeline, FollowsTheBend) {
  SubjectPipeline subject(Define());
  float last = -1.0f;
  for (int step = 0; step <= 10; ++step) {
    ApplyPose(Bend(0.2f * static_cast<float>(step)), subject.stream(), subject.mutable_pose());
    ASSERT_EQ(subject.Solve(static_cast<std::uint32_t>(step), step * 1000),
              wrinkle::JobStatus::kOk);
    EXPECT_GT(subject.wrinkle_weights()[0], last);
    last = subject.wrinkle_weights()[0];
  }
  EXPECT_GT(last, 0.5f);
  EXPECT_EQ(subject.sequence(), 10u);
  EXPECT_EQ(subject.capture_time_us(), 10'000);
}

TEST(SubjectPipeline, ACaptureTimeThatGoesBackRestartsTheFilter) {
  SubjectPipeline subject(Define(/*filter=*/true));
  const auto solve = [&](float bend, std::uint32_t sequence, std::int64_t time_us) {
    ApplyPose(Bend(bend), subject.stream(), subject.mutable_pose());
    EXPECT_EQ(subject.Solve(sequence, time_us), wrinkle::JobStatus::kOk);
    return subject.wrinkle_weights()[0];
  };
  const float bent = solve(2.0f, 0, 50'000'000);
  EXPECT_GT(solve(0.0f, 1, 50'001'000), 0.0f) << "a millisecond on, the filter still holds";
  EXPECT_EQ(solve(2.0f, 2, 1'000), bent) << "a first pose passes unchanged";
}

TEST(SubjectPipeline, AnotherPipelineGoesOnAsIfNothingHadHappened) {
  const auto stream = Define(/*filter=*/true);
  SubjectPipeline former(stream);
  const auto solve = [&stream](SubjectPipeline& pipeline, std::uint32_t sequence) {
    const float bend = 0.3f + 0.2f * std::sin(static_cast<float>(sequence));
    ApplyPose(Bend(bend), *stream, pipeline.mutable_pose());
    EXPECT_EQ(pipeline.Solve(sequence, 20'000 * std::int64_t{sequence}), wrinkle::JobStatus::kOk);
  };
  wrinkle::LocalPose neutral = former.pose();
  neutral.joints[2].rotation = glm::angleAxis(0.1f, glm::vec3(1, 0, 0));
  ASSERT_TRUE(former.SetNeutral(neutral));
  for (std::uint32_t i = 1; i <= 5; ++i) solve(former, i);
  ASSERT_EQ(former.Decay(0.05), wrinkle::JobStatus::kOk);
  SubjectPipeline next(stream);
  ASSERT_TRUE(next.SetNeutral(former.neutral_pose()));
  ASSERT_TRUE(next.Resume(former.pose(), former.memory()));
  const auto weights = [](const SubjectPipeline& pipeline) {
    const auto all = pipeline.wrinkle_weights();
    return std::vector<float>(all.begin(), all.end());
  };
  EXPECT_TRUE(next.has_pose());
  EXPECT_EQ(next.sequence(), 5u);
  EXPECT_EQ(next.capture_time_us(), 100'000);
  EXPECT_EQ(weights(next), weights(former));
  for (std::uint32_t i = 6; i <= 9; ++i) {
    solve(former, i);
    solve(next, i);
    EXPECT_EQ(weights(next), weights(former)) << i;
  }
  // One without this past differs, so the comparison can fail.
  SubjectPipeline fresh(stream);
  ASSERT_TRUE(fresh.SetNeutral(former.neutral_pose()));
  solve(fresh, 9);
  EXPECT_NE(weights(fresh), weights(former));
}

TEST(SubjectPipeline, RefusesThePastOfAnotherRig) {
  SubjectPipeline pipeline(Define(/*filter=*/true));
  SubjectPipeline::Memory memory = pipeline.memory();
  EXPECT_FALSE(pipeline.Resume(pipeline.pose(), memory)) << "there was no pose yet";
  memory.solver.filtered.assign(99, 0.0f);
  memory.solver.inputs = memory.solver.speeds = memory.solver.filtered;
  EXPECT_FALSE(pipeline.Resume(pipeline.pose(), memory));
  EXPECT_FALSE(pipeline.has_pose());
}

TEST(SubjectPipeline, FoldsAtRestDoNotHoldASubject) {
  auto rig = std::make_shared<wrinkle::Rig>(*KneeRig(/*filter=*/true));
  rig->regions[0].curve = {{0.0f, 0.5f}, {1.0f, 1.0f}};
  SubjectPipeline subject(Define(rig));
  ApplyPose(Bend(2.0f), subject.stream(), subject.mutable_pose());
  ASSERT_EQ(subject.Solve(7, 0), wrinkle::JobStatus::kOk);
  EXPECT_FALSE(subject.neutral());
  for (int i = 0; i < 600; ++i) ASSERT_EQ(subject.Decay(0.02), wrinkle::JobStatus::kOk);
  EXPECT_NEAR(subject.wrinkle_weights()[0], 0.5f, 1e-3f);
  EXPECT_TRUE(subject.neutral());
}

TEST(SubjectPipeline, ANewRigOrNeutralDoesNotBringBackWhatHasDecayed) {
  const auto solve = [](SubjectPipeline& subject) {
    ApplyPose(Bend(2.0f), subject.stream(), subject.mutable_pose());
    ASSERT_EQ(subject.Solve(7, 0), wrinkle::JobStatus::kOk);
  };
  const auto definition = Define(/*filter=*/true);
  SubjectPipeline gone(definition);
  SubjectPipeline fading(definition);
  solve(gone);
  solve(fading);
  for (int i = 0; i < 600; ++i) ASSERT_EQ(gone.Decay(0.02), wrinkle::JobStatus::kOk);
  const float fresh = fading.wrinkle_weights()[0];
  const auto& filter = KneeRig(/*filter=*/true)->filter;
  const double fades = double{filter.hold_seconds} + 0.3 * double{filter.decay_seconds};
  ASSERT_EQ(fading.Decay(fades), wrinkle::JobStatus::kOk);
  const float faded = fading.wrinkle_weights()[0];
  ASSERT_LT(faded, fresh);
  ASSERT_GT(faded, 0.0f);
  for (SubjectPipeline* subject : {&gone, &fading}) {
    const float before = subject->wrinkle_weights()[0];
    subject->SetStream(definition);
    EXPECT_FLOAT_EQ(subject->wrinkle_weights()[0], before);
    ASSERT_TRUE(subject->SetNeutral(std::nullopt));
    EXPECT_FLOAT_EQ(subject->wrinkle_weights()[0], before);
  }
  EXPECT_TRUE(gone.neutral());
}

TEST(SubjectPipeline, SnapshotsShowTheDecay) {
  SubjectPipeline subject(Define(/*filter=*/true));
  ApplyPose(Bend(2.0f), subject.stream(), subject.mutable_pose());
  ASSERT_EQ(subject.Solve(7, 0), wrinkle::JobStatus::kOk);
  EXPECT_FALSE(subject.neutral());
  const auto before = subject.TakeSnapshot(0);
  for (int i = 0; i < 600; ++i) ASSERT_EQ(subject.Decay(0.02), wrinkle::JobStatus::kOk);
  EXPECT_TRUE(subject.neutral());
  const auto after = subject.TakeSnapshot(12'000'000);
  EXPECT_GT(before->wrinkle_weights[0], 0.5f) << "a snapshot is a value";
  EXPECT_LT(after->wrinkle_weights[0], 0.01f);
  EXPECT_EQ(after->age_us, 12'000'000);
  EXPECT_EQ(after->joints[2].rotation.x, before->joints[2].rotation.x) << "the pose stays";
}

}  // namespace
}  // namespace furrow::server
