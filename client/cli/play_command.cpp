// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "client/cli/command.h"
#include "client/cli/endpoint.h"
#include "client/cli/exit_code.h"
#include "client/cli/inputs.h"
#include "client/cli/progress.h"
#include "client/cli/wire_pose.h"
#include "client/cpp/publisher.h"
#include "motion/clip.h"

namespace furrow::cli {
namespace {

using client::IoStatus;
using client::TransportKind;
using std::chrono::microseconds;
using std::chrono::milliseconds;

struct PlayOptions {
  std::string file;
  std::string host;
  std::string subject;
  bool udp = false;  // the default: said for clarity
  bool tcp = false;
  bool loop = false;
  bool quantise = false;
  double rate = 0.0;
  double speed = 1.0;
  float scale = 1.0f;
};

// Which frames are sent, and when: seconds of the recording's own time since its start.
struct Schedule {
  std::vector<int> frames;
  std::vector<double> seconds;
  double lap = 0.0;  // from the start of one round to the next
};

Schedule MakeSchedule(const motion::Clip& clip, double rate) {
  Schedule schedule;
  const double start = clip.times.front();
  if (rate <= 0.0) {
    for (int frame = 0; frame < clip.num_frames(); ++frame) {
      schedule.frames.push_back(frame);
      schedule.seconds.push_back(clip.times[frame] - start);
    }
    const int last = clip.num_frames() - 1;
    schedule.lap = clip.duration() + (last > 0 ? clip.duration() / last : 1.0 / 30.0);
    return schedule;
  }
  const auto count = static_cast<std::int64_t>(std::floor(clip.duration() * rate + 1e-6)) + 1;
  for (std::int64_t i = 0; i < count; ++i) {
    const double seconds = static_cast<double>(i) / rate;
    const auto after =
        std::upper_bound(clip.times.begin(), clip.times.end(), start + seconds + 1e-9);
    schedule.frames.push_back(static_cast<int>(after - clip.times.begin()) - 1);
    schedule.seconds.push_back(seconds);
  }
  schedule.lap = static_cast<double>(count) / rate;
  return schedule;
}

// Offers the skeleton and waits for the answer; prints why when there is none.
int WaitUntilAccepted(client::Publisher& publisher, std::uint16_t stream, const std::string& host) {
  const std::int64_t deadline = SteadyMicroseconds() + 5'000'000;
  IoStatus last = IoStatus::kTimeout;
  while (SteadyMicroseconds() < deadline) {
    const IoStatus status = publisher.Poll(SteadyMicroseconds(), milliseconds(50));
    if (publisher.accepted(stream)) return kDone;
    if (!publisher.rejection(stream).empty()) {
      std::fprintf(stderr, "furrow: the daemon refuses this skeleton: %s\n",
                   publisher.rejection(stream).c_str());
      return kBadInput;
    }
    if (status != IoStatus::kTimeout) last = status;
    if (status == IoStatus::kClosed) break;
    if (status == IoStatus::kNoConnection) std::this_thread::sleep_for(milliseconds(50));
  }
  if (!publisher.last_error().empty()) {
    std::fprintf(stderr, "furrow: the daemon says: %s\n", publisher.last_error().c_str());
    return kFailed;
  }
  std::fprintf(stderr, "furrow: nobody answers at %s%s (is furrowd running there?)\n", host.c_str(),
               last == IoStatus::kNoConnection ? ": connection refused" : "");
  return kNoConnection;
}

int SendAll(client::Publisher& publisher, std::uint16_t stream, const motion::Clip& clip,
            const PlayOptions& options) {
  const Schedule schedule = MakeSchedule(clip, options.rate);
  const auto encoding =
      options.quantise ? protocol::PoseEncoding::Small() : protocol::PoseEncoding{};
  const std::int64_t capture_start = SystemMicroseconds();
  const std::int64_t send_start = SteadyMicroseconds();
  Progress progress("playing", static_cast<std::int64_t>(schedule.frames.size()));
  protocol::PoseFrame pose;
  double lap_start = 0.0;
  std::int64_t refused = 0;
  do {
    for (std::size_t i = 0; i < schedule.frames.size(); ++i) {
      const double seconds = lap_start + schedule.seconds[i];
      const std::int64_t due = send_start + std::llround(seconds * 1e6 / options.speed);
      // Answers are read while waiting: a daemon that was restarted asks for the skeleton again.
      for (std::int64_t now = SteadyMicroseconds(); now < due; now = SteadyMicroseconds()) {
        const auto left = std::chrono::duration_cast<milliseconds>(microseconds(due - now));
        const IoStatus status = left.count() > 0 ? publisher.Poll(now, left) : IoStatus::kTimeout;
        if (status == IoStatus::kClosed) {
          std::fprintf(stderr, "furrow: the daemon closed the connection\n");
          return kNoConnection;
        }
        const std::int64_t rest = due - SteadyMicroseconds();
        if (rest > 0 && (left.count() == 0 || status == IoStatus::kNoConnection)) {
          std::this_thread::sleep_for(microseconds(rest));
        }
      }
      (void)publisher.Poll(SteadyMicroseconds(), milliseconds(0));
      FillPose(clip, schedule.frames[i], &pose);
      const IoStatus sent =
          publisher.Send(stream, pose, capture_start + std::llround(seconds * 1e6), encoding);
      if (sent == IoStatus::kClosed) {
        std::fprintf(stderr, "furrow: the daemon closed the connection\n");
        return kNoConnection;
      }
      if (sent != IoStatus::kOk) ++refused;
      progress.Set(static_cast<std::int64_t>(i) + 1);
    }
    lap_start += schedule.lap;
  } while (options.loop);
  if (refused > 0) {
    std::fprintf(stderr, "furrow: %lld of %zu poses found nobody listening\n",
                 static_cast<long long>(refused), schedule.frames.size());
    return kNoConnection;
  }
  return kDone;
}

int PlayFile(const PlayOptions& options) {
  const auto clip = LoadClipArgument(options.file);
  if (!clip.ok()) return Fail(clip.status());
  if (clip->num_frames() == 0) {
    return Fail({StatusCode::kInvalidArgument, "the recording has no frames", options.file});
  }
  int exit_code = kDone;
  auto transport = OpenTransport(
      options.host, options.tcp ? TransportKind::kTcp : TransportKind::kUdp, &exit_code);
  if (!transport) return exit_code;
  client::Publisher publisher(std::move(transport));
  const std::string subject = options.subject.empty()
                                  ? std::filesystem::path(options.file).stem().string()
                                  : options.subject;
  const std::uint16_t stream =
      publisher.AddSubject(OfferOf(*clip, subject, options.scale), SteadyMicroseconds());
  exit_code = WaitUntilAccepted(publisher, stream, options.host);
  if (exit_code != kDone) return exit_code;
  exit_code = SendAll(publisher, stream, *clip, options);
  publisher.Close();
  return exit_code;
}

}  // namespace

void AddPlay(CLI::App& app, Action& action) {
  auto options = std::make_shared<PlayOptions>();
  CLI::App* command = app.add_subcommand("play", "Sends a recording to a daemon, at its own pace");
  command->add_option("FILE", options->file, "BVH, glTF/GLB, VRMA or Live Link Face CSV")
      ->required();
  command->add_option("--to", options->host, "HOST, HOST:PORT or [IPV6]:PORT of furrowd")
      ->required();
  auto* udp = command->add_flag("--udp", options->udp, "Send datagrams (default; port 7401)");
  command->add_flag("--tcp", options->tcp, "Send over a TCP connection (port 7400)")->excludes(udp);
  command->add_option("--subject", options->subject, "Who is captured; default: the file's name");
  command->add_option("--rate", options->rate, "Poses per second of recording; default: all it has")
      ->check(CLI::Range(0.001, 100000.0));
  command->add_option("--speed", options->speed, "How many times as fast as recorded")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  command->add_flag("--loop", options->loop, "Begin again at the end, with the numbers going on");
  command->add_flag("--quantise", options->quantise,
                    "Send rotations in 6 bytes (off by at most 1.5e-4 rad) instead of 16");
  command->add_option("--scale", options->scale, "Metres per unit of the recording's lengths")
      ->check(CLI::Range(1e-6, 1e6))
      ->capture_default_str();
  command->callback([options, &action] { action = [options] { return PlayFile(*options); }; });
}

}  // namespace furrow::cli
