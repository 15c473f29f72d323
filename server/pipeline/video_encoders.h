// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/status.h"
#include "render/video/video_codec.h"
#include "server/shares/fair_share.h"

namespace furrow::server {

// The video encoders of the viewers, one for each picture subscription that gets video. Their
// number and memory are bounded, and one host gets at most half of both (FairShare); other viewers
// get JPEG until an encoder is free. Thread-safe; only Encode() takes long, and it must not
// run on two threads at a time.
class VideoEncoders {
 public:
  // Of all encoders together.
  static constexpr std::size_t kMaxBytes = std::size_t{256} << 20;

  // `codec` outlives this object; null: there is none, because of `why`. `max_encoders`: 0 or more.
  VideoEncoders(const render::VideoCodec* codec, int max_encoders, std::string why = {});

  // Gives the subscription a place, or keeps the one that it has. Another format means a new
  // encoder. False: there is no place for it (one that it had is free again), or its encoder has
  // failed; the viewer gets JPEG.
  [[nodiscard]] bool Open(std::uint64_t subscription, const std::string& host,
                          const render::VideoFormat& format);
  // Frees the place, if the subscription has one.
  void Close(std::uint64_t subscription);

  // Encodes the next picture of a subscription. Errors: kNotFound (it has no place, or one for
  // another size; the viewer gets JPEG), kInternal (its encoder failed and gets no more pictures).
  [[nodiscard]] Result<render::VideoPicture> Encode(std::uint64_t subscription,
                                                    const render::Planes& planes,
                                                    const render::VideoTarget& target);

  // The next picture of the subscription begins the video again, because the last one was lost. Not
  // while Encode() runs.
  void Restart(std::uint64_t subscription);

  struct State {
    std::string library;  // empty: there is no video
    std::string why;      // there is none
    int encoders = 0;     // in use
    int max_encoders = 0;
  };
  [[nodiscard]] State state() const;

 private:
  struct Place {
    render::VideoFormat format;
    bool failed = false;
    std::unique_ptr<render::VideoEncoder> encoder;  // made by Encode()
    std::string codec;                              // of its last key picture
  };
  struct Held {
    std::string host;
    std::shared_ptr<Place> place;  // Encode() may still use it when it is closed
  };

  [[nodiscard]] bool Fits(const std::string& host, const render::VideoFormat& format) const;
  void Erase(std::unordered_map<std::uint64_t, Held>::iterator held);
  std::shared_ptr<Place> Find(std::uint64_t subscription) const;

  const render::VideoCodec* const codec_;
  const int max_encoders_;
  const std::string why_;
  mutable std::mutex mutex_;
  std::unordered_map<std::uint64_t, Held> held_;  // by subscription
  FairShare shares_;
  // Of viewers that have left or have another format. Encode() frees them: Open() and Close() run
  // where poses wait.
  std::vector<std::shared_ptr<Place>> former_;
};

}  // namespace furrow::server
