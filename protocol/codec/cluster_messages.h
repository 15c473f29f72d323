// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/codec/decode_status.h"
#include "protocol/codec/wire_fields.h"
#include "protocol/messages/cluster_messages.h"
#include "protocol/schema/drain_generated.h"
#include "protocol/schema/drain_state_generated.h"
#include "protocol/schema/subject_state_generated.h"

// Subjects that move between servers: STANDARD.md section 10.
namespace furrow::protocol::internal {

[[nodiscard]] DecodeStatus ReadTable(const wire::SubjectState& table, SubjectState& message);
[[nodiscard]] flatbuffers::Offset<wire::SubjectState> WriteTable(PayloadBuilder& payload,
                                                                 const SubjectState& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::Drain& table, Drain& message);
[[nodiscard]] flatbuffers::Offset<wire::Drain> WriteTable(PayloadBuilder& payload,
                                                          const Drain& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::DrainState& table, DrainState& message);
[[nodiscard]] flatbuffers::Offset<wire::DrainState> WriteTable(PayloadBuilder& payload,
                                                               const DrainState& message);

}  // namespace furrow::protocol::internal
