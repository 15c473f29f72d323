// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// The names of all blend shapes that a rig's drivers read, in the order of the rig, each once.
// Names that differ only in case are one name.
[[nodiscard]] std::vector<std::string> BlendShapesOf(const Rig& rig);

// True if a driver of the rig reads one of these blend shapes; case is ignored.
[[nodiscard]] bool ReadsAny(const Rig& rig, std::span<const std::string> blend_shapes);

}  // namespace furrow::wrinkle
