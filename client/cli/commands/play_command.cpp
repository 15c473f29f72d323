// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/command.h"
#include "client/cli/endpoint.h"
#include "client/cli/exit_code.h"
#include "client/cli/interrupt.h"
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
  bool udp = false;  // the default: said for clarity
  bool tcp = false;
  bool loop = false;
  bool quantise = false;
  double rate = 0.0;
  double speed = 1.0;
  double from = 0.0;
  float scale = 1.0f;
};

// What to exit with where a skeleton is not accepted; prints why.
int NotAccepted(const client::Acceptance& answer, const std::string& host) {
  switch (answer.kind) {
    case Kind::kAccepted:
    case Kind::kGivenUp: return kDone;
    case Kind::kRefused:
      std::fprintf(stderr, "furrow: this skeleton is refused: %s\n", answer.reason.c_str());
      return kBadInput;
    case Kind::kError:
      std::fprintf(stderr, "furrow: the daemon says: %s\n", answer.reason.c_str());
      return kFailed;
    case Kind::kNobody:
    case Kind::kNoConnection: break;
  }
  std::fprintf(stderr, "furrow: nobody answers at %s%s (is furrowd running there?)\n", host.c_str(),
               answer.kind == Kind::kNoConnection ? ": connection refused" : "");
  return kNoConnection;
}

// The subjects of the recording, under the name they are to have.
Result<std::vector<PlaySource>> LoadSources(const PlayOptions& options) {
  auto sources = PlaySource::Load(options.file);
  if (!sources.ok() || options.subject.empty() || sources->size() == 1) return sources;
  std::string names;
  for (const PlaySource& source : *sources) names += (names.empty() ? "" : ", ") + source.subject();
  return Status(StatusCode::kInvalidArgument, "the take has several subjects: " + names,
                options.file,
                "to play one under another name: " + options.file + "#" +
                    sources->front().subject() + " --subject " + options.subject);
}

SessionSchedule MakeSchedule(const std::vector<PlaySource>& sources, const PlayOptions& options) {
  std::vector<SessionSchedule::Track> tracks;
  for (const PlaySource& source : sources) tracks.push_back({source.times(), source.start()});
  return SessionSchedule(tracks, options.rate, options.from);
}

int PlayFile(const PlayOptions& options) {
  const auto sources = LoadSources(options);
  if (!sources.ok()) return Fail(sources.status());
  SessionSchedule schedule = MakeSchedule(*sources, options);
  if (schedule.count() == 0) {
    std::fprintf(stderr, "furrow: --from %g: %s ends after %.3f s\n", options.from,
                 options.file.c_str(), schedule.duration());
    return kBadInput;
  }
  int exit_code = kDone;
  auto transport = OpenTransport(
      options.host, options.tcp ? TransportKind::kTcp : TransportKind::kUdp, &exit_code);
  if (!transport) return exit_code;
  CatchInterrupts();
  client::Publisher publisher(std::move(transport));
  std::vector<SessionPlayer::Track> tracks;
  for (const PlaySource& source : *sources) {
    const std::string& subject = options.subject.empty() ? source.subject() : options.subject;
    const std::uint16_t stream =
        publisher.AddSubject(source.Offer(subject, options.scale), SteadyMicroseconds());
    const client::Acceptance answer = client::WaitUntilAccepted(
        publisher, stream, SteadyMicroseconds, [] { return !Interrupted(); });
    if (answer.kind != Kind::kAccepted) return NotAccepted(answer, options.host);
    tracks.push_back({stream, &source});
  }
  SessionPlayer player(
      publisher, std::move(tracks), std::move(schedule),
      {.speed = options.speed,
       .loop = options.loop,
       .encoding = options.quantise ? protocol::PoseEncoding::Small() : protocol::PoseEncoding{}});
  exit_code = player.Run();
  publisher.Close();
  return exit_code;
}

}  // namespace

void AddPlay(CLI::App& app, Action& action) {
  auto options = std::make_shared<PlayOptions>();
  CLI::App* command = app.add_subcommand("play", "Sends a recording to a daemon, at its own pace");
  command
      ->add_option("FILE", options->file,
                   "BVH, glTF/GLB, VRMA, Live Link Face CSV or a take (FILE.mcap: everybody in it; "
                   "FILE.mcap#SUBJECT)")
      ->required();
  command->add_option("--to", options->host, "HOST, HOST:PORT or [IPV6]:PORT of furrowd")
      ->required();
  auto* udp = command->add_flag("--udp", options->udp, "Send datagrams (default; port 7401)");
  command->add_flag("--tcp", options->tcp, "Send over a TCP connection (port 7400)")->excludes(udp);
  command->add_option("--subject", options->subject,
                      "Who is captured; default: whom a take names, else the file's name");
  command->add_option("--rate", options->rate, "Poses per second of recording; default: all it has")
      ->check(Within(0.001, 100000.0));
  command->add_option("--speed", options->speed, "How many times as fast as recorded")
      ->check(Within(0.001, 1000.0))
      ->capture_default_str();
  command->add_option("--from", options->from, "Seconds of the recording to leave out at its start")
      ->check(Within(0.0, 1e9))
      ->capture_default_str();
  command->add_flag("--loop", options->loop,
                    "Begin again at the end, until Ctrl-C; the numbers go on");
  command->add_flag("--quantise", options->quantise,
                    "Send 6 bytes a rotation (off by at most 1.5e-4 rad) and a translation (off by "
                    "1/65534 of the largest in the pose), 2 a blend shape (off by 1/32768)");
  command->add_option("--scale", options->scale, "Metres per unit of the recording's lengths")
      ->check(Within(1e-6, 1e6))
      ->capture_default_str();
  command->callback([options, &action] { action = [options] { return PlayFile(*options); }; });
}

}  // namespace furrow::cli
