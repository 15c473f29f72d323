// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "authoring/shapes/face_skin.h"
#include "authoring/shapes/shape_landmarks.h"
#include "character/character.h"

namespace furrow::authoring {

// The regions of the rig `arkit`, in the order of its mask channels: r, g, b and a of face_masks_a,
// then of face_masks_b.
inline constexpr std::array kFaceRegions = {"brow_l", "brow_r", "glabella", "nose",
                                            "eye_l",  "eye_r",  "mouth_l",  "mouth_r"};
inline constexpr const char* kFaceMaskNames[2] = {"face_masks_a", "face_masks_b"};

// One mask per region of kFaceRegions: a value in [0, 1] per vertex of the skin.
using FaceMasks = std::array<std::vector<float>, kFaceRegions.size()>;

// Proposes the masks of a face from what its blend shapes move. A region is where its shapes move
// the skin by more than a tenth of their strongest motion, inside the limits that the landmarks
// set; smoothed over the surface and cut between the halves. The sum of all masks is at most 1. A
// region without shapes has an empty mask (all 0).
[[nodiscard]] FaceMasks ProposeFaceMasks(const FaceSkin& skin, const ShapeLandmarks& landmarks);

// Paints the masks in the UVs of the skin: two pictures of 4 channels, `size` x `size` texels,
// named as kFaceMaskNames. If both halves of the face share texels (mirrored UVs), a texel takes
// the larger value of each region, and the sum is limited to 1 again.
[[nodiscard]] std::array<character::Picture, 2> PaintFaceMasks(
    const character::Character& character, const FaceSkin& skin, const FaceMasks& masks, int size);

}  // namespace furrow::authoring
