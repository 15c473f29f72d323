// SPDX-License-Identifier: Apache-2.0
// Records of a cluster's store, which everybody may have written who can write to it.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "server/cluster/store/records.h"

using furrow::server::LeaseKey;
using furrow::server::ToText;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto lease = furrow::server::ParseLease(text)) {
    if (furrow::server::ParseLease(ToText(*lease)) != lease) std::abort();
  }
  if (const auto node = furrow::server::ParseAnnouncement("a", text)) {
    if (furrow::server::ParseAnnouncement("a", ToText(*node)) != node) std::abort();
  }
  if (const auto subject = furrow::server::SubjectOfKey(text)) {
    if (LeaseKey(*subject) != text) std::abort();
  }
  (void)furrow::server::NodeOfKey(text);
  (void)furrow::server::ParseNode(text);
  return 0;
}
