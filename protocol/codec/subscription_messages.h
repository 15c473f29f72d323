// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/codec/decode_status.h"
#include "protocol/codec/wire_fields.h"
#include "protocol/messages/messages.h"
#include "protocol/schema/dropped_generated.h"
#include "protocol/schema/list_subjects_generated.h"
#include "protocol/schema/subjects_generated.h"
#include "protocol/schema/subscribe_poses_generated.h"
#include "protocol/schema/subscribe_reply_generated.h"
#include "protocol/schema/subscribe_weights_generated.h"
#include "protocol/schema/unsubscribe_generated.h"

// Subscriptions to weights and poses, and the list of subjects: STANDARD.md sections 8 and 9.
namespace furrow::protocol::internal {

[[nodiscard]] DecodeStatus ReadTable(const wire::SubscribeWeights& table,
                                     SubscribeWeights& message);
[[nodiscard]] flatbuffers::Offset<wire::SubscribeWeights> WriteTable(
    PayloadBuilder& payload, const SubscribeWeights& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::SubscribePoses& table, SubscribePoses& message);
[[nodiscard]] flatbuffers::Offset<wire::SubscribePoses> WriteTable(PayloadBuilder& payload,
                                                                   const SubscribePoses& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::Unsubscribe& table, Unsubscribe& message);
[[nodiscard]] flatbuffers::Offset<wire::Unsubscribe> WriteTable(PayloadBuilder& payload,
                                                                const Unsubscribe& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::SubscribeReply& table, SubscribeReply& message);
[[nodiscard]] flatbuffers::Offset<wire::SubscribeReply> WriteTable(PayloadBuilder& payload,
                                                                   const SubscribeReply& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::Dropped& table, Dropped& message);
[[nodiscard]] flatbuffers::Offset<wire::Dropped> WriteTable(PayloadBuilder& payload,
                                                            const Dropped& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::ListSubjects& table, ListSubjects& message);
[[nodiscard]] flatbuffers::Offset<wire::ListSubjects> WriteTable(PayloadBuilder& payload,
                                                                 const ListSubjects& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::Subjects& table, Subjects& message);
[[nodiscard]] flatbuffers::Offset<wire::Subjects> WriteTable(PayloadBuilder& payload,
                                                             const Subjects& message);

}  // namespace furrow::protocol::internal
