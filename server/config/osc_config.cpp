// SPDX-License-Identifier: Apache-2.0
#include "server/config/osc_config.h"

#include "protocol/messages/limits.h"

namespace furrow::server {
namespace {

Status Invalid(const char* field, std::string what) {
  return Status(StatusCode::kInvalidArgument, std::move(what), field);
}

}  // namespace

Status CheckOscTarget(const OscTargetConfig& target) {
  if (target.prefix.empty() || target.prefix.size() > protocol::kMaxNameBytes ||
      // OSC 1.0 reserves these characters.
      target.prefix.find_first_of(" #*,?[]{}") != std::string::npos) {
    return Invalid(
        "prefix", "'" + target.prefix + "' must not be empty or contain blanks or any of #*,?[]{}");
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
