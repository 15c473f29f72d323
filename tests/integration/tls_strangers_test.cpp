// SPDX-License-Identifier: Apache-2.0
// Clients of one address that have not shown who they are, at a daemon with TLS and tokens: they
// pass one after the other, and nobody is left out.
#include <array>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include "client/cpp/tls/client_tls.h"
#include "daemon_fixture.h"
#include "protocol/secure/token/token_text.h"
#include "sealed_client.h"
#include "tests/certificates.h"
#include "tests/temporary_folder.h"
#include "tls_tunnel.h"
#include "web_client.h"

namespace furrow::testing_net {
namespace {

using testing::HasSubstr;

class TlsStrangers : public testing::Test {
 protected:
  void SetUp() override {
    server::Config config = SecureConfig(keys);
    const TestCertificate certificate;
    config.security.tls.certificate = certificate.Write(folder.path(), "daemon");
    config.security.tls.key = folder / "daemon.key";
    daemon.emplace(config);
    ASSERT_TRUE(daemon->serves());
    auto context = client::MakeTlsContext({.authority = folder / "daemon.crt"});
    ASSERT_TRUE(context.ok()) << context.status().ToString();
    trusted = *context;
  }
  [[nodiscard]] std::unique_ptr<TlsTunnel> WebTunnel() const {
    return std::make_unique<TlsTunnel>(*daemon->ready().http, trusted.get(), "\x08http/1.1");
  }

  const TestKeys keys;
  TemporaryFolder folder;
  std::optional<DaemonThread> daemon;
  std::shared_ptr<SSL_CTX> trusted;
};

TEST_F(TlsStrangers, ConnectionsOfABrowserAreAllServed) {
  std::vector<std::future<int>> statuses;
  for (int i = 0; i < 6; ++i) {
    statuses.push_back(std::async(std::launch::async, [this] {
      const auto tunnel = WebTunnel();
      if (!tunnel->connected()) return 0;
      return WebClient(Connected{tunnel->TakeSocket()}).Ask("GET", "/healthz").status;
    }));
  }
  for (std::future<int>& status : statuses) EXPECT_EQ(status.get(), 200);
}

TEST_F(TlsStrangers, SilentOnesDoNotKeepOutAClientWithAToken) {
  const std::array<std::uint8_t, 5> begin{22, 3, 1, 2, 0};  // the head of a ClientHello
  std::vector<std::unique_ptr<TcpClient>> halves;
  for (int i = 0; i < 8; ++i) {
    halves.push_back(std::make_unique<TcpClient>(daemon->ready().tcp));
    halves.back()->SendRaw(begin);
  }
  TlsTunnel one(daemon->ready().tcp, trusted.get());
  ASSERT_TRUE(one.connected());
  TcpClient silent(Connected{one.TakeSocket()});
  TlsTunnel two(daemon->ready().tcp, trusted.get());
  ASSERT_TRUE(two.connected());
  TcpClient viewer(Connected{two.TakeSocket()});
  viewer.Send(protocol::Hello{
      .client = "test", .token = 0, .access = ToText(keys.Token(protocol::secure::Role::kWatch))});
  EXPECT_TRUE(Watch(viewer, {.wait = true}).has_value());
  EXPECT_TRUE(silent.AwaitClose());
}

TEST_F(TlsStrangers, AConnectionWithoutATokenClosesOnlyWhileOthersWait) {
  const auto tunnel = WebTunnel();
  ASSERT_TRUE(tunnel->connected());
  WebClient probe(Connected{tunnel->TakeSocket()});
  for (int i = 0; i < 3; ++i) {
    const auto answer = probe.Ask("GET", "/healthz");
    ASSERT_EQ(answer.status, 200);
    EXPECT_THAT(answer.head, Not(HasSubstr("Connection: close")));
  }
  auto other = std::async(std::launch::async, [this] { return WebTunnel()->connected(); });
  WebClient::Answer answer;
  do {
    answer = probe.Ask("GET", "/healthz");
    ASSERT_EQ(answer.status, 200) << "closed without a word";
  } while (answer.head.find("Connection: close") == std::string::npos);
  EXPECT_TRUE(other.get());
}

}  // namespace
}  // namespace furrow::testing_net
