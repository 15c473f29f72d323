// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gltf/document/document.h"

namespace tinygltf {
class Value;
}  // namespace tinygltf

namespace furrow::gltf {

// How the eyes of a VRM avatar follow a gaze, by their bones or by expressions.
struct VrmLookAt {
  // A gaze of `input` degrees or more turns an eye by `output` degrees, a smaller one by its share.
  // By expressions, `output` is the weight of the expression.
  struct Range {
    float input = 90.0f;
    float output = 10.0f;
  };
  Range inner, outer;  // towards the nose, away from it
  Range down, up;
};

// Reads look-at by bones of VRM 0.x (VRM.firstPerson) and 1.0 (VRMC_vrm.lookAt) of a document with
// Contents::kCharacter. Nullopt if the file has none or moves the eyes by expressions. Ranges that
// are missing or that are not numbers from 0 to 180 have VRM's defaults.
[[nodiscard]] std::optional<VrmLookAt> ReadVrmLookAt(const Document& document);

// The same for look-at by expressions. Weights are limited to 0 and 1. Ranges that are missing have
// UniVRM's defaults: the full weight at 90 degrees.
[[nodiscard]] std::optional<VrmLookAt> ReadVrmLookAtExpressions(const Document& document);

// Reads "inputMaxValue" and "outputScale" of a range for expressions.
[[nodiscard]] VrmLookAt::Range ReadGazeRange(const tinygltf::Value& from);

}  // namespace furrow::gltf
