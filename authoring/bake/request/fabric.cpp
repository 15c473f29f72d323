// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/request/fabric.h"

#include <cmath>

#include "base/scalar.h"

namespace furrow::authoring {
namespace {

// The pull on cloth, N/m.
constexpr float kBentPull = 10.0f;
constexpr float kHangingPull = 2.0f;

}  // namespace

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

float FoldWavelength(const Fabric& fabric) {
  constexpr float kLength = 0.15f;  // metres
  return 2.0f * std::sqrt(kPi) * std::pow(1e-6f * fabric.bending / kBentPull, 0.25f) *
         std::sqrt(kLength);
}

float HangingWidth() { return std::pow(kBentPull / kHangingPull, 0.25f); }

}  // namespace furrow::authoring
