// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/messages/messages.h"

namespace furrow::server {

// Translates the hub's messages about weights into JSON objects, one per line
// (docs/HTTP-API.md, "Weights as JSON lines").
class WeightLines {
 public:
  enum class Line {
    kNone = 0,  // nothing to tell the client
    kText,      // `line` is the next line
    kLast,      // the same, and nothing follows: close the connection after it
  };

  // `requests`: the subscriptions; request i was sent with sequence i + 1.
  explicit WeightLines(std::vector<protocol::SubscribeWeights> requests)
      : requests_(std::move(requests)) {}

  // Translates one message. `line` is replaced, and has no line end. Messages that cannot be
  // decoded are kNone.
  [[nodiscard]] Line Translate(std::span<const std::uint8_t> message, std::string* line);

  // The line that follows a silence, so that both ends know that the other is there.
  static constexpr std::string_view kAlive = R"({"type":"alive"})";

 private:
  [[nodiscard]] const std::string& Requested(std::uint32_t sequence) const;

  std::vector<protocol::SubscribeWeights> requests_;
  std::map<std::uint16_t, std::string> subjects_;  // by subscription, as JSON with its quotes
  protocol::SubscribeReply reply_;
  protocol::WeightFrame frame_;
};

}  // namespace furrow::server
