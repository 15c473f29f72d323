// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "rig/shapes/arkit_shapes.h"

namespace furrow::rig {

// Limit of ShapeMap::shapes. The largest vocabularies in use have some 300 shapes.
inline constexpr std::size_t kMaxMapShapes = 2048;

// gain * product of shapes, each in [0, 1]. `rest`: 1 - shape instead of the shape.
struct MapTerm {
  struct Factor {
    int shape = 0;  // index into ARKit's shapes or into ShapeMap::shapes
    bool rest = false;
    [[nodiscard]] bool operator==(const Factor&) const = default;
  };
  float gain = 1.0f;
  std::vector<Factor> product;  // not empty
};

// A sum of terms, clamped to [0, 1]. A single shape with gain 1 is a new name and is not clamped.
struct MapFormula {
  std::vector<MapTerm> sum;  // not empty
  // The gains are shares: those of missing shapes are distributed among the others, and a sum above
  // 1 is scaled to 1.
  bool mean = false;

  // The shape that the formula renames; -1 if it does more.
  [[nodiscard]] int RenamedShape() const;
};

// A shape of a vocabulary.
struct MapShape {
  std::string name;
  std::vector<std::string> aliases;
  // The shape is moved only if the face has none of these (indices into ShapeMap::shapes): a face
  // with both "blink" and "blinkLeft" closes its eyes by the latter.
  std::vector<int> unless;
  // How ARKit's shapes make this shape, the best first; later ones are for sources that lack
  // something. Empty: ARKit has nothing like it.
  std::vector<MapFormula> from_arkit;
};

// A vocabulary of blend shapes and its translation from and to ARKit's. docs/SHAPES.md describes
// the file format.
struct ShapeMap {
  std::string name;                   // as shown in options and logs, such as "vrm0"
  std::string title;                  // for display
  std::vector<std::string> prefixes;  // see WithoutShapePrefix()
  std::vector<MapShape> shapes;       // sorted by name
  // How the vocabulary's shapes make each of ARKit's, the best first. Empty: not at all.
  std::array<std::vector<MapFormula>, kNumArkitShapes> to_arkit;
};

// Reads a map. Errors, with "file: field" as `where`: kParse, kSchema (an unknown or missing field,
// a wrong type, an unknown shape, a name that means two shapes), kLimit (more than 1 MiB, 2048
// shapes, 64 prefixes, 32 aliases, terms or alternatives, 8 factors or 255 bytes per name).
[[nodiscard]] Result<ShapeMap> ParseShapeMap(std::string_view json, std::string_view source_name);

// Loads the map in a file, or the shipped map of this name ("vrm0"). Errors: kNotFound, and those
// of ParseShapeMap().
[[nodiscard]] Result<ShapeMap> LoadShapeMap(const std::string& name_or_file);

// Loads all shipped maps (share/furrow/shape_maps/*.json), sorted by name. Errors: kNotFound, and
// those of ParseShapeMap().
[[nodiscard]] Result<std::vector<ShapeMap>> LoadShippedShapeMaps();

}  // namespace furrow::rig
