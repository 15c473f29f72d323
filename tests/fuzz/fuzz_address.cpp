// SPDX-License-Identifier: Apache-2.0
// Addresses of daemons (furrow://...): whatever is accepted keeps the limits of the wire.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "client/cpp/address.h"
#include "protocol/messages/limits.h"
#include "protocol/messages/text.h"

namespace p = furrow::protocol;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto address = furrow::client::ParseAddress({reinterpret_cast<const char*>(data), size});
  if (!address.ok()) return 0;
  bool sound = !address->host.empty() && address->subjects.size() <= 256 &&
               address->pattern.size() <= p::kMaxPatternBytes && p::IsPlainText(address->pattern) &&
               address->max_rate_hz >= 0.0f && address->max_rate_hz <= p::kMaxRateHz;
  for (const std::string& subject : address->subjects) {
    sound =
        sound && !subject.empty() && subject.size() <= p::kMaxNameBytes && p::IsPlainText(subject);
  }
  if (!sound) std::abort();
  return 0;
}
