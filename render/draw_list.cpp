// SPDX-License-Identifier: Apache-2.0
#include "render/draw_list.h"

#include <algorithm>

namespace furrow::render {

void DrawList::Build(std::span<const GpuMesh> meshes, std::span<const NamedSubject> subjects,
                     const std::array<View, kNumViews>& views, float reach) {
  meshes_.assign(meshes.size(), {});
  for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh) {
    Mesh& list = meshes_[mesh];
    for (std::size_t subject = 0; subject < subjects.size(); ++subject) {
      const PosedSubject& who = *subjects[subject].subject;
      bool is_seen = false;
      for (std::size_t view = 0; view < views.size(); ++view) {
        if (!views[view].is_asked) continue;
        const glm::mat4 projection = views[view].projection * who.placement;
        if (!meshes[mesh].bounds.Look(who.model, projection, reach).is_seen()) continue;
        list.seen[view].push_back(static_cast<std::uint32_t>(list.subjects.size()));
        is_seen = true;
      }
      if (is_seen) list.subjects.push_back(static_cast<std::uint32_t>(subject));
    }
  }
}

}  // namespace furrow::render
