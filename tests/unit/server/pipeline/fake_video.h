// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "render/video/video_codec.h"

namespace furrow::server::test {

// What the encoders of FakeVideoCodec() do. Reset it in each test.
struct FakeVideo {
  int alive = 0;
  int made = 0;
  bool cannot_make = false;
  int fails_after = -1;  // pictures of an encoder; below 0: never
};
inline FakeVideo fake_video;

// A picture of six bytes: the start code and type of a parameter set, or of a slice.
class FakeVideoEncoder : public render::VideoEncoder {
 public:
  FakeVideoEncoder() { ++fake_video.alive; }
  ~FakeVideoEncoder() override { --fake_video.alive; }
  StatusCode Encode(const render::Planes&, const render::VideoTarget& target,
                    render::VideoPicture* picture, std::string* why) override {
    if (num_ == fake_video.fails_after) {
      *why = "the fake encoder failed";
      return StatusCode::kInternal;
    }
    picture->key = num_++ == 0 || target.key;
    picture->bytes = {0, 0, 1, 0x41, 9, 9, 9};
    if (picture->key) picture->bytes = {0, 0, 1, 0x67, 0x42, 0xC0, 0x1E};
    return StatusCode::kOk;
  }

 private:
  int num_ = 0;
};

inline const render::VideoCodec* FakeVideoCodec() {
  static const render::VideoCodec codec{
      "fake 1.0",
      [](const render::VideoFormat&, std::string* why) -> std::unique_ptr<render::VideoEncoder> {
        ++fake_video.made;
        if (!fake_video.cannot_make) return std::make_unique<FakeVideoEncoder>();
        *why = "no fake encoder";
        return nullptr;
      }};
  return &codec;
}

}  // namespace furrow::server::test
