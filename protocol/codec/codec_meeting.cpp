// SPDX-License-Identifier: Apache-2.0
// Hello, Welcome, Ping, Pong, Goodbye, Error: STANDARD.md sections 4 and 10.
#include "protocol/codec/codec_internal.h"
#include "protocol/schema/error_generated.h"
#include "protocol/schema/goodbye_generated.h"
#include "protocol/schema/hello_generated.h"
#include "protocol/schema/ping_generated.h"
#include "protocol/schema/pong_generated.h"
#include "protocol/schema/welcome_generated.h"

namespace furrow::protocol {

using internal::Finish;
using internal::ReadText;
using internal::Verify;
using internal::WriteText;

DecodeStatus Decode(const MessageView& view, Hello& message) {
  const wire::Hello* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kHello, root));
  message.token = root->token();
  message.bundles = root->bundles();
  return ReadText(root->client(), kMaxProgramBytes, message.client);
}

void Encoder::Encode(const Header& header, const Hello& message, std::vector<std::uint8_t>& out) {
  // What the other fields take depends on alignment, so one
  // try without padding says what is missing.
  std::size_t padding = 0;
  do {
    internal::Builder& builder = state_->builder;
    builder.Clear();
    const auto client = WriteText(builder, message.client);
    state_->mask.assign(padding, 0);
    const auto zeros = padding > 0 ? builder.CreateVector(state_->mask) : 0;
    Finish(builder, wire::CreateHello(builder, client, message.token, zeros, message.bundles),
           header, MessageKind::kHello, out);
    padding += kHelloBytes - std::min(kHelloBytes, out.size());
  } while (out.size() < kHelloBytes);
}

DecodeStatus Decode(const MessageView& view, Welcome& message) {
  const wire::Welcome* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kWelcome, root));
  message.token = root->token();
  return ReadText(root->server(), kMaxProgramBytes, message.server);
}

void Encoder::Encode(const Header& header, const Welcome& message, std::vector<std::uint8_t>& out) {
  internal::Builder& builder = state_->builder;
  builder.Clear();
  const auto server = WriteText(builder, message.server);
  Finish(builder, wire::CreateWelcome(builder, server, message.token), header,
         MessageKind::kWelcome, out);
}

DecodeStatus Decode(const MessageView& view, Ping& message) {
  const wire::Ping* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kPing, root));
  message.time_us = root->time_us();
  return DecodeStatus::kOk;
}

void Encoder::Encode(const Header& header, const Ping& message, std::vector<std::uint8_t>& out) {
  internal::Builder& builder = state_->builder;
  builder.Clear();
  Finish(builder, wire::CreatePing(builder, message.time_us), header, MessageKind::kPing, out);
}

DecodeStatus Decode(const MessageView& view, Pong& message) {
  const wire::Pong* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kPong, root));
  message.time_us = root->time_us();
  message.server_time_us = root->server_time_us();
  return DecodeStatus::kOk;
}

void Encoder::Encode(const Header& header, const Pong& message, std::vector<std::uint8_t>& out) {
  internal::Builder& builder = state_->builder;
  builder.Clear();
  Finish(builder, wire::CreatePong(builder, message.time_us, message.server_time_us), header,
         MessageKind::kPong, out);
}

DecodeStatus Decode(const MessageView& view, Goodbye& message) {
  const wire::Goodbye* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kGoodbye, root));
  if (root->reason() > wire::GoodbyeReason::MAX) return DecodeStatus::kBadValue;
  message.reason = static_cast<GoodbyeReason>(root->reason());
  return DecodeStatus::kOk;
}

void Encoder::Encode(const Header& header, const Goodbye& message, std::vector<std::uint8_t>& out) {
  internal::Builder& builder = state_->builder;
  builder.Clear();
  const auto reason = static_cast<wire::GoodbyeReason>(message.reason);
  Finish(builder, wire::CreateGoodbye(builder, reason), header, MessageKind::kGoodbye, out);
}

DecodeStatus Decode(const MessageView& view, ErrorMessage& message) {
  const wire::Error* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kError, root));
  const auto code = static_cast<ErrorCode>(root->code());
  if (code < ErrorCode::kMalformed || code > ErrorCode::kInternal) return DecodeStatus::kBadValue;
  message.code = code;
  return ReadText(root->message(), kMaxTextBytes, message.message);
}

void Encoder::Encode(const Header& header, const ErrorMessage& message,
                     std::vector<std::uint8_t>& out) {
  internal::Builder& builder = state_->builder;
  builder.Clear();
  const auto text = WriteText(builder, message.message);
  const auto code = static_cast<std::uint16_t>(message.code);
  Finish(builder, wire::CreateError(builder, code, text), header, MessageKind::kError, out);
}

}  // namespace furrow::protocol
