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
#include "base/text.h"
#include "client/cli/commands/commands.h"
#include "client/cli/common/endpoint.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/inputs.h"
#include "client/cli/common/progress.h"
#include "client/cli/common/standard_output.h"
#include "client/cli/receive/receive_events.h"
#include "client/cli/receive/take_recorder.h"
#include "motion/clip/clip.h"
#include "recording/take_poses.h"
#include "rig/rig_file.h"

namespace furrow::cli {
namespace {

struct RecordOptions {
  std::string host;
  std::filesystem::path out;
  std::vector<std::string> subjects;
  SecurityFlags security;
  bool wait = false;
  bool once = false;      // do not connect again after a loss
  double duration = 0.0;  // seconds; 0: until an interrupt
  double rotate_megabytes = 0.0;
  double rotate_seconds = 0.0;
  std::string rig;
  motion::LoadOptions poses;  // of the rig
};

// Progress on a terminal: a bar if the duration is known, otherwise the current counts.
class RecordingLine {
 public:
  RecordingLine(std::int64_t start_us, std::int64_t duration_us) : start_us_(start_us) {
    if (duration_us > 0) bar_.emplace("recording", duration_us);
  }
  ~RecordingLine() {
    // Erases the line, so that the summary stands alone.
    if (shown_us_ > 0) std::fputs("\r\033[K", stderr);
  }
  RecordingLine(const RecordingLine&) = delete;
  RecordingLine& operator=(const RecordingLine&) = delete;

  void Show(const TakeRecorder& take, std::int64_t now_us) {
    constexpr std::int64_t kInterval = 500'000;
    if (bar_) return bar_->Set(now_us - start_us_);
    if (!terminal_ || now_us - shown_us_ < kInterval) return;
    shown_us_ = now_us;
    std::fprintf(stderr, "\rrecording %.1f s, %s, %" PRIu64 " dropped",
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
  // The rig travels with the take, so that its weights can be explained later.
  const auto rig = LoadRigArgument(options.rig, options.poses);
  FURROW_RETURN_IF_ERROR(rig);
  folder.rig_json = rig::RigToJson(*rig);
  return folder;
}

// `failed`: some data could not be written.
void PrintSummary(const TakeRecorder& take, bool failed) {
  if (take.folder() == nullptr) return;
  std::fprintf(stderr, "furrow: %s and %s of %s %s %s", Counted(take.num_poses(), "pose").c_str(),
               Counted(take.num_weights(), "weight").c_str(), take.SubjectNames().c_str(),
               failed ? "received; 'furrow info' shows how many are in" : "in",
               take.folder()->path().c_str());
  if (take.folder()->num_files() > 1) {
    std::fprintf(stderr, " and %s before it",
                 Counted(take.folder()->num_files() - 1, "file").c_str());
  }
  std::fputs("\n", stderr);
  if (take.num_dropped() == 0) return;
  std::fprintf(stderr, "furrow: %s missing, because this computer or the network was too slow\n",
               Counted(take.num_dropped(), "frame").c_str());
}

// When recording all subjects: returns false after the last one has left.
bool HasMore(const TakeRecorder& take, const RecordOptions& options, Status* status) {
  if (!options.subjects.empty() || options.wait || take.num_present().value_or(1) > 0) return true;
  if (take.folder() == nullptr) {
    *status = Status(StatusCode::kUnavailable, "no subject is connected", options.host,
                     "start a publisher first, or use --wait");
  }
  return false;
}

// Records until the end and completes the take, even after an error. Returns the exit code.
int RecordInto(TakeRecorder& take, client::Subscriber& subscriber, const RecordOptions& options) {
  const std::int64_t start = SteadyMicroseconds();
  const auto duration = static_cast<std::int64_t>(options.duration * 1e6);
  const bool all_subjects = options.subjects.empty();
  RecordingLine line(start, duration);
  Status status;
  StopConditions stop;
  // Poses and weights are two subscriptions of each subject.
  stop.goodbyes = options.wait || all_subjects ? 0 : 2 * static_cast<int>(options.subjects.size());
  // A subject that is unavailable does not end the recording of the others.
  stop.survives_errors = [&] { return all_subjects && take.num_present(); };
  stop.on_return = [&] { take.OnReturn(); };
  stop.drain_us = 1'000'000;  // wait for the weights of the last recorded pose
  stop.keep_going = [&] {
    const std::int64_t now = SteadyMicroseconds();
    line.Show(take, now);
    status = take.Flush(now);
    return status.ok() && (duration == 0 || now - start < duration) &&
           HasMore(take, options, &status);
  };
  const int exit_code = ReceiveEvents(
      subscriber,
      [&](const client::Event& event) {
        status = take.OnEvent(event, subscriber, SteadyMicroseconds());
        return status.ok();
      },
      stop);
  // In any case, so that what was received is readable.
  const Status closed = take.Close();
  if (!status.ok()) return Fail(status);
  return closed.ok() ? exit_code : Fail(closed);
}

int Record(RecordOptions options) {
  const auto address =
      ParseHost(options.host, {.several_subjects = true, .security = options.security});
  if (!address) return kUsage;
  if (options.subjects.empty()) options.subjects = address->subjects;
  if (!recording::IsTakePath(options.out.string())) {
    std::fprintf(stderr, "furrow: --out %s: the name of a take must be FILE.mcap\n",
                 options.out.c_str());
    return kUsage;
  }
  std::error_code error;
  // A recording cannot be repeated, so it never overwrites a file.
  if (std::filesystem::exists(options.out, error)) {
    return Fail({StatusCode::kIo, "the file already exists", options.out.string(),
                 "choose another --out; takes are never overwritten"});
  }
  auto folder = FolderOptions(options);
  if (!folder.ok()) return Fail(folder.status());
  int exit_code = kDone;
  auto transport = OpenTransport(*address, client::TransportKind::kTcp, options.once, &exit_code);
  if (!transport) return exit_code;
  client::Subscriber subscriber(std::move(transport), "furrow record " FURROW_VERSION);
  // The offset is read once: the time of the take does not jump if the system clock is set.
  TakeRecorder take(*std::move(folder), SystemMicroseconds() - SteadyMicroseconds());
  for (const std::string& subject : options.subjects)
    take.Subscribe(subscriber, subject, options.wait);
  if (options.subjects.empty()) take.SubscribeToAll(subscriber);
  exit_code = RecordInto(take, subscriber, options);
  const bool is_empty = take.folder() == nullptr || take.folder()->RemoveIfEmpty();
  if (!is_empty) PrintSummary(take, exit_code == kFailed);
  if (exit_code == kDone && is_empty) {
    return Fail({StatusCode::kUnavailable, "no subject connected; no file was written",
                 options.host, "start a publisher, or wait longer with --duration"});
  }
  return exit_code;
}

}  // namespace

void AddRecord(CLI::App& app, Action& action) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* command =
      app.add_subcommand("record", "Record the poses and weights of a daemon's subjects as a take");
  command->add_option("HOST", options->host, kHostHelp)->required();
  command
      ->add_option("--out", options->out,
                   "Take to write, FILE.mcap; an existing file is never overwritten")
      ->required();
  command
      ->add_option("--subject", options->subjects,
                   "Name of a subject (repeatable; default: all subjects, including later ones)")
      ->allow_extra_args(false);
  command->add_flag(
      "--wait", options->wait,
      "Wait for subjects that are not connected yet, and continue when all have left");
  command->add_flag("--once", options->once, kOnceHelp);
  AddSecurityOptions(*command, options->security);
  command
      ->add_option("--duration", options->duration,
                   "Length of the recording, in seconds (default: until Ctrl-C)")
      ->check(Within(0.001, 1e9));
  command
      ->add_option("--rotate-megabytes", options->rotate_megabytes,
                   "Start the next file, FILE_2.mcap, at this size in megabytes (default: never)")
      ->check(Within(0.001, 1e9));
  command
      ->add_option("--rotate-seconds", options->rotate_seconds,
                   "Start the next file after this time, in seconds (default: never)")
      ->check(Within(0.001, 1e9));
  command->add_option(
      "--rig", options->rig,
      "The daemon's wrinkle rig, by file or shipped name, to attach to the take (default: "
      "none)");
  AddBvhOptions(*command, options->poses);
  command->callback([options, &action] { action = [options] { return Record(*options); }; });
}

}  // namespace furrow::cli
