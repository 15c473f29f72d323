// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "authoring/generator/recordings/recordings.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// Returns the recording as BVH text, in metres. The root and joints that translate have six
// channels, other joints three; rotations are in the order Z Y X. Precondition: every rest rotation
// of the skeleton is the identity.
[[nodiscard]] std::string RecordingToBvh(const Recording& recording,
                                         const wrinkle::Skeleton& skeleton);

}  // namespace furrow::authoring
