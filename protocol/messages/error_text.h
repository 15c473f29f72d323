// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "protocol/messages/messages.h"

namespace furrow::protocol {

// The sentence of an error: what the sender wrote, or a general one for the code. Answers to short
// datagrams have the code alone, because an answer must not be longer than its request.
[[nodiscard]] std::string SentenceOf(const ErrorMessage& error);

}  // namespace furrow::protocol
