// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "gltf/document/buffer_view.h"

namespace furrow::gltf {

// The nodes that an animation of the file `json` moves, turns or scales: ascending, each below
// kMaxNodes. A channel that only repeats the node's own transform moves nothing; exporters bake one
// for every node. Channels with keys that cannot be read count as moving.
[[nodiscard]] std::vector<int> ListMovingNodes(const nlohmann::json& json,
                                               std::span<const BufferView> views);

}  // namespace furrow::gltf
