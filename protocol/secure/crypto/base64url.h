// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "protocol/secure/crypto/primitives.h"

namespace furrow::protocol::secure {

// base64url without padding (RFC 4648 section 5). The running time depends on the size alone, so it
// tells nothing about a secret.
[[nodiscard]] std::string ToBase64Url(ByteView bytes);
// Returns false unless `text` encodes exactly bytes.size() bytes in the one canonical form. `bytes`
// is unspecified then.
[[nodiscard]] bool FromBase64Url(std::string_view text, ByteSpan bytes);

}  // namespace furrow::protocol::secure
