// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "render/renderer.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/pipeline/picture_source.h"
#include "server/pipeline/render_mailbox.h"
#include "server/pipeline/video_encoders.h"

namespace furrow::server {

// Encodes drawn pictures and delivers them: once per encoding, and for viewers with a video encoder
// once for each. Used by the render thread.
class PictureEncoder {
 public:
  // Different encodings of one picture. Further JPEG qualities get the nearest of these.
  static constexpr std::size_t kMaxEncodings = 4;
  // Must not block.
  using Deliver = std::function<void(FinishedPicture)>;

  // All pointers outlive this object. `video`: null means that all pictures are files.
  PictureEncoder(Metrics* metrics, Time (*clock)(), const Deliver* deliver, VideoEncoders* video)
      : metrics_(metrics), clock_(clock), deliver_(deliver), video_(video) {}

  // Returns every ticket of the job, in a picture with bytes or, after a failure, without. If
  // memory is so short that not even a failure can be reported, the viewers ask again after
  // ViewerFlow::kGiveUp.
  void Encode(const render::Image& image, RenderJob job);

 private:
  void EncodeVideos(const render::Image& image, RenderJob* job);
  bool EncodeVideo(const render::Image& image, const RenderJob& job, const PictureTicket& ticket);
  void EncodeFile(const render::Image& image, const RenderJob& job, const Encoding& encoding,
                  std::vector<PictureTicket> tickets);

  Metrics* const metrics_;
  Time (*const clock_)();
  const Deliver* const deliver_;
  VideoEncoders* const video_;
  render::Planes planes_;  // of the picture that is being encoded; its memory is reused
};

}  // namespace furrow::server
