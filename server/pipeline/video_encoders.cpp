// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/video_encoders.h"

#include <algorithm>
#include <iterator>
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

// The rule of FairShare, for bytes: a host gets more only while it holds fewer than are free.
bool VideoEncoders::Fits(const std::string& host, const render::VideoFormat& format) const {
  std::size_t of_host = 0, of_all = 0;
  for (const auto& [subscription, held] : held_) {
    const std::size_t bytes = BytesOf(held.place->format);
    of_all += bytes;
    if (held.host == host) of_host += bytes;
  }
  return std::min(format.width, format.height) >= kMinSize &&
         of_host + of_all + BytesOf(format) <= kMaxBytes;
}

bool VideoEncoders::Open(std::uint64_t subscription, const std::string& host,
                         const render::VideoFormat& format) {
  const std::lock_guard lock(mutex_);
  const auto known = held_.find(subscription);
  if (known != held_.end() && known->second.place->format == format) {
    return !known->second.place->failed;
  }
  // Memory first: after it, nothing fails halfway.
  Held held{host, std::make_shared<Place>(Place{.format = format})};
  former_.reserve(held_.size() + former_.size() + 1);
  if (known != held_.end()) Erase(known);
  if (!Fits(host, format) || !shares_.Enter(host)) return false;
  try {
    held_.emplace(subscription, std::move(held));
  } catch (...) {
    shares_.Leave(host);
    throw;
  }
  return true;
}

void VideoEncoders::Close(std::uint64_t subscription) {
  const std::lock_guard lock(mutex_);
  const auto known = held_.find(subscription);
  if (known != held_.end()) Erase(known);
}

void VideoEncoders::Erase(std::unordered_map<std::uint64_t, Held>::iterator held) {
  shares_.Leave(held->second.host);
  former_.push_back(std::move(held->second.place));
  held_.erase(held);
  // Nobody may encode any more.
  if (held_.empty()) former_.clear();
}

void VideoEncoders::Restart(std::uint64_t subscription) {
  if (const std::shared_ptr<Place> place = Find(subscription)) place->encoder.reset();
}

std::shared_ptr<VideoEncoders::Place> VideoEncoders::Find(std::uint64_t subscription) const {
  const std::lock_guard lock(mutex_);
  const auto held = held_.find(subscription);
  return held == held_.end() || held->second.place->failed ? nullptr : held->second.place;
}

Result<render::VideoPicture> VideoEncoders::Encode(std::uint64_t subscription,
                                                   const render::Planes& planes,
                                                   const render::VideoTarget& target) {
  std::vector<std::shared_ptr<Place>> former;  // freed here, where nobody waits for the lock
  {
    const std::lock_guard lock(mutex_);
    former.assign(std::make_move_iterator(former_.begin()), std::make_move_iterator(former_.end()));
    former_.clear();  // keeps its memory, which Erase() relies on
  }
  former.clear();
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
