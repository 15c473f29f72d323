// SPDX-License-Identifier: Apache-2.0
// Subjects that move from one hub to another one.
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fake_cluster.h"
#include "hub_fixture.h"
#include "protocol/secure/token/roles.h"

namespace furrow::server {
namespace {

using protocol::SkeletonStatus;

// One hub at a time: the next node of the cluster takes the place of the one before.
class HubMoveTest : public HubPeersTest {
 protected:
  HubMoveTest() {
    cluster = &nodes;
    nodes.successor = FakeCluster::At(FakeCluster::kOther);
    nodes.expects.kind = Place::Kind::kPending;
  }
  void SetUp() override {
    Make({}, /*filter=*/true);
    Connect(&sender);
    Connect(&viewer);
    Serve(10);
  }

  void Serve(std::uint64_t epoch) {
    nodes.places["ada"] = FakeCluster::Here(now + FromSeconds(60.0), epoch);
  }
  // The last weights that the viewer has got.
  std::vector<float> Weights() {
    std::vector<float> values;
    while (!viewer.inbox.empty()) {
      const auto got = viewer.Take<protocol::WeightFrame>();
      if (got) values = got->message.values;
    }
    return values;
  }
  void SendPose(std::uint32_t sequence) {
    Advance(0.02);
    Send(sender, Pose(0.1f * static_cast<float>(sequence % 7)), 1, sequence, 20'000 * sequence);
  }
  // Publishes "ada" here, with a neutral pose, and sends some poses.
  void Perform() {
    Publish(sender, "ada");
    ASSERT_NE(Watch(viewer, {.subject = "ada"}), 0);
    for (std::uint32_t i = 1; i <= 5; ++i) SendPose(i);
    Subject* const subject = hub->RequireAllDrivers("ada");
    ASSERT_NE(subject, nullptr);
    wrinkle::LocalPose neutral = subject->pipeline->pose();
    neutral.blend_shapes[0] = 0.05f;
    hub->SetNeutral(*subject, neutral, now);
    for (std::uint32_t i = 6; i <= 9; ++i) SendPose(i);
    viewer.inbox.clear();
    sender.inbox.clear();
  }
  [[nodiscard]] std::vector<std::uint8_t> State() {
    std::vector<std::uint8_t> state;
    EXPECT_TRUE(hub->WriteState("ada", 1, state));
    return state;
  }
  // Another node, where nobody is yet.
  void NextNode() {
    nodes.places.clear();
    Make({}, /*filter=*/true);
    for (FakePeer* peer : {&sender, &viewer, &node}) {
      peer->inbox.clear();
      Connect(peer);
    }
  }
  void Receive(const std::vector<std::uint8_t>& state) { hub->OnMessage(node.id, state, now); }
  void ExpectAnswer(SkeletonStatus status, const std::string& why) {
    const auto reply = node.Take<protocol::SkeletonReply>();
    ASSERT_TRUE(reply.has_value());
    EXPECT_EQ(reply->message.status, status);
    EXPECT_EQ(reply->message.message, why);
    EXPECT_EQ(reply->header.sequence, 1u);
  }

  // A peer on this computer.
  static PeerLabel Here() {
    PeerLabel label("fake");
    label.address = "127.0.0.1";
    return label;
  }

  FakeCluster nodes;
  FakePeer node;  // the one that hands the subject over
};

TEST_F(HubMoveTest, TheNextNodeGoesOnAsIfNothingHadHappened) {
  Perform();
  const std::vector<std::uint8_t> state = State();
  SendPose(10);
  const std::vector<float> wanted = Weights();
  ASSERT_EQ(wanted.size(), 2u);
  now -= FromSeconds(0.02);

  NextNode();
  Receive(state);
  ExpectAnswer(SkeletonStatus::kAccepted, "");
  EXPECT_EQ(nodes.expected, std::vector<std::string>{"ada"});
  Serve(11);
  Publish(sender, "ada");
  ASSERT_NE(Watch(viewer, {.subject = "ada"}), 0);
  // The viewer has got the newest pose of the other node there.
  hub->Tick(now);
  EXPECT_TRUE(Weights().empty());
  // What the other node has used already is not used again.
  Send(sender, Pose(0.9f), 1, 9, 180'000);
  EXPECT_TRUE(Weights().empty());
  EXPECT_EQ(Count(Counter::kPosesDuplicate), 1u);
  SendPose(10);
  EXPECT_EQ(Weights(), wanted);
  EXPECT_TRUE(hub->RequireAllDrivers("ada")->pipeline->neutral_pose().has_value());
}

TEST_F(HubMoveTest, TheTimecodeOfTheLastPoseMovesAlong) {
  Perform();
  protocol::PoseFrame pose = Pose(0.5f);
  pose.timecode = MakeTimecode(17'982, 0.0, 30'000, 1001);
  Send(sender, pose, 1, 10, 200'000);
  const std::vector<std::uint8_t> state = State();
  NextNode();
  Receive(state);
  Serve(11);
  Publish(sender, "ada");
  EXPECT_EQ(hub->FindSubject("ada")->timecode, pose.timecode);
}

TEST_F(HubMoveTest, AnotherSessionGetsTheNeutralPoseAlone) {
  Perform();
  const std::vector<std::uint8_t> state = State();
  NextNode();
  Receive(state);
  Serve(11);
  sender.session = 78;
  now += Arrivals::kReserved;
  Publish(sender, "ada");
  const Subject* subject = hub->RequireAllDrivers("ada");
  EXPECT_TRUE(subject->pipeline->neutral_pose().has_value());
  EXPECT_FALSE(subject->pipeline->has_pose());
  Send(sender, Pose(0.5f), 1, 0, 0);
  EXPECT_TRUE(subject->pipeline->has_pose());
}

TEST_F(HubMoveTest, AnotherSenderCannotTakeASubjectOnItsWay) {
  Perform();
  const std::vector<std::uint8_t> state = State();
  NextNode();
  FakePeer thief;
  thief.session = 78;
  Connect(&thief);
  Place pending;
  pending.kind = Place::Kind::kPending;
  nodes.places["ada"] = pending;
  Send(thief, Offer("ada"), 1);  // waits before the state comes
  EXPECT_TRUE(thief.inbox.empty());
  Receive(state);
  Send(sender, Offer("ada"), 1);
  Send(thief, Offer("ada"), 1);
  ExpectError(thief, protocol::ErrorCode::kSubjectTaken);
  Serve(11);
  hub->Tick(now);
  // The publisher is asked again, and nobody else.
  EXPECT_TRUE(thief.inbox.empty());
  ASSERT_TRUE(sender.Take<protocol::SkeletonReply>().has_value());
  Send(thief, Offer("ada"), 1);
  ExpectError(thief, protocol::ErrorCode::kSubjectTaken);
  Publish(sender, "ada");
  EXPECT_TRUE(hub->FindSubject("ada")->pipeline->has_pose()) << "the state is still there";
}

TEST_F(HubMoveTest, DriversStayUntilTheSubscribersHaveFollowed) {
  Perform();
  const std::vector<std::uint8_t> state = State();
  NextNode();
  Receive(state);
  Serve(11);
  Publish(sender, "ada");
  const Subject* subject = hub->subjects().all().at(0).get();
  EXPECT_EQ(subject->pipeline->level(), wrinkle::kAllDrivers);
  Advance(5.0);
  hub->Tick(now);
  EXPECT_EQ(subject->pipeline->level(), 0u) << "nobody needs them";
}

TEST_F(HubMoveTest, TheOldNodeSendsEverybodyAway) {
  Perform();
  hub->TakeNothingNew();
  EXPECT_TRUE(nodes.draining);
  // The subject stays until it moves.
  hub->Tick(now += Places::kRefresh);
  SendPose(10);
  EXPECT_FALSE(Weights().empty());
  EXPECT_EQ(hub->SubjectNames(), std::vector<std::string>{"ada"});
  const Place place = hub->SuccessorOf("ada", now);
  ASSERT_EQ(place.kind, Place::Kind::kElsewhere);
  std::vector<std::uint8_t> state;
  ASSERT_TRUE(hub->HandOver("ada", place.node, 7, state, now).ok());
  for (FakePeer* peer : {&sender, &viewer}) {
    const auto error = peer->Take<protocol::ErrorMessage>();
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->message.host, "host-b");
    EXPECT_TRUE(peer->inbox.empty());
  }
  EXPECT_EQ(hub->num_subjects(), 0u);
  protocol::MessageView view;
  protocol::SubjectState message;
  ASSERT_EQ(protocol::OpenMessage(state, view), protocol::DecodeStatus::kOk);
  ASSERT_EQ(protocol::Decode(view, message), protocol::DecodeStatus::kOk);
  EXPECT_EQ(view.header.sequence, 7u);
  EXPECT_EQ(view.header.capture_time_us, 200'000);
  EXPECT_EQ(message.newest_sequence, 10u);
  EXPECT_EQ(message.publisher_session, sender.session);
  // Poses that are still on their way here change nothing, and an offer is sent after the subject.
  SendPose(11);
  EXPECT_TRUE(Weights().empty());
  sender.inbox.clear();
  Send(sender, Offer("ada"), 1);
  EXPECT_TRUE(sender.Take<protocol::ErrorMessage>().has_value());
  EXPECT_EQ(hub->HandOver("ada", place.node, 8, state, now).code(), StatusCode::kNotFound);
}

TEST_F(HubMoveTest, ASubjectWithoutASuccessorStays) {
  Publish(sender, "ada");
  nodes.successor = Place();
  nodes.successor.why = "no other node has room";
  EXPECT_EQ(hub->SuccessorOf("ada", now).why, "no other node has room");
  EXPECT_EQ(hub->SuccessorOf("bob", now).why, "it has left");
}

TEST_F(HubMoveTest, ForeignWiresCannotBeSentElsewhere) {
  FakePeer wire;
  Connect(&wire, Transport::kMocap);
  Publish(wire, "ada");
  EXPECT_EQ(hub->SuccessorOf("ada", now).why, "its sender cannot be sent to another daemon");
}

TEST_F(HubMoveTest, WebPagesAndSendersOfSeveralSubjectsStay) {
  FakePeer page;
  Connect(&page, Transport::kWeb);
  Publish(page, "ada");
  EXPECT_EQ(hub->SuccessorOf("ada", now).why, "its sender cannot be sent to another daemon");
  for (const char* subject : {"bob", "eve"}) {
    nodes.places[subject] = FakeCluster::Here(now + FromSeconds(60.0), 1);
  }
  Publish(sender, "bob", 1);
  EXPECT_EQ(hub->SuccessorOf("bob", now).why, "");
  Publish(sender, "eve", 2);
  for (const char* subject : {"bob", "eve"}) {
    EXPECT_EQ(hub->SuccessorOf(subject, now).why,
              "its sender has several subjects on one connection");
  }
  Send(sender, protocol::Goodbye{}, 2);
  EXPECT_EQ(hub->SuccessorOf("bob", now).why, "");
}

TEST_F(HubMoveTest, ASubjectStaysIfItsLeaseWasNotConfirmedLately) {
  nodes.places["ada"] = FakeCluster::Here(now + FromSeconds(2.0), 10);
  Publish(sender, "ada");
  EXPECT_EQ(hub->SuccessorOf("ada", now).kind, Place::Kind::kElsewhere);
  now += FromSeconds(1.6);
  EXPECT_EQ(hub->SuccessorOf("ada", now).why, "the store of the cluster does not answer");
  std::vector<std::uint8_t> state;
  EXPECT_EQ(hub->HandOver("ada", FakeCluster::kOther, 7, state, now).code(),
            StatusCode::kUnavailable);
  EXPECT_EQ(hub->SubjectNames(), std::vector<std::string>{"ada"});
}

TEST_F(HubMoveTest, ManyWaitingOffersAreAskedForOneAfterTheOther) {
  nodes.places.clear();
  Place pending;
  pending.kind = Place::Kind::kPending;
  for (int i = 0; i < 100; ++i) {
    const std::string subject = "s" + std::to_string(i);
    nodes.places[subject] = pending;
    Send(sender, Offer(subject), static_cast<std::uint16_t>(i));
  }
  nodes.asked.clear();
  hub->Tick(now);
  EXPECT_LE(nodes.asked.size(), 64u);
  hub->Tick(now += FromSeconds(0.01));
  EXPECT_EQ(std::set<std::string>(nodes.asked.begin(), nodes.asked.end()).size(), 100u);
}

TEST_F(HubMoveTest, AFixedListMovesNothing) {
  nodes.why_nothing_moves = "a fixed list of nodes decides where subjects are served";
  drain = [](bool) { return protocol::DrainState{}; };
  Make({});
  sender.id = hub->AddPeer(Transport::kTcp, Here(), &sender, now);
  Send(sender, protocol::Drain{true}, 0, 3);
  const auto error = sender.Take<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->message.code, protocol::ErrorCode::kUnsupported);
  EXPECT_EQ(error->message.message,
            "a fixed list of nodes decides where subjects are served; end the daemon with SIGTERM");
}

TEST_F(HubMoveTest, OnlyThisComputerOrAnOperatorOfAllSubjectsDrains) {
  int drained = 0;
  drain = [&drained](bool) { return ++drained, protocol::DrainState{}; };
  Make({});
  sender.id = hub->AddPeer(Transport::kTcp, "elsewhere", &sender, now);
  const auto tries = [&](const char* subjects) {
    if (subjects != nullptr) {
      const protocol::secure::Grant grant{.roles = protocol::secure::Role::kOperate,
                                          .subjects = subjects};
      hub->SetAccess(sender.id, Access::Of(grant, 1, now + FromSeconds(60)));
    }
    sender.inbox.clear();
    Send(sender, protocol::Drain{true}, 0, 3);
  };
  tries(nullptr);
  ExpectError(sender, protocol::ErrorCode::kNotPermitted);
  tries("stage-*");
  ExpectError(sender, protocol::ErrorCode::kNotPermitted);
  EXPECT_EQ(drained, 0);
  tries("*");
  EXPECT_EQ(drained, 1);
  sender.id = hub->AddPeer(Transport::kTcp, Here(), &sender, now);
  tries(nullptr);
  EXPECT_EQ(drained, 2);
}

TEST_F(HubMoveTest, ArrivingCapturesAreLimited) {
  Perform();
  wrinkle::Rig rig = hub->rig();
  for (int i = 0; i <= Hub::kMaxAddedPoses; ++i) {
    const std::string name = "p" + std::to_string(i);
    rig.reference_poses.push_back({.name = name, .joints = {}, .shapes = {{"brow", 0.75f}}});
    hub->FindSubject("ada")->captures.insert(name);
  }
  ASSERT_TRUE(hub->SetRig(std::make_shared<const wrinkle::Rig>(std::move(rig)), now).ok());
  const std::vector<std::uint8_t> state = State();
  NextNode();
  const std::size_t before = hub->rig().reference_poses.size();
  Receive(state);
  EXPECT_EQ(hub->rig().reference_poses.size(), before);
  EXPECT_EQ(hub->num_rig_replacements(), 0u);
}

TEST_F(HubMoveTest, ANodeMayRefuseASubject) {
  Perform();
  const std::vector<std::uint8_t> state = State();
  NextNode();
  nodes.expects = {};
  nodes.expects.why = "this node is full";
  Receive(state);
  ExpectAnswer(SkeletonStatus::kRejected, "this node is full");
  // A state that arrives after its subject changes nothing.
  Serve(11);
  Publish(sender, "ada");
  Receive(state);
  ExpectAnswer(SkeletonStatus::kAccepted, "");
  EXPECT_FALSE(hub->subjects().all().at(0)->pipeline->has_pose());
}

TEST_F(HubMoveTest, StatesThatNobodyComesForAreForgotten) {
  Perform();
  const std::vector<std::uint8_t> state = State();
  NextNode();
  Receive(state);
  Advance(10.0);
  hub->Tick(now);
  Serve(11);
  Publish(sender, "ada");
  EXPECT_FALSE(hub->subjects().all().at(0)->pipeline->has_pose());
}

TEST_F(HubMoveTest, OnlyOperatorsHandSubjectsOver) {
  Perform();
  const std::vector<std::uint8_t> state = State();
  NextNode();
  protocol::secure::Grant grant{.roles = protocol::secure::Role::kPublish};
  hub->SetAccess(node.id, Access::Of(grant, 1, now + FromSeconds(60)));
  Receive(state);
  ExpectError(node, protocol::ErrorCode::kNotPermitted);
  grant.roles = protocol::secure::Role::kOperate;
  grant.subjects = "bob";
  hub->SetAccess(node.id, Access::Of(grant, 1, now + FromSeconds(60)));
  Receive(state);
  ExpectError(node, protocol::ErrorCode::kNotPermitted);
  EXPECT_TRUE(nodes.expected.empty());
}

TEST_F(HubMoveTest, AnOfferIsAskedForAgainAsSoonAsItsPlaceIsHere) {
  Place pending;
  pending.kind = Place::Kind::kPending;
  nodes.places["ada"] = pending;
  Send(sender, Offer("ada"), 1);
  hub->Tick(now);
  EXPECT_TRUE(sender.inbox.empty());
  Serve(11);
  hub->Tick(now += FromSeconds(0.01));
  const auto reply = sender.Take<protocol::SkeletonReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->message.status, SkeletonStatus::kNeeded);
  EXPECT_EQ(reply->header.stream, 1);
  hub->Tick(now += FromSeconds(0.01));
  EXPECT_TRUE(sender.inbox.empty()) << "once";
  Publish(sender, "ada");
}

TEST_F(HubMoveTest, CapturedReferencePosesMoveAlong) {
  Perform();
  wrinkle::Rig rig = hub->rig();
  rig.reference_poses.push_back({.name = "smile", .joints = {}, .shapes = {{"brow", 0.75f}}});
  ASSERT_TRUE(hub->SetRig(std::make_shared<const wrinkle::Rig>(std::move(rig)), now).ok());
  hub->FindSubject("ada")->captures.insert("smile");
  const std::vector<std::uint8_t> state = State();
  NextNode();
  const std::size_t before = hub->rig().reference_poses.size();
  for (int i = 0; i < 2; ++i) Receive(state);  // the second time, there is nothing to do
  const auto& poses = hub->rig().reference_poses;
  ASSERT_EQ(poses.size(), before + 1);
  EXPECT_EQ(poses.back().name, "smile");
  EXPECT_EQ(poses.back().shapes, (std::vector<wrinkle::ShapeValue>{{"brow", 0.75f}}));
  // They go on with the subject from there, too.
  Serve(11);
  Publish(sender, "ada");
  EXPECT_EQ(hub->FindSubject("ada")->captures, std::set<std::string>{"smile"});
}

TEST_F(HubMoveTest, ADaemonThatIsAloneTakesNothingAndDrainsNothing) {
  Perform();
  const std::vector<std::uint8_t> state = State();
  cluster = nullptr;
  NextNode();
  Receive(state);
  ExpectAnswer(SkeletonStatus::kRejected, "this daemon is in no cluster");
  Send(node, protocol::Drain{true}, 0, 3);
  ExpectError(node, protocol::ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace furrow::server
