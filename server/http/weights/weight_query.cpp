// SPDX-License-Identifier: Apache-2.0
#include "server/http/weights/weight_query.h"

#include <algorithm>
#include <cmath>
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

Result<double> NumberIn(double least, double most, const std::string& name,
                        const std::string& value) {
  double number = 0.0;
  // The comparison is written so that NaN fails.
  if (TryParseNumber(value, &number) && number >= least && number <= most) return number;
  std::string limits = "from ";
  AppendShortest(static_cast<float>(least), &limits);
  limits += " to ";
  AppendShortest(static_cast<float>(most), &limits);
  return Status(StatusCode::kInvalidArgument, "'" + value + "' is not a number " + limits, name);
}

}  // namespace

Result<WeightQuery> WeightsOf(const Url& url) {
  WeightQuery query;
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
      const auto rate = NumberIn(0.0, 1000.0, name, value);
      FURROW_RETURN_IF_ERROR(rate);
      common.max_rate_hz = static_cast<float>(*rate);
    } else if (name == "alive") {
      const auto seconds = NumberIn(0.1, 60.0, name, value);
      FURROW_RETURN_IF_ERROR(seconds);
      query.alive = std::chrono::milliseconds(std::lround(*seconds * 1000.0));
    } else if (name == "every") {
      if (value != "true" && value != "false") {
        return Status(StatusCode::kInvalidArgument, "'" + value + "' is not true or false", name);
      }
      common.every = value == "true";
    } else {
      return Status(StatusCode::kInvalidArgument, "unknown name", name,
                    "use subject, pattern, rate, every or alive");
    }
  }
  if (subjects.empty()) subjects.emplace_back();
  for (std::string& subject : subjects) {
    common.subject = std::move(subject);
    common.wait = true;
    query.requests.push_back(common);
  }
  return query;
}

}  // namespace furrow::server
