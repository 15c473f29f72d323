// SPDX-License-Identifier: Apache-2.0
#include "server/credentials.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "server/net/clock.h"

namespace furrow::server {

Credentials::Credentials(const Config& config, Metrics* metrics)
    : gate_({.security = config.security.mode,
             .name = config.security.name,
             .tokens_in_clear = config.security.tokens_in_clear},
            &UnixSeconds, metrics),
      secure_(&gate_, &UnixSeconds, std::min(config.limits.max_udp_peers, 0xFFFF), config.threads,
              metrics),
      keys_file_(config.security.keys),
      tls_(config.security.tls) {
  SetLimits(config.limits);
}

Status Credentials::Load() {
  auto keys = keys_file_.Load();
  if (!keys.ok()) return keys.status().Within("security.keys");
  SetKeys(*std::move(keys));
  if (Status status = tls_.Load(); !status.ok()) return status.Within("tls");
  return {};
}

void Credentials::SetLimits(const Limits& limits) {
  tls_.places().SetPlacesOfHost(static_cast<std::size_t>(limits.max_strangers_per_host));
}

void Credentials::SetKeys(protocol::secure::KeyRing keys) {
  secure_.SetKeys(keys);
  gate_.SetKeys(std::move(keys));
}

void Credentials::ReadIfChanged() {
  if (auto keys = keys_file_.ReadIfChanged()) SetKeys(*std::move(keys));
  tls_.ReadIfChanged();
}

void Credentials::TakeOver(Reload* reload) {
  keys_file_ = std::move(reload->keys_file);
  SetKeys(std::move(reload->keys));
  SetLimits(reload->plan.config.limits);
  if (!reload->tls) return;
  tls_.Replace(reload->plan.config.security.tls, std::move(reload->tls_watches),
               *std::move(reload->tls));
}

}  // namespace furrow::server
