// SPDX-License-Identifier: Apache-2.0
// SubscribePoses and Dropped: STANDARD.md sections 8 and 9.
#include "protocol/codec/codec_internal.h"
#include "protocol/schema/dropped_generated.h"
#include "protocol/schema/subscribe_poses_generated.h"

namespace furrow::protocol {

using internal::Builder;
using internal::Finish;
using internal::Verify;

DecodeStatus Decode(const MessageView& view, SubscribePoses& message) {
  const wire::SubscribePoses* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kSubscribePoses, root));
  FURROW_CHECK_DECODE(internal::ReadText(root->subject(), kMaxNameBytes, message.subject));
  FURROW_CHECK_DECODE(internal::CheckRate(root->max_rate_hz()));
  message.wait = root->wait();
  message.max_rate_hz = root->max_rate_hz();
  message.every = root->every();
  return DecodeStatus::kOk;
}

void Encoder::Encode(const Header& header, const SubscribePoses& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  const auto subject = internal::WriteText(builder, message.subject);
  Finish(builder,
         wire::CreateSubscribePoses(builder, subject, message.wait, message.max_rate_hz,
                                    message.every),
         header, MessageKind::kSubscribePoses, out);
}

DecodeStatus Decode(const MessageView& view, Dropped& message) {
  const wire::Dropped* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kDropped, root));
  message.frames = root->frames();
  return DecodeStatus::kOk;
}

void Encoder::Encode(const Header& header, const Dropped& message, std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  Finish(builder, wire::CreateDropped(builder, message.frames), header, MessageKind::kDropped, out);
}

}  // namespace furrow::protocol
