// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/video_encoders.h"

#include <algorithm>
#include <utility>

namespace furrow::server {
namespace {

// Below this OpenH264 makes no encoder.
constexpr int kMinSize = 16;

std::size_t BytesOf(const render::VideoFormat& format) {
  return render::VideoEncoderBytes(format.width, format.height);
}

}  // namespace

VideoEncoders::VideoEncoders(const render::VideoCodec* codec, int max_encoders, std::string why)
    : codec_(codec),
      max_encoders_(codec == nullptr ? 0 : max_encoders),
      why_(std::move(why)),
      shares_(static_cast<std::size_t>(max_encoders_)) {}

// `others`: the bytes of all encoders beside this one.
bool VideoEncoders::Fits(const render::VideoFormat& format, std::size_t others) const {
  return std::min(format.width, format.height) >= kMinSize && others + BytesOf(format) <= kMaxBytes;
}

bool VideoEncoders::Open(std::uint64_t subscription, const std::string& host,
                         const render::VideoFormat& format) {
  std::shared_ptr<Place> former;  // destroyed after the lock, because that frees its memory
  const std::lock_guard lock(mutex_);
  const auto known = held_.find(subscription);
  if (known == held_.end()) {
    if (!Fits(format, bytes_) || !shares_.Enter(host)) return false;
    bytes_ += BytesOf(format);
    held_.emplace(subscription,
                  Held{host, BytesOf(format), std::make_shared<Place>(Place{.format = format})});
    return true;
  }
  Held& held = known->second;
  if (held.place->format == format) return !held.place->failed;
  if (!Fits(format, bytes_ - held.bytes)) return false;
  bytes_ += BytesOf(format) - held.bytes;
  held.bytes = BytesOf(format);
  former = std::exchange(held.place, std::make_shared<Place>(Place{.format = format}));
  return true;
}

void VideoEncoders::Close(std::uint64_t subscription) {
  std::shared_ptr<Place> former;
  const std::lock_guard lock(mutex_);
  const auto held = held_.find(subscription);
  if (held == held_.end()) return;
  bytes_ -= held->second.bytes;
  shares_.Leave(held->second.host);
  former = std::move(held->second.place);
  held_.erase(held);
}

std::shared_ptr<VideoEncoders::Place> VideoEncoders::Find(std::uint64_t subscription) const {
  const std::lock_guard lock(mutex_);
  const auto held = held_.find(subscription);
  return held == held_.end() || held->second.place->failed ? nullptr : held->second.place;
}

Result<render::VideoPicture> VideoEncoders::Encode(std::uint64_t subscription,
                                                   const render::Planes& planes,
                                                   const render::VideoTarget& target) {
  const std::shared_ptr<Place> place = Find(subscription);
  // The viewer has left, or has asked for another size since.
  if (place == nullptr || place->format.width != planes.width ||
      place->format.height != planes.height) {
    return Status(StatusCode::kNotFound, "no encoder for this picture");
  }
  std::string why;
  // Back in its place only after success: a picture that is lost to lack of memory, too, leaves an
  // encoder that no decoder can follow.
  std::unique_ptr<render::VideoEncoder> encoder = std::move(place->encoder);
  if (encoder == nullptr) encoder = codec_->make_encoder(place->format, &why);
  render::VideoPicture picture;
  if (encoder != nullptr && encoder->Encode(planes, target, &picture, &why) == StatusCode::kOk) {
    if (picture.key) place->codec = render::VideoCodecName(picture.bytes);
    picture.codec = place->codec;
    place->encoder = std::move(encoder);
    return picture;
  }
  const std::lock_guard lock(mutex_);
  place->failed = true;
  return Status(StatusCode::kInternal, why);
}

VideoEncoders::State VideoEncoders::state() const {
  const std::lock_guard lock(mutex_);
  return {codec_ == nullptr ? std::string() : codec_->library, why_, static_cast<int>(held_.size()),
          max_encoders_};
}

}  // namespace furrow::server
