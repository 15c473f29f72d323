// SPDX-License-Identifier: Apache-2.0
// A hub that requires tokens, in simulated time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/secure/token/token_text.h"
#include "tests/unit/protocol/secure/secure_testing.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

namespace secure = protocol::secure;
using protocol::ErrorCode;
using secure::Roles;
using secure::test::kUnixNow;
using testing::ElementsAre;
using testing::HasSubstr;

const Roles kBoth = Roles(Role::kPublish) | Role::kWatch;

class HubAccessTest : public HubTest {
 protected:
  void SetUp() override {
    strict.SetKeys(ring);
    gate = &strict;
    Make({});
    Connect(&peer);
  }

  [[nodiscard]] std::string Token(Roles roles, const std::string& subjects,
                                  std::uint64_t seconds = 3600, std::uint32_t rate = 0) {
    secure::Grant grant;
    grant.roles = roles;
    grant.subjects = subjects;
    grant.packets_per_second = rate;
    return ToText(secure::test::MakeTestToken(ring, random, grant, kUnixNow + seconds));
  }
  void Show(FakePeer& from, const std::string& token) {
    Send(from, protocol::Hello{"test", 0, false, token});
    ASSERT_TRUE(from.Take<protocol::Welcome>().has_value());
  }
  void Pass(double seconds) {
    now += FromSeconds(seconds);
    unix_now += static_cast<std::uint64_t>(seconds);
    hub->Tick(now);
  }
  ErrorCode Refused(FakePeer& from, std::string* why = nullptr) {
    const auto got = from.Take<protocol::ErrorMessage>();
    if (!got) return ErrorCode::kInternal;
    if (why != nullptr) *why = got->message.message;
    return got->message.code;
  }

  secure::test::RepeatableRandom random{1};
  const secure::KeyRing ring = secure::test::MakeRing(random);
  std::uint64_t unix_now = kUnixNow;
  TokenGate strict{{.security = Security::kRequired, .name = "", .tokens_in_clear = false},
                   [this] { return unix_now; },
                   &metrics};
  FakePeer peer;
};

TEST_F(HubAccessTest, AStrangerGetsOneErrorAndIsCutOff) {
  Send(peer, Offer("ann"), 1);
  Send(peer, Offer("ann"), 1);
  Send(peer, protocol::Ping{1});
  EXPECT_EQ(Refused(peer), ErrorCode::kNeedsToken);
  EXPECT_TRUE(peer.inbox.empty());
  EXPECT_TRUE(peer.finished);
  EXPECT_TRUE(hub->IsIdle(peer.id, now)) << "the connection may close";
  EXPECT_EQ(hub->num_subjects(), 0u);
  // Too late: the connection is closing.
  Send(peer, protocol::Hello{"test", 0, false, Token(kBoth, "*")});
  EXPECT_TRUE(peer.inbox.empty());
}

TEST_F(HubAccessTest, AHelloWithoutATokenIsAStrangers) {
  std::string why;
  Send(peer, protocol::Hello{"test", 0});
  EXPECT_EQ(Refused(peer, &why), ErrorCode::kNeedsToken);
  EXPECT_EQ(why, kNeedsTokenText);
  FakePeer other;
  Connect(&other, Transport::kWeb);
  Send(other, protocol::Hello{"test", 0, false, "frw1_nonsense"});
  EXPECT_EQ(Refused(other, &why), ErrorCode::kNeedsToken);
  EXPECT_THAT(why, HasSubstr("malformed"));
  const auto bye = other.Take<protocol::Goodbye>();
  ASSERT_TRUE(bye.has_value()) << "by which a WebSocket closes";
  EXPECT_EQ(bye->header.stream, 0u);
}

TEST_F(HubAccessTest, BytesThatAreNoMessageAreAStrangers) {
  const std::vector<std::uint8_t> bytes(64, 7);
  for (int i = 0; i < 3; ++i) hub->OnMessage(peer.id, bytes, now);
  EXPECT_EQ(Refused(peer), ErrorCode::kNeedsToken);
  EXPECT_TRUE(peer.inbox.empty());
  EXPECT_TRUE(peer.finished);
  FakePeer other;
  Connect(&other);
  Send(other, protocol::Hello{std::string(protocol::kMaxProgramBytes + 1, 'x'), 0});
  EXPECT_EQ(Refused(other), ErrorCode::kMalformed);
  EXPECT_TRUE(other.finished);
}

TEST_F(HubAccessTest, AStrangerWhoShowsNothingMayNotStay) {
  FakePeer known;
  Connect(&known);
  Show(known, Token(kBoth, "*"));
  const Time began = now;
  EXPECT_FALSE(hub->IsIdle(peer.id, began + Hub::kStrangerPatience));
  EXPECT_TRUE(hub->IsIdle(peer.id, began + Hub::kStrangerPatience + FromSeconds(0.001)));
  EXPECT_FALSE(hub->IsIdle(known.id, began + Hub::kStrangerPatience + FromSeconds(0.001)));
}

TEST_F(HubAccessTest, AFrameThatIsTooLongIsAStrangers) {
  hub->OnBadFrame(peer.id);
  EXPECT_EQ(Refused(peer), ErrorCode::kNeedsToken);
  EXPECT_TRUE(peer.finished);
  FakePeer known;
  Connect(&known);
  Show(known, Token(kBoth, "*"));
  hub->OnBadFrame(known.id);
  EXPECT_EQ(Refused(known), ErrorCode::kMalformed);
}

TEST_F(HubAccessTest, ATokenEndsInTime) {
  Show(peer, Token(kBoth, "*", 60));
  Send(peer, Offer("ann"), 1);
  EXPECT_TRUE(peer.Take<protocol::SkeletonReply>().has_value());
  Pass(59);
  EXPECT_TRUE(peer.inbox.empty());
  Pass(1);
  std::string why;
  EXPECT_EQ(Refused(peer, &why), ErrorCode::kNeedsToken);
  EXPECT_EQ(why, "the token has expired");
  EXPECT_TRUE(peer.finished);
  EXPECT_EQ(metrics.Get(Counter::kTokensEnded), 1u);
  Pass(1);
  EXPECT_TRUE(peer.inbox.empty()) << "once";
}

TEST_F(HubAccessTest, ANewerTokenGoesOn) {
  Show(peer, Token(kBoth, "*", 60));
  Pass(50);
  Show(peer, Token(kBoth, "*", 120));
  Pass(50);
  EXPECT_TRUE(peer.inbox.empty());
  EXPECT_FALSE(peer.finished);
}

TEST_F(HubAccessTest, ARetiredKeyEndsItsPeers) {
  Show(peer, Token(kBoth, "*"));
  strict.SetKeys({});
  Pass(0.01);
  std::string why;
  EXPECT_EQ(Refused(peer, &why), ErrorCode::kNeedsToken);
  EXPECT_EQ(why, "the key of the token was retired");
}

TEST_F(HubAccessTest, ListsAndErrorsNameNoForeignSubjects) {
  FakePeer stage;
  Connect(&stage);
  Show(stage, Token(kBoth, "stage-*"));
  Show(peer, Token(kBoth, "ann"));
  for (const char* name : {"stage-1", "stage-2"}) {
    Send(stage, Offer(name), name[6]);
    EXPECT_TRUE(stage.Take<protocol::SkeletonReply>().has_value());
  }
  Send(peer, protocol::ListSubjects{.follow = true});
  EXPECT_THAT(peer.Take<protocol::Subjects>()->message.names, ElementsAre());
  Send(peer, protocol::SubscribeWeights{});
  std::string why;
  EXPECT_EQ(Refused(peer, &why), ErrorCode::kUnknownSubject);
  EXPECT_EQ(why.find("stage"), std::string::npos) << why;
  Send(peer, protocol::SubscribeWeights{.subject = "stage-1"});
  EXPECT_EQ(Refused(peer), ErrorCode::kNotPermitted);
  Send(stage, protocol::ListSubjects{});
  EXPECT_THAT(stage.Take<protocol::Subjects>()->message.names, ElementsAre("stage-1", "stage-2"));
}

TEST_F(HubAccessTest, ASubscriptionToAnySubjectWaitsForAnAllowedOne) {
  FakePeer stage;
  Connect(&stage);
  Show(stage, Token(kBoth, "*"));
  Show(peer, Token(Role::kWatch, "ann"));
  Send(peer, protocol::SubscribeWeights{.wait = true});
  EXPECT_EQ(peer.Take<protocol::SubscribeReply>()->message.subject, "");
  Send(stage, Offer("bob"), 1);
  EXPECT_TRUE(peer.inbox.empty());
  Send(stage, Offer("ann"), 2);
  EXPECT_EQ(peer.Take<protocol::SubscribeReply>()->message.subject, "ann");
}

TEST_F(HubAccessTest, ATokenMayLowerTheRate) {
  Show(peer, Token(kBoth, "*", 3600, 10));
  for (int i = 0; i < 20; ++i) Send(peer, protocol::Ping{i});
  EXPECT_EQ(metrics.Get(Counter::kMessagesThrottled), 18u) << "the burst shrinks with the rate";
}

TEST_F(HubAccessTest, PartsOfTheDaemonNeedNoToken) {
  FakePeer phone;
  Connect(&phone, Transport::kMocap);
  Send(phone, Offer("phone"), 1);
  EXPECT_EQ(hub->num_subjects(), 1u);
}

TEST_F(HubAccessTest, AnOpenDaemonStillChecksATokenThatIsShown) {
  TokenGate open(
      {}, [this] { return unix_now; }, &metrics);
  open.SetKeys(ring);
  gate = &open;
  Make({});
  FakePeer any;
  Connect(&any);
  Send(any, Offer("ann"), 1);
  EXPECT_EQ(any.Take<protocol::SkeletonReply>()->message.status,
            protocol::SkeletonStatus::kAccepted);
  Show(any, Token(Role::kWatch, "ann"));
  Send(any, Offer("bob"), 2);
  EXPECT_EQ(any.Take<protocol::SkeletonReply>()->message.status,
            protocol::SkeletonStatus::kRejected);
  FakePeer bad;
  Connect(&bad);
  Send(bad, protocol::Hello{"test", 0, false, "frw1_nonsense"});
  EXPECT_EQ(Refused(bad), ErrorCode::kNeedsToken);
}

}  // namespace
}  // namespace furrow::server
