// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow {

// What a helper program makes of a file.
struct HelperReply {
  std::vector<std::string> notes;  // a line each; their meaning is the helper program's
  std::string payload;
};

// A reply or an error as the bytes of the helper's standard output. Both ends belong to one build,
// so there is no version and no fixed byte order.
[[nodiscard]] std::string EncodeReply(const Result<HelperReply>& reply);

// The inverse. A hostile file may have taken over the helper: every length is checked. Errors: the
// encoded one, kParse (not a reply).
[[nodiscard]] Result<HelperReply> DecodeReply(std::string_view bytes);

}  // namespace furrow
