// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "server/core/time.h"

namespace furrow::server {

// The way of one pose through the daemon. All times are on the daemon's clock.
struct PoseTrace {
  std::string subject;
  std::uint32_t sequence = 0;
  std::optional<Time> late;  // beyond the fastest poses of the stream; absent: no capture time
  Time buffered{0};          // the delay of the subject's jitter buffer; `received` comes after it
  Time received{0};          // read from its socket, or released from the jitter buffer
  Time accepted{0};          // decoded and checked
  Time solving{0};           // the batch is being solved
  Time solved{0};
  Time published{0};      // its weights were encoded for the subscribers
  Time sent{0};           // its weights left, or wait in the queues of connections
  std::size_t batch = 0;  // poses that were solved together

  // The first picture that shows this pose or a later one.
  struct Picture {
    std::uint32_t sequence = 0;
    Time submitted{0};  // requested
    Time taken{0};      // by the render thread
    Time drawn{0};
    Time encoded{0};
    Time sent{0};  // to its viewers, or waits in the queues of their connections
    int width = 0;
    int height = 0;
    std::size_t bytes = 0;
    std::size_t viewers = 0;
    bool is_video = false;
  };
  std::optional<Picture> picture;
};

}  // namespace furrow::server
