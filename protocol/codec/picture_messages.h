// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/codec/decode_status.h"
#include "protocol/codec/wire_fields.h"
#include "protocol/messages/messages.h"
#include "protocol/schema/frame_ack_generated.h"
#include "protocol/schema/image_generated.h"
#include "protocol/schema/subscribe_pictures_generated.h"
#include "protocol/schema/update_pictures_generated.h"

// Subscriptions to pictures, and the pictures: STANDARD.md sections 8 and 9.
namespace furrow::protocol::internal {

[[nodiscard]] DecodeStatus ReadTable(const wire::SubscribePictures& table,
                                     SubscribePictures& message);
[[nodiscard]] flatbuffers::Offset<wire::SubscribePictures> WriteTable(
    PayloadBuilder& payload, const SubscribePictures& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::UpdatePictures& table, UpdatePictures& message);
[[nodiscard]] flatbuffers::Offset<wire::UpdatePictures> WriteTable(PayloadBuilder& payload,
                                                                   const UpdatePictures& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::Image& table, ImageFrame& message);
[[nodiscard]] flatbuffers::Offset<wire::Image> WriteTable(PayloadBuilder& payload,
                                                          const ImageFrame& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::FrameAck& table, FrameAck& message);
[[nodiscard]] flatbuffers::Offset<wire::FrameAck> WriteTable(PayloadBuilder& payload,
                                                             const FrameAck& message);

}  // namespace furrow::protocol::internal
