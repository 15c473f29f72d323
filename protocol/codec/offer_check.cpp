// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/offer_check.h"

#include "protocol/codec/codec.h"
#include "protocol/messages/limits.h"

namespace furrow::protocol {

std::string FindOfferProblem(std::span<const std::uint8_t> offer) {
  MessageView view;
  SkeletonOffer decoded;
  DecodeStatus status = OpenMessage(offer, view);
  if (status == DecodeStatus::kOk) status = Decode(view, decoded);
  switch (status) {
    case DecodeStatus::kOk: return {};
    case DecodeStatus::kBadText:
      return "the name of the subject, a joint or a blend shape is empty, duplicated, not UTF-8 or "
             "contains control characters";
    case DecodeStatus::kLimit:
    case DecodeStatus::kBadLength:
      return "the skeleton has more than " + std::to_string(kMaxJoints) + " joints or " +
             std::to_string(kMaxBlendShapes) + " blend shapes, or a name longer than " +
             std::to_string(kMaxNameBytes) + " bytes";
    default:
      return "the skeleton cannot be encoded (" + std::string(DecodeStatusName(status)) + ")";
  }
}

}  // namespace furrow::protocol
