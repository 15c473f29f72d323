// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/codec/decode_status.h"
#include "protocol/codec/wire_fields.h"
#include "protocol/messages/messages.h"
#include "protocol/messages/quantise.h"
#include "protocol/schema/pose_generated.h"

// Poses: STANDARD.md sections 5 and 7. This is the hot path: reading and writing stop allocating
// once their memory has grown.
namespace furrow::protocol::internal {

[[nodiscard]] DecodeStatus ReadTable(const wire::Pose& table, PoseFrame& message);
[[nodiscard]] flatbuffers::Offset<wire::Pose> WriteTable(PayloadBuilder& payload,
                                                         const PoseFrame& message,
                                                         const PoseEncoding& encoding);

}  // namespace furrow::protocol::internal
