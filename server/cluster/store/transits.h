// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "server/cluster/node/node_address.h"
#include "server/core/time.h"

namespace furrow::server {

// Subjects on their way from one node to another one, which the store does not show yet. Each
// counts as on its way for Coordinator::kExpected at most. Thread-safe.
class Transits {
 public:
  // The subject comes to this node.
  void Expect(std::string_view subject, Time now);
  void ForgetExpected(std::string_view subject);
  [[nodiscard]] bool IsExpected(std::string_view subject, Time now) const;
  // Those that are expected, except `besides` and those that `is_here` knows.
  [[nodiscard]] std::size_t CountExpected(std::string_view besides,
                                          const std::function<bool(const std::string&)>& is_here,
                                          Time now) const;
  // True if any subject is expected. Forgets entries older than kExpected, whether or not their
  // subjects came.
  [[nodiscard]] bool ExpectsAny(Time now);

  // The subject goes from this node to another one.
  void Give(std::string_view subject, const NodeAddress& heir, Time now);
  [[nodiscard]] std::optional<NodeAddress> HeirOf(std::string_view subject, Time now) const;
  // How many subjects the node has got from this one since the start.
  [[nodiscard]] int NumGivenTo(const std::string& node) const;

 private:
  struct Given {
    NodeAddress heir;
    Time until{0};  // by then the record says so
  };
  mutable std::mutex mutex_;
  std::map<std::string, Time, std::less<>> expected_;  // by subject: until when
  std::map<std::string, Given, std::less<>> given_;    // by subject
  std::map<std::string, int> given_to_;                // by node
};

}  // namespace furrow::server
