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
  float bending = 6.0f;     // bending stiffness B, micronewton metres (KES: 1 gf cm^2/cm = 98),
                            // [0.1, 1000]
  float weight = 120.0f;    // g/m^2, [20, 2000]
  float thickness = 0.3f;   // millimetres, [0.05, 5]
  float stretching = 3e3f;  // membrane stiffness Y, force per width and strain, N/m, [10, 1e5]
};

// Typical values of a shirt, a suit, 12 oz jeans and a T-shirt.
inline constexpr Fabric kFabrics[] = {
    {.name = "cotton", .bending = 6, .weight = 120, .thickness = 0.3f, .stretching = 3000},
    {.name = "wool", .bending = 12, .weight = 250, .thickness = 0.5f, .stretching = 1500},
    {.name = "denim", .bending = 60, .weight = 420, .thickness = 0.9f, .stretching = 5000},
    {.name = "jersey", .bending = 2, .weight = 160, .thickness = 0.6f, .stretching = 80}};

// The fabric of that name, or nothing.
[[nodiscard]] std::optional<Fabric> FindFabric(std::string_view name);
// "cotton, wool, denim, jersey"
[[nodiscard]] std::string FabricNames();

// How a fabric folds.
struct FabricFolds {
  // From fold to fold, for folds as long as a limb is round, metres:
  //   lambda = 2 sqrt(pi) (B / T)^(1/4) L^(1/2)
  // (Cerda and Mahadevan, Geometry and Physics of Wrinkling, 2003) with the pull T = 10 N/m of
  // cloth beside a bent joint and the length L = 15 cm. Cotton 38 mm, wool 45, denim 68, jersey 29.
  float wavelength = 0.038f;
  // How much wider than that the folds of hanging cloth are, by the same law and length, where T is
  // the weight of 80 cm of cloth: cotton 1.81, wool 1.50, denim 1.32, jersey 1.68.
  float hanging = 1.5f;
  // The radius of the sharpest fold, metres. A sheet that is pulled over an edge by T on both
  // sides, so that it turns by the angle a, has the radius sqrt(B / T) / (2 sin(a / 4)) there
  // (Euler's elastica); half of the thickness lies outside of that. For flanks of 45 degrees, a is
  // 90; T is 2 N/m, the pull of hanging cloth. Cotton 2.4 mm, wool 3.5, denim 7.6, jersey 1.6.
  float radius = 0.0f;
  // The share of its length by which cloth stretches before it slips over the body: 10 N/m / Y.
  // Woven cloth less than 0.01, jersey 0.125.
  float stretches = 0.0f;

  bool operator==(const FabricFolds&) const = default;
};
[[nodiscard]] FabricFolds FoldsOf(const Fabric& fabric);

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
  // The share of its length that cloth hides along the limb where it rests on something below, such
  // as a trouser leg on a shoe, at the usual ease of all cloth, [0, 0.8].
  float stacks = 0.0f;
};

// The ease of a region's cloth.
struct RegionEase {
  std::string region;
  ClothEase ease;

  [[nodiscard]] bool Covers(std::string_view name) const { return CoversRegion(region, name); }
};

}  // namespace furrow::authoring
