// SPDX-License-Identifier: Apache-2.0
#include "server/shares/host_rates.h"

#include <array>

#include <arpa/inet.h>

#include "protocol/secure/crypto/random_source.h"

namespace furrow::server {
namespace {

namespace secure = protocol::secure;

secure::PeerAddress AddressOf(const std::string& host) {
  secure::PeerAddress address;
  std::array<std::uint8_t, 4> v4{};
  if (inet_pton(AF_INET, host.c_str(), v4.data()) == 1) return secure::FromIpv4(v4, 0);
  // Other text leaves the zeros.
  (void)inet_pton(AF_INET6, host.c_str(), address.host.data());
  return address;
}

}  // namespace

HostRates::HostRates(std::uint32_t per_second) : budgets_(per_second, secure::SystemRandom()) {}

bool HostRates::Take(const std::string& host, Time now) {
  return budgets_.Take(AddressOf(host), {}, ToMicroseconds(now));
}

}  // namespace furrow::server
