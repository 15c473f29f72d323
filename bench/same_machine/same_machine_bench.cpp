// SPDX-License-Identifier: Apache-2.0
// Compares ways for weights from the daemon to a client on the same machine: UDP over loopback, and
// a ring in shared memory. Writer and reader are two processes on two cores. All ways run in turn
// in one run, with the same message: the weights of the default rig. The last table measures the
// whole way: a publisher sends poses to the writer over UDP, and the latency counts from there.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/report/aims.h"
#include "bench/report/command_line.h"
#include "bench/report/machine.h"
#include "bench/same_machine/ways.h"
#include "client/load/measure/histogram.h"
#include "client/load/measure/quartiles.h"
#include "protocol/codec/codec.h"
#include "protocol/codec/message_view.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

constexpr std::size_t kWeights = 37;  // of the default rig
constexpr int kWaitMs = 200;          // a reader that waits longer has received everything
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kFrame = kSecond / 60;  // of a reader that polls once per frame

std::int64_t Now(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return time.tv_sec * kSecond + time.tv_nsec;
}

void SleepUntil(std::int64_t time) {
  const timespec until{time / kSecond, time % kSecond};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

// Keeps the scheduler from deciding the comparison.
void RunOnCore(int core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(core, &cores);
  sched_setaffinity(0, sizeof(cores), &cores);
}

// What the reader's process reports, in shared memory. Times in nanoseconds.
struct Reading {
  std::int64_t cpu = 0;
  std::int64_t received = 0;
  std::array<std::int64_t, 3> latency{};  // p50, p90, p99
};

enum class Mode {
  kWaits,
  kPolls,    // the reader looks once per frame
  kWholeWay  // the reader waits, and the writer waits for poses of a third process
};

struct Task {
  int rate = 0;   // messages per second
  int count = 0;  // messages
  Mode mode = Mode::kWaits;
};

// Handles one message as a client does up to the decoder, which is the same for all ways.
void Handle(std::span<const std::uint8_t> bytes, load::Histogram& latency) {
  const std::int64_t now = Now(CLOCK_MONOTONIC);
  protocol::MessageView view;
  if (protocol::OpenMessage(bytes, view) != protocol::DecodeStatus::kOk) std::exit(1);
  latency.Record(now - view.header.capture_time_us);
}

void ReadWaiting(Way& way, const Task& task, load::Histogram& latency) {
  // The end is silence, so that lost messages do not matter.
  for (int wait = 2000; latency.count() < static_cast<std::uint64_t>(task.count); wait = kWaitMs) {
    const auto message = way.Receive(wait);
    if (message.empty()) return;
    Handle(message, latency);
  }
}

void ReadPolling(Way& way, const Task& task, load::Histogram& latency) {
  const std::int64_t frames = kSecond / kFrame * task.count / task.rate + 12;
  const std::int64_t start = Now(CLOCK_MONOTONIC);
  for (std::int64_t i = 1; i <= frames; ++i) {
    SleepUntil(start + i * kFrame);
    // A reader of UDP has to read all messages to find the newest one.
    const bool skips = way.SkipToNewest();
    do {
      const auto message = way.Receive(0);
      if (message.empty()) break;
      Handle(message, latency);
    } while (!skips);
  }
}

[[noreturn]] void Read(Way& way, const Task& task, Reading& reading) {
  RunOnCore(1);
  way.StartReader();
  const std::int64_t cpu = Now(CLOCK_PROCESS_CPUTIME_ID);
  load::Histogram latency;
  (task.mode == Mode::kPolls ? ReadPolling : ReadWaiting)(way, task, latency);
  reading.cpu = Now(CLOCK_PROCESS_CPUTIME_ID) - cpu;
  reading.received = static_cast<std::int64_t>(latency.count());
  reading.latency = {latency.Percentile(50), latency.Percentile(90), latency.Percentile(99)};
  _exit(0);
}

// Calls `send` with the stamp of each message, at the times of the task.
void KeepTime(const Task& task, const std::function<void(std::int64_t)>& send) {
  const std::int64_t start = Now(CLOCK_MONOTONIC) + kSecond / 100;
  for (int i = 0; i < task.count; ++i) {
    SleepUntil(start + i * kSecond / task.rate);
    send(Now(CLOCK_MONOTONIC));
  }
}

// A pose of 51 joints, packed. Only its stamp is read.
struct Pose {
  std::int64_t stamp = 0;
  std::array<char, 432> rest{};
};

[[noreturn]] void Publish(int socket, const Task& task) {
  RunOnCore(1);
  Pose pose;
  KeepTime(task, [&](std::int64_t stamp) {
    pose.stamp = stamp;
    (void)!send(socket, &pose, sizeof(pose), 0);
  });
  _exit(0);
}

// A pair of connected UDP sockets.
std::array<int, 2> MakePair() {
  std::array<int, 2> sockets{};
  for (int& one : sockets) {
    one = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in any{};
    any.sin_family = AF_INET;
    any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (bind(one, reinterpret_cast<const sockaddr*>(&any), sizeof(any)) != 0) std::exit(1);
  }
  for (int i = 0; i < 2; ++i) {
    sockaddr_in other{};
    socklen_t size = sizeof(other);
    getsockname(sockets[1 - i], reinterpret_cast<sockaddr*>(&other), &size);
    if (connect(sockets[i], reinterpret_cast<const sockaddr*>(&other), size) != 0) std::exit(1);
  }
  return sockets;
}

// Calls `send` with the stamp of each pose. Receives as the daemon does: poll, then read.
void AwaitPoses(int socket, const Task& task, const std::function<void(std::int64_t)>& send) {
  pollfd wait{socket, POLLIN, 0};
  for (int received = 0; received < task.count && poll(&wait, 1, 1000) == 1; ++received) {
    Pose pose;
    if (recv(socket, &pose, sizeof(pose), 0) == sizeof(pose)) send(pose.stamp);
  }
}

// Returns the writer's processor time.
std::int64_t Write(Way& way, const Task& task, int poses) {
  protocol::WeightFrame frame;
  frame.names_hash = 7;
  for (std::size_t i = 0; i < kWeights; ++i) {
    frame.values.push_back(static_cast<float>(i % 8) / 8.0f);
  }
  std::vector<std::uint8_t> message;
  protocol::Encoder().Encode({.session = 1}, frame, message);
  const std::vector<std::uint8_t> payload(message.begin() + protocol::kEnvelopeBytes,
                                          message.end());
  const auto send = [&](std::int64_t stamp) {
    // The stamp is in nanoseconds here.
    protocol::WriteMessage({.session = 1, .stream = 1, .capture_time_us = stamp}, payload, message);
    way.Send(message);
  };
  const std::int64_t cpu = Now(CLOCK_PROCESS_CPUTIME_ID);
  if (task.mode == Mode::kWholeWay) {
    AwaitPoses(poses, task, send);
  } else {
    KeepTime(task, send);
  }
  return Now(CLOCK_PROCESS_CPUTIME_ID) - cpu;
}

// One run of one way. Times in microseconds; processor times per message sent.
struct Result {
  double writer = 0.0;
  double reader = 0.0;
  std::array<double, 3> latency{};
  double received = 0.0;  // share of the messages
};

Result RunOnce(Way& way, const Task& task) {
  void* const memory =
      mmap(nullptr, sizeof(Reading), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) std::exit(1);
  auto* const reading = new (memory) Reading;
  const pid_t child = fork();
  if (child == 0) Read(way, task, *reading);
  way.StartWriter();
  const auto [publishers, writers] = MakePair();
  const pid_t publisher = task.mode == Mode::kWholeWay ? fork() : -1;
  if (publisher == 0) Publish(publishers, task);
  const double cpu = static_cast<double>(Write(way, task, writers));
  int status = 0;
  if (publisher > 0) waitpid(publisher, &status, 0);
  close(publishers);
  close(writers);
  if (waitpid(child, &status, 0) != child || status != 0) {
    std::fprintf(stderr, "error: the reader failed\n");
    std::exit(1);
  }
  const double count = task.count;
  Result result{cpu / count / 1e3,
                static_cast<double>(reading->cpu) / count / 1e3,
                {},
                static_cast<double>(reading->received) / count};
  for (std::size_t i = 0; i < 3; ++i) {
    result.latency[i] = static_cast<double>(reading->latency[i]) / 1e3;
  }
  munmap(memory, sizeof(Reading));
  return result;
}

struct Candidate {
  std::string name;
  std::function<std::unique_ptr<Way>()> make;
};

std::string Text(std::vector<double> values, int digits) {
  const load::Quartiles quartiles = load::QuartilesOf(std::move(values));
  return Between(quartiles.median, quartiles.low, quartiles.high, digits);
}

// The ratios compare with `first` in the same round. `idle` sends nothing; its processor times are
// taken off.
std::vector<std::string> Row(const Candidate& candidate, const std::vector<Result>& results,
                             const std::vector<Result>& first, const std::vector<Result>& idle) {
  std::vector<double> writer, reader, both, p50, p90, p99, cpu_ratio, latency_ratio;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto net = [&](const Result& r) {
      return r.writer + r.reader - idle[i].writer - idle[i].reader;
    };
    writer.push_back(results[i].writer - idle[i].writer);
    reader.push_back(results[i].reader - idle[i].reader);
    cpu_ratio.push_back(net(results[i]) / net(first[i]));
    p50.push_back(results[i].latency[0]);
    p90.push_back(results[i].latency[1]);
    p99.push_back(results[i].latency[2]);
    latency_ratio.push_back(results[i].latency[0] / first[i].latency[0]);
  }
  return {candidate.name,  Text(p50, 1),           Text(p90, 1),
          Text(p99, 1),    Text(latency_ratio, 2), Text(writer, 2),
          Text(reader, 2), Text(cpu_ratio, 2),     report::Fixed(results.back().received, 2)};
}

void Compare(const std::vector<Candidate>& candidates, const Task& task, int rounds) {
  std::vector<std::vector<Result>> results(candidates.size());
  // The first round warms up and is dropped.
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const auto way = candidates[i].make();
      const Result result = RunOnce(*way, task);
      if (round > 0) results[i].push_back(result);
    }
  }
  const bool whole = task.mode == Mode::kWholeWay;
  const std::string title = whole                       ? "From the publisher, the reader waits"
                            : task.mode == Mode::kPolls ? "The reader polls 60 times per second"
                                                        : "The reader waits";
  report::Table table{title + ", " + std::to_string(task.rate) + " messages per second",
                      {"way", "p50, us", "p90", "p99", "p50, ratio", "writer, us of CPU",
                       "reader, us of CPU", "CPU, ratio", "messages read"},
                      {}};
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    // On the whole way, waiting for poses is part of the writer's work.
    const std::vector<Result> idle = whole ? std::vector<Result>(results[0].size()) : results[0];
    table.rows.push_back(Row(candidates[i], results[i], results[1], idle));
  }
  std::fputs((report::ToMarkdown(table) + "\n").c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace
}  // namespace furrow::bench

int main(int argc, char** argv) {
  using namespace furrow::bench;
  std::vector<int> rates = {60, 1000, 10000};
  int rounds = 7;
  double seconds = 1.0;
  CLI::App app{"Compare UDP with shared memory for weights to a client on the same machine"};
  app.add_option("--rates", rates, "Messages per second")
      ->delimiter(',')
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--rounds", rounds, "Samples of each way, in turn")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--seconds", seconds, "Duration of a sample in seconds")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  ReadCommandLine(app, argc, argv);
  std::printf("%s\n\n", ToText(ThisMachine()).c_str());
  RunOnCore(0);
  const std::vector<Candidate> waiting = {
      {"nothing", Nothing},
      {"UDP, the client library", UdpLibrary},
      {"UDP again", UdpLibrary},
      {"UDP, bare recv()", UdpBare},
      {"ring, futex", [] { return SharedRing(Wake::kFutex); }},
      {"ring, eventfd and poll()", [] { return SharedRing(Wake::kEventfd); }},
  };
  const std::vector<Candidate> polling = {
      {"nothing", Nothing},
      {"UDP, the client library", UdpLibrary},
      {"UDP again", UdpLibrary},
      {"UDP, bare recv()", UdpBare},
      {"ring, nobody is woken", [] { return SharedRing(Wake::kNobody); }},
  };
  for (const int rate : rates) {
    const int count = std::max(1, static_cast<int>(rate * seconds));
    Compare(waiting, {rate, count, Mode::kWaits}, rounds);
    Compare(polling, {rate, count, Mode::kPolls}, rounds);
    Compare(waiting, {rate, count, Mode::kWholeWay}, rounds);
  }
  return 0;
}
