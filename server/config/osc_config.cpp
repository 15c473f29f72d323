// SPDX-License-Identifier: Apache-2.0
#include "server/config/osc_config.h"

#include "protocol/messages/limits.h"
#include "protocol/messages/text.h"

namespace furrow::server {
namespace {

Status Invalid(const char* field, std::string what) {
  return Status(StatusCode::kInvalidArgument, std::move(what), field);
}

}  // namespace

Status CheckOscTarget(const OscTargetConfig& target) {
  const std::string& prefix = target.prefix;
  if (prefix.empty() || prefix.size() > protocol::kMaxNameBytes ||
      // OSC 1.0 reserves these characters.
      prefix.find_first_of(" #*,?[]{}") != std::string::npos) {
    return Invalid("prefix", "'" + prefix + "' must have 1 to " +
                                 std::to_string(protocol::kMaxNameBytes) +
                                 " bytes and no blanks or any of #*,?[]{}");
  }
  // A zero byte ends an OSC string, so the rest of the prefix could forge arguments. Addresses have
  // their own slashes around the prefix.
  if (!protocol::IsPlainText(prefix) || prefix.front() == '/' || prefix.back() == '/') {
    return Invalid("prefix",
                   "must be UTF-8 without control characters and without '/' at its ends");
  }
  if (target.subject.size() > protocol::kMaxNameBytes) {
    return Invalid("subject",
                   "the name is longer than " + std::to_string(protocol::kMaxNameBytes) + " bytes");
  }
  if (target.pattern.empty() || target.pattern.size() > protocol::kMaxPatternBytes) {
    return Invalid("pattern",
                   "must have 1 to " + std::to_string(protocol::kMaxPatternBytes) + " bytes");
  }
  // The comparison is written so that NaN fails.
  if (!(target.rate_hz >= 0.0 && target.rate_hz <= 1000.0)) {
    return Invalid("rate_hz", "must be 0 to 1000 frames per second; 0 means every pose");
  }
  return {};
}

}  // namespace furrow::server
