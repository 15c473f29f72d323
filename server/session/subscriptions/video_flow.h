// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "protocol/messages/messages.h"
#include "render/video/video_codec.h"
#include "server/core/time.h"
#include "server/session/subscriptions/video_rate.h"

namespace furrow::server {

// The video of one viewer, beside its ViewerFlow: the bit rate, and which picture must be a key
// picture. A decoder that misses one picture cannot use the next ones, so whatever is lost between
// encoder and decoder is followed by a key picture.
class VideoFlow {
 public:
  // How to encode the next picture.
  [[nodiscard]] render::VideoTarget Target() const {
    return {.bits = rate_.PictureBits(), .key = needs_key_};
  }
  // A picture was encoded but did not leave.
  void Lose() { needs_key_ = true; }
  // A picture was sent, a file or one of the video.
  void Sent(std::uint32_t number, std::size_t bytes, bool is_key, Time now) {
    if (is_key) {
      needs_key_ = false;
      last_key_ = number;
    }
    rate_.Sent(number, bytes, now);
  }
  // Precondition: the picture was sent.
  void Acknowledge(const protocol::FrameAck& ack, Time now) {
    rate_.Acknowledged(ack.number, std::chrono::microseconds(ack.held_us), now);
    // A viewer that missed a picture before the last key picture will find that one.
    if (ack.needs_key && static_cast<std::int32_t>(ack.number - last_key_) >= 0) needs_key_ = true;
  }
  [[nodiscard]] int kbps() const { return rate_.kbps(); }

 private:
  VideoRate rate_;
  bool needs_key_ = false;      // the first picture of an encoder is a key picture anyway
  std::uint32_t last_key_ = 0;  // its number
};

}  // namespace furrow::server
