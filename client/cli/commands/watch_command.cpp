// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "client/cli/command.h"
#include "client/cli/endpoint.h"
#include "client/cli/exit_code.h"
#include "client/cli/file_output.h"
#include "client/cli/listen.h"
#include "client/cli/output/weight_writer.h"

namespace furrow::cli {
namespace {

using client::TransportKind;

struct WatchOptions {
  ListenOptions listen;
  TableFormat format = TableFormat::kTable;
  bool tcp = false;  // the default: said for clarity
  bool udp = false;
  bool u8 = false;
  bool drivers = false;
  protocol::SubscribeWeights request;
};

// Rows out of weight frames: names come first, and again when they change.
class WeightRows {
 public:
  WeightRows(const WatchOptions& options, client::Subscriber& subscriber)
      : subscriber_(subscriber),
        writer_(WeightWriter::Create(options.format)),
        left_(options.listen.frames) {}

  bool operator()(const client::Event& event) {
    if (event.kind == client::Event::Kind::kReply) {
      OnReply();
      return true;
    }
    const protocol::WeightFrame& frame = subscriber_.weights();
    // Weights that hold or decay carry no new pose; without names a frame cannot be read.
    if (frame.age_us > 0 || !names_hash_ || frame.names_hash != *names_hash_) return true;
    if (!first_us_) first_us_ = event.header.capture_time_us;
    const double seconds = static_cast<double>(event.header.capture_time_us - *first_us_) * 1e-6;
    if (!writer_->Row(event.header.sequence, seconds, frame.values)) {
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
  std::int64_t left_;  // 0: without end
  std::optional<std::uint64_t> names_hash_;
  std::optional<std::int64_t> first_us_;
  int failure_ = kDone;
};

int Watch(const WatchOptions& options) {
  int exit_code = kDone;
  auto transport = OpenTransport(
      options.listen.host, options.udp ? TransportKind::kUdp : TransportKind::kTcp, &exit_code);
  if (!transport) return exit_code;
  client::Subscriber subscriber(std::move(transport), "furrow watch " FURROW_VERSION);
  protocol::SubscribeWeights request = options.request;
  if (options.u8) request.format = protocol::WeightFormat::kU8;
  if (options.drivers) request.source = protocol::WeightSource::kDriverValues;
  subscriber.Subscribe(request);
  WeightRows rows(options, subscriber);
  exit_code = Listen(subscriber, std::ref(rows));
  return rows.failure() != kDone ? rows.failure() : exit_code;
}

}  // namespace

void AddWatch(CLI::App& app, Action& action) {
  auto options = std::make_shared<WatchOptions>();
  CLI::App* command = app.add_subcommand("watch", "Prints a subject's weights as they arrive");
  AddListenOptions(*command, options->listen, options->request, "every pose");
  command
      ->add_option("--pattern", options->request.pattern,
                   "Comma list of globs over weight names, as 'brow_*,knee_l_*'")
      ->capture_default_str();
  const std::map<std::string, TableFormat> formats{
      {"table", TableFormat::kTable}, {"csv", TableFormat::kCsv}, {"jsonl", TableFormat::kJsonl}};
  AddChoice(*command, "--format", options->format, formats, "table (default), csv or jsonl");
  auto* tcp = command->add_flag("--tcp", options->tcp, "Over TCP (default; port 7400)");
  command->add_flag("--udp", options->udp, "Over UDP (port 7401)")->excludes(tcp);
  command->add_flag("--u8", options->u8, "Ask for 8-bit weights (off by at most 1/510)");
  command->add_flag("--drivers", options->drivers, "Driver values before modulation and filter");
  command->callback([options, &action] { action = [options] { return Watch(*options); }; });
}

}  // namespace furrow::cli
