// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/joined.h"
#include "client/cli/commands/commands.h"
#include "client/cli/common/endpoint.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/inputs.h"
#include "client/cli/common/interrupt.h"
#include "client/cli/play/play_source.h"
#include "client/cli/play/session_player.h"
#include "client/cpp/acceptance.h"
#include "client/cpp/publisher.h"

namespace furrow::cli {
namespace {

using client::TransportKind;
using Kind = client::Acceptance::Kind;

struct PlayOptions {
  std::string file;
  std::string host;
  std::string subject;
  SecurityFlags security;
  motion::LoadOptions read;
  bool udp = false;  // the default
  bool tcp = false;
  bool once = false;  // do not connect again after a loss
  bool loop = false;
  bool quantise = false;
  bool floats = false;
  bool redundant = false;
  double rate = 0.0;
  double speed = 1.0;
  double from = 0.0;
  float scale = 1.0f;
};

// Prints why a skeleton was not accepted and returns the exit code.
int NotAccepted(const client::Acceptance& answer, const std::string& host) {
  switch (answer.kind) {
    case Kind::kAccepted:
    case Kind::kCancelled: return kDone;
    case Kind::kRefused:
      std::fprintf(stderr, "furrow: the skeleton was not accepted: %s\n", answer.reason.c_str());
      return kBadInput;
    case Kind::kError:
      std::fprintf(stderr, "furrow: the daemon reports an error: %s\n", answer.reason.c_str());
      return kFailed;
    case Kind::kNoAnswer:
    case Kind::kNoConnection: break;
  }
  std::fprintf(stderr, "furrow: no answer from %s%s (is furrowd running there?)\n", host.c_str(),
               answer.kind == Kind::kNoConnection ? ": connection refused" : "");
  return kNoConnection;
}

// Loads the subjects of the recording. Only a single subject can be renamed.
Result<std::vector<PlaySource>> LoadSources(const PlayOptions& options) {
  auto sources = PlaySource::Load(options.file, options.read);
  if (!sources.ok() || options.subject.empty() || sources->size() == 1) return sources;
  const std::string names = Joined(*sources, &PlaySource::subject);
  return Status(StatusCode::kInvalidArgument, "the take has several subjects: " + names,
                options.file,
                "to play one under another name, use: " + options.file + "#" +
                    sources->front().subject() + " --subject " + options.subject);
}

SessionSchedule MakeSchedule(const std::vector<PlaySource>& sources, const PlayOptions& options) {
  std::vector<SessionSchedule::Track> tracks;
  for (const PlaySource& source : sources) tracks.push_back({source.times(), source.start()});
  return SessionSchedule(tracks, options.rate, options.from);
}

// Prints the skeleton maps that match the sources.
void PrintMatches(const std::vector<PlaySource>& sources) {
  // The daemon finds the same map, unless it was started with another one.
  std::vector<wrinkle::Skeleton> skeletons;
  for (const PlaySource& source : sources) {
    auto skeleton = source.Skeleton();
    // The daemon rejects an invalid one, and says why.
    if (skeleton.ok()) skeletons.push_back(std::move(*skeleton));
  }
  PrintMatchesOf(skeletons);
}

// The transport that the options choose, or else the address.
TransportKind KindOf(const PlayOptions& options, const client::Address& address) {
  if (options.tcp) return TransportKind::kTcp;
  if (options.udp) return TransportKind::kUdp;
  return address.transport.value_or(TransportKind::kUdp);
}

protocol::PoseEncoding EncodingOf(const PlayOptions& options, TransportKind transport) {
  if (options.quantise) return protocol::PoseEncoding::Small();
  const bool fits = options.floats || transport == TransportKind::kTcp;
  return fits ? protocol::PoseEncoding{} : protocol::PoseEncoding::Fitting();
}

int PlayFile(PlayOptions options) {
  const auto address = ParseHost(options.host, {.udp = !options.tcp, .security = options.security});
  if (!address) return kUsage;
  if (options.subject.empty() && !address->subjects.empty()) {
    options.subject = address->subjects.front();
  }
  const auto sources = LoadSources(options);
  if (!sources.ok()) return Fail(sources.status());
  SessionSchedule schedule = MakeSchedule(*sources, options);
  if (schedule.count() == 0) {
    std::fprintf(stderr, "furrow: --from %g: %s ends after %.3f s\n", options.from,
                 options.file.c_str(), schedule.duration());
    return kBadInput;
  }
  PrintMatches(*sources);
  int exit_code = kDone;
  const TransportKind kind = KindOf(options, *address);
  auto transport = OpenTransport(*address, kind, options.once, &exit_code);
  if (!transport) return exit_code;
  // After loading: until here Ctrl-C may end the program at once, from here on it must say goodbye.
  CatchInterrupts();
  client::Publisher publisher(std::move(transport));
  std::vector<SessionPlayer::Track> tracks;
  // One offer at a time: the first rejection ends the command with its reason.
  for (const PlaySource& source : *sources) {
    const std::string& subject = options.subject.empty() ? source.subject() : options.subject;
    const std::uint16_t stream =
        publisher.AddSubject(source.Offer(subject, options.scale), SteadyMicroseconds());
    const client::Acceptance answer = client::WaitUntilAccepted(
        publisher, stream, SteadyMicroseconds, [] { return !Interrupted(); });
    if (answer.kind != Kind::kAccepted) return NotAccepted(answer, options.host);
    tracks.push_back({stream, &source});
  }
  SessionPlayer player(publisher, std::move(tracks), std::move(schedule),
                       {.speed = options.speed,
                        .loop = options.loop,
                        .once = options.once,
                        .encoding = EncodingOf(options, kind),
                        .redundant = options.redundant});
  exit_code = player.Run();
  // Without the goodbye, subscribers would see the subjects hold and decay first.
  publisher.Close();
  return exit_code;
}

}  // namespace

void AddPlay(CLI::App& app, Action& action) {
  auto options = std::make_shared<PlayOptions>();
  CLI::App* command = app.add_subcommand("play", "Send a recording to a daemon in real time");
  command
      ->add_option("FILE", options->file,
                   "Recording: BVH, glTF/GLB, VRMA, FBX, Collada, Live Link Face CSV or a take "
                   "(FILE.mcap plays all "
                   "subjects, FILE.mcap#SUBJECT one); or the name of a shipped recording "
                   "(performance, walk, ...)")
      ->required();
  command->add_option("--to", options->host, kHostHelp)->required();
  auto* udp = command->add_flag("--udp", options->udp, "Send over UDP, port 7401 (default)");
  command->add_flag("--tcp", options->tcp, "Send over TCP, port 7400")->excludes(udp);
  command->add_flag("--once", options->once, kOnceHelp);
  AddSecurityOptions(*command, options->security);
  command->add_option("--subject", options->subject,
                      "Name of the subject (default: the name in a take, or the file name)");
  command
      ->add_option("--rate", options->rate, "Poses per second of recording (default: every frame)")
      ->check(Within(0.001, 100000.0));
  command->add_option("--speed", options->speed, "Playback speed, as a multiple of real time")
      ->check(Within(0.001, 1000.0))
      ->capture_default_str();
  command->add_option("--from", options->from, "Seconds to skip at the start of the recording")
      ->check(Within(0.0, 1e9))
      ->capture_default_str();
  command->add_flag("--loop", options->loop, "Repeat until Ctrl-C; pose numbers continue");
  auto* redundant = command->add_flag(
      "--redundant", options->redundant,
      "Repeat the previous pose in each datagram where both fit, so that a lost datagram loses no "
      "pose; implies --quantise (UDP only)");
  auto* quantise = command->add_flag(
      "--quantise", options->quantise,
      "Send packed poses: 6 bytes per rotation (error up to 1.5e-4 rad), 6 per translation "
      "(error up to 1/65534 of the largest in the pose) and 2 per blend shape (error up to "
      "1/32768) (default over UDP: those that do not fit one datagram otherwise)");
  command
      ->add_flag("--floats", options->floats,
                 "Send poses as floats, in several datagrams if necessary (default over TCP)")
      ->excludes(quantise)
      ->excludes(redundant);
  command->add_option("--scale", options->scale, "Metres per unit of the recording's lengths")
      ->check(Within(1e-6, 1e6))
      ->capture_default_str();
  AddReadOptions(*command, options->read);
  command->callback([options, &action] { action = [options] { return PlayFile(*options); }; });
}

}  // namespace furrow::cli
