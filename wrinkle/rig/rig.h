// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wrinkle/drivers/driver.h"
#include "wrinkle/skeleton/reference_pose.h"

// The wrinkle rig as data: the contents of a rig file, by name, before the rig is bound to a
// skeleton. rig/rig_file.h reads it from JSON. RigBinding (solver/rig_binding.h) binds it.
namespace furrow::wrinkle {

enum class Modulation { kLinear, kCosine, kCubic };  // thesis 4.3, 4.4

// A point of a modulation curve: the combined value `x` becomes `y`, both in [0, 1]. A curve has 2
// to 16 points, and `x` rises by at least 0.01 from point to point (weights/modulation_curve.h).
struct CurvePoint {
  float x = 0.0f;
  float y = 0.0f;

  friend bool operator==(const CurvePoint&, const CurvePoint&) = default;
};

// How the sources of a map become one number, with theta the map's modulation:
// - kMax, kSum, kMean: theta of the largest gain * value, of their sum, clamped to 1, or of the
//   mean of the values, weighted by gain.
// - kSumModulated: the sum of gain * theta(value), clamped to 1 (4.2 as printed, with the gain as
//   lambda).
enum class Combine { kMax, kSum, kMean, kSumModulated };
enum class LambdaMode { kSmooth, kBinary, kLinear };  // 4.2

// The driver values that feed one wrinkle map of a region.
struct Feed {
  struct Source {
    std::string driver;
    std::string value;
    float gain = 1.0f;
  };
  std::string map;  // a WrinkleMap's name; the wrinkle weight is "<region>.<map>"
  std::vector<Source> sources;
  // The modulation of this map, instead of the region's: a name, or a curve. If both are set, the
  // curve counts.
  std::optional<Modulation> modulation = std::nullopt;
  std::vector<CurvePoint> curve = {};
  // A curve over the angle of a joint, instead of `curve`: points of degrees from straight,
  // [0, 180], and weights, [0, 1]. The first source's driver states the angle
  // (DriverValueAtAngle()): a hinge, a ball or a twist. 2 to 16 points that rise by at least 2
  // degrees. Empty: none.
  std::vector<CurvePoint> angles = {};
};

// Where a region's wrinkles are drawn.
struct Mask {
  // kTexture: painted. kSkinning: the vertices that the driving joints move. kSliding: around the
  // joint of a ball, hinge or twist driver, on the side it moves to (sliding_mask.h).
  enum class Kind { kTexture, kSkinning, kSliding };
  Kind kind = Kind::kTexture;
  std::string texture;  // a file, or the name of a picture inside the character
  int channel = 0;      // 0..3 = r, g, b, a
  LambdaMode lambda = LambdaMode::kSmooth;
  float smooth_width = 0.25f;  // w0 of smoothstep(0, w0, skin_weight)
  // For kSliding. The unit of length is the bone below the joint.
  std::string driver;             // the driver that moves the mask; a hinge must have an axis
  float spread_degrees = 100.0f;  // [1, 180]: reach to either side of the direction
  float above = 0.15f;            // [0, 10]: reach beyond the joint, towards the parent
  float below = 0.4f;             // [0, 10]: reach along the bone; above + below > 0
  float radius = 0.5f;            // [0.001, 10]: reach from the bone's axis
};

// A part of the surface whose wrinkles have common weights.
struct Region {
  std::string name;
  Mask mask;
  std::vector<Feed> feeds;
  Combine combine = Combine::kMax;
  Modulation modulation = Modulation::kCosine;
  std::vector<CurvePoint> curve = {};   // instead of `modulation`, unless empty
  std::vector<std::string> neighbours;  // adjacent regions, for incongruence
};

struct WrinkleMap {
  // The surfaces a map is drawn on. Eyes and hair never wrinkle.
  enum class Surface { kAny, kSkin, kCloth };

  std::string name;               // "stretch", "squash", "folds", ...
  std::string normal;             // tangent-space normal map; or
  std::string derivative;         // partial-derivative map (n.xy / n.z), green up
  float derivative_scale = 1.0f;  // the derivative of an integer texel of 1; see below
  std::string height;             // optional: height over the rest surface, for displacement
  float height_mm = 1.0f;         // the millimetres of an integer texel of 1
  std::string colour;             // optional: sRGB, multiplies the surface's base colour
  float colour_scale = 1.0f;      // the linear factor of a full texel
  std::string cavity;             // optional: scales gloss and sky light
  float amplitude = 1.0f;         // scales derivatives and heights
  std::string opposes;  // optional: the map that must not meet this map at a shared border
  Surface surface = Surface::kAny;
};
// Derivatives and heights in an integer picture are signed around the middle: a texel t in [0, 1]
// means (2 t - 1) * scale. A float picture (EXR) holds the derivative or the millimetres
// themselves, and the scale is ignored.

// Smoothing of driver values over time: One-Euro and a slew limit.
struct Filter {
  bool enabled = true;
  float min_cutoff_hz = 4.0f;  // One-Euro (Casiez, Roussel and Vogel 2012)
  float beta = 1.0f;           // One-Euro speed coefficient
  float derivative_cutoff_hz = 1.0f;
  float slew_per_second = 30.0f;  // largest change of a weight; 0: no limit
  float hold_seconds = 0.25f;     // without poses: hold the values for this time
  float decay_seconds = 0.5f;     // and then decay to neutral with this time constant
};

// The name of a wrinkle weight in another system.
struct Export {
  std::string profile;  // "metahuman", "osc", ...
  std::string weight;
  std::string name;
};

// The name of the reference pose for which the clothes were cut, for example with the arms 30
// degrees away from the sides. The bake measures the lengths of cloth in it. Without one, clothes
// fit the rest pose. No driver needs to use it.
inline constexpr std::string_view kClothesFitPose = "clothes_fit";

struct Rig {
  std::string name;
  std::string anchor;  // pose drivers without their own anchor measure in this joint's space;
                       // empty: model space
  // The skeleton of the rig's lengths. Null: their sizes compare with SkeletonSize().
  std::shared_ptr<const SizeReference> size_reference = nullptr;
  std::vector<ReferencePose> reference_poses;
  std::vector<Driver> drivers;
  std::vector<Region> regions;
  std::vector<WrinkleMap> wrinkle_maps;
  Filter filter;
  std::vector<Export> exports;
};

}  // namespace furrow::wrinkle
