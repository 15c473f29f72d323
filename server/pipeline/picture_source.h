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

// A rendered and encoded picture with its recipients. Empty `bytes`: rendering failed.
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

// The renderer as the session sees it. Submit() requests a picture; a FinishedPicture comes back
// later through the session's own thread. RenderThread implements it.
class PictureSource {
 public:
  virtual ~PictureSource() = default;
  // Requests a picture. A newer job replaces a waiting one of the same subject and spec. May be
  // called from any thread; never waits for rendering.
  virtual void Submit(RenderJob job) = 0;
  // Cancels a still that waits to be rendered for this subscription. False: there is none, or its
  // rendering has begun.
  virtual bool WithdrawStill(std::uint64_t subscription) = 0;
  // A camera preset of the character. Errors: kNotFound; the hint lists the presets.
  [[nodiscard]] virtual Result<render::Camera> Preset(std::string_view name) const = 0;
};

}  // namespace furrow::server
