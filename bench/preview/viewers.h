// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/core/time.h"
#include "web_client.h"

namespace furrow::bench {

// A picture as it came.
struct Received {
  protocol::ImageFrame image;  // without its bytes
  server::Time at{0};
  // Since its pose came to the daemon, whose clock is ours here.
  [[nodiscard]] double age_seconds() const {
    return server::ToSeconds(at) - 1e-6 * static_cast<double>(image.received_us);
  }
};

// Somebody who looks at the performer over a WebSocket. `acknowledged`: as the page does; else
// everything is sent that is drawn.
class Viewer {
 public:
  Viewer(std::uint16_t port, int width, int height, bool acknowledged, int quality = 85);

  // The next picture; what else comes before it is let go. Ends the program where the connection
  // ends: there is nothing to measure.
  Received Next();
  void Acknowledge(std::uint32_t number);
  // Shows pictures for so long, each acknowledged when it has come.
  void Watch(double seconds);
  // Seconds from a ping to its answer, pictures aside.
  [[nodiscard]] double RoundTrip();
  // Takes what is under way and acknowledges none of it: the bytes of each picture. The subject
  // rests.
  [[nodiscard]] std::vector<std::size_t> TakeUnderWay();

 private:
  testing_net::WebClient client_;
  std::uint16_t stream_ = 0;
};

}  // namespace furrow::bench
