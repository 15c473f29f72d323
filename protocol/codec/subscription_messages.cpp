// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/subscription_messages.h"

#include "protocol/messages/hash.h"

namespace furrow::protocol::internal {

DecodeStatus ReadTable(const wire::SubscribeWeights& table, SubscribeWeights& message) {
  FURROW_CHECK_DECODE(ReadText(table.subject(), kMaxNameBytes, message.subject));
  FURROW_CHECK_DECODE(ReadText(table.pattern(), kMaxPatternBytes, message.pattern));
  if (table.pattern() == nullptr) message.pattern = "*";
  FURROW_CHECK_DECODE(CheckRate(table.max_rate_hz()));
  if (table.format() > wire::WeightFormat::MAX || table.source() > wire::WeightSource::MAX) {
    return DecodeStatus::kBadValue;
  }
  message.wait = table.wait();
  message.max_rate_hz = table.max_rate_hz();
  message.format = static_cast<WeightFormat>(table.format());
  message.source = static_cast<WeightSource>(table.source());
  message.every = table.every();
  return DecodeStatus::kOk;
}

flatbuffers::Offset<wire::SubscribeWeights> WriteTable(PayloadBuilder& payload,
                                                       const SubscribeWeights& message) {
  const auto subject = WriteText(payload, message.subject);
  // Written even if empty: an absent pattern means "*", an empty pattern matches nothing.
  const auto pattern = payload.builder.CreateString(message.pattern);
  return wire::CreateSubscribeWeights(
      payload.builder, subject, message.wait, pattern, message.max_rate_hz,
      static_cast<wire::WeightFormat>(message.format),
      static_cast<wire::WeightSource>(message.source), message.every);
}

DecodeStatus ReadTable(const wire::SubscribePoses& table, SubscribePoses& message) {
  FURROW_CHECK_DECODE(ReadText(table.subject(), kMaxNameBytes, message.subject));
  FURROW_CHECK_DECODE(CheckRate(table.max_rate_hz()));
  message.wait = table.wait();
  message.max_rate_hz = table.max_rate_hz();
  message.every = table.every();
  return DecodeStatus::kOk;
}

flatbuffers::Offset<wire::SubscribePoses> WriteTable(PayloadBuilder& payload,
                                                     const SubscribePoses& message) {
  const auto subject = WriteText(payload, message.subject);
  return wire::CreateSubscribePoses(payload.builder, subject, message.wait, message.max_rate_hz,
                                    message.every);
}

DecodeStatus ReadTable(const wire::Unsubscribe& /*table*/, Unsubscribe& /*message*/) {
  return DecodeStatus::kOk;
}

flatbuffers::Offset<wire::Unsubscribe> WriteTable(PayloadBuilder& payload,
                                                  const Unsubscribe& /*message*/) {
  return wire::CreateUnsubscribe(payload.builder);
}

DecodeStatus ReadTable(const wire::SubscribeReply& table, SubscribeReply& message) {
  FURROW_CHECK_DECODE(ReadText(table.subject(), kMaxNameBytes, message.subject));
  FURROW_CHECK_DECODE(ReadNames(table.names(), kMaxWeights, message.names));
  message.names_hash = table.names_hash();
  message.publisher_session = table.publisher_session();
  message.epoch = table.epoch();
  return NamesHash(message.names) == message.names_hash ? DecodeStatus::kOk
                                                        : DecodeStatus::kBadHash;
}

flatbuffers::Offset<wire::SubscribeReply> WriteTable(PayloadBuilder& payload,
                                                     const SubscribeReply& message) {
  const auto subject = WriteText(payload, message.subject);
  const auto names = WriteNames(payload, message.names);
  return wire::CreateSubscribeReply(payload.builder, subject, NamesHash(message.names), names,
                                    message.publisher_session, message.epoch);
}

DecodeStatus ReadTable(const wire::Dropped& table, Dropped& message) {
  message.frames = table.frames();
  return DecodeStatus::kOk;
}

flatbuffers::Offset<wire::Dropped> WriteTable(PayloadBuilder& payload, const Dropped& message) {
  return wire::CreateDropped(payload.builder, message.frames);
}

DecodeStatus ReadTable(const wire::ListSubjects& table, ListSubjects& message) {
  message.follow = table.follow();
  return DecodeStatus::kOk;
}

flatbuffers::Offset<wire::ListSubjects> WriteTable(PayloadBuilder& payload,
                                                   const ListSubjects& message) {
  return wire::CreateListSubjects(payload.builder, message.follow);
}

DecodeStatus ReadTable(const wire::Subjects& table, Subjects& message) {
  FURROW_CHECK_DECODE(ReadNames(table.names(), kMaxListedSubjects, message.names));
  message.total = table.total();
  return message.total < message.names.size() ? DecodeStatus::kBadCount : DecodeStatus::kOk;
}

flatbuffers::Offset<wire::Subjects> WriteTable(PayloadBuilder& payload, const Subjects& message) {
  const auto names = WriteNames(payload, message.names);
  return wire::CreateSubjects(payload.builder, names, message.total);
}

}  // namespace furrow::protocol::internal
