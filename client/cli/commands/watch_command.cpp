// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "client/cli/commands/commands.h"
#include "client/cli/common/endpoint.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/standard_output.h"
#include "client/cli/output/weight_writer.h"
#include "client/cli/receive/receive_events.h"

namespace furrow::cli {
namespace {

struct WatchOptions {
  SubscriptionOptions listen;
  TableFormat format = TableFormat::kTable;
  bool tcp = false;  // the default
  bool udp = false;
  bool u8 = false;
  bool drivers = false;
  bool timecode = false;
  protocol::SubscribeWeights request;
};

// Converts weight frames to rows. Names arrive first, and again when they change.
class WeightRows {
 public:
  WeightRows(const WatchOptions& options, client::Subscriber& subscriber)
      : subscriber_(subscriber),
        writer_(WeightWriter::Create(options.format, options.timecode)),
        left_(options.listen.frames) {}

  bool operator()(const client::Event& event) {
    if (event.kind == client::Event::Kind::kReply) {
      OnReply();
      return true;
    }
    const protocol::WeightFrame& frame = subscriber_.weights();
    // Skip held or decaying weights, which belong to no new pose, and frames whose names are
    // unknown.
    if (frame.age_us > 0 || !names_hash_ || frame.names_hash != *names_hash_) return true;
    if (!first_us_) first_us_ = event.header.capture_time_us;
    const double seconds = static_cast<double>(event.header.capture_time_us - *first_us_) * 1e-6;
    if (!writer_->Row({event.header.sequence, seconds, frame.timecode}, frame.values)) {
      failure_ = StandardOutputFailed();
      return false;
    }
    return --left_ != 0;
  }

  [[nodiscard]] int failure() const { return failure_; }

 private:
  void OnReply() {
    const protocol::SubscribeReply& reply = subscriber_.reply();
    if (reply.names.empty()) {
      std::fprintf(stderr, "furrow: waiting for the subject\n");
    } else if (names_hash_ != reply.names_hash) {
      names_hash_ = reply.names_hash;
      writer_->Names(reply.names);
    }
  }

  client::Subscriber& subscriber_;
  std::unique_ptr<WeightWriter> writer_;
  std::int64_t left_;  // rows to receive; 0: unlimited
  std::optional<std::uint64_t> names_hash_;
  std::optional<std::int64_t> first_us_;
  int failure_ = kDone;
};

int Watch(const WatchOptions& options) {
  const auto address = ParseHost(
      options.listen.host,
      {.pattern = true, .rate = true, .udp = !options.tcp, .security = options.listen.security});
  if (!address) return kUsage;
  int exit_code = kDone;
  auto transport = OpenTransport(*address, ChooseTransport(options.udp, options.tcp, *address),
                                 options.listen.once, &exit_code);
  if (!transport) return exit_code;
  client::Subscriber subscriber(std::move(transport), "furrow watch " FURROW_VERSION);
  protocol::SubscribeWeights request = options.request;
  ApplyAddress(*address, request);
  if (request.pattern == "*" && !address->pattern.empty()) request.pattern = address->pattern;
  if (options.u8) request.format = protocol::WeightFormat::kU8;
  if (options.drivers) request.source = protocol::WeightSource::kDriverValues;
  subscriber.Subscribe(request);
  WeightRows rows(options, subscriber);
  exit_code = ReceiveEvents(subscriber, std::ref(rows));
  return rows.failure() != kDone ? rows.failure() : exit_code;
}

}  // namespace

void AddWatch(CLI::App& app, Action& action) {
  auto options = std::make_shared<WatchOptions>();
  CLI::App* command = app.add_subcommand("watch", "Print the weights of a subject as they arrive");
  AddSubscriptionOptions(*command, options->listen, options->request, "weight frames",
                         "every pose");
  command
      ->add_option("--pattern", options->request.pattern,
                   "Weight names to receive, as comma-separated globs such as 'brow_*,knee_l_*'")
      ->capture_default_str();
  const std::map<std::string, TableFormat> formats{
      {"table", TableFormat::kTable}, {"csv", TableFormat::kCsv}, {"jsonl", TableFormat::kJsonl}};
  AddChoice(*command, "--format", options->format, formats, "Output format");
  auto* tcp = command->add_flag("--tcp", options->tcp,
                                "Receive over TCP, port 7400 (default without a token)");
  command->add_flag("--udp", options->udp, "Receive over UDP, port 7401 (default with a token)")
      ->excludes(tcp);
  command->add_flag("--u8", options->u8, "Receive 8-bit weights (error up to 1/510)");
  command->add_flag("--drivers", options->drivers,
                    "Receive driver values, before modulation and filter, instead of weights");
  command->add_flag(
      "--timecode", options->timecode,
      "Add a last column 'timecode' to CSV; other formats show it if the source sends it");
  command->callback([options, &action] { action = [options] { return Watch(*options); }; });
}

}  // namespace furrow::cli
