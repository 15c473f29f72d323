// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "authoring/generator/head/head_mesh.h"
#include "authoring/generator/head/head_shape.h"

// Parts of the face that are separate meshes, in model space and the rest pose.
namespace furrow::authoring {

// Both eyeballs with their corneas, side by side in one atlas, looking along +Z.
[[nodiscard]] HeadMesh MakeEyes();

// The lashes of the four lids of a head.
[[nodiscard]] HeadMesh MakeLashes(const HeadShape& shape = DefaultHead());

// Both rows of teeth, with gums.
[[nodiscard]] HeadMesh MakeTeeth();

// The tongue. It lies between the lower teeth and follows the jaw.
[[nodiscard]] HeadMesh MakeTongue();

// The centre of an eyeball in head space, centimetres, the same for every face. `side`: +1 for the
// subject's left, -1 for the right.
[[nodiscard]] glm::vec3 EyeCentre(float side);

}  // namespace furrow::authoring
