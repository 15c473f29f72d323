// SPDX-License-Identifier: Apache-2.0
// TLS at the TCP port and the web port, over real sockets: each door opens with it, and none
// without it.
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <openssl/ssl.h>
#include <sys/socket.h>

#include "client/cpp/tls/client_tls.h"
#include "client/cpp/transports.h"
#include "daemon_fixture.h"
#include "pictures_fixture.h"
#include "protocol/secure/token/token_text.h"
#include "sealed_client.h"
#include "tests/certificates.h"
#include "tests/log_capture.h"
#include "tests/temporary_folder.h"
#include "tls_tunnel.h"
#include "web_client.h"

namespace furrow::testing_net {
namespace {

using client::ClientTlsFiles;
using client::TransportKind;
using protocol::ErrorCode;
using server::Counter;
using testing::HasSubstr;

using Context = std::shared_ptr<SSL_CTX>;
const std::string kHttp = "\x08http/1.1";

Context ContextOf(const ClientTlsFiles& files) {
  auto context = client::MakeTlsContext(files);
  EXPECT_TRUE(context.ok()) << context.status().ToString();
  return context.ok() ? *context : nullptr;
}

class Tls : public testing::Test {
 protected:
  // `wanted`: the certificate of the daemon, which signs itself.
  void Start(const TestCertificate::Wanted& wanted = {}, server::Config config = Weights()) {
    const TestCertificate certificate(wanted);
    config.security.tls = {.certificate = certificate.Write(folder.path(), "daemon"),
                           .key = folder / "daemon.key",
                           .client_authority = config.security.tls.client_authority};
    daemon.emplace(config);
    ASSERT_TRUE(daemon->serves());
    trusted = ContextOf({.authority = folder / "daemon.crt"});
  }
  static server::Config Weights() { return WeightsConfig("arkit.json"); }
  // The status of a client of the library that connects to `host`.
  [[nodiscard]] Status Connect(const ClientTlsFiles& files,
                               const std::string& host = "127.0.0.1") const {
    return client::OpenTransport(TransportKind::kTcp, host, daemon->ready().tcp, kGuard,
                                 {.tls = ContextOf(files)})
        .status();
  }

  TemporaryFolder folder;
  std::optional<DaemonThread> daemon;
  Context trusted;  // of clients that trust the daemon's certificate
};

TEST_F(Tls, CarriesPosesAndWeights) {
  Start();
  TlsTunnel one(daemon->ready().tcp, trusted.get());
  TlsTunnel two(daemon->ready().tcp, trusted.get());
  ASSERT_TRUE(one.connected() && two.connected());
  TcpClient sender(Connected{one.TakeSocket()});
  TcpClient viewer(Connected{two.TakeSocket()});
  const motion::Clip clip = ArkitClip(100);
  const auto offer = OfferOf(clip, "ann");
  Offer(sender, offer);
  ASSERT_TRUE(Watch(viewer, {.subject = "ann"}).has_value());
  for (int frame = 0; frame < 100; ++frame) {
    sender.Send(PoseOf(clip, frame, offer), 1, static_cast<std::uint32_t>(frame));
    protocol::Header header;
    ASSERT_TRUE(viewer.Await<protocol::WeightFrame>(&header).has_value());
    ASSERT_EQ(header.sequence, static_cast<std::uint32_t>(frame));
  }
  daemon->AwaitCount(Counter::kTlsHandshakes, 2);
}

TEST_F(Tls, ServesEveryWebDoor) {
  Start();
  const auto ask = [&](const char* path) {
    TlsTunnel tunnel(*daemon->ready().http, trusted.get(), kHttp);
    return WebClient(Connected{tunnel.TakeSocket()}).Ask("GET", path);
  };
  EXPECT_EQ(ask("/healthz").status, 200);
  EXPECT_THAT(ask("/metrics").body, HasSubstr("furrow_tls_handshakes_total"));
  EXPECT_EQ(ask("/api/status").status, 200);
  EXPECT_EQ(ask("/mjpeg").status, 503) << "this daemon draws nothing, but it answers";
  EXPECT_EQ(ask("/snapshot.png").status, 503);
  TlsTunnel tunnel(*daemon->ready().http, trusted.get(), kHttp);
  WebClient socket(Connected{tunnel.TakeSocket()});
  ASSERT_EQ(socket.Upgrade().status, 101);
  socket.Send(protocol::SubscribeWeights{.wait = true}, 0, 1);
  EXPECT_TRUE(socket.Await<protocol::SubscribeReply>().has_value());
  TlsTunnel lines_tunnel(*daemon->ready().http, trusted.get(), kHttp);
  WebClient lines(Connected{lines_tunnel.TakeSocket()});
  EXPECT_EQ(lines.AskRaw("GET /weights HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 200);
}

TEST_F(Tls, PlainClientsGetOneAnswer) {
  Start();
  TcpClient plain(daemon->ready().tcp);
  plain.Send(protocol::SubscribeWeights{.wait = true});
  const auto error = plain.Await<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code, ErrorCode::kUnsupported);
  EXPECT_THAT(error->message, HasSubstr("speaks TLS only"));
  EXPECT_TRUE(plain.AwaitClose());
  const auto answer = WebClient(*daemon->ready().http).Ask("GET", "/healthz");
  EXPECT_EQ(answer.status, 400);
  EXPECT_THAT(answer.body, HasSubstr("https://"));
  daemon->AwaitCount(Counter::kTlsPlain, 2);
  EXPECT_EQ(daemon->Count(Counter::kTlsHandshakes), 0u);
}

TEST_F(Tls, ClientsTrustTheRightCertificateOnly) {
  Start();
  EXPECT_TRUE(Connect({.authority = folder / "daemon.crt"}).ok());
  EXPECT_TRUE(Connect({.authority = folder / "daemon.crt"}, "localhost").ok());
  // The system does not know it, and neither does somebody else's authority.
  const auto other = TestCertificate().Write(folder.path(), "other");
  for (const ClientTlsFiles& files : {ClientTlsFiles{}, ClientTlsFiles{.authority = other}}) {
    const Status status = Connect(files);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_THAT(status.what(), HasSubstr("no known authority has signed its certificate"));
  }
  daemon->AwaitCount(Counter::kTlsRefusedByClient, 2);
}

TEST_F(Tls, ClientsRefuseACertificateOfAnotherHost) {
  Start({.names = "DNS:stage.example,IP:192.0.2.1"});
  for (const char* host : {"127.0.0.1", "localhost"}) {
    EXPECT_THAT(Connect({.authority = folder / "daemon.crt"}, host).what(),
                HasSubstr("its certificate is for another host"));
  }
}

TEST_F(Tls, ClientsRefuseAnExpiredCertificate) {
  const LogCapture log;
  Start({.from = -2 * TestCertificate::kDay, .until = -60});
  EXPECT_THAT(Connect({.authority = folder / "daemon.crt"}).what(), HasSubstr("has expired"));
  EXPECT_THAT(log.text(), HasSubstr("the certificate has expired"));
}

TEST_F(Tls, AnAuthorityMaySignTheCertificate) {
  const TestCertificate authority({.names = "", .is_authority = true});
  const auto file = authority.Write(folder.path(), "authority");
  TestCertificate({}, &authority).Write(folder.path(), "signed");
  server::Config config = Weights();
  config.security.tls = {.certificate = folder / "signed.crt", .key = folder / "signed.key"};
  daemon.emplace(config);
  ASSERT_TRUE(daemon->serves());
  EXPECT_TRUE(Connect({.authority = file}).ok());
}

TEST_F(Tls, AClientSaysThatADaemonSpeaksNoTls) {
  daemon.emplace(Weights());
  ASSERT_TRUE(daemon->serves());
  // The name of the host is part of the handshake. Without one, its head looks like the length of a
  // permitted message.
  for (const char* host : {"127.0.0.1", "localhost"}) {
    const Status status = client::OpenTransport(TransportKind::kTcp, host, daemon->ready().tcp,
                                                kGuard, {.tls = ContextOf({})})
                              .status();
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument) << host;
    EXPECT_THAT(status.what(), HasSubstr("it does not speak TLS")) << host;
  }
}

TEST_F(Tls, EachPortSpeaksItsOwnProtocol) {
  Start();
  // Somebody who redirects a browser to the TCP port, or a client to the web port.
  EXPECT_FALSE(TlsTunnel(daemon->ready().tcp, trusted.get(), kHttp).connected());
  EXPECT_FALSE(TlsTunnel(*daemon->ready().http, trusted.get()).connected());
  EXPECT_TRUE(TlsTunnel(daemon->ready().tcp, trusted.get(), "").connected()) << "names none";
  daemon->AwaitCount(Counter::kTlsWrongProtocol, 2);
}

TEST_F(Tls, Tls12IsTooOld) {
  Start();
  SSL_CTX_set_min_proto_version(trusted.get(), TLS1_2_VERSION);
  SSL_CTX_set_max_proto_version(trusted.get(), TLS1_2_VERSION);
  EXPECT_FALSE(TlsTunnel(daemon->ready().tcp, trusted.get()).connected());
  EXPECT_FALSE(TlsTunnel(*daemon->ready().http, trusted.get(), kHttp).connected());
  daemon->AwaitCount(Counter::kTlsOldVersion, 2);
}

TEST_F(Tls, AChangedCertificateIsUsedWithoutDroppingAnybody) {
  const LogCapture log;
  Start();
  TlsTunnel tunnel(daemon->ready().tcp, trusted.get());
  TlsTunnel web_tunnel(*daemon->ready().http, trusted.get(), kHttp);
  TcpClient viewer(Connected{tunnel.TakeSocket()});
  WebClient web(Connected{web_tunnel.TakeSocket()});
  ASSERT_EQ(web.Ask("GET", "/healthz").status, 200);
  // A certificate with the key of another one is a broken pair.
  std::ofstream(folder / "daemon.crt") << TestCertificate().CertificateText();
  ASSERT_TRUE(log.Await("the certificate stays as it was"));
  EXPECT_EQ(TlsTunnel(daemon->ready().tcp, trusted.get()).serial(), tunnel.serial());
  const TestCertificate next;
  next.Write(folder.path(), "daemon");
  ASSERT_TRUE(log.Await("read the certificate"));
  const Context trusts_next = ContextOf({.authority = folder / "daemon.crt"});
  const TlsTunnel later(daemon->ready().tcp, trusts_next.get());
  EXPECT_TRUE(later.connected());
  EXPECT_GT(later.serial(), tunnel.serial());
  EXPECT_TRUE(TlsTunnel(*daemon->ready().http, trusts_next.get(), kHttp).connected());
  // Those who were connected go on.
  EXPECT_TRUE(Watch(viewer, {.wait = true}).has_value());
  EXPECT_EQ(web.Ask("GET", "/healthz").status, 200);
}

TEST_F(Tls, ASilentHandshakeEnds) {
  Start();
  TcpClient silent(daemon->ready().tcp);
  TcpClient slow(daemon->ready().tcp);
  WebClient web(*daemon->ready().http);
  const std::array<std::uint8_t, 5> begin{22, 3, 1, 2, 0};  // the head of a ClientHello
  slow.SendRaw(begin);
  EXPECT_TRUE(silent.AwaitClose());
  EXPECT_TRUE(slow.AwaitClose());
  EXPECT_EQ(web.AskRaw("\x16\x03\x01").status, 0);
  daemon->AwaitCount(Counter::kTlsSlow, 3);
  // Their places are free again.
  EXPECT_TRUE(TlsTunnel(daemon->ready().tcp, trusted.get()).connected());
}

TEST_F(Tls, HandshakesHoldTheirHostsShare) {
  server::Config config = Weights();
  config.limits.max_connections = 4;
  Start({}, config);
  const TcpClient one(daemon->ready().tcp);
  const TcpClient two(daemon->ready().tcp);
  // Half of the places is for others.
  TcpClient three(daemon->ready().tcp);
  EXPECT_TRUE(three.AwaitClose());
  EXPECT_EQ(daemon->Count(Counter::kConnectionsRefused), 1u);
}

TEST_F(Tls, RefusalsAndGoodbyesArriveBeforeTheEnd) {
  const TestKeys keys;
  Start({}, SecureConfig(keys));
  TlsTunnel one(daemon->ready().tcp, trusted.get());
  TcpClient stranger(Connected{one.TakeSocket()});
  stranger.Send(protocol::SubscribeWeights{.wait = true});
  const auto error = stranger.Await<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code, ErrorCode::kNeedsToken);
  EXPECT_TRUE(stranger.AwaitClose());
  TlsTunnel two(daemon->ready().tcp, trusted.get());
  TcpClient viewer(Connected{two.TakeSocket()});
  viewer.Send(protocol::Hello{
      .client = "test", .token = 0, .access = ToText(keys.Token(protocol::secure::Role::kWatch))});
  ASSERT_TRUE(Watch(viewer, {.wait = true}).has_value());
  EXPECT_EQ(daemon->Stop(), server::ExitCode::kOk);
  EXPECT_TRUE(viewer.Await<protocol::Goodbye>().has_value());
  EXPECT_TRUE(viewer.AwaitClose());
}

class TlsPictures : public PicturesTest {
 protected:
  void Configure(server::Config* config) override {
    config->security.tls = {.certificate = TestCertificate().Write(folder.path(), "daemon"),
                            .key = folder / "daemon.key",
                            .client_authority = {}};
    trusted = ContextOf({.authority = folder / "daemon.crt"});
  }
  Connected ConnectSender() override {
    tunnel.emplace(daemon->ready().tcp, trusted.get());
    return {tunnel->TakeSocket()};
  }

  TemporaryFolder folder;
  Context trusted;
  std::optional<TlsTunnel> tunnel;  // of the sender
};

TEST_F(TlsPictures, ArriveAsSnapshotsAndAsAStream) {
  SendPose(0);
  const std::string query = "?subject=ann&width=64&height=64&shading=diffuse";
  TlsTunnel one(*daemon->ready().http, trusted.get(), kHttp);
  const auto snapshot = WebClient(Connected{one.TakeSocket()}).Ask("GET", "/snapshot.png" + query);
  ASSERT_EQ(snapshot.status, 200) << snapshot.body;
  EXPECT_TRUE(snapshot.body.starts_with("\x89PNG"));
  TlsTunnel two(*daemon->ready().http, trusted.get(), kHttp);
  WebClient stream(Connected{two.TakeSocket()});
  ASSERT_EQ(stream.AskRaw("GET /mjpeg" + query + " HTTP/1.1\r\nHost: localhost\r\n\r\n").status,
            200);
  stream.ReadUntil("Content-Type: image/jpeg");
  stream.ReadUntil("\r\n\r\n");
  EXPECT_EQ(stream.Take(3), "\xFF\xD8\xFF");
}

class ClientCertificates : public Tls {
 protected:
  void SetUp() override {
    server::Config config = Weights();
    config.security.tls.client_authority = authority.Write(folder.path(), "authority");
    TestCertificate({.names = ""}, &authority).Write(folder.path(), "client");
    TestCertificate({.names = ""}).Write(folder.path(), "stranger");
    Start({}, config);
  }
  [[nodiscard]] ClientTlsFiles As(const std::string& name) const {
    return {.authority = folder / "daemon.crt",
            .certificate = folder / (name + ".crt"),
            .key = folder / (name + ".key")};
  }
  // What the client of the library receives, or why it failed.
  std::string Ping(const ClientTlsFiles& files) {
    auto transport = client::OpenTransport(TransportKind::kTcp, "127.0.0.1", daemon->ready().tcp,
                                           kGuard, {.tls = ContextOf(files)});
    if (!transport.ok()) return transport.status().what();
    protocol::Encoder encoder;
    std::vector<std::uint8_t> bytes;
    encoder.Encode({.session = 1}, protocol::Ping{1}, bytes);
    (void)(*transport)->Send(bytes);
    std::span<const std::uint8_t> message;
    const auto status = (*transport)->Receive(message, kGuard);
    return status == client::IoStatus::kOk ? "pong" : (*transport)->failure();
  }

  const TestCertificate authority{{.names = "", .is_authority = true}};
};

TEST_F(ClientCertificates, AreRequired) {
  EXPECT_EQ(Ping(As("client")), "pong");
  EXPECT_THAT(Ping({.authority = folder / "daemon.crt"}),
              HasSubstr("asks for a certificate of the client"));
  EXPECT_THAT(Ping(As("stranger")), HasSubstr("TLS failed"));
  daemon->AwaitCount(Counter::kTlsNoCertificate, 1);
  daemon->AwaitCount(Counter::kTlsBadCertificate, 1);
}

TEST_F(ClientCertificates, ProbesNeedNone) {
  const auto status = [&](const Context& context, const char* path) {
    TlsTunnel tunnel(*daemon->ready().http, context.get(), kHttp);
    return WebClient(Connected{tunnel.TakeSocket()}).Ask("GET", path).status;
  };
  EXPECT_EQ(status(trusted, "/healthz"), 200);
  EXPECT_EQ(status(trusted, "/readyz"), 200);
  EXPECT_EQ(status(trusted, "/"), 403);
  EXPECT_EQ(status(trusted, "/api/status"), 403);
  EXPECT_EQ(status(ContextOf(As("client")), "/api/status"), 200);
}

// An address of this computer that is not a loopback address; empty: it has none.
std::string OwnAddress() {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return {};
  std::string found;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    const bool counts = each->ifa_addr != nullptr && each->ifa_addr->sa_family == AF_INET &&
                        (each->ifa_flags & IFF_LOOPBACK) == 0 && (each->ifa_flags & IFF_UP) != 0;
    if (!counts) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr, text.data(),
              text.size());
    found = text.data();
  }
  freeifaddrs(all);
  return found;
}

// An address of the network stands for another computer.
TEST_F(Tls, TokensMayComeFromOtherComputers) {
  const std::string host = OwnAddress();
  if (host.empty()) GTEST_SKIP() << "this computer has no address but the loopback address";
  const TestKeys keys;
  server::Config config = SecureConfig(keys);
  config.bind = host;
  Start({.names = "IP:" + host}, config);
  client::Security security{.token = keys.Token(protocol::secure::Role::kWatch), .tls = trusted};
  auto transport =
      client::OpenTransport(TransportKind::kTcp, host, daemon->ready().tcp, kGuard, security);
  ASSERT_TRUE(transport.ok()) << transport.status().ToString();
  protocol::Encoder encoder;
  std::vector<std::uint8_t> bytes;
  encoder.Encode({.session = 1, .sequence = 5}, protocol::SubscribeWeights{.wait = true}, bytes);
  ASSERT_EQ((*transport)->Send(bytes), client::IoStatus::kOk);
  std::span<const std::uint8_t> message;
  protocol::SubscribeReply reply;
  bool subscribed = false;
  while (!subscribed && (*transport)->Receive(message, kGuard) == client::IoStatus::kOk) {
    protocol::MessageView view;
    subscribed = protocol::OpenMessage(message, view, protocol::kMaxReplyBytes) ==
                     protocol::DecodeStatus::kOk &&
                 protocol::Decode(view, reply) == protocol::DecodeStatus::kOk;
  }
  EXPECT_TRUE(subscribed);
  EXPECT_EQ(daemon->Count(Counter::kRefusedInClear), 0u);
  // Without TLS, the client does not even connect.
  security.tls = nullptr;
  const Status refused =
      client::OpenTransport(TransportKind::kTcp, host, daemon->ready().tcp, kGuard, security)
          .status();
  EXPECT_EQ(refused.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(refused.what(), HasSubstr("unencrypted"));
}

}  // namespace
}  // namespace furrow::testing_net
