// SPDX-License-Identifier: Apache-2.0
// furrowd under a service manager, which this test plays.
#include <csignal>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "notify_socket.h"
#include "process.h"
#include "raw_client.h"
#include "web_client.h"

namespace furrow::testing_net {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

std::vector<std::string> ServiceCommand(const std::vector<std::string>& more = {}) {
  std::vector<std::string> ports = {"--tcp", "0", "--udp", "0"};
  ports.insert(ports.end(), more.begin(), more.end());
  return FurrowdCommand(ports);
}

// A TCP socket that listens on a free port.
class TcpListener {
 public:
  explicit TcpListener(std::uint32_t address)
      : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in any{};
    any.sin_family = AF_INET;
    any.sin_addr.s_addr = htonl(address);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&any), sizeof(any)), 0);
    EXPECT_EQ(listen(socket_, 16), 0);
  }
  ~TcpListener() { close(socket_); }
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  [[nodiscard]] int socket_number() const { return socket_; }
  [[nodiscard]] std::uint16_t port() const {
    sockaddr_in address{};
    socklen_t size = sizeof(address);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
  }

 private:
  int socket_;
};

TEST(Service, TheManagerHearsThatTheDaemonServesLivesAndEnds) {
  const NotifySocket manager;
  Process daemon(ServiceCommand(), {.notify_socket = manager.path()});
  const std::string ready = manager.Next();
  EXPECT_THAT(ready, StartsWith("READY=1\n"));
  EXPECT_THAT(ready, HasSubstr("STATUS=furrowd ready tcp=127.0.0.1:"));
  EXPECT_THAT(manager.Next(), StartsWith("WATCHDOG=1"));
  daemon.Signal(SIGTERM);
  EXPECT_THAT(manager.NextBut("WATCHDOG=1"), StartsWith("STOPPING=1"));
  EXPECT_EQ(daemon.Wait(), 0);
}

// The clients have connected before the daemon runs.
TEST(Service, ServesTheSocketsOfTheManager) {
  const TcpListener tcp(INADDR_LOOPBACK);
  const TcpListener http(INADDR_LOOPBACK);
  TcpClient client(tcp.port());
  client.Send(protocol::Hello{"test", 0});
  WebClient web(http.port());
  Process daemon(ServiceCommand(),
                 {.sockets = {http.socket_number(), tcp.socket_number()}, .names = "http:tcp"});
  EXPECT_TRUE(client.Await<protocol::Welcome>().has_value());
  EXPECT_EQ(web.Ask("GET", "/healthz").status, 200);
  const std::string ready = daemon.ReadLine().value_or("");
  EXPECT_THAT(ready, HasSubstr("tcp=127.0.0.1:" + std::to_string(tcp.port()) + " "));
  EXPECT_THAT(ready, HasSubstr("http=127.0.0.1:" + std::to_string(http.port())));
}

TEST(Service, AnOpenDaemonTakesNoSocketOnTheNetwork) {
  const TcpListener tcp(INADDR_ANY);
  Process daemon(ServiceCommand(), {.sockets = {tcp.socket_number()}, .names = "tcp"});
  EXPECT_EQ(daemon.Wait(), 1);
  EXPECT_THAT(daemon.ReadErrors(), HasSubstr("listens on 0.0.0.0"));
  Process open(ServiceCommand({"--open"}), {.sockets = {tcp.socket_number()}, .names = "tcp"});
  EXPECT_THAT(open.ReadLine().value_or(""), HasSubstr("tcp=0.0.0.0:"));
}

// sd_notify(3) describes the messages of a reload.
TEST(Service, TheManagerHearsWhenAReloadBeginsAndEnds) {
  const NotifySocket manager;
  Process daemon(ServiceCommand(), {.notify_socket = manager.path()});
  EXPECT_THAT(manager.Next(), StartsWith("READY=1\n"));
  daemon.Signal(SIGHUP);
  EXPECT_THAT(manager.NextBut("WATCHDOG=1"),
              MatchesRegex("RELOADING=1\nMONOTONIC_USEC=[0-9]+\nSTATUS=.*"));
  EXPECT_EQ(manager.NextBut("WATCHDOG=1"), "READY=1\nSTATUS=the configuration was read again");
}

// systemd.exec(5): JOURNAL_STREAM names the pipe to the journal.
TEST(Service, LinesForTheJournalBeginWithTheirPriority) {
  const std::string journal = "JOURNAL_STREAM=$(stat -L -c %d:%i /proc/self/fd/2) exec \"$0\" ";
  Process daemon(
      {"/bin/sh", "-c", journal + "--rig nosuch --no-render", FURROW_BINARY_DIR "/bin/furrowd"});
  EXPECT_EQ(daemon.Wait(), 3);
  EXPECT_THAT(daemon.ReadErrors(), MatchesRegex("<6>furrowd .*started at [^\n]*\n<3>nosuch: .*"));
}

TEST(Service, OtherSocketsAreNamedAndClosed) {
  const TcpListener other(INADDR_LOOPBACK);
  Process daemon(ServiceCommand(), {.sockets = {other.socket_number()}, .names = "telnet"});
  EXPECT_THAT(daemon.ReadLine().value_or(""), StartsWith("furrowd ready"));
  daemon.Signal(SIGTERM);
  EXPECT_EQ(daemon.Wait(), 0);
  EXPECT_THAT(daemon.ReadErrors(), HasSubstr("passes socket 'telnet', which is not used"));
}

}  // namespace
}  // namespace furrow::testing_net
