// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/status.h"
#include "render/video/planes.h"

namespace furrow::render {

// What a video encoder is made for. A change of any of these needs a new encoder.
struct VideoFormat {
  int width = 0;  // pixels, even, at least 16
  int height = 0;
  // The quality that the video never exceeds, on the scale of JPEG in [1, 100]. At equal numbers
  // both have about the same error.
  int quality = 80;
  [[nodiscard]] bool operator==(const VideoFormat&) const = default;
};

// How to encode the next picture.
struct VideoTarget {
  int bits = 80'000;  // what a picture may have in the long run; key pictures are several times
                      // larger, and `quality` often needs less
  bool key = false;   // encode it without earlier pictures
};

// One encoded picture.
struct VideoPicture {
  std::vector<std::uint8_t> bytes;  // one access unit in Annex B form; key pictures begin with the
                                    // parameter sets
  bool key = false;
  std::string codec;  // of the video (VideoCodecName()); filled by the caller of the encoder
};

// Encodes a sequence of pictures as H.264 in constrained baseline: each picture comes out as soon
// as it goes in, and none is shown later than the next one. The first picture is a key picture. Not
// thread-safe, but may move between threads.
class VideoEncoder {
 public:
  virtual ~VideoEncoder() = default;
  VideoEncoder() = default;
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;
  // `planes` has the size of the format. On failure returns kInternal and sets `why`; then neither
  // this picture nor any later one can be decoded, so make a new encoder. No pointer may be null.
  [[nodiscard]] virtual StatusCode Encode(const Planes& planes, const VideoTarget& target,
                                          VideoPicture* picture, std::string* why) = 0;
};

// Makes encoders with OpenH264. The codec is a module, lib/furrow/furrow-video.so beside bin/, so
// that programs run without the library and send JPEG.
struct VideoCodec {
  std::string library;  // such as "OpenH264 2.3.1"
  // Null on failure: sets `why`.
  std::unique_ptr<VideoEncoder> (*make_encoder)(const VideoFormat& format, std::string* why);
};

// Returns the codec, which lives until the process ends. Loads it on the first call; safe on any
// thread. Error: kUnavailable, with the module's path or the missing library.
[[nodiscard]] Result<const VideoCodec*> GetVideoCodec();

// What an encoder of this size takes, measured and rounded up.
[[nodiscard]] constexpr std::size_t VideoEncoderBytes(int width, int height) {
  return (std::size_t{7} << 20) +
         std::size_t{20} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

// The codec of a key picture for WebCodecs and other programs (RFC 6381): "avc1." and profile,
// constraints and level of its parameter set, such as "avc1.42c01f". Empty: there is none.
[[nodiscard]] std::string VideoCodecName(const std::vector<std::uint8_t>& key_picture);

}  // namespace furrow::render
