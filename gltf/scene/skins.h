// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "base/status.h"
#include "gltf/document/document.h"

namespace furrow::gltf {

[[nodiscard]] std::size_t NumSkins(const Document& document);

// The nodes of a skin's joints. Errors: kSchema (no joint, a node that does not exist).
[[nodiscard]] Result<std::vector<int>> ReadSkinJoints(const Document& document, std::size_t skin);

// One matrix per joint of the skin: from mesh space in the rest pose to the joint's space. The
// identity for all joints if the file has none. Errors: Accessor::Create()'s, kSchema (fewer
// matrices than joints), kNonFinite.
[[nodiscard]] Result<std::vector<glm::mat4>> ReadInverseBindMatrices(const Document& document,
                                                                     std::size_t skin);

}  // namespace furrow::gltf
