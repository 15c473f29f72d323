// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tests/unit/protocol/drill.h"

namespace furrow::protocol::test {

// Writes Live Link Face datagrams from the documented layout. Shares no code with the decoder.
struct LiveLinkPacket {
  int version = 6;
  std::string device = "8E5C3A10-1B2F-4D3E-9A77-0123456789AB";  // 36 characters
  std::string subject = "iPhoneOfAnna1";                        // 13 characters
  int frame = 1'234'567;
  float subframe = 0.25f;
  int rate_numerator = 60;
  int rate_denominator = 1;
  std::vector<float> values = std::vector<float>(61, 0.0f);  // empty: no face

  [[nodiscard]] Bytes Encode() const;
};

}  // namespace furrow::protocol::test
