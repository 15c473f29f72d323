// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::authoring {

// A kind of cloth, by what decides how it folds.
struct Fabric {
  std::string_view name;
  // Bending stiffness B, micronewton metres (KES: 1 gf cm^2/cm = 98), [0.1, 1000].
  float bending = 6.0f;
};

// Typical values: shirt cotton of 120 g/m^2, wool suiting of 250, denim of 420 (12 oz), jersey of
// 160.
inline constexpr Fabric kFabrics[] = {
    {"cotton", 6.0f}, {"wool", 12.0f}, {"denim", 60.0f}, {"jersey", 2.0f}};

// The fabric of that name, or nothing.
[[nodiscard]] std::optional<Fabric> FindFabric(std::string_view name);
// "cotton, wool, denim, jersey"
[[nodiscard]] std::string FabricNames();

// The distance from fold to fold in metres, for folds as long as a limb is round:
//   lambda = 2 sqrt(pi) (B / T)^(1/4) L^(1/2)
// (Cerda and Mahadevan, Geometry and Physics of Wrinkling, 2003) with the pull T = 10 N/m of
// cloth beside a bent joint and the length L = 15 cm. Cotton 38 mm, wool 45, denim 68, jersey 29.
[[nodiscard]] float FoldWavelength(const Fabric& fabric);
// How much wider than that the folds of hanging cloth are, by the same law with the pull T = 2 N/m,
// the weight of 80 cm of 250 g/m^2: 1.495, for all fabrics.
[[nodiscard]] float HangingWidth();

// True for a region itself and for its parts: "knee" covers knee_l_inner, and not kneecap.
[[nodiscard]] inline bool CoversRegion(const std::string& region, std::string_view name) {
  return name == region || name.starts_with(region + "_");
}

// The fabric of a region's cloth.
struct RegionFabric {
  std::string region;
  Fabric fabric;

  [[nodiscard]] bool Covers(std::string_view name) const { return CoversRegion(region, name); }
};

// How loose cloth is cut, relative to the ease of all clothes.
struct ClothEase {
  float looser = 1.0f;  // multiplier for the mean ease, [1, 4]
  float least = 0.0f;   // the least ease of any place, as a share of this mean, [0, 1]
  // How much length the cloth around a pull gives, relative to what the pull needs, [0, 4]. A tight
  // leg gives less, as it slips as a whole. A wide sleeve gives more: it is cut as long as a bent
  // elbow needs it on the outside, so it is too long at the sides.
  float feeds = 1.0f;
};

// The ease of a region's cloth.
struct RegionEase {
  std::string region;
  ClothEase ease;

  [[nodiscard]] bool Covers(std::string_view name) const { return CoversRegion(region, name); }
};

}  // namespace furrow::authoring
