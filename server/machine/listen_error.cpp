// SPDX-License-Identifier: Apache-2.0
#include "server/machine/listen_error.h"

#include <cerrno>
#include <vector>

#include "base/joined.h"
#include "server/machine/own_addresses.h"

namespace furrow::server {
namespace {

// The addresses that --bind may take, as a list.
std::string OwnAddresses() {
  std::vector<std::string> addresses = ReachableAddresses("::");
  addresses.insert(addresses.begin(), {"127.0.0.1", "::1"});
  return Joined(addresses);
}

}  // namespace

Status ListenError(const std::string& transport, const HostPort& where, int error,
                   const std::string& flag) {
  // The number may be any that the system knows; strerror() is not safe between threads.
  const std::string reason = std::error_code(error, std::system_category()).message();
  const std::string what = "cannot listen on " + transport + " " + where.host + " port " +
                           std::to_string(where.port) + ": ";
  switch (error) {
    case EADDRNOTAVAIL:
      return {StatusCode::kUnavailable, what + where.host + " is not an address of this computer",
              "",
              "set --bind to one of its addresses (" + OwnAddresses() +
                  "), or to 0.0.0.0 or :: for all of them"};
    case EACCES:
      if (where.port >= 1024) break;
      return {StatusCode::kUnavailable, what + reason, "",
              "ports below 1024 need privileges; set another one with " + flag};
    case EADDRINUSE:
      return {StatusCode::kUnavailable, what + reason, "",
              "stop the program that uses the port, or set another one with " + flag};
    default: break;
  }
  return {StatusCode::kUnavailable, what + reason, "",
          "set another address with --bind, or another port with " + flag};
}

}  // namespace furrow::server
