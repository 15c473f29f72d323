// SPDX-License-Identifier: Apache-2.0
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <unistd.h>

#include "base/status.h"
#include "client/cli/command.h"
#include "client/cli/endpoint.h"
#include "client/cli/exit_code.h"
#include "client/cli/file_output.h"
#include "client/cli/inputs.h"
#include "client/cli/listen.h"
#include "client/cli/output/take_listener.h"
#include "client/cli/progress.h"
#include "recording/take_poses.h"
#include "report/words.h"
#include "rig/rig_file.h"

namespace furrow::cli {
namespace {

using report::Counted;

struct RecordOptions {
  std::string host;
  std::filesystem::path out;
  std::vector<std::string> subjects;
  bool wait = false;
  double duration = 0.0;  // seconds; 0: until it is interrupted
  double rotate_megabytes = 0.0;
  double rotate_seconds = 0.0;
  std::string rig;
};

// How far it is: a bar where the end is known, else what there is so far. Silent in a pipe.
class RecordingLine {
 public:
  RecordingLine(std::int64_t start_us, std::int64_t duration_us) : start_us_(start_us) {
    if (duration_us > 0) bar_.emplace("recording", duration_us);
  }
  ~RecordingLine() {
    if (shown_us_ > 0) std::fputs("\r\033[K", stderr);
  }
  RecordingLine(const RecordingLine&) = delete;
  RecordingLine& operator=(const RecordingLine&) = delete;

  void Show(const TakeListener& take, std::int64_t now_us) {
    constexpr std::int64_t kInterval = 500'000;
    if (bar_) return bar_->Set(now_us - start_us_);
    if (!terminal_ || now_us - shown_us_ < kInterval) return;
    shown_us_ = now_us;
    std::fprintf(stderr, "\rrecording %.1f s, %s, %" PRIu64 " left out",
                 static_cast<double>(now_us - start_us_) * 1e-6,
                 Counted(take.num_poses(), "pose").c_str(), take.num_dropped());
  }

 private:
  std::int64_t start_us_;
  std::int64_t shown_us_ = 0;
  bool terminal_ = isatty(STDERR_FILENO) == 1;
  std::optional<Progress> bar_;
};

Result<recording::TakeFolderOptions> FolderOptions(const RecordOptions& options) {
  recording::TakeFolderOptions folder{
      .folder = options.out.parent_path(),
      .name = options.out.filename(),
      .rotate_bytes = static_cast<std::uint64_t>(options.rotate_megabytes * 1e6),
      .rotate_ns = static_cast<std::uint64_t>(options.rotate_seconds * 1e9),
      .rig_json = {}};
  if (options.rig.empty()) return folder;
  const auto rig = LoadRigArgument(options.rig);
  FURROW_RETURN_IF_ERROR(rig);
  folder.rig_json = character::RigToJson(*rig);
  return folder;
}

// `failed`: not all of it could be written.
void PrintSummary(const TakeListener& take, bool failed) {
  if (take.folder() == nullptr) return;
  std::fprintf(stderr, "furrow: %s and %s of %s %s %s", Counted(take.num_poses(), "pose").c_str(),
               Counted(take.num_weights(), "weight").c_str(), take.SubjectNames().c_str(),
               failed ? "came; 'furrow info' tells how many are in" : "in",
               take.folder()->path().c_str());
  if (take.folder()->num_files() > 1) {
    std::fprintf(stderr, " and %s before it",
                 Counted(take.folder()->num_files() - 1, "file").c_str());
  }
  std::fputs("\n", stderr);
  if (take.num_dropped() == 0) return;
  std::fprintf(stderr, "furrow: missing: %s; this computer or the network was too slow\n",
               Counted(take.num_dropped(), "frame").c_str());
}

// Whether there is something left to record of everybody: false once the last one has left.
bool HasMore(const TakeListener& take, const RecordOptions& options, Status* status) {
  if (!options.subjects.empty() || options.wait || take.num_present().value_or(1) > 0) return true;
  if (take.folder() == nullptr) {
    *status = Status(StatusCode::kUnavailable, "nobody is there to be recorded", options.host,
                     "start a publisher first, or wait for one: --wait");
  }
  return false;
}

// What listening comes to; the take is complete afterwards, whatever happened.
int ListenInto(TakeListener& take, client::Subscriber& subscriber, const RecordOptions& options) {
  const std::int64_t start = SteadyMicroseconds();
  const auto duration = static_cast<std::int64_t>(options.duration * 1e6);
  const bool everybody = options.subjects.empty();
  RecordingLine line(start, duration);
  Status status;
  ListenEnd end;
  end.goodbyes = options.wait || everybody ? 0 : 2 * static_cast<int>(options.subjects.size());
  // One that cannot be had does not end the recording of the others.
  end.outlives_errors = [&] { return everybody && take.num_present(); };
  end.lingers_us = 1'000'000;  // the weights of a pose that is recorded
  end.goes_on = [&] {
    const std::int64_t now = SteadyMicroseconds();
    line.Show(take, now);
    status = take.Flush(now);
    return status.ok() && (duration == 0 || now - start < duration) &&
           HasMore(take, options, &status);
  };
  const int exit_code = Listen(
      subscriber,
      [&](const client::Event& event) {
        status = take.OnEvent(event, subscriber, SteadyMicroseconds());
        return status.ok();
      },
      end);
  const Status closed = take.Close();
  if (!status.ok()) return Fail(status);
  return closed.ok() ? exit_code : Fail(closed);
}

int Record(const RecordOptions& options) {
  if (!recording::IsTakePath(options.out.string())) {
    std::fprintf(stderr, "furrow: --out %s: a take is called FILE.mcap\n", options.out.c_str());
    return kUsage;
  }
  std::error_code error;
  if (std::filesystem::exists(options.out, error)) {
    return Fail({StatusCode::kIo, "the file is there already", options.out.string(),
                 "choose another --out: nothing is overwritten"});
  }
  auto folder = FolderOptions(options);
  if (!folder.ok()) return Fail(folder.status());
  int exit_code = kDone;
  auto transport = OpenTransport(options.host, client::TransportKind::kTcp, &exit_code);
  if (!transport) return exit_code;
  client::Subscriber subscriber(std::move(transport), "furrow record " FURROW_VERSION);
  TakeListener take(*std::move(folder), SystemMicroseconds() - SteadyMicroseconds());
  for (const std::string& subject : options.subjects) take.Ask(subscriber, subject, options.wait);
  if (options.subjects.empty()) take.AskForAll(subscriber);
  exit_code = ListenInto(take, subscriber, options);
  PrintSummary(take, exit_code == kFailed);
  if (exit_code == kDone && take.folder() == nullptr) {
    return Fail({StatusCode::kUnavailable, "nobody came, so there is no file", options.host,
                 "start a publisher, or wait longer: --duration"});
  }
  return exit_code;
}

}  // namespace

void AddRecord(CLI::App& app, Action& action) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* command =
      app.add_subcommand("record", "Records poses and weights of a daemon's subjects as a take");
  command->add_option("HOST", options->host, "HOST, HOST:PORT or [IPV6]:PORT of furrowd")
      ->required();
  command->add_option("--out", options->out, "FILE.mcap; never overwritten")->required();
  command
      ->add_option("--subject", options->subjects,
                   "Who; may be given several times; default: everybody, also who comes later")
      ->allow_extra_args(false);
  command->add_flag("--wait", options->wait,
                    "Wait where nobody is there yet, and go on when all have left");
  command->add_option("--duration", options->duration, "Seconds; default: until Ctrl-C")
      ->check(Within(0.001, 1e9));
  command
      ->add_option("--rotate-megabytes", options->rotate_megabytes,
                   "The next file, FILE_2.mcap, begins at this size; default: never")
      ->check(Within(0.001, 1e9));
  command
      ->add_option("--rotate-seconds", options->rotate_seconds,
                   "And when a file covers so much time; default: never")
      ->check(Within(0.001, 1e9));
  command->add_option("--rig", options->rig,
                      "The daemon's wrinkle rig, to go with the take as an attachment");
  command->callback([options, &action] { action = [options] { return Record(*options); }; });
}

}  // namespace furrow::cli
