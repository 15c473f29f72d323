// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/shape_finder.h"

#include <map>
#include <utility>

#include "base/ascii.h"

namespace furrow::authoring {

std::string ShapeKey(std::string_view name) {
  if (const std::size_t cut = name.find_last_of(":|."); cut != std::string_view::npos) {
    name.remove_prefix(cut + 1);
  }
  // A side of one letter stands apart: "_L", " R". "jawL" would be ambiguous.
  std::string side;
  if (name.size() > 2) {
    const char before = name[name.size() - 2], letter = AsciiLower(name.back());
    if ((before == '_' || before == ' ' || before == '-') && (letter == 'l' || letter == 'r')) {
      side = letter == 'l' ? "left" : "right";
      name.remove_suffix(2);
    }
  }
  std::string key;
  for (const char c : name) {
    const char lower = AsciiLower(c);
    if ((lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9')) key += lower;
  }
  return key + side;
}

ShapeFinder FindShapesByName(const character::Character& character) {
  std::map<std::string, int> shapes;
  for (std::size_t i = 0; i < character.shapes.size(); ++i) {
    shapes.emplace(ShapeKey(character.shapes[i]), static_cast<int>(i));
  }
  return [shapes = std::move(shapes)](std::string_view name) {
    const auto found = shapes.find(ShapeKey(name));
    return found == shapes.end() ? -1 : found->second;
  };
}

}  // namespace furrow::authoring
