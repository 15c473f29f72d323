// SPDX-License-Identifier: Apache-2.0
// Prints the wrinkle weights of a daemon's subjects as they arrive.
//
// usage: watch_weights HOST PORT FRAMES     the daemon's UDP port; ends after FRAMES weight packets
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "client/cpp/subscriber.h"
#include "client/cpp/transports.h"

namespace client = furrow::client;
namespace protocol = furrow::protocol;
using namespace std::chrono_literals;

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  auto transport = client::OpenTransport(client::TransportKind::kUdp, argv[1],
                                         static_cast<std::uint16_t>(std::atoi(argv[2])), 3s);
  if (!transport.ok()) {
    std::fprintf(stderr, "%s\n", transport.status().ToString().c_str());
    return 4;
  }
  client::Subscriber subscriber(*std::move(transport), "my engine 1.0");
  // An empty subject means any performer; `wait` accepts one that connects later.
  subscriber.Subscribe(protocol::SubscribeWeights{.wait = true, .pattern = "brow_*,mouth_*"});

  for (int frames = std::atoi(argv[3]); frames > 0;) {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    const auto now_us = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
    const client::Event event = subscriber.Next(now_us, 16ms);
    if (event.kind == client::Event::Kind::kNoConnection) return 4;
    if (event.kind != client::Event::Kind::kWeights) continue;
    // The names arrive once, in the reply; the values follow in the same order.
    const auto& names = subscriber.reply().names;
    const auto& values = subscriber.weights().values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::printf("%s %.3f\n", names[i].c_str(), values[i]);
    }
    --frames;
  }
  return 0;
}
