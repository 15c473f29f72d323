// SPDX-License-Identifier: Apache-2.0
// SubscribeWeights, Unsubscribe, SubscribeReply: STANDARD.md
// section 8.
#include "protocol/codec/codec_internal.h"
#include "protocol/messages/hash.h"
#include "protocol/schema/subscribe_reply_generated.h"
#include "protocol/schema/subscribe_weights_generated.h"
#include "protocol/schema/unsubscribe_generated.h"

namespace furrow::protocol {
using internal::Builder;
using internal::Finish;
using internal::ReadText;
using internal::Verify;
using internal::WriteText;

DecodeStatus Decode(const MessageView& view, SubscribeWeights& message) {
  const wire::SubscribeWeights* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kSubscribeWeights, root));
  FURROW_CHECK_DECODE(ReadText(root->subject(), kMaxNameBytes, message.subject));
  FURROW_CHECK_DECODE(ReadText(root->pattern(), kMaxPatternBytes, message.pattern));
  if (root->pattern() == nullptr) message.pattern = "*";
  FURROW_CHECK_DECODE(internal::CheckRate(root->max_rate_hz()));
  if (root->format() > wire::WeightFormat::MAX || root->source() > wire::WeightSource::MAX) {
    return DecodeStatus::kBadValue;
  }
  message.wait = root->wait();
  message.max_rate_hz = root->max_rate_hz();
  message.format = static_cast<WeightFormat>(root->format());
  message.source = static_cast<WeightSource>(root->source());
  message.every = root->every();
  return DecodeStatus::kOk;
}

void Encoder::Encode(const Header& header, const SubscribeWeights& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  const auto subject = WriteText(builder, message.subject);
  const auto pattern = builder.CreateString(message.pattern);
  Finish(
      builder,
      wire::CreateSubscribeWeights(builder, subject, message.wait, pattern, message.max_rate_hz,
                                   static_cast<wire::WeightFormat>(message.format),
                                   static_cast<wire::WeightSource>(message.source), message.every),
      header, MessageKind::kSubscribeWeights, out);
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
  message.publisher_session = root->publisher_session();
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
  Finish(builder,
         wire::CreateSubscribeReply(builder, subject, NamesHash(message.names), names,
                                    message.publisher_session),
         header, MessageKind::kSubscribeReply, out);
}

}  // namespace furrow::protocol
