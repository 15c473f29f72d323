// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "authoring/bake/request/bake_request.h"
#include "authoring/shapes/face_measures.h"
#include "authoring/shapes/face_skin.h"
#include "wrinkle/rig/rig.h"

namespace furrow::authoring {

// The face on which the strokes of the shipped default.strokes.json are drawn.
[[nodiscard]] const FaceMeasures& DefaultFaceMeasures();

// Strokes on the default face that keep the cheeks free of folds from strain. Fat below the skin of
// a cheek is thick, so that it bulges where thin skin would fold; strain does not know this.
[[nodiscard]] std::vector<BakeStroke> FirmCheeks();

// Strokes moved to another face.
struct TransferredStrokes {
  std::vector<BakeStroke> strokes;
  std::size_t lost = 0;  // that left the face's skin
};

// Moves strokes that were drawn on the face `from` to the corresponding places of a face of blend
// shapes, measured as `to`.
//
// A point keeps its height relative to brow, lid, corner of the mouth and chin, and its direction
// seen from an axis inside the head. Directions at the mouth follow the width of the mouth. The
// point then lies on the outermost skin in this direction, so noses and cheeks may have any shape.
// Widths and depths grow with the face. `rig`: the rig of the new face. Strokes for maps or regions
// that it lacks are left out, and so are personal ones (BakeStroke::personal) and strokes below the
// chin, which the facial masks do not reach.
[[nodiscard]] TransferredStrokes TransferStrokes(std::span<const BakeStroke> strokes,
                                                 const FaceMeasures& from, const FaceMeasures& to,
                                                 const FaceSkin& skin, const wrinkle::Rig& rig);

}  // namespace furrow::authoring
