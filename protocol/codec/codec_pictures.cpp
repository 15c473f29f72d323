// SPDX-License-Identifier: Apache-2.0
// SubscribePictures, UpdatePictures, Image, FrameAck: STANDARD.md sections 8 and 9.
#include "protocol/codec/codec_internal.h"
#include "protocol/schema/frame_ack_generated.h"
#include "protocol/schema/image_generated.h"
#include "protocol/schema/subscribe_pictures_generated.h"
#include "protocol/schema/update_pictures_generated.h"

namespace furrow::protocol {
namespace {

using internal::Builder;
using internal::Finish;
using internal::ReadText;
using internal::SizeOf;
using internal::Verify;
using internal::WriteText;

bool IsImageSize(int pixels) { return pixels >= kMinImageSize && pixels <= kMaxImageSize; }

DecodeStatus ReadCamera(const wire::Camera& wire_camera, Camera& camera) {
  const wire::Vec3& eye = wire_camera.eye();
  const wire::Vec3& target = wire_camera.target();
  camera.eye = {eye.x(), eye.y(), eye.z()};
  camera.target = {target.x(), target.y(), target.z()};
  camera.vertical_fov_degrees = wire_camera.vertical_fov_degrees();
  FURROW_CHECK_DECODE(internal::CheckVector(camera.eye));
  FURROW_CHECK_DECODE(internal::CheckVector(camera.target));
  FURROW_CHECK_DECODE(internal::CheckNumber(camera.vertical_fov_degrees));
  const bool good = camera.vertical_fov_degrees > 1.0f && camera.vertical_fov_degrees < 170.0f &&
                    camera.eye != camera.target;
  return good ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

DecodeStatus CheckPicture(const wire::SubscribePictures& table) {
  if (!IsImageSize(table.width()) || !IsImageSize(table.height())) return DecodeStatus::kBadValue;
  if (table.quality() < 1 || table.quality() > 100) return DecodeStatus::kBadValue;
  if (table.format() > wire::ImageFormat::MAX) return DecodeStatus::kBadValue;
  return internal::CheckRate(table.max_rate_hz());
}

DecodeStatus ReadSettings(const internal::TextVector* settings, std::vector<std::string>& out) {
  if (SizeOf(settings) > kMaxPictureSettings) return DecodeStatus::kLimit;
  out.resize(SizeOf(settings));
  for (std::size_t i = 0; i < out.size(); ++i) {
    FURROW_CHECK_DECODE(ReadText(settings->Get(static_cast<flatbuffers::uoffset_t>(i)),
                                 kMaxNameBytes, out[i], internal::Presence::kRequired));
  }
  return DecodeStatus::kOk;
}

DecodeStatus Read(const wire::SubscribePictures& table, SubscribePictures& message) {
  FURROW_CHECK_DECODE(CheckPicture(table));
  FURROW_CHECK_DECODE(ReadText(table.subject(), kMaxNameBytes, message.subject));
  FURROW_CHECK_DECODE(ReadText(table.view(), kMaxNameBytes, message.view));
  if (table.view() == nullptr) message.view = "final";
  FURROW_CHECK_DECODE(ReadText(table.camera_preset(), kMaxNameBytes, message.camera_preset));
  FURROW_CHECK_DECODE(ReadSettings(table.settings(), message.settings));
  message.has_camera = table.camera() != nullptr;
  if (message.has_camera) {
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

flatbuffers::Offset<wire::SubscribePictures> Write(Builder& builder,
                                                   const SubscribePictures& message) {
  const auto subject = WriteText(builder, message.subject);
  const auto view = WriteText(builder, message.view);
  const auto preset = WriteText(builder, message.camera_preset);
  flatbuffers::Offset<internal::TextVector> settings = 0;
  if (!message.settings.empty()) settings = builder.CreateVectorOfStrings(message.settings);
  const Camera& c = message.camera;
  const wire::Camera camera(wire::Vec3(c.eye.x, c.eye.y, c.eye.z),
                            wire::Vec3(c.target.x, c.target.y, c.target.z), c.vertical_fov_degrees);
  return wire::CreateSubscribePictures(
      builder, subject, message.wait, message.width, message.height, message.max_rate_hz,
      static_cast<wire::ImageFormat>(message.format), message.quality, view, preset,
      message.has_camera ? &camera : nullptr, message.acknowledged, settings,
      message.camera_follows);
}

}  // namespace

DecodeStatus Decode(const MessageView& view, SubscribePictures& message) {
  const wire::SubscribePictures* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kSubscribePictures, root));
  return Read(*root, message);
}

void Encoder::Encode(const Header& header, const SubscribePictures& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  Finish(builder, Write(builder, message), header, MessageKind::kSubscribePictures, out);
}

DecodeStatus Decode(const MessageView& view, UpdatePictures& message) {
  const wire::UpdatePictures* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kUpdatePictures, root));
  if (root->pictures() == nullptr) return DecodeStatus::kMissingField;
  return Read(*root->pictures(), message.pictures);
}

void Encoder::Encode(const Header& header, const UpdatePictures& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  const auto pictures = Write(builder, message.pictures);
  Finish(builder, wire::CreateUpdatePictures(builder, pictures), header,
         MessageKind::kUpdatePictures, out);
}

DecodeStatus Decode(const MessageView& view, ImageFrame& message) {
  const wire::Image* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kImage, root));
  if (SizeOf(root->bytes()) == 0) return DecodeStatus::kMissingField;
  if (root->format() > wire::ImageFormat::MAX || root->age_us() < 0 ||
      root->tier() >= kNumPictureTiers) {
    return DecodeStatus::kBadValue;
  }
  const auto is_size = [](int pixels) { return pixels > 0 && pixels <= kMaxImageSize; };
  if (!is_size(root->width()) || !is_size(root->height())) return DecodeStatus::kBadValue;
  message.width = root->width();
  message.height = root->height();
  message.format = static_cast<ImageFormat>(root->format());
  message.age_us = root->age_us();
  message.bytes.assign(root->bytes()->begin(), root->bytes()->end());
  message.number = root->number();
  message.tier = root->tier();
  message.still = root->still();
  message.dropped = root->dropped();
  message.received_us = root->received_us();
  message.view_request = root->view_request();
  return DecodeStatus::kOk;
}

void Encoder::Encode(const Header& header, const ImageFrame& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  const auto bytes = builder.CreateVector(message.bytes);
  Finish(builder,
         wire::CreateImage(builder, message.width, message.height,
                           static_cast<wire::ImageFormat>(message.format), message.age_us, bytes,
                           message.number, message.tier, message.still, message.dropped,
                           message.received_us, message.view_request),
         header, MessageKind::kImage, out);
}

DecodeStatus Decode(const MessageView& view, FrameAck& message) {
  const wire::FrameAck* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kFrameAck, root));
  message.number = root->number();
  return message.number > 0 ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

void Encoder::Encode(const Header& header, const FrameAck& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  Finish(builder, wire::CreateFrameAck(builder, message.number), header, MessageKind::kFrameAck,
         out);
}

}  // namespace furrow::protocol
