// SPDX-License-Identifier: Apache-2.0
// Measures sending weights to 64 subscribers: sendto compared with the daemon's batched path. Both
// write each subscriber's envelope before the same payload and send to the same addresses. Received
// datagrams are read between the batches, outside the measurement.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>
#include <nlohmann/json.hpp>

#include "bench/report/aims.h"
#include "bench/report/command_line.h"
#include "bench/report/interleave.h"
#include "bench/report/results.h"
#include "client/load/measure/quartiles.h"
#include "protocol/codec/codec.h"
#include "protocol/framing/bundle.h"
#include "report/table.h"
#include "server/net/udp/udp_sender.h"

namespace furrow::bench {
namespace {

using asio::ip::udp;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kSubscribers = 64;
constexpr double kAim = 0.45;

struct Subscriber {
  explicit Subscriber(asio::io_context& io)
      : socket(io, udp::endpoint(asio::ip::address_v4::loopback(), 0)),
        to(socket.local_endpoint()) {
    socket.set_option(asio::socket_base::receive_buffer_size(4 << 20));
    socket.non_blocking(true);
  }
  udp::socket socket;
  udp::endpoint to;
};

// The path of weights from the hub to the sockets, with several subjects in a batch.
class FanOut {
 public:
  FanOut(int subjects, int weights) : subjects_(subjects) {
    for (std::size_t i = 0; i < kSubscribers; ++i) subscribers_.push_back(Subscriber(io_));
    protocol::WeightFrame frame;
    frame.names_hash = 7;
    for (int i = 0; i < weights; ++i) frame.values.push_back(static_cast<float>(i % 8) / 8.0f);
    Bytes message;
    protocol::Encoder().Encode({.session = 1}, frame, message);
    payload_.assign(message.begin() + protocol::kEnvelopeBytes, message.end());
    socket_.non_blocking(true);
    sender_.Open(socket_.native_handle());
  }

  [[nodiscard]] std::size_t message_bytes() const {
    return protocol::kEnvelopeBytes + payload_.size();
  }

  void SendPlain() {
    ForEach([this](std::size_t, const udp::endpoint& to) {
      asio::error_code full;  // lost datagrams are counted on receipt
      socket_.send_to(asio::buffer(message_), to, 0, full);
    });
  }
  void SendPacked(server::Packing packing) {
    ForEach([this, packing](std::size_t key, const udp::endpoint& to) {
      std::ranges::copy(message_, sender_.Prepare().begin());
      sender_.Commit(key, to, message_.size(), packing);
    });
    sender_.Flush();
  }

  // Reads the received datagrams. Returns false if some were lost.
  [[nodiscard]] bool Drain() {
    std::size_t messages = 0;
    for (Subscriber& subscriber : subscribers_) {
      for (;;) {
        asio::error_code error;
        const std::size_t size = subscriber.socket.receive(asio::buffer(received_), 0, error);
        if (error) break;
        ++datagrams_;
        protocol::Unbundler unbundler;
        (void)unbundler.Open(std::span(received_).first(size));
        std::span<const std::uint8_t> message;
        while (unbundler.Next(message)) messages += message.size() == message_bytes() ? 1 : 0;
      }
    }
    return messages == kSubscribers * static_cast<std::size_t>(subjects_);
  }
  // Received since the last call.
  [[nodiscard]] std::size_t TakeDatagrams() { return std::exchange(datagrams_, 0); }

 private:
  // In the order of the hub: one subject after the other, each to all subscribers.
  template <class Use>
  void ForEach(const Use& use) {
    ++sequence_;
    for (int subject = 0; subject < subjects_; ++subject) {
      for (std::size_t i = 0; i < subscribers_.size(); ++i) {
        const auto stream = static_cast<std::uint16_t>(subject + 1);
        protocol::WriteMessage({.session = 1, .stream = stream, .sequence = sequence_}, payload_,
                               message_);
        use(i, subscribers_[i].to);
      }
    }
  }

  int subjects_;
  asio::io_context io_;
  std::vector<Subscriber> subscribers_;
  udp::socket socket_{io_, udp::endpoint(asio::ip::address_v4::loopback(), 0)};
  server::UdpSender sender_;
  Bytes payload_;
  Bytes message_;
  Bytes received_ = Bytes(2048);
  std::uint32_t sequence_ = 0;
  std::size_t datagrams_ = 0;
};

// Seconds per weight set over `batches` batches. Exits the program if one is lost.
Sample SampleOf(FanOut& fan_out, int subjects, int batches, const std::function<void()>& send) {
  Sample sum;
  for (int i = 0; i < batches; ++i) {
    const Sample one = Measure(send, subjects * static_cast<int>(kSubscribers) * batches);
    sum.wall += one.wall;
    sum.cpu += one.cpu;
    if (!fan_out.Drain()) {
      std::fprintf(stderr,
                   "error: weights were lost; raise the socket buffer limit net.core.rmem_max\n");
      std::exit(1);
    }
  }
  return sum;
}

load::Quartiles Ratio(const std::vector<Sample>& samples, const std::vector<Sample>& plain) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < samples.size(); ++i) ratios.push_back(samples[i].cpu / plain[i].cpu);
  return load::QuartilesOf(std::move(ratios));
}

std::string Text(const load::Quartiles& ratio) {
  return Between(ratio.median, ratio.low, ratio.high, 2) + "x";
}

// The results for one number of subjects in a batch.
struct Outcome {
  int subjects = 0;
  std::size_t bytes = 0;   // per weight set
  double sendto_ns = 0.0;  // processor time per set
  load::Quartiles again;      // ratios to sendto_ns
  load::Quartiles cut;        // segmented by the kernel
  load::Quartiles bundled;
  double sets_a_datagram = 0.0;  // with bundles
};

Outcome MeasureOne(int subjects, int weights, int repetitions) {
  constexpr int kSetsASample = 16384;
  const int batches = std::max(1, kSetsASample / (subjects * static_cast<int>(kSubscribers)));
  FanOut fan_out(subjects, weights);
  const auto sampler = [&](const std::function<void()>& send) {
    return
        [&fan_out, subjects, batches, send] { return SampleOf(fan_out, subjects, batches, send); };
  };
  const std::vector<Sampler> samplers = {
      sampler([&] { fan_out.SendPlain(); }),
      sampler([&] { fan_out.SendPlain(); }),
      sampler([&] { fan_out.SendPacked(server::Packing::kSeparate); }),
      sampler([&] { fan_out.SendPacked(server::Packing::kBundled); }),
  };
  const auto samples = Interleave(samplers, repetitions);
  (void)fan_out.TakeDatagrams();
  fan_out.SendPacked(server::Packing::kBundled);
  (void)fan_out.Drain();
  const double sets = static_cast<double>(kSubscribers) * subjects;
  return {.subjects = subjects,
          .bytes = fan_out.message_bytes(),
          .sendto_ns = MedianCpu(samples[0]) * 1e9,
          .again = Ratio(samples[1], samples[0]),
          .cut = Ratio(samples[2], samples[0]),
          .bundled = Ratio(samples[3], samples[0]),
          .sets_a_datagram = sets / static_cast<double>(fan_out.TakeDatagrams())};
}

std::vector<std::string> Row(const Outcome& outcome) {
  return {std::to_string(outcome.subjects),
          std::to_string(outcome.bytes),
          report::Fixed(outcome.sendto_ns, 0),
          Text(outcome.again),
          Text(outcome.cut),
          Text(outcome.bundled),
          report::Fixed(outcome.sets_a_datagram, 1),
          outcome.bundled.median <= kAim ? "yes" : "no"};
}

nlohmann::json ToJson(const Outcome& outcome) {
  const auto spread = [](const load::Quartiles& ratio) {
    return nlohmann::json{{"median", ratio.median}, {"low", ratio.low}, {"high", ratio.high}};
  };
  return {{"subjects", outcome.subjects},
          {"bytes", outcome.bytes},
          {"sendto_cpu_ns", outcome.sendto_ns},
          {"sendto_again", spread(outcome.again)},
          {"system_cuts", spread(outcome.cut)},
          {"bundles", spread(outcome.bundled)},
          {"sets_a_datagram", outcome.sets_a_datagram}};
}

struct Options {
  std::vector<int> subjects = {1, 2, 4, 16, 64};
  std::vector<int> weights = {37, 81};
  int repetitions = 21;
  std::filesystem::path out;
};

int Run(const Options& options) {
  report::Table table{"A weight set to each of 64 subscribers",
                      {"subjects per batch", "bytes", "sendto, ns of CPU", "sendto again",
                       "kernel segmentation", "bundles", "sets per datagram", "<= 0.45x"},
                      {}};
  nlohmann::json json = nlohmann::json::array();
  for (const int weights : options.weights) {
    for (const int subjects : options.subjects) {
      const Outcome outcome = MeasureOne(subjects, weights, options.repetitions);
      table.rows.push_back(Row(outcome));
      json.push_back(ToJson(outcome));
    }
  }
  const std::string markdown = report::ToMarkdown(table) + "\n";
  std::fputs(markdown.c_str(), stdout);
  if (options.out.empty()) return 0;
  WriteResult(options.out / "fanout.md", markdown);
  WriteResult(options.out / "fanout.json", json.dump(2) + "\n");
  return 0;
}

}  // namespace
}  // namespace furrow::bench

int main(int argc, char** argv) {
  furrow::bench::Options options;
  CLI::App app{"Measure sending weights to 64 subscribers: sendto compared with the batched path"};
  app.add_option("--subjects", options.subjects, "Numbers of subjects per batch")
      ->delimiter(',')
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--weights", options.weights,
                 "Weights per subject (the default rig has 37; 81 make 400 bytes)")
      ->delimiter(',')
      ->check(CLI::Range(1, 250))
      ->capture_default_str();
  app.add_option("--repetitions", options.repetitions, "Samples of each path, in turn")
      ->check(CLI::Range(3, 10000))
      ->capture_default_str();
  app.add_option("--out", options.out, "Folder for fanout.md and fanout.json (default: none)");
  furrow::bench::ReadCommandLine(app, argc, argv);
  if (!options.out.empty()) furrow::bench::MakeResultFolder(options.out);
  return furrow::bench::Run(options);
}
