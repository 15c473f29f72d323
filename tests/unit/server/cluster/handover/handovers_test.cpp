// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/handover/handovers.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/messages/limits.h"

namespace furrow::server {
namespace {

using std::chrono::milliseconds;

// A node with some subjects, and other nodes that the test plays.
class HandoversTest : public ::testing::Test, public DepartingSubjects, public NodeLinks {
 protected:
  void TakeNothingNew() override { takes_nothing_new = true; }
  std::vector<std::string> SubjectNames() override { return {subjects.begin(), subjects.end()}; }
  Place SuccessorOf(const std::string& /*subject*/, Time /*now*/,
                    const std::set<std::string>& without) override {
    Place place;
    place.why = "no other node has room";
    for (const std::string& node : nodes) {
      if (without.contains(node)) continue;
      place.kind = Place::Kind::kElsewhere;
      place.node.name = node;
      break;
    }
    return place;
  }
  bool WriteState(const std::string& subject, std::uint32_t number,
                  std::vector<std::uint8_t>& message) override {
    message.assign(state_bytes, static_cast<std::uint8_t>(number));
    return subjects.contains(subject);
  }
  Status HandOver(const std::string& subject, const NodeAddress& node, std::uint32_t number,
                  std::vector<std::uint8_t>& message, Time /*now*/) override {
    if (!subjects.contains(subject)) return {StatusCode::kNotFound, "it has left"};
    (void)WriteState(subject, number, message);
    subjects.erase(subject);
    handed.emplace_back(subject, node.name);
    return {};
  }
  void Open(const NodeAddress& node, Time patience) override {
    opened.push_back(node.name);
    patience_of_open = patience;
    if (!unreachable.contains(node.name)) handovers.OnLink(node.name, Status());
  }
  void Send(const std::string& node, std::span<const std::uint8_t> message) override {
    sent.emplace_back(node, message.empty() ? 0u : std::uint32_t{message[0]});
  }
  bool HasFailed(const std::string& node) const override { return failed.contains(node); }
  void Close(const std::string& node) override { closed.push_back(node); }

  void Begin() {
    handovers.Begin();
    handovers.Tick(now);
  }
  // Lets the time pass in steps of a millisecond, as Mover does.
  void Pass(Time time) {
    for (const Time end = now + time; now < end;) {
      now += milliseconds(1);
      handovers.Tick(now);
    }
  }
  void Answer(const std::string& node, bool accepted, const std::string& why = {}) {
    ASSERT_FALSE(sent.empty());
    handovers.OnAnswer(node, sent.back().second, accepted, why);
    handovers.Tick(now);
  }
  [[nodiscard]] std::size_t CountSent(const std::string& node) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(sent, [&](const auto& each) { return each.first == node; }));
  }
  using Names = std::vector<std::string>;
  using Handed = std::vector<std::pair<std::string, std::string>>;

  Handovers handovers{this, this};
  Time now = std::chrono::seconds(100);
  std::set<std::string> subjects{"ada"};
  std::vector<std::string> nodes{"b", "c"};  // the one with the most room first
  std::set<std::string> unreachable;
  std::set<std::string> failed;
  std::size_t state_bytes = 100;
  bool takes_nothing_new = false;
  Time patience_of_open{0};
  Names opened;
  Names closed;
  std::vector<std::pair<std::string, std::uint32_t>> sent;  // node, number
  Handed handed;
};

TEST_F(HandoversTest, TheNodeWithTheMostRoomGetsTheStateThenTheLastOne) {
  Begin();
  EXPECT_TRUE(takes_nothing_new);
  EXPECT_EQ(sent, (decltype(sent){{"b", 1}}));
  EXPECT_TRUE(handed.empty()) << "the node has not agreed";
  Answer("b", true);
  EXPECT_EQ(handed, (Handed{{"ada", "b"}}));
  EXPECT_EQ(sent, (decltype(sent){{"b", 1}, {"b", 2}}));
  EXPECT_TRUE(handovers.running()) << "the last state may be lost";
  Answer("b", true);
  EXPECT_FALSE(handovers.running());
  EXPECT_EQ(closed, Names{"b"});
  EXPECT_EQ(handovers.progress().moved, 1u);
  EXPECT_EQ(handovers.progress().stays, "");
}

TEST_F(HandoversTest, ASecondHeirTakesWhatTheFirstRefuses) {
  Begin();
  Answer("b", false, "this node is full");
  EXPECT_TRUE(closed.empty()) << "the node answers, and may take the next subject";
  EXPECT_EQ(sent.back(), (std::pair<std::string, std::uint32_t>("c", 2)));
  Answer("c", true);
  EXPECT_EQ(handed, (Handed{{"ada", "c"}}));
  EXPECT_EQ(opened, (Names{"b", "c"}));
}

TEST_F(HandoversTest, EachSubjectIsOfferedToTheFirstNodeAgain) {
  subjects = {"ada", "bob"};
  Begin();
  Answer("b", false, "not this one");
  Answer("c", true);
  EXPECT_EQ(sent.back().first, "b");
  Answer("b", true);
  EXPECT_EQ(handed, (Handed{{"ada", "c"}, {"bob", "b"}}));
  EXPECT_EQ(opened, (Names{"b", "c"})) << "one conversation with each";
}

TEST_F(HandoversTest, ANodeThatCannotBeReachedIsPassedOverForTheRound) {
  subjects = {"ada", "bob"};
  unreachable = {"b"};
  Begin();
  EXPECT_EQ(patience_of_open, Handovers::kConnectPatience);
  Pass(milliseconds(500));
  EXPECT_TRUE(sent.empty());
  handovers.OnLink("b", Status(StatusCode::kUnavailable, "does not answer"));
  handovers.Tick(now);
  EXPECT_EQ(closed, Names{"b"});
  Answer("c", true);
  Answer("c", true);
  EXPECT_EQ(handed, (Handed{{"ada", "c"}, {"bob", "c"}}));
  EXPECT_EQ(opened, (Names{"b", "c"})) << "nobody waits for b twice";
}

TEST_F(HandoversTest, AQuestionIsRepeatedUntilItIsAnswered) {
  Begin();
  Pass(milliseconds(100));
  EXPECT_EQ(CountSent("b"), 6u);
  Answer("b", true);
  handovers.OnAnswer("b", 1, false, "a late copy");
  Pass(milliseconds(10));
  EXPECT_EQ(handed, (Handed{{"ada", "b"}}));
  EXPECT_EQ(CountSent("b"), 7u);
}

TEST_F(HandoversTest, ANodeThatFallsSilentIsClosedAndTheNextOneAsked) {
  Begin();
  Pass(Handovers::kAnswerPatience - milliseconds(1));
  EXPECT_TRUE(closed.empty());
  EXPECT_EQ(CountSent("c"), 0u);
  Pass(milliseconds(1));
  EXPECT_EQ(closed, Names{"b"});
  EXPECT_EQ(CountSent("c"), 1u);
  // The answer of a closed link counts for nothing.
  handovers.OnAnswer("b", 1, true, "");
  handovers.Tick(now);
  EXPECT_TRUE(handed.empty());
  Answer("c", true);
  EXPECT_EQ(handed, (Handed{{"ada", "c"}}));
}

TEST_F(HandoversTest, AFailedLinkIsClosedAndMadeAgain) {
  nodes = {"b"};
  Begin();
  failed = {"b"};
  Answer("b", false, "who are you?");
  EXPECT_EQ(closed, Names{"b"});
  EXPECT_EQ(handovers.progress().stays, "ada");
  EXPECT_EQ(handovers.progress().why, "the node 'b' refuses it: who are you?");
  failed.clear();
  Pass(Handovers::kNextRound - milliseconds(1));
  EXPECT_EQ(opened, Names{"b"});
  Pass(milliseconds(1));
  EXPECT_EQ(opened, (Names{"b", "b"}));
  Answer("b", true);
  EXPECT_EQ(handed, (Handed{{"ada", "b"}}));
}

TEST_F(HandoversTest, AnswersOfAnotherNodeCountForNothing) {
  Begin();
  handovers.OnAnswer("c", 1, true, "");
  handovers.Tick(now);
  EXPECT_TRUE(handed.empty());
}

TEST_F(HandoversTest, WithoutARoomElsewhereTheSubjectStaysUntilThereIsOne) {
  nodes.clear();
  Begin();
  EXPECT_EQ(handovers.progress().why, "no other node has room");
  Pass(std::chrono::seconds(10));
  EXPECT_TRUE(handovers.running());
  nodes = {"d"};
  Pass(Handovers::kNextRound);
  Answer("d", true);
  Answer("d", true);
  EXPECT_FALSE(handovers.running());
}

TEST_F(HandoversTest, AtTheEndWhatStaysIsGivenUp) {
  nodes = {"b"};
  unreachable = {"b"};
  handovers.EndBy(now + milliseconds(300));
  Begin();
  EXPECT_EQ(patience_of_open, milliseconds(300)) << "no wait outlasts the end";
  Pass(milliseconds(300));
  handovers.OnLink("b", Status(StatusCode::kUnavailable, "does not answer"));
  Pass(milliseconds(1));
  EXPECT_FALSE(handovers.running());
  EXPECT_EQ(closed, Names{"b"});
  EXPECT_EQ(subjects, std::set<std::string>{"ada"});
}

TEST_F(HandoversTest, WithAnEndOneRoundWithoutASuccessIsEnough) {
  nodes.clear();
  handovers.EndBy(now + std::chrono::seconds(5));
  Begin();
  EXPECT_FALSE(handovers.running());
}

TEST_F(HandoversTest, TheLastStateIsRepeatedAndThenGivenUp) {
  Begin();
  Answer("b", true);
  Pass(Handovers::kAnswerPatience - milliseconds(1));
  EXPECT_TRUE(handovers.running());
  EXPECT_EQ(CountSent("b"), 51u);
  Pass(milliseconds(1));
  EXPECT_FALSE(handovers.running());
  EXPECT_EQ(handovers.progress().moved, 1u);
}

TEST_F(HandoversTest, ASubjectThatLeavesMeanwhileIsNoFailure) {
  subjects = {"ada", "bob"};
  Begin();
  subjects.erase("ada");
  Answer("b", true);
  Answer("b", true);
  EXPECT_EQ(handed, (Handed{{"bob", "b"}}));
  EXPECT_EQ(handovers.progress().stays, "");
}

TEST_F(HandoversTest, AStateThatDoesNotFitStays) {
  state_bytes = protocol::kMaxUdpMessageBytes + 1;
  Begin();
  EXPECT_TRUE(sent.empty());
  EXPECT_EQ(handovers.progress().why, "its state has 131073 bytes, more than the 131072 that fit");
}

TEST_F(HandoversTest, WithoutSubjectsItEndsAtOnce) {
  subjects.clear();
  Begin();
  EXPECT_FALSE(handovers.running());
  EXPECT_TRUE(opened.empty());
}

}  // namespace
}  // namespace furrow::server
