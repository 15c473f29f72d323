// SPDX-License-Identifier: Apache-2.0
#include "server/reload.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "base/joined.h"
#include "character/package/package.h"

namespace furrow::server {
namespace {

bool Contains(const std::vector<std::string>& keys, std::string_view key) {
  return std::ranges::find(keys, key) != keys.end();
}

// What a daemon that draws may take over: its pictures belong to the rig that it has.
Result<Reload::Files> LoadMapsOnly(const Config& config, const character::Character& drawn) {
  auto skeletons = rig::SkeletonMatcher::Create(config.skeleton_map);
  if (!skeletons.ok()) return skeletons.status().At("skeleton_map");
  auto shapes = rig::ShapeMatcher::Create(config.shape_map);
  if (!shapes.ok()) return shapes.status().At("shape_map");
  skeletons->SetCharacterRoles(drawn.skeleton, drawn.roles);
  return Reload::Files{nullptr, {*std::move(skeletons), *std::move(shapes)}};
}

Result<Reload::Files> LoadFiles(const Config& config) {
  Config weights_only = config;
  weights_only.render = false;
  auto assets = LoadAssets(weights_only);
  FURROW_RETURN_IF_ERROR(assets);
  return Reload::Files{std::move(assets->rig),
                       {std::move(assets->skeletons), std::move(assets->shape_matcher)}};
}

// A shipped rig has a name instead, and belongs to the installation.
std::filesystem::path RigFileOf(const Config& config) {
  if (!config.rig.empty() || config.character.empty()) return config.rig;
  return character::RigBeside(character::FindCharacterFile(config.character));
}

Result<Reload> ReadReload(const ReloadRequest& request) {
  const auto wanted = request.read();
  FURROW_RETURN_IF_ERROR(wanted);
  const bool draws = request.drawn != nullptr;
  const ReloadPlan plan = PlanReload(request.running, *wanted, draws);
  // A setting that waits may be what makes another one safe.
  if (const Status status = ValidateConfig(plan.config); !status.ok()) {
    return Status(status.code(), status.what(), status.where(),
                  "restart the daemon, because these changes take effect only then: " +
                      Joined(plan.needs_restart));
  }
  const Config& config = plan.config;
  // Of the files that count from now on, not of those that wait for a restart.
  Reload reload{.plan = plan,
                .keys_file = KeyFile(config.security.keys),
                .keys = {},
                .tls = {},
                .tls_watches = WatchTlsFiles(config.security.tls),
                .rig_files = RigFiles(config),
                .files = {}};
  auto keys = reload.keys_file.Load();
  if (!keys.ok()) return keys.status().Within("keys");
  reload.keys = *std::move(keys);
  if (config.security.tls.enabled()) {
    auto contexts = LoadTlsContexts(config.security.tls);
    if (!contexts.ok()) return contexts.status().Within("tls");
    reload.tls = *std::move(contexts);
  }
  const auto& applied = plan.applied;
  const bool maps_change =
      request.maps_changed || Contains(applied, "skeleton_map") || Contains(applied, "shape_map");
  // The rig of a daemon that draws waits for a restart.
  const bool rig_changes = !draws && (request.rig_changed || Contains(applied, "rig"));
  if (!maps_change && !rig_changes) return reload;
  auto files = draws ? LoadMapsOnly(config, *request.drawn) : LoadFiles(config);
  FURROW_RETURN_IF_ERROR(files);
  reload.files = *std::move(files);
  // Captures stay in a rig whose file is the same.
  if (!rig_changes) reload.files->rig = nullptr;
  return reload;
}

// Landlock refuses files in new folders as if they lacked permissions.
Status NamingConfinement(const Status& status) {
  if (status.what().find("Permission denied") == std::string::npos) return status;
  return {status.code(), status.what(), status.where(),
          "a confined daemon reads only the folders that it had at its start: restart it if this "
          "folder is new"};
}

}  // namespace

RigFiles::RigFiles(const Config& config)
    : rig_(RigFileOf(config)), skeleton_map_(config.skeleton_map), shape_map_(config.shape_map) {
  (void)Changed();
  rig_changed_ = maps_changed_ = false;
}

bool RigFiles::Changed() {
  rig_changed_ |= rig_.Changed();
  maps_changed_ |= skeleton_map_.Changed();
  maps_changed_ |= shape_map_.Changed();
  return rig_changed_ || maps_changed_;
}

Result<Reload> PrepareReload(const ReloadRequest& request) {
  auto reload = ReadReload(request);
  if (reload.ok() || !request.is_confined) return reload;
  return NamingConfinement(reload.status());
}

}  // namespace furrow::server
