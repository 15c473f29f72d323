// SPDX-License-Identifier: Apache-2.0
#include "server/http/weights/weight_query.h"

#include <algorithm>
#include <string>

#include "base/numbers.h"
#include "base/status.h"
#include "protocol/messages/limits.h"

namespace furrow::server {
namespace {

// Each subject is a message to the hub, and a peer may have 64 of them waiting.
constexpr std::size_t kMaxSubjects = 64;

// The limits of the wire. The hub answers what exceeds them without saying which field it was.
Status CheckLength(const std::string& name, const std::string& value) {
  const int most = name == "pattern" ? protocol::kMaxPatternBytes : protocol::kMaxNameBytes;
  if (value.size() <= static_cast<std::size_t>(most)) return {};
  return Status(StatusCode::kInvalidArgument,
                "the value is longer than " + std::to_string(most) + " bytes", name);
}

}  // namespace

Result<std::vector<protocol::SubscribeWeights>> WeightsOf(const Url& url) {
  protocol::SubscribeWeights common;
  std::vector<std::string> subjects;
  for (const auto& [name, value] : url.values) {
    FURROW_RETURN_IF_ERROR(CheckLength(name, value));
    if (name == "subject") {
      if (std::ranges::find(subjects, value) != subjects.end()) {
        return Status(StatusCode::kInvalidArgument, "'" + value + "' is repeated", name);
      }
      if (subjects.size() >= kMaxSubjects) {
        return Status(StatusCode::kInvalidArgument,
                      "at most " + std::to_string(kMaxSubjects) + " subjects", name,
                      "use another connection for more");
      }
      subjects.push_back(value);
    } else if (name == "pattern") {
      if (!value.empty()) common.pattern = value;
    } else if (name == "rate") {
      double rate = 0.0;
      // The comparison is written so that NaN fails.
      if (!TryParseNumber(value, &rate) || !(rate >= 0.0 && rate <= 1000.0)) {
        return Status(StatusCode::kInvalidArgument,
                      "'" + value + "' is not a number from 0 to 1000", name);
      }
      common.max_rate_hz = static_cast<float>(rate);
    } else if (name == "every") {
      if (value != "true" && value != "false") {
        return Status(StatusCode::kInvalidArgument, "'" + value + "' is not true or false", name);
      }
      common.every = value == "true";
    } else {
      return Status(StatusCode::kInvalidArgument, "unknown name", name,
                    "use subject, pattern, rate or every");
    }
  }
  if (subjects.empty()) subjects.emplace_back();
  std::vector<protocol::SubscribeWeights> requests;
  for (std::string& subject : subjects) {
    common.subject = std::move(subject);
    common.wait = true;
    requests.push_back(common);
  }
  return requests;
}

}  // namespace furrow::server
