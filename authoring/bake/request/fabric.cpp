// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/request/fabric.h"

#include <cmath>

#include "base/scalar.h"

namespace furrow::authoring {

std::optional<Fabric> FindFabric(std::string_view name) {
  for (const Fabric& fabric : kFabrics) {
    if (fabric.name == name) return fabric;
  }
  return std::nullopt;
}

std::string FabricNames() {
  std::string names;
  for (const Fabric& fabric : kFabrics) {
    names += names.empty() ? "" : ", ";
    names += fabric.name;
  }
  return names;
}

float FoldWavelength(const Fabric& fabric, float pull) {
  constexpr float kLength = 0.15f;  // metres
  return 2.0f * std::sqrt(kPi) * std::pow(1e-6f * fabric.bending / pull, 0.25f) *
         std::sqrt(kLength);
}

}  // namespace furrow::authoring
