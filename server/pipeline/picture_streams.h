// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "server/pipeline/picture_scale.h"
#include "server/pipeline/render_mailbox.h"

namespace furrow::server {

// The streams of moving pictures that are drawn: one for each viewer and its subject. A picture for
// several viewers continues the one of their streams that was used last, so that it stays with one
// history and one scale; if none of them has a stream, the viewer that subscribed first begins one.
// A viewer that changes its subject begins a new stream, so a stream holds pictures of one subject,
// which its viewer was sent.
class PictureStreams {
 public:
  // More than the renderer keeps histories. The stream that rested longest is forgotten.
  static constexpr std::size_t kMaxStreams = 64;
  // The stream of jobs that prepare completed pictures. Those of viewers have higher numbers.
  static constexpr std::uint64_t kPreparation = 1;

  struct Place {
    std::uint64_t stream = 0;  // render::FrameRequest::stream
    float scale = 1.0f;
  };
  // Where the picture of a job with moving pictures belongs; a job without viewers says so itself.
  // Stream 0, at the full size: some viewer does not acknowledge its pictures, so it gets no
  // refined picture at rest either.
  [[nodiscard]] Place Find(const RenderJob& job);
  // A picture was completed at `now`. `stream`: 0 if it belongs to none; all these count as one
  // more stream. `busy`: how long the renderer has worked since it began.
  void OnDrawn(std::uint64_t stream, Time busy, Time now);

  [[nodiscard]] std::size_t num_streams() const { return streams_.size(); }

 private:
  struct Stream {
    std::uint64_t number = 0;
    std::uint64_t subject = 0;
    PictureScale scale;
    std::uint64_t drawn = 0;  // number of the last picture, of all that were drawn; 0: none
    Time busy{0};             // at the last picture
    Time drawn_at{0};
    std::uint64_t used = 0;  // counts up with each job
  };
  Stream& Begin(const RenderJob& job);
  void ForgetOldest();

  std::map<std::uint64_t, Stream> streams_;  // by subscription
  std::uint64_t last_number_ = kPreparation;
  std::uint64_t num_jobs_ = 0;
  Time busy_{0};  // at the last picture of any stream
  std::uint64_t num_drawn_ = 0;
  std::uint64_t other_drawn_ = 0;  // number of the last picture without a stream
};

}  // namespace furrow::server
