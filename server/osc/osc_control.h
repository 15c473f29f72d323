// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/status.h"
#include "server/config/osc_config.h"

namespace furrow::server {

// What HTTP clients may do with the targets of OSC. Apart from OscTargets, whose header needs
// standalone Asio, which cannot be compiled together with Boost's. Functions require the hub's
// exclusive lock.
class OscControl {
 public:
  virtual ~OscControl() = default;

  // Adds a target and returns its number; an equal target is not added again. HTTP clients are not
  // trusted with addresses: they may add this machine's loopback addresses and those that the
  // operator allows, so that nobody can aim the daemon's traffic at others.
  //
  // Errors, with the name of the field as `where`: kInvalidArgument, kNotFound (no such shipped
  // profile), kUnsupported (a forbidden address), kLimit, kUnavailable (no socket).
  [[nodiscard]] virtual Result<int> Add(const OscTargetConfig& config) = 0;
  // Removes a target. Errors: kNotFound; kUnsupported (a target of the operator).
  [[nodiscard]] virtual Status Remove(int id) = 0;

  // One target as users see it.
  struct View {
    int id = 0;
    OscTargetConfig config;
    bool configured = false;    // by the operator
    std::uint64_t packets = 0;  // sent so far
    std::uint64_t errors = 0;   // packets that could not be sent, or that nobody received
    std::string last_error;     // empty: none so far
  };
  [[nodiscard]] virtual std::vector<View> List() const = 0;
  // The addresses that the operator allows.
  [[nodiscard]] virtual const std::vector<std::string>& allowed() const = 0;
};

}  // namespace furrow::server
