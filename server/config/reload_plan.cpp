// SPDX-License-Identifier: Apache-2.0
#include "server/config/reload_plan.h"

#include <string_view>

#include "server/config/settings.h"

namespace furrow::server {
namespace {

// Whether a live key must wait for a restart this time.
bool MustWait(std::string_view key, const Config& running, const Config& wanted, bool draws) {
  const TlsFiles& old_tls = running.security.tls;
  const TlsFiles& new_tls = wanted.security.tls;
  if (key.starts_with("tls.")) {
    return old_tls.enabled() != new_tls.enabled() ||
           old_tls.client_authority.empty() != new_tls.client_authority.empty();
  }
  // Without a rig of its own, the daemon uses that of the character.
  if (key == "rig") {
    return draws || running.rig.empty() || wanted.rig.empty() || !running.character.empty();
  }
  return false;
}

}  // namespace

ReloadPlan PlanReload(const Config& running, const Config& wanted, bool draws) {
  ReloadPlan plan;
  plan.config = running;
  VisitSettings(
      [&](const Setting& setting, auto& taken, const auto& value) {
        if (taken == value) return;
        if (!setting.is_live || MustWait(setting.key, running, wanted, draws)) {
          plan.needs_restart.emplace_back(setting.key);
        } else {
          taken = value;
          plan.applied.emplace_back(setting.key);
        }
      },
      plan.config, wanted);
  return plan;
}

}  // namespace furrow::server
