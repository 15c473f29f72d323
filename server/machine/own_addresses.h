// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace furrow::server {

// The numeric addresses by which other computers reach a port that listens on `bind`: `bind`
// itself, or for 0.0.0.0 and :: the addresses of this computer's interfaces that are up, IPv4
// first, without loopback and link-local ones. Empty if only this computer reaches it.
[[nodiscard]] std::vector<std::string> ReachableAddresses(const std::string& bind);

// True for a numeric address of this computer: a loopback one, or one of its interfaces that are
// up.
[[nodiscard]] bool IsOwnAddress(const std::string& address);

}  // namespace furrow::server
