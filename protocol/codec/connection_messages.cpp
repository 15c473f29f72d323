// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/connection_messages.h"

namespace furrow::protocol::internal {

DecodeStatus ReadTable(const wire::Hello& table, Hello& message) {
  message.token = table.token();
  message.bundles = table.bundles();
  const DecodeStatus status = ReadText(table.access(), kMaxAccessBytes, message.access);
  if (status != DecodeStatus::kOk) return status;
  return ReadText(table.client(), kMaxProgramBytes, message.client);
}

flatbuffers::Offset<wire::Hello> WriteTable(PayloadBuilder& payload, const Hello& message,
                                            std::size_t padding) {
  const auto client = WriteText(payload, message.client);
  const auto access = WriteText(payload, message.access);
  // Reuses the scratch bytes for the padding.
  payload.mask.assign(padding, 0);
  const auto zeros = padding > 0 ? payload.builder.CreateVector(payload.mask) : 0;
  return wire::CreateHello(payload.builder, client, message.token, zeros, message.bundles, access);
}

DecodeStatus ReadTable(const wire::Welcome& table, Welcome& message) {
  message.token = table.token();
  FURROW_CHECK_DECODE(ReadNames(table.others(), kMaxOthers, message.others));
  return ReadText(table.server(), kMaxProgramBytes, message.server);
}

flatbuffers::Offset<wire::Welcome> WriteTable(PayloadBuilder& payload, const Welcome& message) {
  const auto server = WriteText(payload, message.server);
  const auto others = WriteNames(payload, message.others);
  return wire::CreateWelcome(payload.builder, server, message.token, others);
}

DecodeStatus ReadTable(const wire::Ping& table, Ping& message) {
  message.time_us = table.time_us();
  return DecodeStatus::kOk;
}

flatbuffers::Offset<wire::Ping> WriteTable(PayloadBuilder& payload, const Ping& message) {
  return wire::CreatePing(payload.builder, message.time_us);
}

DecodeStatus ReadTable(const wire::Pong& table, Pong& message) {
  message.time_us = table.time_us();
  message.server_time_us = table.server_time_us();
  return DecodeStatus::kOk;
}

flatbuffers::Offset<wire::Pong> WriteTable(PayloadBuilder& payload, const Pong& message) {
  return wire::CreatePong(payload.builder, message.time_us, message.server_time_us);
}

DecodeStatus ReadTable(const wire::Goodbye& table, Goodbye& message) {
  // The verifier checks offsets and sizes but no enumerations.
  if (table.reason() > wire::GoodbyeReason::MAX) return DecodeStatus::kBadValue;
  message.reason = static_cast<GoodbyeReason>(table.reason());
  return DecodeStatus::kOk;
}

flatbuffers::Offset<wire::Goodbye> WriteTable(PayloadBuilder& payload, const Goodbye& message) {
  return wire::CreateGoodbye(payload.builder, static_cast<wire::GoodbyeReason>(message.reason));
}

DecodeStatus ReadTable(const wire::Error& table, ErrorMessage& message) {
  const auto code = static_cast<ErrorCode>(table.code());
  if (code < ErrorCode::kMalformed || code > ErrorCode::kNotPermitted)
    return DecodeStatus::kBadValue;
  message.code = code;
  FURROW_CHECK_DECODE(ReadText(table.message(), kMaxTextBytes, message.message));
  FURROW_CHECK_DECODE(ReadText(table.host(), kMaxHostBytes, message.host));
  message.tcp = table.tcp();
  message.udp = table.udp();
  message.web = table.web();
  message.web_tls = table.web_tls();
  const bool has_ports = message.tcp != 0 && message.udp != 0;
  return message.host.empty() || has_ports ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

flatbuffers::Offset<wire::Error> WriteTable(PayloadBuilder& payload, const ErrorMessage& message) {
  const auto text = WriteText(payload, message.message);
  const auto host = WriteText(payload, message.host);
  return wire::CreateError(payload.builder, static_cast<std::uint16_t>(message.code), text, host,
                           message.tcp, message.udp, message.web, message.web_tls);
}

}  // namespace furrow::protocol::internal
