// SPDX-License-Identifier: Apache-2.0
#include "server/http/socket/web_message.h"

#include "protocol/codec/codec.h"
#include "server/http/request/web_context.h"

namespace furrow::server {

bool IsWebMessage(std::span<const std::uint8_t> bytes) {
  protocol::MessageView view;
  const auto status = protocol::OpenMessage(bytes, view, kMaxWebMessageBytes);
  return status == protocol::DecodeStatus::kOk || status == protocol::DecodeStatus::kUnknownKind;
}

}  // namespace furrow::server
