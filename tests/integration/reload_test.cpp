// SPDX-License-Identifier: Apache-2.0
// SIGHUP: furrowd reads its configuration again, and nobody who is connected notices.
#include <csignal>
#include <fstream>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "client/cpp/tls/client_tls.h"
#include "daemon_fixture.h"
#include "notify_socket.h"
#include "process.h"
#include "rig/rig_file.h"
#include "sealed_client.h"
#include "tests/certificates.h"
#include "tests/temporary_folder.h"
#include "tls_tunnel.h"
#include "web_client.h"

namespace furrow::testing_net {
namespace {

using protocol::secure::Refusal;
using protocol::secure::Role;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr char kPorts[] = "[listen]\ntcp = 0\nudp = 0\n[http]\nport = 0\n";
constexpr char kDone[] = "READY=1\nSTATUS=the configuration was read again";
constexpr char kRefused[] = "READY=1\nSTATUS=the configuration stays as it was; see the log";

class ReloadTest : public testing::Test {
 protected:
  // Starts a daemon with this configuration, and waits until it serves.
  void Start(const std::string& toml, const std::string& rig = {}) {
    Write(toml);
    const std::string chosen = rig.empty() ? FURROW_SOURCE_DIR "/rig/rigs/arkit.json" : rig;
    daemon.emplace(std::vector<std::string>{FURROW_BINARY_DIR "/bin/furrowd", "--config",
                                            file.string(), "--rig", chosen, "--no-render"},
                   Process::Service{.notify_socket = manager.path(), .sockets = {}, .names = {}});
    ASSERT_THAT(manager.Next(), StartsWith("READY=1\n"));
    const std::string line = daemon->ReadLine().value_or("");
    const auto port = [&line](const std::string& name) {
      std::smatch match;
      const bool found = std::regex_search(line, match, std::regex(name + "=127.0.0.1:(\\d+)"));
      return found ? static_cast<std::uint16_t>(std::stoi(match[1])) : std::uint16_t{0};
    };
    tcp = port("tcp");
    udp = port("udp");
    http = port("http");
  }
  void Write(const std::string& toml) const { ASSERT_TRUE(WriteFileAtomically(file, toml).ok()); }
  // Reloads with this configuration. Returns what the daemon tells its manager at the end.
  std::string Reload(const std::string& toml) {
    Write(toml);
    daemon->Signal(SIGHUP);
    EXPECT_THAT(manager.NextBut("WATCHDOG=1"), StartsWith("RELOADING=1\n"));
    return manager.NextBut("WATCHDOG=1");
  }
  // Ends the daemon and returns its log.
  std::string Log() {
    daemon->Signal(SIGTERM);
    EXPECT_EQ(daemon->Wait(), 0);
    return daemon->ReadErrors();
  }
  // A pose of the sender reaches the viewer.
  void ExpectWeights(RawClient& sender, RawClient& viewer) {
    sender.Send(PoseOf(clip, static_cast<int>(frame), offer), 1, frame, 16'667 * frame);
    protocol::Header header;
    do {  // a new rig sends the weights of the last pose again
      ASSERT_TRUE(viewer.Await<protocol::WeightFrame>(&header).has_value());
    } while (header.sequence < frame);
    ASSERT_EQ(header.sequence, frame++);
  }
  [[nodiscard]] int StatusOf(const std::string& host) const {
    return WebClient(http).Ask("GET", "/metrics", {}, "Host: " + host + "\r\n").status;
  }

  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "furrow.toml";
  const NotifySocket manager;
  const motion::Clip clip = ArkitClip(100);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  std::optional<Process> daemon;
  std::uint16_t tcp = 0;
  std::uint16_t udp = 0;
  std::uint16_t http = 0;
  std::uint32_t frame = 0;
};

TEST_F(ReloadTest, StreamsGoOnWithNewNamesAndLimits) {
  Start(kPorts);
  TcpClient sender(tcp);
  TcpClient viewer(tcp);
  Offer(sender, offer);
  ASSERT_TRUE(Watch(viewer, {.subject = "ann"}).has_value());
  ExpectWeights(sender, viewer);
  EXPECT_EQ(StatusOf("furrow.example"), 403);
  EXPECT_EQ(Reload(std::string(kPorts) +
                   "allow_hosts = ['furrow.example']\n[limits]\nmax_subscriptions = 1\n"),
            kDone);
  for (int i = 0; i < 10; ++i) ExpectWeights(sender, viewer);
  EXPECT_EQ(StatusOf("furrow.example"), 200) << "a scrape by name";
  EXPECT_EQ(StatusOf("evil.example"), 403);
  EXPECT_FALSE(Watch(viewer, {.subject = "ann"}, 2).has_value()) << "one subscription is the most";
  EXPECT_THAT(Log(), HasSubstr("took effect: http.allow_hosts, limits.max_subscriptions"));
}

TEST_F(ReloadTest, NamesWhatTakesARestart) {
  Start(kPorts);
  EXPECT_EQ(Reload("[listen]\ntcp = 0\nudp = 7499\n[http]\nport = 0\n[log]\njson = true\n"), kDone);
  TcpClient client(tcp);
  client.Send(protocol::Hello{"test", 0});
  EXPECT_TRUE(client.Await<protocol::Welcome>().has_value());
  EXPECT_THAT(Log(), AllOf(HasSubstr("listen.udp changed: takes effect after a restart"),
                           HasSubstr("log.json changed: takes effect after a restart"),
                           HasSubstr("took effect: nothing")));
}

TEST_F(ReloadTest, AFaultLeavesEverythingAsItWas) {
  Start(std::string(kPorts) + "allow_hosts = ['furrow.example']\n");
  // The names would change, and the keys cannot be read.
  for (const std::string fault :
       {"allow_hosts = [\n", "allow_hosts = ['a']\n[security]\nkeys = 'absent.keys'\n",
        "allow_hosts = ['a']\n[limits]\nmax_subjects = 0\n"}) {
    EXPECT_EQ(Reload(kPorts + fault), kRefused) << fault;
    EXPECT_EQ(StatusOf("furrow.example"), 200) << fault;
    EXPECT_EQ(StatusOf("a"), 403) << fault;
    EXPECT_THAT(WebClient(http).Ask("GET", "/metrics").body,
                HasSubstr("furrow_config_refused 1\n"));
  }
  EXPECT_EQ(Reload(std::string(kPorts) + "allow_hosts = ['furrow.example']\n"), kDone);
  EXPECT_THAT(WebClient(http).Ask("GET", "/metrics").body, HasSubstr("furrow_config_refused 0\n"));
  EXPECT_THAT(Log(), AllOf(HasSubstr("the configuration stays as it was: " + file.string() + ":"),
                           HasSubstr("absent.keys"), HasSubstr("limits.max_subjects is 0")));
}

TEST_F(ReloadTest, RefusesTheTokensOfFormerKeys) {
  const TestKeys former;
  const TestKeys next;
  const auto config = [](const TestKeys& keys) {
    return std::string(kPorts) + "[security]\nmode = 'required'\nkeys = '" + keys.file().string() +
           "'\nname = 'stage'\n";
  };
  Start(config(former));
  SealedClient viewer(udp, former.Token(Role::kWatch));
  EXPECT_TRUE(viewer.Introduce());
  EXPECT_EQ(Reload(config(next)), kDone);
  SealedClient late(udp, former.Token(Role::kWatch));
  EXPECT_FALSE(late.Introduce());
  EXPECT_EQ(late.refusal(), Refusal::kUnknownKey);
  SealedClient newcomer(udp, next.Token(Role::kWatch));
  EXPECT_TRUE(newcomer.Introduce());
  // The session ends with its key: the client begins again, in vain.
  while (viewer.refusal() == Refusal::kNone || viewer.refusal() == Refusal::kUnknownSession) {
    (void)viewer.TryNext();
  }
  EXPECT_EQ(viewer.refusal(), Refusal::kUnknownKey);
}

TEST_F(ReloadTest, NewConnectionsGetTheNewCertificate) {
  const auto config = [this](const std::string& name) {
    const TestCertificate certificate;
    return std::string(kPorts) + "[tls]\ncertificate = '" +
           certificate.Write(folder.path(), name).string() + "'\nkey = '" +
           (folder / (name + ".key")).string() + "'\n";
  };
  const auto context = [this](const std::string& name) {
    return client::MakeTlsContext({.authority = folder / (name + ".crt")}).value();
  };
  Start(config("first"));
  TlsTunnel one(tcp, context("first").get());
  TlsTunnel two(tcp, context("first").get());
  ASSERT_TRUE(one.connected() && two.connected());
  TcpClient sender(Connected{one.TakeSocket()});
  TcpClient viewer(Connected{two.TakeSocket()});
  Offer(sender, offer);
  ASSERT_TRUE(Watch(viewer, {.subject = "ann"}).has_value());
  EXPECT_EQ(Reload(config("second")), kDone);
  for (int i = 0; i < 10; ++i) ExpectWeights(sender, viewer);
  EXPECT_TRUE(TlsTunnel(tcp, context("second").get()).connected());
  EXPECT_FALSE(TlsTunnel(tcp, context("first").get()).connected());
  // TLS cannot end while connections have it.
  EXPECT_EQ(Reload(kPorts), kDone);
  EXPECT_TRUE(TlsTunnel(tcp, context("second").get()).connected());
  EXPECT_THAT(Log(), HasSubstr("tls.certificate changed: takes effect after a restart"));
}

TEST_F(ReloadTest, ReadsAChangedRig) {
  const auto shipped = rig::LoadRig(FURROW_SOURCE_DIR "/rig/rigs/arkit.json");
  ASSERT_TRUE(shipped.ok());
  wrinkle::Rig changed = *shipped;
  const std::string path = (folder / "rig.json").string();
  ASSERT_TRUE(rig::SaveRig(changed, path).ok());
  Start(kPorts, path);
  TcpClient sender(tcp);
  TcpClient viewer(tcp);
  Offer(sender, offer);
  ASSERT_TRUE(Watch(viewer, {.subject = "ann"}).has_value());
  ExpectWeights(sender, viewer);
  changed.name = "renamed";
  ASSERT_TRUE(rig::SaveRig(changed, path).ok());
  EXPECT_EQ(Reload(kPorts), kDone);
  EXPECT_THAT(WebClient(http).Ask("GET", "/api/rig").body, HasSubstr("\"renamed\""));
  for (int i = 0; i < 10; ++i) ExpectWeights(sender, viewer);
  // A rig that cannot be read is a fault like any other.
  ASSERT_TRUE(WriteFileAtomically(path, "{").ok());
  EXPECT_EQ(Reload(kPorts), kRefused);
  EXPECT_THAT(WebClient(http).Ask("GET", "/api/rig").body, HasSubstr("\"renamed\""));
  ExpectWeights(sender, viewer);
}

TEST_F(ReloadTest, TheLogLevelChanges) {
  Start(kPorts);
  EXPECT_EQ(Reload(std::string(kPorts) + "[log]\nlevel = 'error'\n"), kDone);
  EXPECT_THAT(Log(), AllOf(HasSubstr("started at "), Not(HasSubstr("shutting down"))));
}

}  // namespace
}  // namespace furrow::testing_net
