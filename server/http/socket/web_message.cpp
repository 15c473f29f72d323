// SPDX-License-Identifier: Apache-2.0
#include "server/http/socket/web_message.h"

#include "protocol/codec/codec.h"
#include "server/http/request/web_context.h"

namespace furrow::server {

bool IsWebMessage(std::span<const std::uint8_t> bytes) {
  protocol::MessageView view;
  const auto status = protocol::OpenMessage(bytes, view, kMaxWebMessageBytes);
  // The hub answers unknown kinds with an error, so a newer client learns what is missing.
  return status == protocol::DecodeStatus::kOk || status == protocol::DecodeStatus::kUnknownKind;
}

}  // namespace furrow::server
