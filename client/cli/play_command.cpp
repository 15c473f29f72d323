// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

#include "client/cli/command.h"
#include "client/cli/endpoint.h"
#include "client/cli/exit_code.h"
#include "client/cli/interrupt.h"
#include "client/cli/play_source.h"
#include "client/cli/progress.h"
#include "client/cli/schedule.h"
#include "client/cli/spacing.h"
#include "client/cpp/publisher.h"

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
  double from = 0.0;
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
  // Sends the frames of `source` from number `first` on.
  Player(client::Publisher& publisher, std::uint16_t stream, const PlaySource& source, int first,
         const PlayOptions& options)
      : publisher_(publisher), stream_(stream), source_(source), first_(first), options_(options) {}

  // To the end, or an interrupt, or what makes going on useless.
  int Run() {
    const Schedule schedule(source_.times().subspan(static_cast<std::size_t>(first_)),
                            options_.rate);
    const auto encoding =
        options_.quantise ? protocol::PoseEncoding::Small() : protocol::PoseEncoding{};
    const std::int64_t capture_start = SystemMicroseconds();
    const std::int64_t send_start = SteadyMicroseconds();
    Progress progress("playing", schedule.count());
    protocol::PoseFrame pose;
    for (std::int64_t i = 0; options_.loop || i < schedule.count(); ++i) {
      const double seconds = schedule.Seconds(i);
      const std::int64_t due = send_start + std::llround(seconds * 1e6 / options_.speed);
      if (!WaitUntil(due)) break;
      source_.Fill(first_ + schedule.Frame(i), &pose);
      spacing_.Sent(due, SteadyMicroseconds());
      Note(publisher_.Send(stream_, pose, capture_start + std::llround(seconds * 1e6), encoding));
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
                   std::min(refused_, spacing_.count()), spacing_.count());
      return kNoConnection;
    }
    std::fprintf(stderr,
                 "furrow: %" PRId64 " poses; spacing off by %.3f ms on average, %.3f ms at most\n",
                 spacing_.count(), spacing_.mean_ms(), spacing_.largest_ms());
    return kDone;
  }

  client::Publisher& publisher_;
  std::uint16_t stream_;
  const PlaySource& source_;
  int first_;
  const PlayOptions& options_;
  Spacing spacing_;
  std::int64_t refused_ = 0;  // over UDP: answers that nobody listens at the port
  bool closed_ = false;
};

int PlayFile(const PlayOptions& options) {
  const auto source = PlaySource::Load(options.file);
  if (!source.ok()) return Fail(source.status());
  const auto times = source->times();
  const auto first = std::lower_bound(times.begin(), times.end(), times.front() + options.from);
  if (first == times.end()) {
    std::fprintf(stderr, "furrow: --from %g: %s ends after %.3f s\n", options.from,
                 options.file.c_str(), times.back() - times.front());
    return kBadInput;
  }
  int exit_code = kDone;
  auto transport = OpenTransport(
      options.host, options.tcp ? TransportKind::kTcp : TransportKind::kUdp, &exit_code);
  if (!transport) return exit_code;
  CatchInterrupts();
  client::Publisher publisher(std::move(transport));
  const std::string& subject = options.subject.empty() ? source->subject() : options.subject;
  const std::uint16_t stream =
      publisher.AddSubject(source->Offer(subject, options.scale), SteadyMicroseconds());
  exit_code = WaitUntilAccepted(publisher, stream, options.host);
  if (exit_code != kDone || Interrupted()) return exit_code;
  exit_code =
      Player(publisher, stream, *source, static_cast<int>(first - times.begin()), options).Run();
  publisher.Close();
  return exit_code;
}

}  // namespace

void AddPlay(CLI::App& app, Action& action) {
  auto options = std::make_shared<PlayOptions>();
  CLI::App* command = app.add_subcommand("play", "Sends a recording to a daemon, at its own pace");
  command
      ->add_option(
          "FILE", options->file,
          "BVH, glTF/GLB, VRMA, Live Link Face CSV or a take (FILE.mcap, FILE.mcap#SUBJECT)")
      ->required();
  command->add_option("--to", options->host, "HOST, HOST:PORT or [IPV6]:PORT of furrowd")
      ->required();
  auto* udp = command->add_flag("--udp", options->udp, "Send datagrams (default; port 7401)");
  command->add_flag("--tcp", options->tcp, "Send over a TCP connection (port 7400)")->excludes(udp);
  command->add_option("--subject", options->subject,
                      "Who is captured; default: whom a take names, else the file's name");
  command->add_option("--rate", options->rate, "Poses per second of recording; default: all it has")
      ->check(CLI::Range(0.001, 100000.0));
  command->add_option("--speed", options->speed, "How many times as fast as recorded")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  command->add_option("--from", options->from, "Seconds of the recording to leave out at its start")
      ->check(CLI::Range(0.0, 1e9))
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
