// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow::protocol::secure {

// What the holder of a connect token may do. A token holds a set of roles, one bit each.
enum class Role : std::uint16_t {
  kPublish = 1,  // send the poses of the subjects that match the token's pattern
  kWatch = 2,    // receive weights, poses and pictures of these subjects
  kDirect = 4,   // change settings and take captures
  kOperate = 8,  // read metrics and drain the daemon
};

class Roles {
 public:
  static constexpr std::uint16_t kAllBits = 15;

  constexpr Roles() = default;
  constexpr Roles(Role role) : bits_(static_cast<std::uint16_t>(role)) {}  // NOLINT: implicit
  // Bits outside of kAllBits are kept; valid() reports them.
  constexpr explicit Roles(std::uint16_t bits) : bits_(bits) {}

  [[nodiscard]] constexpr bool Has(Role role) const {
    return (bits_ & static_cast<std::uint16_t>(role)) != 0;
  }
  // At least one role, and no undefined one.
  [[nodiscard]] constexpr bool valid() const { return bits_ != 0 && (bits_ & ~kAllBits) == 0; }
  [[nodiscard]] constexpr std::uint16_t bits() const { return bits_; }

  friend constexpr Roles operator|(Roles a, Roles b) {
    return Roles(static_cast<std::uint16_t>(a.bits_ | b.bits_));
  }
  friend constexpr bool operator==(Roles, Roles) = default;

 private:
  std::uint16_t bits_ = 0;
};

// "publish,watch", in the order of Role. Undefined bits are not shown.
[[nodiscard]] std::string ToText(Roles roles);
// Reads a comma-separated list of roles. Error: kInvalidArgument, with the words that exist.
[[nodiscard]] Result<Roles> ParseRoles(std::string_view text);

}  // namespace furrow::protocol::secure
