// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "render/renderer.h"
#include "server/pipeline/render_mailbox.h"

namespace furrow::server {

// A rendered and encoded picture with its recipients.
struct FinishedPicture {
  std::uint64_t subject = 0;
  std::uint32_t sequence = 0;        // of the pose
  std::int64_t capture_time_us = 0;  // of the pose, on the sender's clock
  std::int64_t age_us = 0;           // > 0: time since the pose, while weights decay
  std::int64_t received_us = 0;      // arrival of the pose, on the daemon's clock
  // On the daemon's clock: when it was requested, taken by the render thread, drawn and encoded.
  Time submitted{0};
  Time taken{0};
  Time drawn{0};
  Time encoded{0};
  int width = 0;  // pixels
  int height = 0;
  int drawn_percent = 100;  // render::Image::drawn_percent
  Encoding encoding;
  std::vector<std::uint8_t> bytes;     // the encoded picture; empty: rendering failed
  std::string codec;                   // of a video (VideoCodecName()); empty: a file of `encoding`
  bool key = false;                    // of a video: needs no earlier picture
  std::vector<PictureTicket> tickets;  // the recipients
};

// The interface of the renderer for the session. Submit() requests a picture; its FinishedPicture
// reaches Hub::OnPicture() later, on the thread of shard 0. RenderThread implements it.
class PictureSource {
 public:
  virtual ~PictureSource() = default;
  // Requests a picture. A newer job replaces a waiting one of the same subject and spec. May be
  // called from any thread; never waits for rendering.
  virtual void Submit(RenderJob job) = 0;
  // Cancels a still of this subscription that waits or is being drawn. False: there is none.
  virtual bool WithdrawStill(std::uint64_t subscription) = 0;
  // Cancels everything that the subscription waits for, because it has ended, and closes its video.
  virtual void Withdraw(std::uint64_t subscription) = 0;
  // Gives the subscription a video encoder, or keeps the one that it has. False: there is none for
  // it (VideoEncoders); its pictures are files. May be called from any thread.
  [[nodiscard]] virtual bool OpenVideo(std::uint64_t /*subscription*/, const std::string& /*host*/,
                                       const render::VideoFormat& /*format*/) {
    return false;
  }
  // The viewer wants no video any more.
  virtual void CloseVideo(std::uint64_t /*subscription*/) {}
  // The passes of the picture that is being drawn.
  struct Drawing {
    int done = 0;
    int passes = 0;
  };
  // Absent: nothing is being drawn.
  [[nodiscard]] virtual std::optional<Drawing> drawing() const { return std::nullopt; }
  // The renderer and its device, for people.
  [[nodiscard]] virtual std::string description() const { return {}; }
  // True if pictures are drawn on the processor.
  [[nodiscard]] virtual bool is_software() const { return false; }
  // True while pictures wait for the renderer, or are drafts (RenderJob::TakesDraft()).
  [[nodiscard]] virtual bool is_starting() const { return false; }
  // True if the renderer could not start, or while it does not respond; every request fails.
  [[nodiscard]] virtual bool is_stuck() const { return false; }
  // Why is_stuck() is true, for people; else empty.
  [[nodiscard]] virtual std::string fault() const {
    return is_stuck() ? "the renderer does not respond" : "";
  }
  // A camera preset of the character. Errors: kNotFound, the hint lists the presets; kInternal, the
  // renderer could not start.
  [[nodiscard]] virtual Result<render::Camera> Preset(std::string_view name) const = 0;
};

}  // namespace furrow::server
