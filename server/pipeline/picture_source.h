// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "render/renderer.h"
#include "server/pipeline/render_mailbox.h"

namespace furrow::server {

// A picture drawn and packed, and who waits for it. No bytes: it could not be drawn.
struct FinishedPicture {
  std::uint32_t sequence = 0;
  std::int64_t capture_time_us = 0;
  std::int64_t age_us = 0;
  std::int64_t received_us = 0;
  int width = 0;
  int height = 0;
  Encoding encoding;
  std::vector<std::uint8_t> bytes;
  std::vector<PictureTicket> tickets;
};

// Where pictures come from, seen from the sessions: they ask here, and get a FinishedPicture back
// through their own thread's queue. RenderThread is the one that draws.
class PictureSource {
 public:
  virtual ~PictureSource() = default;
  // From any thread; never blocks on drawing. The newest job of a subject and spec wins.
  virtual void Submit(RenderJob job) = 0;
  // Takes back a still that waits to be drawn for this subscription. False: there is none, or it is
  // being drawn.
  virtual bool WithdrawStill(std::uint64_t subscription) = 0;
  // A camera preset of the character; the error lists them.
  [[nodiscard]] virtual Result<render::Camera> Preset(std::string_view name) const = 0;
};

}  // namespace furrow::server
