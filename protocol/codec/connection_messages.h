// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "protocol/codec/decode_status.h"
#include "protocol/codec/wire_fields.h"
#include "protocol/messages/messages.h"
#include "protocol/schema/error_generated.h"
#include "protocol/schema/goodbye_generated.h"
#include "protocol/schema/hello_generated.h"
#include "protocol/schema/ping_generated.h"
#include "protocol/schema/pong_generated.h"
#include "protocol/schema/welcome_generated.h"

// Connection messages: STANDARD.md sections 4 and 10.
namespace furrow::protocol::internal {

[[nodiscard]] DecodeStatus ReadTable(const wire::Hello& table, Hello& message);
// `padding`: bytes of zeros to add.
[[nodiscard]] flatbuffers::Offset<wire::Hello> WriteTable(PayloadBuilder& payload,
                                                          const Hello& message,
                                                          std::size_t padding);

[[nodiscard]] DecodeStatus ReadTable(const wire::Welcome& table, Welcome& message);
[[nodiscard]] flatbuffers::Offset<wire::Welcome> WriteTable(PayloadBuilder& payload,
                                                            const Welcome& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::Ping& table, Ping& message);
[[nodiscard]] flatbuffers::Offset<wire::Ping> WriteTable(PayloadBuilder& payload,
                                                         const Ping& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::Pong& table, Pong& message);
[[nodiscard]] flatbuffers::Offset<wire::Pong> WriteTable(PayloadBuilder& payload,
                                                         const Pong& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::Goodbye& table, Goodbye& message);
[[nodiscard]] flatbuffers::Offset<wire::Goodbye> WriteTable(PayloadBuilder& payload,
                                                            const Goodbye& message);

[[nodiscard]] DecodeStatus ReadTable(const wire::Error& table, ErrorMessage& message);
[[nodiscard]] flatbuffers::Offset<wire::Error> WriteTable(PayloadBuilder& payload,
                                                          const ErrorMessage& message);

}  // namespace furrow::protocol::internal
