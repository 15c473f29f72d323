// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/core/time.h"
#include "web_client.h"

namespace furrow::bench {

// A received picture.
struct Received {
  protocol::ImageFrame image;  // without its bytes
  server::Time at{0};
  // Time since the pose reached the daemon, which shares the clock of this process.
  [[nodiscard]] double age_seconds() const {
    return server::ToSeconds(at) - 1e-6 * static_cast<double>(image.received_us);
  }
};

// A viewer over a WebSocket. `acknowledged`: with flow control, as the preview page; otherwise the
// daemon sends every picture that it draws.
class Viewer {
 public:
  Viewer(std::uint16_t port, int width, int height, bool acknowledged, int quality = 85);

  // Returns the next picture and ignores other messages. Exits the program if the connection ends.
  Received Next();
  void Acknowledge(std::uint32_t number);
  // Receives and acknowledges pictures for `seconds`.
  void Watch(double seconds);
  // Round trip of a ping in seconds, without waiting pictures.
  [[nodiscard]] double RoundTrip();
  // Receives the pictures that are still in flight without acknowledging them. Returns their sizes
  // in bytes. Precondition: the subject rests.
  [[nodiscard]] std::vector<std::size_t> DrainInFlight();

 private:
  testing_net::WebClient client_;
  std::uint16_t stream_ = 0;
};

}  // namespace furrow::bench
