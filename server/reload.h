// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/status.h"
#include "protocol/secure/token/key_ring.h"
#include "server/assets.h"
#include "server/config/config.h"
#include "server/config/reload_plan.h"
#include "server/core/file_watch.h"
#include "server/pipeline/stream_definition.h"
#include "server/session/access/key_file.h"
#include "server/tls/tls_context.h"
#include "server/tls/tls_identity.h"

namespace furrow::server {

// Reads the configuration from where it was read at the start.
using ReadConfig = std::function<Result<Config>()>;

// Notices changes of the rig and of the maps that the configuration names as files. Not
// thread-safe.
class RigFiles {
 public:
  explicit RigFiles(const Config& config);
  // Looks at the files. True if one of them has changed since the construction.
  [[nodiscard]] bool Changed();
  // Whether the rig and the maps are among those that Changed() has found.
  [[nodiscard]] bool rig_changed() const { return rig_changed_; }
  [[nodiscard]] bool maps_changed() const { return maps_changed_; }

 private:
  FileWatch rig_;
  FileWatch skeleton_map_;
  FileWatch shape_map_;
  bool rig_changed_ = false;
  bool maps_changed_ = false;
};

// Everything that a reload needs, read and checked, so that taking it over cannot fail halfway.
struct Reload {
  ReloadPlan plan;
  KeyFile keys_file;
  protocol::secure::KeyRing keys;
  std::optional<TlsContexts> tls;  // absent: the ports are plain
  // Both from before the files were read, so that no change is missed.
  TlsWatches tls_watches;
  RigFiles rig_files;
  // Absent: rig and maps stay. Without a rig, the maps alone change.
  struct Files {
    std::shared_ptr<const wrinkle::Rig> rig;
    StreamMaps maps;
  };
  std::optional<Files> files;
};

struct ReloadRequest {
  Config running;
  ReadConfig read;
  // The character that is drawn, with its rig; null: none, and the rig may change.
  std::shared_ptr<const character::Character> drawn;
  bool rig_changed = false;   // RigFiles::rig_changed()
  bool maps_changed = false;  // RigFiles::maps_changed()
  bool is_confined = false;   // the process, by Confine()
};

// Reads the configuration again, and the files that it names. Changes nothing, and may take a
// while: call it on a thread without other duties. Errors: those of `read` and of the files, and
// those of ValidateConfig() if what can change now does not fit what needs a restart.
[[nodiscard]] Result<Reload> PrepareReload(const ReloadRequest& request);

}  // namespace furrow::server
