// SPDX-License-Identifier: Apache-2.0
// furrowd as a process: ready line, exit codes, signals.
#include "process.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "raw_client.h"
#include "tests/temporary_folder.h"
#include "web_client.h"

namespace furrow::testing_net {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

const char kProgram[] = FURROW_BINARY_DIR "/bin/furrowd";

// The ports in the ready line; 0 if the line is not one.
std::pair<int, int> Ports(const std::string& line) {
  std::smatch match;
  const std::regex ready(
      R"(furrowd ready tcp=127\.0\.0\.1:(\d+) udp=127\.0\.0\.1:(\d+) render=off http=127\.0\.0\.1:\d+)");
  if (!std::regex_match(line, match, ready)) return {0, 0};
  return {std::stoi(match[1]), std::stoi(match[2])};
}

TEST(Furrowd, PrintsItsPortsAndStopsOnSigterm) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Process daemon(FurrowdCommand({"--tcp", "0", "--udp", "0"}));
    const auto [tcp, udp] = Ports(daemon.ReadLine().value_or(""));
    ASSERT_NE(tcp, 0);
    TcpClient client(static_cast<std::uint16_t>(tcp));
    client.Send(protocol::Hello{"test", 0});
    ASSERT_TRUE(client.Await<protocol::Welcome>().has_value());
    daemon.Signal(signal);
    EXPECT_EQ(client.Await<protocol::Goodbye>()->reason, protocol::GoodbyeReason::kDraining);
    EXPECT_EQ(daemon.Wait(), 0);
  }
}

// True if the process handles the signal by itself.
bool Catches(pid_t process, int signal) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("SigCgt:")) continue;
    return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
  }
  return false;
}

TEST(Furrowd, ASignalWhileItStartsEndsItInOrder) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Process daemon(FurrowdCommand({"--tcp", "0", "--udp", "0"}));
    while (!Catches(daemon.id(), signal)) std::this_thread::yield();
    daemon.Signal(signal);
    EXPECT_EQ(daemon.Wait(), 0);
  }
}

TEST(Furrowd, AFailedStartLeavesNoRecording) {
  const TemporaryFolder folder;
  Process first(FurrowdCommand({"--tcp", "0", "--udp", "0"}));
  const auto [tcp, udp] = Ports(first.ReadLine().value_or(""));
  ASSERT_NE(tcp, 0);
  Process second(FurrowdCommand(
      {"--tcp", std::to_string(tcp), "--udp", "0", "--record", folder.path().string()}));
  EXPECT_EQ(second.Wait(), 1);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Furrowd, ASecondDaemonOnAPortFailsAndNamesThePort) {
  Process first(FurrowdCommand({"--tcp", "0", "--udp", "0"}));
  const auto [tcp, udp] = Ports(first.ReadLine().value_or(""));
  ASSERT_NE(tcp, 0);
  Process second(FurrowdCommand({"--tcp", std::to_string(tcp), "--udp", "0"}));
  EXPECT_EQ(second.Wait(), 1);
  EXPECT_THAT(second.ReadErrors(), HasSubstr("port " + std::to_string(tcp)));
  Process third(FurrowdCommand({"--tcp", "0", "--udp", std::to_string(udp)}));
  EXPECT_EQ(third.Wait(), 1);
  EXPECT_THAT(third.ReadErrors(), HasSubstr("port " + std::to_string(udp)));
}

TEST(Furrowd, ExitsWithTwoForUsageAndThreeForInput) {
  Process usage({kProgram, "--nonsense"});
  EXPECT_EQ(usage.Wait(), 2);
  EXPECT_FALSE(usage.ReadErrors().empty());
  Process rig({kProgram, "--rig", "/nowhere.json", "--no-render"});
  EXPECT_EQ(rig.Wait(), 3);
  EXPECT_THAT(rig.ReadErrors(), HasSubstr("/nowhere.json"));
  Process config({kProgram, "--config", "/nowhere.toml"});
  EXPECT_EQ(config.Wait(), 3);
  EXPECT_THAT(config.ReadErrors(), HasSubstr("/nowhere.toml"));
}

TEST(Furrowd, HelpSucceedsAndListsExitCodes) {
  Process help({kProgram, "--help"});
  std::string text;
  while (auto line = help.ReadLine()) text += *line + "\n";
  EXPECT_EQ(help.Wait(), 0);
  EXPECT_THAT(text, HasSubstr("Exit codes"));
}

TEST(Furrowd, ContinuesWhenTheReaderOfItsLogLeaves) {
  Process daemon(FurrowdCommand({"--tcp", "0", "--udp", "0"}));
  daemon.CloseErrors();
  ASSERT_TRUE(daemon.ReadLine().has_value());
  daemon.Signal(SIGTERM);  // the daemon logs it
  EXPECT_EQ(daemon.Wait(), 0);
}

TEST(Furrowd, LogsAsJsonWhenAsked) {
  Process daemon(FurrowdCommand({"--tcp", "0", "--udp", "0", "--log-json"}));
  ASSERT_TRUE(daemon.ReadLine().has_value());
  daemon.Signal(SIGTERM);
  EXPECT_EQ(daemon.Wait(), 0);
  EXPECT_THAT(daemon.ReadErrors(), HasSubstr(R"("level":"info","message":"shutting down"})"));
}

TEST(Furrowd, SaysWhetherItIsConfined) {
  for (const bool confined : {true, false}) {
    std::vector<std::string> command = FurrowdCommand({"--tcp", "0", "--udp", "0"});
    if (!confined) command.emplace_back("--no-confine");
    Process daemon(command);
    ASSERT_TRUE(daemon.ReadLine().has_value());
    daemon.Signal(SIGTERM);
    EXPECT_EQ(daemon.Wait(), 0);
    EXPECT_THAT(daemon.ReadErrors(), HasSubstr(confined ? "confined: no new privileges"
                                                        : "not confined: security.confine is off"));
  }
}

// Also the threads of the driver, of libraries and of the log.
void ExpectAllThreadsConfined(pid_t process) {
  std::size_t num_threads = 0;
  const auto tasks = std::filesystem::path("/proc") / std::to_string(process) / "task";
  for (const auto& task : std::filesystem::directory_iterator(tasks)) {
    std::ifstream file(task.path() / "status");
    const std::string status{std::istreambuf_iterator<char>(file), {}};
    if (status.empty()) continue;  // the thread has ended
    ++num_threads;
    EXPECT_THAT(status, HasSubstr("\nNoNewPrivs:\t1\n"));
    EXPECT_THAT(status, HasSubstr("\nSeccomp:\t2\n"));
    // At most that of opening ports below 1024.
    EXPECT_THAT(status, ContainsRegex("\nCapEff:\t0000000000000[04]00\n"));
  }
  EXPECT_GT(num_threads, 3u);
}

// The driver of OpenGL, the module of pictures and the recording need files after the start.
TEST(Furrowd, DrawsAndRecordsWhileItIsConfined) {
  const TemporaryFolder folder;
  Process daemon({kProgram, "--tcp", "0", "--udp", "0", "--http", "0", "--play", "performance",
                  "--record", (folder / "takes").string()});
  const std::string ready = daemon.ReadLine().value_or("");
  std::smatch match;
  if (!std::regex_search(ready, match, std::regex(R"(render=on http=127\.0\.0\.1:(\d+))"))) {
    GTEST_SKIP() << "no OpenGL 4.5 here, or furrow_share is not built: " << ready;
  }
  const auto port = static_cast<std::uint16_t>(std::stoi(match[1]));
  WebClient::Answer answer;
  for (int i = 0; i < 6 && answer.status != 200; ++i) {  // shaders may take longer than a reply
    answer = WebClient(port).Ask("GET", "/snapshot.png?width=64&height=64");
  }
  EXPECT_EQ(answer.status, 200) << answer.body;
  ExpectAllThreadsConfined(daemon.id());
  daemon.Signal(SIGTERM);
  EXPECT_EQ(daemon.Wait(), 0);
  EXPECT_FALSE(std::filesystem::is_empty(folder / "takes"));
  EXPECT_THAT(daemon.ReadErrors(), HasSubstr("confined: "));
}

}  // namespace
}  // namespace furrow::testing_net
