// SPDX-License-Identifier: Apache-2.0
// SubscribeWeights, SubscribePictures, Unsubscribe, SubscribeReply: STANDARD.md section 8.
#include "protocol/codec_internal.h"
#include "protocol/hash.h"
#include "protocol/schema/subscribe_pictures_generated.h"
#include "protocol/schema/subscribe_reply_generated.h"
#include "protocol/schema/subscribe_weights_generated.h"
#include "protocol/schema/unsubscribe_generated.h"

namespace furrow::protocol {
namespace {

using internal::Builder;
using internal::Finish;
using internal::ReadText;
using internal::Verify;
using internal::WriteText;

DecodeStatus CheckRate(float rate_hz) {
  FURROW_CHECK_DECODE(internal::CheckNumber(rate_hz));
  return rate_hz >= 0.0f && rate_hz <= kMaxRateHz ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

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

DecodeStatus CheckPicture(const wire::SubscribePictures& root) {
  if (!IsImageSize(root.width()) || !IsImageSize(root.height())) return DecodeStatus::kBadValue;
  if (root.quality() < 1 || root.quality() > 100) return DecodeStatus::kBadValue;
  if (root.format() > wire::ImageFormat::MAX) return DecodeStatus::kBadValue;
  return CheckRate(root.max_rate_hz());
}

}  // namespace

DecodeStatus Decode(const MessageView& view, SubscribeWeights& message) {
  const wire::SubscribeWeights* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kSubscribeWeights, root));
  FURROW_CHECK_DECODE(ReadText(root->subject(), kMaxNameBytes, message.subject));
  FURROW_CHECK_DECODE(ReadText(root->pattern(), kMaxPatternBytes, message.pattern));
  if (root->pattern() == nullptr) message.pattern = "*";
  FURROW_CHECK_DECODE(CheckRate(root->max_rate_hz()));
  if (root->format() > wire::WeightFormat::MAX || root->source() > wire::WeightSource::MAX) {
    return DecodeStatus::kBadValue;
  }
  message.wait = root->wait();
  message.max_rate_hz = root->max_rate_hz();
  message.format = static_cast<WeightFormat>(root->format());
  message.source = static_cast<WeightSource>(root->source());
  return DecodeStatus::kOk;
}

void Encoder::Encode(const Header& header, const SubscribeWeights& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  const auto subject = WriteText(builder, message.subject);
  const auto pattern = builder.CreateString(message.pattern);
  Finish(builder,
         wire::CreateSubscribeWeights(builder, subject, message.wait, pattern, message.max_rate_hz,
                                      static_cast<wire::WeightFormat>(message.format),
                                      static_cast<wire::WeightSource>(message.source)),
         header, MessageKind::kSubscribeWeights, out);
}

DecodeStatus Decode(const MessageView& view, SubscribePictures& message) {
  const wire::SubscribePictures* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kSubscribePictures, root));
  FURROW_CHECK_DECODE(CheckPicture(*root));
  FURROW_CHECK_DECODE(ReadText(root->subject(), kMaxNameBytes, message.subject));
  FURROW_CHECK_DECODE(ReadText(root->view(), kMaxNameBytes, message.view));
  if (root->view() == nullptr) message.view = "final";
  FURROW_CHECK_DECODE(ReadText(root->camera_preset(), kMaxNameBytes, message.camera_preset));
  message.has_camera = root->camera() != nullptr;
  if (message.has_camera) {
    if (!message.camera_preset.empty()) return DecodeStatus::kBadValue;
    FURROW_CHECK_DECODE(ReadCamera(*root->camera(), message.camera));
  }
  message.wait = root->wait();
  message.width = root->width();
  message.height = root->height();
  message.max_rate_hz = root->max_rate_hz();
  message.format = static_cast<ImageFormat>(root->format());
  message.quality = root->quality();
  return DecodeStatus::kOk;
}

void Encoder::Encode(const Header& header, const SubscribePictures& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  const auto subject = WriteText(builder, message.subject);
  const auto view = WriteText(builder, message.view);
  const auto preset = WriteText(builder, message.camera_preset);
  const Camera& c = message.camera;
  const wire::Camera camera(wire::Vec3(c.eye.x, c.eye.y, c.eye.z),
                            wire::Vec3(c.target.x, c.target.y, c.target.z), c.vertical_fov_degrees);
  Finish(builder,
         wire::CreateSubscribePictures(
             builder, subject, message.wait, message.width, message.height, message.max_rate_hz,
             static_cast<wire::ImageFormat>(message.format), message.quality, view, preset,
             message.has_camera ? &camera : nullptr),
         header, MessageKind::kSubscribePictures, out);
}

DecodeStatus Decode(const MessageView& view, Unsubscribe& /*message*/) {
  const wire::Unsubscribe* root = nullptr;
  return Verify(view, MessageKind::kUnsubscribe, root);
}

void Encoder::Encode(const Header& header, const Unsubscribe& /*message*/,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  Finish(builder, wire::CreateUnsubscribe(builder), header, MessageKind::kUnsubscribe, out);
}

DecodeStatus Decode(const MessageView& view, SubscribeReply& message) {
  const wire::SubscribeReply* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kSubscribeReply, root));
  FURROW_CHECK_DECODE(ReadText(root->subject(), kMaxNameBytes, message.subject));
  FURROW_CHECK_DECODE(internal::ReadNames(root->names(), kMaxWeights, message.names));
  message.names_hash = root->names_hash();
  return NamesHash(message.names) == message.names_hash ? DecodeStatus::kOk
                                                        : DecodeStatus::kBadHash;
}

void Encoder::Encode(const Header& header, const SubscribeReply& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  const auto subject = WriteText(builder, message.subject);
  flatbuffers::Offset<internal::TextVector> names = 0;
  if (!message.names.empty()) names = builder.CreateVectorOfStrings(message.names);
  Finish(builder, wire::CreateSubscribeReply(builder, subject, NamesHash(message.names), names),
         header, MessageKind::kSubscribeReply, out);
}

}  // namespace furrow::protocol
