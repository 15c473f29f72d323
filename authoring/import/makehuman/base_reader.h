// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "authoring/import/makehuman/body_parts.h"
#include "authoring/import/makehuman/face/face_landmarks.h"
#include "authoring/import/makehuman/formats/mhm.h"
#include "authoring/import/makehuman/save/person.h"
#include "base/status.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// The base mesh of a data folder in the shape of a person, and what is defined by its vertices.
struct FittedBase {
  BaseMesh mesh;
  wrinkle::Skeleton skeleton;  // rigs/default.mhskel
  FaceLandmarks face;
  PersonShape shape;  // empty without a save
};

// Reads 3dobjs/base.obj and the default rig of `folder`, and gives the mesh the shape of the person
// in `save` (null: none). Metres; the lowest point of the body is at y = 0.
//
// Errors name the file: those of ReadFile(), the parsers, ShapePerson(), BuildSkeleton(),
// FindFaceLandmarks() and BindBaseMesh(), and kSchema (the mesh has no body).
[[nodiscard]] Result<FittedBase> ReadBase(const std::filesystem::path& folder, const MhmSave* save);

}  // namespace furrow::authoring
