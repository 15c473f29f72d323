// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "client/cli/command.h"
#include "client/cli/endpoint.h"
#include "client/cli/exit_code.h"
#include "client/cli/inputs.h"
#include "client/cli/interrupt.h"
#include "client/cli/progress.h"
#include "client/cli/schedule.h"
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

bool IsOver(IoStatus status) {
  return status == IoStatus::kClosed || status == IoStatus::kMalformed;
}

// Offers the skeleton and waits for the answer; prints why when there is none.
int WaitUntilAccepted(client::Publisher& publisher, std::uint16_t stream, const std::string& host) {
  const std::int64_t deadline = SteadyMicroseconds() + 5'000'000;
  IoStatus last = IoStatus::kTimeout;
  while (SteadyMicroseconds() < deadline && !Interrupted()) {
    const IoStatus status = publisher.Poll(SteadyMicroseconds(), milliseconds(50));
    if (publisher.accepted(stream)) return kDone;
    if (!publisher.rejection(stream).empty()) {
      std::fprintf(stderr, "furrow: this skeleton is refused: %s\n",
                   publisher.rejection(stream).c_str());
      return kBadInput;
    }
    if (status != IoStatus::kTimeout) last = status;
    if (IsOver(status)) break;
    if (status == IoStatus::kNoConnection) std::this_thread::sleep_for(milliseconds(50));
  }
  if (Interrupted()) return kDone;
  if (!publisher.last_error().empty()) {
    std::fprintf(stderr, "furrow: the daemon says: %s\n", publisher.last_error().c_str());
    return kFailed;
  }
  std::fprintf(stderr, "furrow: nobody answers at %s%s (is furrowd running there?)\n", host.c_str(),
               last == IoStatus::kNoConnection ? ": connection refused" : "");
  return kNoConnection;
}

// Sends the poses of an accepted stream, each at its time.
class Player {
 public:
  Player(client::Publisher& publisher, std::uint16_t stream, const motion::Clip& clip,
         const PlayOptions& options)
      : publisher_(publisher), stream_(stream), clip_(clip), options_(options) {}

  // To the end, or an interrupt, or what makes going on useless.
  int Run() {
    const Schedule schedule(clip_, options_.rate);
    const auto encoding =
        options_.quantise ? protocol::PoseEncoding::Small() : protocol::PoseEncoding{};
    const std::int64_t capture_start = SystemMicroseconds();
    const std::int64_t send_start = SteadyMicroseconds();
    Progress progress("playing", schedule.count());
    protocol::PoseFrame pose;
    for (std::int64_t i = 0; options_.loop || i < schedule.count(); ++i) {
      const double seconds = schedule.Seconds(i);
      if (!WaitUntil(send_start + std::llround(seconds * 1e6 / options_.speed))) break;
      FillPose(clip_, schedule.Frame(i), &pose);
      Note(publisher_.Send(stream_, pose, capture_start + std::llround(seconds * 1e6), encoding));
      ++sent_;
      progress.Set(i % schedule.count() + 1);
    }
    return Report();
  }

 private:
  // Reads answers meanwhile: a daemon that was restarted asks for the skeleton again. False when
  // there is no use in going on.
  bool WaitUntil(std::int64_t due_us) {
    constexpr std::int64_t kLongestWait = 100'000;  // until the next look at interrupts
    Note(publisher_.Poll(SteadyMicroseconds(), milliseconds(0)));
    for (;;) {
      if (closed_ || Interrupted() || !publisher_.rejection(stream_).empty()) return false;
      const std::int64_t now = SteadyMicroseconds();
      if (now >= due_us) return true;
      const microseconds wait(std::min(due_us - now, kLongestWait));
      const auto whole = std::chrono::duration_cast<milliseconds>(wait);
      const IoStatus status = whole.count() > 0 ? publisher_.Poll(now, whole) : IoStatus::kTimeout;
      Note(status);
      // A refusal comes at once, and a rest of less than a millisecond cannot be polled.
      if (whole.count() == 0 || status == IoStatus::kNoConnection) {
        std::this_thread::sleep_for(wait);
      }
    }
  }

  void Note(IoStatus status) {
    closed_ = closed_ || IsOver(status);
    if (status == IoStatus::kNoConnection) ++refused_;
  }

  int Report() const {
    if (closed_) {
      std::fprintf(stderr, "furrow: the daemon closed the connection\n");
      return kNoConnection;
    }
    if (const std::string& why = publisher_.rejection(stream_); !why.empty()) {
      std::fprintf(stderr, "furrow: the daemon takes no more poses: %s\n", why.c_str());
      return kFailed;
    }
    if (refused_ > 0) {
      std::fprintf(stderr, "furrow: nobody listened for %" PRId64 " of %" PRId64 " poses\n",
                   std::min(refused_, sent_), sent_);
      return kNoConnection;
    }
    return kDone;
  }

  client::Publisher& publisher_;
  std::uint16_t stream_;
  const motion::Clip& clip_;
  const PlayOptions& options_;
  std::int64_t sent_ = 0;
  std::int64_t refused_ = 0;  // over UDP: answers that nobody listens at the port
  bool closed_ = false;
};

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
  CatchInterrupts();
  client::Publisher publisher(std::move(transport));
  const std::string subject = options.subject.empty()
                                  ? std::filesystem::path(options.file).stem().string()
                                  : options.subject;
  const std::uint16_t stream =
      publisher.AddSubject(OfferOf(*clip, subject, options.scale), SteadyMicroseconds());
  exit_code = WaitUntilAccepted(publisher, stream, options.host);
  if (exit_code != kDone || Interrupted()) return exit_code;
  exit_code = Player(publisher, stream, *clip, options).Run();
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
  command->add_flag("--loop", options->loop,
                    "Begin again at the end, until Ctrl-C; the numbers go on");
  command->add_flag("--quantise", options->quantise,
                    "Send 6 bytes a rotation (off by at most 1.5e-4 rad) and a translation (off by "
                    "1/65534 of the largest in the pose), 2 a blend shape (off by 1/32768)");
  command->add_option("--scale", options->scale, "Metres per unit of the recording's lengths")
      ->check(CLI::Range(1e-6, 1e6))
      ->capture_default_str();
  command->callback([options, &action] { action = [options] { return PlayFile(*options); }; });
}

}  // namespace furrow::cli
