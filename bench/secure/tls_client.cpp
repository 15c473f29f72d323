// SPDX-License-Identifier: Apache-2.0
// Sends poses of one face over a stream, one after the other, and waits for the weights of each.
//
//   bench_tls_client PORT POSES [AUTHORITY]
//
// Prints the median and the 99th percentile of the time from a pose to its weights, microseconds,
// and the processor time of this program per pose. With AUTHORITY (PEM) over TLS.
// bench/secure/tls_stream.py runs it.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include <unistd.h>

#include "client/cpp/acceptance.h"
#include "client/cpp/clock.h"
#include "client/cpp/publisher.h"
#include "client/cpp/subscriber.h"
#include "client/cpp/tls/client_tls.h"
#include "client/cpp/transports.h"
#include "protocol/messages/hash.h"

namespace furrow::bench {
namespace {

using client::SteadyMicroseconds;
using std::chrono::milliseconds;

constexpr int kShapes = 52;

[[noreturn]] void Fail(const std::string& why) {
  std::fprintf(stderr, "bench_tls_client: %s\n", why.c_str());
  std::exit(1);
}

std::unique_ptr<client::Transport> Open(std::uint16_t port, const client::Security& security) {
  auto opened = client::OpenTransport(client::TransportKind::kTcp, "127.0.0.1", port,
                                      milliseconds(3000), security);
  if (!opened.ok()) Fail(opened.status().ToString());
  return *std::move(opened);
}

protocol::SkeletonOffer Face(const std::string& subject) {
  protocol::SkeletonOffer offer;
  offer.subject = subject;
  const std::array<const char*, 4> known{"browInnerUp", "browDownLeft", "mouthSmileLeft",
                                         "mouthFrownLeft"};
  for (int shape = 0; shape < kShapes; ++shape) {
    const auto index = static_cast<std::size_t>(shape);
    offer.blend_shape_names.push_back(index < known.size() ? known[index]
                                                           : "shape" + std::to_string(shape));
  }
  offer.skeleton_hash = protocol::SkeletonHash(offer);
  return offer;
}

double ProcessorSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Sends a pose and waits for its weights. Returns the time between them, microseconds.
double RoundTrip(client::Publisher& publisher, std::uint16_t stream, client::Subscriber& subscriber,
                 std::uint32_t number) {
  protocol::PoseFrame pose;
  pose.num_blend_shapes = kShapes;
  for (int shape = 0; shape < kShapes; ++shape) {
    pose.blend_shapes.push_back(
        static_cast<float>((number + 7u * static_cast<unsigned>(shape)) % 100) / 100.0f);
  }
  const auto start = std::chrono::steady_clock::now();
  if (publisher.Send(stream, pose, SteadyMicroseconds()) != client::IoStatus::kOk) Fail("no send");
  while (true) {
    const client::Event event = subscriber.Next(SteadyMicroseconds(), milliseconds(1000));
    // A pong also ends the wait.
    if (std::chrono::steady_clock::now() - start > milliseconds(5000)) Fail("no weights");
    if (event.kind == client::Event::Kind::kWeights && event.header.sequence == number) break;
  }
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
      .count();
}

int Run(std::uint16_t port, std::uint32_t poses, const std::string& authority) {
  client::Security security;
  if (!authority.empty()) {
    auto tls = client::MakeTlsContext({.authority = authority, .certificate = {}, .key = {}});
    if (!tls.ok()) Fail(tls.status().ToString());
    security.tls = *tls;
  }
  // Another one in each run: a subject that has just ended would be taken over.
  const std::string subject = "face-" + std::to_string(getpid());
  client::Publisher publisher(Open(port, security));
  const std::uint16_t stream = publisher.AddSubject(Face(subject), SteadyMicroseconds());
  const auto answer =
      client::WaitUntilAccepted(publisher, stream, SteadyMicroseconds, [] { return true; });
  if (answer.kind != client::Acceptance::Kind::kAccepted) Fail("not accepted: " + answer.reason);
  client::Subscriber subscriber(Open(port, security), "bench");
  subscriber.Subscribe(protocol::SubscribeWeights{.subject = subject});
  while (subscriber.Next(SteadyMicroseconds(), milliseconds(100)).kind !=
         client::Event::Kind::kReply) {
  }
  constexpr std::uint32_t kWarmUp = 200;
  std::vector<double> times;
  double before = 0.0;
  for (std::uint32_t number = 0; number < kWarmUp + poses; ++number) {
    if (number == kWarmUp) before = ProcessorSeconds();
    const double time = RoundTrip(publisher, stream, subscriber, number);
    if (number >= kWarmUp) times.push_back(time);
  }
  const double own = 1e6 * (ProcessorSeconds() - before) / poses;
  std::ranges::sort(times);
  std::printf("%.1f %.1f %.2f\n", times[times.size() / 2], times[times.size() * 99 / 100], own);
  return 0;
}

}  // namespace
}  // namespace furrow::bench

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  return furrow::bench::Run(static_cast<std::uint16_t>(std::atoi(argv[1])),
                            static_cast<std::uint32_t>(std::atoi(argv[2])),
                            argc > 3 ? argv[3] : "");
}
