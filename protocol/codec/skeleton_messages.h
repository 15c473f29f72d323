// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/codec/decode_status.h"
#include "protocol/codec/wire_fields.h"
#include "protocol/messages/messages.h"
#include "protocol/schema/skeleton_offer_generated.h"
#include "protocol/schema/skeleton_reply_generated.h"

// The skeletons that publishers offer: STANDARD.md section 6.
namespace furrow::protocol::internal {

[[nodiscard]] DecodeStatus ReadTable(const wire::SkeletonOffer& table, SkeletonOffer& message);
[[nodiscard]] flatbuffers::Offset<wire::SkeletonOffer> WriteTable(PayloadBuilder& payload,
                                                                  const SkeletonOffer& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::SkeletonReply& table, SkeletonReply& message);
[[nodiscard]] flatbuffers::Offset<wire::SkeletonReply> WriteTable(PayloadBuilder& payload,
                                                                  const SkeletonReply& message);

}  // namespace furrow::protocol::internal
