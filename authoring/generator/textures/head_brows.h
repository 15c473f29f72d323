// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "authoring/generator/head/face_parameters.h"

namespace furrow::authoring {

// How much of the skin around the point `p` the hairs of the brows cover, 0 none to 1 all of it.
// `p`: head space, centimetres.
[[nodiscard]] float BrowShare(const glm::vec3& p, const FaceParameters& face);

}  // namespace furrow::authoring
