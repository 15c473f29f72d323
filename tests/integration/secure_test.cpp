// SPDX-License-Identifier: Apache-2.0
// A daemon that requires tokens, over real sockets: who gets in, what a token allows, and what
// forged, repeated and late datagrams do.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>

#include "daemon_fixture.h"
#include "process.h"
#include "protocol/framing/tcp_framing.h"
#include "protocol/secure/token/token_text.h"
#include "sealed_client.h"
#include "server/session/access/token_gate.h"
#include "tests/log_capture.h"
#include "web_client.h"

namespace furrow::testing_net {
namespace {

namespace secure = protocol::secure;
using protocol::ErrorCode;
using secure::Refusal;
using secure::Role;
using server::Counter;
using testing::HasSubstr;

const secure::Roles kBoth = secure::Roles(Role::kPublish) | Role::kWatch;

// The daemon notices within a second that a key is no longer in its file, and the client begins
// again with the token that is void.
void AwaitUnknownKey(SealedClient& client) {
  while (client.refusal() == Refusal::kNone || client.refusal() == Refusal::kUnknownSession) {
    (void)client.TryNext();
  }
  EXPECT_EQ(client.refusal(), Refusal::kUnknownKey);
}

class Secure : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(daemon.serves()); }

  SealedClient Client(secure::Roles roles, const std::string& subjects = "*") {
    return {daemon.ready().udp, keys.Token(roles, subjects)};
  }
  void SendPose(RawClient& sender, std::uint32_t number) {
    sender.Send(PoseOf(clip, static_cast<int>(number), offer), 1, number, 16'667 * number);
  }
  // `sender` publishes ann, and `viewer` watches.
  void Begin(RawClient& sender, RawClient& viewer) {
    Offer(sender, offer);
    ASSERT_TRUE(viewer.Introduce());
    ASSERT_TRUE(Watch(viewer, {.subject = "ann"}).has_value());
  }
  // The stream is alive: the next pose of the sender reaches the viewer.
  void ExpectWeights(RawClient& sender, RawClient& viewer) {
    SendPose(sender, frame);
    protocol::Header header;
    ASSERT_TRUE(viewer.Await<protocol::WeightFrame>(&header).has_value());
    ASSERT_EQ(header.sequence, frame);
    ++frame;
  }

  const TestKeys keys;
  DaemonThread daemon{SecureConfig(keys)};
  const motion::Clip clip = ArkitClip(200);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  std::uint32_t frame = 0;
};

TEST_F(Secure, PublishesAndWatchesWithTokens) {
  SealedClient sender = Client(Role::kPublish, "ann");
  SealedClient viewer = Client(Role::kWatch, "a*");
  Begin(sender, viewer);
  for (int i = 0; i < 20; ++i) ExpectWeights(sender, viewer);
  EXPECT_EQ(daemon.Count(Counter::kHandshakes), 2u);
  EXPECT_EQ(daemon.Count(Counter::kSealedForged), 0u);
}

TEST_F(Secure, RefusesPlainDatagramsWithOneError) {
  UdpClient plain(daemon.ready().udp);
  plain.Send(protocol::Hello{"test", 0}, 0, 7);
  protocol::Header header;
  const auto error = plain.Await<protocol::ErrorMessage>(&header);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code, ErrorCode::kNeedsToken);
  EXPECT_THAT(error->message, HasSubstr("requires a token"));
  EXPECT_EQ(header.sequence, 7u);
  EXPECT_EQ(plain.datagrams(), 1u);
  // Never more bytes than were sent.
  std::vector<std::uint8_t> bytes;
  protocol::Encoder encoder;
  encoder.Encode({.session = 1}, protocol::Ping{1}, bytes);
  plain.SendRaw(bytes);
  const auto reply = plain.Next();
  ASSERT_TRUE(reply.has_value());
  EXPECT_LE(reply->bytes.size(), bytes.size());
  EXPECT_EQ(daemon.Count(Counter::kRefusedNoToken), 2u);
}

TEST_F(Secure, EachInvalidTokenGetsItsReason) {
  const auto refusal = [&](const secure::ClientToken& token) {
    SealedClient client(daemon.ready().udp, token);
    client.StopClock();  // a repeated handshake would count as refused, too
    EXPECT_FALSE(client.Introduce());
    return client.refusal();
  };
  const TestKeys others;
  EXPECT_EQ(refusal(others.Token(Role::kWatch)), Refusal::kUnknownKey);
  EXPECT_EQ(refusal(keys.Token(Role::kWatch, "*", -10)), Refusal::kExpired);
  EXPECT_EQ(refusal(keys.Token(Role::kWatch, "*", 3600, "another")), Refusal::kWrongAudience);
  secure::ClientToken forged = keys.Token(Role::kWatch);
  forged.bytes[100] ^= 1;
  EXPECT_EQ(refusal(forged), Refusal::kForgedToken);
  // Somebody who has seen the token on the network, and does not have its key.
  secure::ClientToken stolen = keys.Token(Role::kWatch);
  stolen.key = keys.Token(Role::kWatch).key;
  EXPECT_EQ(refusal(stolen), Refusal::kForgedHandshake);
  EXPECT_EQ(daemon.Count(Counter::kRefusedUnknownKey), 1u);
  EXPECT_EQ(daemon.Count(Counter::kRefusedExpired), 1u);
  EXPECT_EQ(daemon.Count(Counter::kHandshakes), 0u);
  SealedClient right(daemon.ready().udp, keys.Token(Role::kWatch, "*", 3600, "stage"));
  EXPECT_TRUE(right.Introduce());
}

TEST_F(Secure, ATokenIsForItsSubjectsAndRoles) {
  SealedClient bob = Client(kBoth, "bob");
  ASSERT_TRUE(bob.Introduce());
  bob.Send(offer, 1);
  const auto reply = bob.Await<protocol::SkeletonReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->status, protocol::SkeletonStatus::kRejected);
  EXPECT_THAT(reply->message, HasSubstr("not permitted to publish 'ann'"));
  // An absent subject and one that is not for the token look the same.
  for (const char* subject : {"ann", "nobody"}) {
    bob.Send(protocol::SubscribeWeights{.subject = subject});
    const auto error = bob.Await<protocol::ErrorMessage>();
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code, ErrorCode::kNotPermitted);
  }
  SealedClient ann = Client(Role::kPublish, "ann");
  Offer(ann, offer);
  // Without a name: the oldest subject that the token allows, and no list of the others.
  bob.Send(protocol::SubscribeWeights{}, 0, 9);
  const auto none = bob.Await<protocol::ErrorMessage>();
  ASSERT_TRUE(none.has_value());
  EXPECT_EQ(none->code, ErrorCode::kUnknownSubject);
  EXPECT_EQ(none->message.find("ann"), std::string::npos) << none->message;
  ann.Send(protocol::SubscribeWeights{.subject = "ann"});
  EXPECT_EQ(ann.Await<protocol::ErrorMessage>()->code, ErrorCode::kNotPermitted);
  EXPECT_EQ(daemon.Count(Counter::kRefusedPublish), 1u);
  EXPECT_EQ(daemon.Count(Counter::kRefusedWatch), 3u);
}

TEST_F(Secure, ForgedRepeatedAndLateDatagramsHaveNoEffect) {
  SealedClient sender = Client(Role::kPublish);
  SealedClient viewer = Client(Role::kWatch);
  Begin(sender, viewer);
  for (int i = 0; i < 3; ++i) ExpectWeights(sender, viewer);
  // Everything again, from the address of the sender and from another one.
  UdpClient other(daemon.ready().udp, "127.0.0.2");
  const auto recorded = sender.sent();
  for (const auto& packet : recorded) {
    sender.SendRaw(packet);
    other.SendRaw(packet);
  }
  // A goodbye of the sender, changed in each byte in turn.
  const auto goodbye = sender.Seal(protocol::Goodbye{}, 1);
  for (std::size_t i = 0; i < goodbye.size(); ++i) {
    auto forged = goodbye;
    forged[i] ^= 0x40;
    other.SendRaw(forged);
  }
  // Plain ones, with the number of the sender's session.
  other.session = sender.session;
  other.Send(protocol::Goodbye{}, 1);
  ExpectWeights(sender, viewer);
  // Another thread may serve the address of the forger.
  daemon.AwaitCount(Counter::kSealedReplayed, 2 * recorded.size());
  daemon.AwaitCount(Counter::kSealedForged, goodbye.size() / 2 + 1);
  EXPECT_EQ(daemon.Count(Counter::kSealedReplayed), 2 * recorded.size());
  EXPECT_EQ(daemon.Count(Counter::kPosesDuplicate), 0u);
  EXPECT_GT(daemon.Count(Counter::kSealedForged), goodbye.size() / 2);
  // Reordered: the later one counts, and nothing is lost.
  const auto first = sender.Seal(PoseOf(clip, 4, offer), 1, frame);
  const auto second = sender.Seal(PoseOf(clip, 5, offer), 1, frame + 1);
  sender.SendRaw(second);
  sender.SendRaw(first);
  protocol::Header header;
  ASSERT_TRUE(viewer.Await<protocol::WeightFrame>(&header).has_value());
  EXPECT_EQ(header.sequence, frame + 1);
  frame += 2;
  ExpectWeights(sender, viewer);
  EXPECT_EQ(daemon.Count(Counter::kPosesLate), 1u);
}

TEST_F(Secure, ASessionSurvivesANewAddress) {
  SealedClient sender = Client(Role::kPublish);
  SealedClient viewer = Client(Role::kWatch);
  Begin(sender, viewer);
  ExpectWeights(sender, viewer);
  sender.MoveTo("127.0.0.2");
  ExpectWeights(sender, viewer);
  viewer.MoveTo("127.0.0.3");
  // The new address counts once it has answered the path challenge.
  bool arrived = false;
  for (int i = 0; i < 1000 && !arrived; ++i) {
    SendPose(sender, frame++ % 200);
    const auto received = viewer.TryNext();
    arrived = received && received->view.kind == protocol::MessageKind::kWeights;
  }
  EXPECT_TRUE(arrived);
  EXPECT_EQ(daemon.Count(Counter::kHandshakes), 2u);
  EXPECT_EQ(daemon.Count(Counter::kSubjectsRestarted), 0u);
}

TEST_F(Secure, ASessionMayEndWithItsFirstPacket) {
  SealedClient client = Client(kBoth);
  client.ConnectAndClose();
  SealedClient next = Client(kBoth);
  Offer(next, offer);
  // Another thread may read the first session.
  daemon.AwaitCount(Counter::kHandshakes, 2);
  EXPECT_EQ(daemon.Count(Counter::kHandshakes), 2u);
}

TEST_F(Secure, ANewerTokenChangesTheRights) {
  SealedClient client = Client(Role::kPublish, "ann");
  Offer(client, offer);
  ASSERT_TRUE(client.Renew(keys.Token(kBoth, "ann")));
  ASSERT_TRUE(Watch(client, {.subject = "ann"}).has_value());
  ExpectWeights(client, client);
  ASSERT_TRUE(client.Renew(keys.Token(Role::kPublish, "bob")));
  EXPECT_EQ(client.Await<protocol::ErrorMessage>()->code, ErrorCode::kNotPermitted);
}

TEST_F(Secure, SessionsEndWithTheirKey) {
  SealedClient client = Client(Role::kWatch);
  ASSERT_TRUE(client.Introduce());
  const_cast<TestKeys&>(keys).Replace();
  AwaitUnknownKey(client);
  SealedClient newer = Client(Role::kWatch);
  EXPECT_TRUE(newer.Introduce());
}

// A copied key file often has rights for others, which a change of its rights alone removes.
TEST(SecureKeys, AFileIsReadWhenItsRightsBecomeRight) {
  namespace fs = std::filesystem;
  const LogCapture log;
  const TestKeys keys;
  DaemonThread daemon(SecureConfig(keys));
  ASSERT_TRUE(daemon.serves());
  const std::uint16_t udp = daemon.ready().udp;
  SealedClient client(udp, keys.Token(Role::kWatch));
  ASSERT_TRUE(client.Introduce());
  const TestKeys others;
  fs::permissions(others.file(), fs::perms::group_read, fs::perm_options::add);
  fs::rename(others.file(), keys.file());
  ASSERT_TRUE(log.Await("the keys stay as they were"));
  SealedClient before(udp, keys.Token(Role::kWatch));
  EXPECT_TRUE(before.Introduce());
  fs::permissions(keys.file(), fs::perms::group_read, fs::perm_options::remove);
  AwaitUnknownKey(client);
  SealedClient newer(udp, others.Token(Role::kWatch));
  EXPECT_TRUE(newer.Introduce());
}

TEST_F(Secure, SessionsEndWithTheirToken) {
  SealedClient client(daemon.ready().udp, keys.Token(Role::kWatch, "*", 2));
  TcpClient tcp(daemon.ready().tcp);
  ASSERT_TRUE(client.Introduce());
  tcp.Send(protocol::Hello{"test", 0, false, ToText(keys.Token(Role::kWatch, "*", 2))});
  ASSERT_TRUE(tcp.Await<protocol::Welcome>().has_value());
  const auto error = tcp.Await<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code, ErrorCode::kNeedsToken);
  EXPECT_EQ(error->message, "the token has expired");
  EXPECT_TRUE(tcp.AwaitClose());
  while (client.refusal() == Refusal::kNone) (void)client.TryNext();
  EXPECT_EQ(client.refusal(), Refusal::kExpired);
}

TEST_F(Secure, TcpNeedsATokenInItsFirstMessage) {
  const auto first = [&](const auto& message) {
    TcpClient client(daemon.ready().tcp);
    client.Send(message, 0, 3);
    const auto error = client.Await<protocol::ErrorMessage>();
    EXPECT_TRUE(client.AwaitClose());
    return error.value_or(protocol::ErrorMessage{});
  };
  EXPECT_EQ(first(protocol::Hello{"test", 0}).code, ErrorCode::kNeedsToken);
  EXPECT_EQ(first(offer).code, ErrorCode::kNeedsToken);
  EXPECT_EQ(first(protocol::SubscribeWeights{}).code, ErrorCode::kNeedsToken);
  EXPECT_EQ(first(protocol::ListSubjects{}).code, ErrorCode::kNeedsToken);
  EXPECT_THAT(first(protocol::Hello{"test", 0, false, "frw1_nonsense"}).message,
              HasSubstr("malformed"));
  // An eavesdropper knows the 252 bytes of a token that travel, and not its key.
  secure::ClientToken stolen = keys.Token(Role::kWatch);
  stolen.key = keys.Token(Role::kWatch).key;
  EXPECT_EQ(first(protocol::Hello{"test", 0, false, ToText(stolen)}).code, ErrorCode::kNeedsToken);
  TcpClient client(daemon.ready().tcp);
  client.Send(protocol::Hello{"test", 0, false, ToText(keys.Token(Role::kPublish, "ann"))});
  ASSERT_TRUE(client.Await<protocol::Welcome>().has_value());
  Offer(client, offer);
}

TEST_F(Secure, TcpTakesLittleFromAStranger) {
  TcpClient stranger(daemon.ready().tcp);
  const auto prefix =
      protocol::FramePrefix(100'000);  // only the length, and no byte of the message
  stranger.SendRaw(prefix);
  EXPECT_EQ(stranger.Await<protocol::ErrorMessage>()->code, ErrorCode::kNeedsToken);
  EXPECT_TRUE(stranger.AwaitClose());
  TcpClient client(daemon.ready().tcp);
  client.Send(protocol::Hello{"test", 0, false, ToText(keys.Token(Role::kWatch))});
  ASSERT_TRUE(client.Await<protocol::Welcome>().has_value());
  client.SendRaw(prefix);
  client.SendRaw(std::vector<std::uint8_t>(100'000, 7));
  const auto error = client.Await<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_THAT(error->message, HasSubstr("not a message")) << "it was read";
}

TEST_F(Secure, EveryWebDoorIsClosedWithoutAToken) {
  const auto status = [&](const char* path, const std::string& token = {},
                          const char* method = "GET") {
    WebClient client(*daemon.ready().http);
    const std::string headers =
        "Host: localhost\r\n" + (token.empty() ? "" : "Authorization: Bearer " + token + "\r\n");
    return client.Ask(method, path, method == std::string("GET") ? "" : "{}", headers).status;
  };
  for (const char* path : {"/api/status", "/api/subjects", "/api/settings", "/api/rig", "/metrics",
                           "/mjpeg", "/snapshot.png", "/weights", "/ws", "/character.glb"}) {
    EXPECT_EQ(status(path), 401) << path;
    EXPECT_EQ(status(path, "frw1_nonsense"), 401) << path;
  }
  EXPECT_EQ(status("/api/settings", "", "PATCH"), 401);
  const auto challenge = [&](const std::string& headers) {
    const auto answer = WebClient(*daemon.ready().http)
                            .Ask("GET", "/api/status", "", "Host: localhost\r\n" + headers);
    const std::size_t at = answer.head.find("WWW-Authenticate: ");
    return at == std::string::npos ? "none"
                                   : answer.head.substr(at, answer.head.find('\r', at) - at);
  };
  EXPECT_EQ(challenge(""), R"(WWW-Authenticate: Bearer realm="furrowd")");
  EXPECT_EQ(challenge("Authorization: Bearer frw1_nonsense\r\n"),
            R"(WWW-Authenticate: Bearer realm="furrowd", error="invalid_token")");
  // The reply to a stranger does not wait for the body, and it arrives with the body on the way.
  const std::string large =
      "PATCH /api/settings HTTP/1.1\r\nHost: localhost\r\n"
      "Content-Length: 60000\r\n\r\n";
  EXPECT_EQ(WebClient(*daemon.ready().http).AskRaw(large + "{").status, 401);
  EXPECT_EQ(WebClient(*daemon.ready().http).AskRaw(large + std::string(60'000, ' ')).status, 401);
  EXPECT_EQ(WebClient(*daemon.ready().http).Upgrade().status, 401);
  EXPECT_EQ(status("/healthz"), 200);
  const std::string watch = ToText(keys.Token(Role::kWatch, "ann"));
  const std::string direct = ToText(keys.Token(Role::kDirect));
  const std::string operates = ToText(keys.Token(Role::kOperate));
  EXPECT_EQ(status("/api/status", watch), 200);
  EXPECT_EQ(status(("/api/status?token=" + watch).c_str()), 200);
  // Errors are copied into logs and messages.
  const auto absent = WebClient(*daemon.ready().http)
                          .Ask("GET", "/nothing?token=" + watch, "", "Host: localhost\r\n");
  EXPECT_EQ(absent.status, 404);
  EXPECT_EQ(absent.body.find(watch), std::string::npos);
  EXPECT_EQ(status("/metrics", watch), 403);
  EXPECT_EQ(status("/metrics", operates), 200);
  EXPECT_EQ(status("/api/settings", watch, "PATCH"), 403);
  EXPECT_EQ(status("/api/settings", direct, "PATCH"), 200);
  EXPECT_EQ(status("/api/capture", watch, "POST"), 403);
  EXPECT_EQ(status("/api/osc", direct, "POST"), 403);
  EXPECT_EQ(status("/api/explain?weight=x", direct), 403);
  EXPECT_GT(daemon.Count(Counter::kRefusedOperate), 1u);
  EXPECT_GT(daemon.Count(Counter::kRefusedDirect), 1u);
}

TEST_F(Secure, OperatorsMakeTokensForOthers) {
  const auto ask = [&](secure::Roles roles, const std::string& body) {
    return WebClient(*daemon.ready().http)
        .Ask("POST", "/api/token", body,
             "Host: localhost\r\nAuthorization: Bearer " + ToText(keys.Token(roles, "ann,bob")) +
                 "\r\n");
  };
  const secure::Roles operates = kBoth | Role::kOperate;
  const auto made = ask(operates, R"({"roles": "publish", "subjects": "ann", "for": "10m"})");
  ASSERT_EQ(made.status, 200) << made.body;
  const auto reply = nlohmann::json::parse(made.body);
  EXPECT_EQ(reply["roles"], "publish");
  // The new token is as good as any other one.
  const auto token = secure::ParseToken(reply["token"].get<std::string>());
  ASSERT_TRUE(token.ok());
  SealedClient sender(daemon.ready().udp, *token);
  Offer(sender, offer);
  EXPECT_EQ(ask(kBoth, R"({"roles": "watch", "for": "10m"})").status, 403);
  EXPECT_EQ(ask(operates, R"({"roles": "direct", "for": "10m"})").status, 403);
  EXPECT_EQ(ask(operates, R"({"roles": "watch", "for": "10m", "subjects": "*"})").status, 403);
  EXPECT_EQ(ask(operates, R"({"roles": "watch", "for": "10d"})").status, 403);
  for (const char* body : {"{}", R"({"roles": "watch"})", R"({"roles": "all", "for": "1h"})",
                           R"({"roles": "watch", "for": "soon"})", R"({"role": "watch"})", "[]"}) {
    EXPECT_EQ(ask(operates, body).status, 400) << body;
  }
  EXPECT_EQ(daemon.Count(Counter::kTokensMade), 1u);
}

TEST_F(Secure, AWebSocketTakesATokenAsAProtocol) {
  WebClient client(*daemon.ready().http);
  const std::string token = ToText(keys.Token(Role::kWatch, "ann"));
  ASSERT_EQ(client.Upgrade("Host: localhost\r\nSec-WebSocket-Protocol: furrow.1, " + token + "\r\n")
                .status,
            101);
  client.Send(protocol::SubscribeWeights{.subject = "ann", .wait = true}, 0, 1);
  EXPECT_TRUE(client.Await<protocol::SubscribeReply>().has_value());
  client.Send(protocol::SubscribeWeights{.subject = "bob", .wait = true}, 0, 2);
  EXPECT_EQ(client.Await<protocol::ErrorMessage>()->code, ErrorCode::kNotPermitted);
}

TEST_F(Secure, OtherComputersMayNotShowTokensInClear) {
  // No other computer is at hand, so the gate itself is asked.
  server::Metrics metrics;
  server::TokenGate gate(
      {.security = server::Security::kRequired}, [] { return 0u; }, &metrics);
  const std::string token = ToText(keys.Token(Role::kWatch));
  EXPECT_THAT(gate.Admit(token, /*shielded=*/false, server::Time(0)).status().what(),
              HasSubstr("not encrypted"));
  EXPECT_THAT(gate.Admit(token, /*shielded=*/true, server::Time(0)).status().what(),
              HasSubstr("does not have the key"));
  EXPECT_EQ(metrics.Get(Counter::kRefusedInClear), 1u);
}

TEST_F(Secure, AFloodOfHandshakesWithAWrongKeyDoesNotStarveWeights) {
  SealedClient sender = Client(Role::kPublish);
  SealedClient viewer = Client(Role::kWatch);
  Begin(sender, viewer);
  // From proven addresses of one host: each of them costs the daemon an attempt.
  secure::ClientToken stolen = keys.Token(Role::kWatch);
  stolen.key = keys.Token(Role::kWatch).key;
  for (int i = 0; i < 120; ++i) {
    SealedClient attacker(daemon.ready().udp, stolen, "127.0.0.9");
    EXPECT_FALSE(attacker.Introduce());
  }
  EXPECT_EQ(daemon.Count(Counter::kRefusedBusy) + daemon.Count(Counter::kRefusedForgedHandshake),
            120u);
  ExpectWeights(sender, viewer);
  // Another host still gets in.
  SealedClient newcomer(daemon.ready().udp, keys.Token(Role::kWatch), "127.0.0.10");
  EXPECT_TRUE(newcomer.Introduce());
}

TEST(OpenDaemon, TakesTokensAndPlainClients) {
  const TestKeys keys;
  server::Config config = SecureConfig(keys);
  config.security.mode = server::Security::kOpen;
  DaemonThread daemon(config);
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(10);
  UdpClient plain(daemon.ready().udp);
  Offer(plain, OfferOf(clip, "ann"));
  SealedClient viewer(daemon.ready().udp, keys.Token(Role::kWatch, "ann"));
  ASSERT_TRUE(viewer.Introduce());
  EXPECT_TRUE(Watch(viewer, {.subject = "ann"}).has_value());
  EXPECT_FALSE(Watch(viewer, {.subject = "bob", .wait = true}, 2).has_value()) << "its token says";
}

}  // namespace
}  // namespace furrow::testing_net
