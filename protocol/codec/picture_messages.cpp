// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/picture_messages.h"

namespace furrow::protocol::internal {
namespace {

bool IsRequestSize(int pixels) { return pixels >= kMinImageSize && pixels <= kMaxImageSize; }

// A server may answer with any size, even a smaller one than a client may request.
bool IsImageSize(int pixels) { return pixels > 0 && pixels <= kMaxImageSize; }

// An eye at its target has no direction, and extreme angles have no usable projection.
DecodeStatus ReadCamera(const wire::Camera& wire_camera, Camera& camera) {
  camera.eye = FromWire(wire_camera.eye());
  camera.target = FromWire(wire_camera.target());
  camera.vertical_fov_degrees = wire_camera.vertical_fov_degrees();
  FURROW_CHECK_DECODE(CheckVector(camera.eye));
  FURROW_CHECK_DECODE(CheckVector(camera.target));
  FURROW_CHECK_DECODE(CheckNumber(camera.vertical_fov_degrees));
  const bool good = camera.vertical_fov_degrees > 1.0f && camera.vertical_fov_degrees < 170.0f &&
                    camera.eye != camera.target;
  return good ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

DecodeStatus CheckPicture(const wire::SubscribePictures& table) {
  if (!IsRequestSize(table.width()) || !IsRequestSize(table.height())) {
    return DecodeStatus::kBadValue;
  }
  if (table.quality() < 1 || table.quality() > 100) return DecodeStatus::kBadValue;
  if (table.format() > wire::ImageFormat::MAX) return DecodeStatus::kBadValue;
  return CheckRate(table.max_rate_hz());
}

// Reads a list of texts. One that comes twice is harmless, so only the texts are checked.
DecodeStatus ReadTexts(const TextVector* texts, std::size_t max_texts, int max_bytes,
                       std::vector<std::string>& out) {
  if (SizeOf(texts) > max_texts) return DecodeStatus::kLimit;
  out.resize(SizeOf(texts));
  for (std::size_t i = 0; i < out.size(); ++i) {
    FURROW_CHECK_DECODE(ReadText(texts->Get(static_cast<flatbuffers::uoffset_t>(i)), max_bytes,
                                 out[i], Presence::kRequired));
  }
  return DecodeStatus::kOk;
}

}  // namespace

DecodeStatus ReadTable(const wire::SubscribePictures& table, SubscribePictures& message) {
  FURROW_CHECK_DECODE(CheckPicture(table));
  FURROW_CHECK_DECODE(ReadText(table.subject(), kMaxNameBytes, message.subject));
  FURROW_CHECK_DECODE(ReadText(table.view(), kMaxNameBytes, message.view));
  if (table.view() == nullptr) message.view = "final";
  FURROW_CHECK_DECODE(ReadText(table.camera_preset(), kMaxNameBytes, message.camera_preset));
  FURROW_CHECK_DECODE(
      ReadTexts(table.settings(), kMaxPictureSettings, kMaxNameBytes, message.settings));
  FURROW_CHECK_DECODE(ReadTexts(table.codecs(), kMaxPictureCodecs, kMaxCodecBytes, message.codecs));
  message.has_camera = table.camera() != nullptr;
  if (message.has_camera) {
    // A camera and a preset contradict each other.
    if (!message.camera_preset.empty()) return DecodeStatus::kBadValue;
    FURROW_CHECK_DECODE(ReadCamera(*table.camera(), message.camera));
  }
  message.wait = table.wait();
  message.width = table.width();
  message.height = table.height();
  message.max_rate_hz = table.max_rate_hz();
  message.format = static_cast<ImageFormat>(table.format());
  message.quality = table.quality();
  message.acknowledged = table.acknowledged();
  message.camera_follows = table.camera_follows();
  return DecodeStatus::kOk;
}

flatbuffers::Offset<wire::SubscribePictures> WriteTable(PayloadBuilder& payload,
                                                        const SubscribePictures& message) {
  const auto subject = WriteText(payload, message.subject);
  const auto view = WriteText(payload, message.view);
  const auto preset = WriteText(payload, message.camera_preset);
  const auto settings = WriteNames(payload, message.settings);
  const auto codecs = WriteNames(payload, message.codecs);
  const wire::Camera camera(ToWire(message.camera.eye), ToWire(message.camera.target),
                            message.camera.vertical_fov_degrees);
  return wire::CreateSubscribePictures(
      payload.builder, subject, message.wait, message.width, message.height, message.max_rate_hz,
      static_cast<wire::ImageFormat>(message.format), message.quality, view, preset,
      message.has_camera ? &camera : nullptr, message.acknowledged, settings,
      message.camera_follows, codecs);
}

DecodeStatus ReadTable(const wire::UpdatePictures& table, UpdatePictures& message) {
  if (table.pictures() == nullptr) return DecodeStatus::kMissingField;
  return ReadTable(*table.pictures(), message.pictures);
}

flatbuffers::Offset<wire::UpdatePictures> WriteTable(PayloadBuilder& payload,
                                                     const UpdatePictures& message) {
  const auto pictures = WriteTable(payload, message.pictures);
  return wire::CreateUpdatePictures(payload.builder, pictures);
}

DecodeStatus ReadTable(const wire::Image& table, ImageFrame& message) {
  if (SizeOf(table.bytes()) == 0) return DecodeStatus::kMissingField;
  if (table.format() > wire::ImageFormat::MAX || table.age_us() < 0 ||
      table.tier() >= kNumPictureTiers) {
    return DecodeStatus::kBadValue;
  }
  if (!IsImageSize(table.width()) || !IsImageSize(table.height())) return DecodeStatus::kBadValue;
  message.width = table.width();
  message.height = table.height();
  message.format = static_cast<ImageFormat>(table.format());
  message.age_us = table.age_us();
  message.bytes.assign(table.bytes()->begin(), table.bytes()->end());
  message.number = table.number();
  message.tier = table.tier();
  message.still = table.still();
  message.dropped = table.dropped();
  message.received_us = table.received_us();
  message.view_request = table.view_request();
  FURROW_CHECK_DECODE(ReadText(table.codec(), kMaxCodecBytes, message.codec));
  // A file needs no other picture, and a refined picture is always a file.
  const bool is_video = !message.codec.empty();
  if (!is_video && table.key()) return DecodeStatus::kBadValue;
  if (is_video && message.still) return DecodeStatus::kBadValue;
  message.key = table.key();
  message.drawn_percent = table.drawn_percent();
  const bool good = message.drawn_percent >= 1 && message.drawn_percent <= 100;
  return good ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

flatbuffers::Offset<wire::Image> WriteTable(PayloadBuilder& payload, const ImageFrame& message) {
  const auto bytes = payload.builder.CreateVector(message.bytes);
  const auto codec = WriteText(payload, message.codec);
  return wire::CreateImage(payload.builder, message.width, message.height,
                           static_cast<wire::ImageFormat>(message.format), message.age_us, bytes,
                           message.number, message.tier, message.still, message.dropped,
                           message.received_us, message.view_request, codec, message.key,
                           message.drawn_percent);
}

DecodeStatus ReadTable(const wire::FrameAck& table, FrameAck& message) {
  message.number = table.number();
  message.needs_key = table.needs_key();
  message.held_us = table.held_us();
  return message.number > 0 ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

flatbuffers::Offset<wire::FrameAck> WriteTable(PayloadBuilder& payload, const FrameAck& message) {
  return wire::CreateFrameAck(payload.builder, message.number, message.needs_key, message.held_us);
}

}  // namespace furrow::protocol::internal
