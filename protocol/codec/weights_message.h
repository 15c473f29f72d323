// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/codec/decode_status.h"
#include "protocol/codec/wire_fields.h"
#include "protocol/messages/messages.h"
#include "protocol/schema/weights_generated.h"

// Weights: STANDARD.md section 9.
namespace furrow::protocol::internal {

[[nodiscard]] DecodeStatus ReadTable(const wire::Weights& table, WeightFrame& message);
[[nodiscard]] flatbuffers::Offset<wire::Weights> WriteTable(PayloadBuilder& payload,
                                                            const WeightFrame& message);

}  // namespace furrow::protocol::internal
