// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/offer_check.h"

#include "protocol/codec/codec.h"
#include "protocol/messages/limits.h"

namespace furrow::protocol {

std::string WhyUnsendable(std::span<const std::uint8_t> offer) {
  MessageView view;
  SkeletonOffer decoded;
  DecodeStatus status = OpenMessage(offer, view);
  if (status == DecodeStatus::kOk) status = Decode(view, decoded);
  switch (status) {
    case DecodeStatus::kOk: return {};
    case DecodeStatus::kBadText:
      return "a name of a joint or blend shape, or the subject's, is empty, there twice, not UTF-8 "
             "or has control characters";
    case DecodeStatus::kLimit:
    case DecodeStatus::kBadLength:
      return "it has more than " + std::to_string(kMaxJoints) + " joints or " +
             std::to_string(kMaxBlendShapes) + " blend shapes, or a name above " +
             std::to_string(kMaxNameBytes) + " bytes";
    default: return "it cannot be put on the wire (" + std::string(DecodeStatusName(status)) + ")";
  }
}

}  // namespace furrow::protocol
