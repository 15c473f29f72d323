// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/request/fabric.h"

#include <cmath>

#include "base/scalar.h"

namespace furrow::authoring {
namespace {

// The pull on cloth beside a bent joint, and over a sharp fold, N/m.
constexpr float kBentPull = 10.0f;
constexpr float kFoldPull = 2.0f;
constexpr float kGravity = 9.81f;       // m/s^2
constexpr float kHangingLength = 0.8f;  // metres
constexpr float kFoldLength = 0.15f;    // metres

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

FabricFolds FoldsOf(const Fabric& fabric) {
  const float bending = 1e-6f * fabric.bending;
  const float hanging_pull = 1e-3f * fabric.weight * kGravity * kHangingLength;
  // Both flanks rise by 45 degrees, so the sheet turns by 90 between them.
  const float bent = std::sqrt(bending / kFoldPull) / (2.0f * std::sin(0.125f * kPi));
  return {.wavelength =
              2.0f * std::sqrt(kPi) * std::pow(bending / kBentPull, 0.25f) * std::sqrt(kFoldLength),
          .hanging = std::pow(kBentPull / hanging_pull, 0.25f),
          .radius = bent + 0.5e-3f * fabric.thickness,
          .stretches = kBentPull / fabric.stretching};
}

}  // namespace furrow::authoring
