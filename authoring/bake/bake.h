// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "base/status.h"
#include "character/character.h"

// Wrinkle maps from the strain of a skinned surface: where a pose compresses the skin or the cloth,
// folds run across the direction of strongest compression, as high as it takes to keep the
// surface's length. docs/BAKE.md describes the method.
namespace furrow::character::bake {

// One pose that feeds a wrinkle map, in one region of the surface.
struct BakePose {
  std::string map;     // a wrinkle map of Character::rig
  std::string region;  // a region of Character::rig; empty: the whole surface. A region masked by
                       // a texture takes the pose where that mask is; one masked by skinning
                       // takes it wherever the pose strains.
  // One a joint of Character::skeleton: posed position = skin_matrix * rest position (model space).
  std::vector<glm::mat4> skin_matrices;
  float weight = 1.0f;  // scales the compression that counts, (0, 1]
};

// A line drawn on the rest pose that says where folds are, how they run, or where none are.
struct BakeStroke {
  enum class Kind {
    kFold,       // one crease: a valley with a ridge on either side
    kDirection,  // folds of strain near the line run along it
    kExclude,    // no folds of strain near the line
  };
  std::string name;
  Kind kind = Kind::kFold;
  std::string muscle;             // whose pull it answers to; for people, not read
  std::vector<std::string> maps;  // wrinkle maps it belongs to; at least one
  std::string region;             // a region of the rig; empty: everywhere. Fades with its mask.
  // Two or more, metres, model space, rest pose. Carried to the nearest surface of the map.
  std::vector<glm::vec3> points;
  bool smooth = true;     // a Catmull-Rom spline through the points, not straight pieces
  float width_mm = 2.0f;  // kFold: valley to ridge, half a wavelength. Others: reach of the line,
                          // over which it fades. (0, 200]
  float depth_mm = 0.5f;  // kFold: of the valley under the surface, [-50, 50]; negative: a bulge
  float ridge = 0.35f;    // kFold: height of the ridges as a fraction of the depth, [0, 1]
  float taper = 0.6f;     // fraction of the length over which the ends fade, (0, 1]
  float wavelength_mm = 0.0f;  // kDirection: of the folds of strain near it; 0: as elsewhere
};

// How a material folds. Wavelengths are valley to valley on the surface at rest.
struct BakeMaterial {
  float wavelength_mm = 5.0f;     // [0.2, 200]
  float variation = 0.4f;         // of wavelength and depth from place to place, [0, 0.5]
  float share = 0.3f;             // part of the compression that folds take up; the rest shortens
                                  // the material itself. 1: the arc keeps its length. [0, 1]
  float max_compression = 0.45f;  // more is skinning gone wrong and counts as this, (0, 0.9]
  float threshold = 0.02f;        // compression that makes no fold yet, [0, 0.5]
  float smoothing_mm = 6.0f;      // strain is averaged over this radius of the surface, [0, 200]
  float sharpness = 0.7f;   // of the valleys: 0 a sine, 1 nearly a crease between round ridges
  float crossing = 0.15f;   // height of folds that cross the first ones, where the surface is
                            // compressed both ways, as a fraction of what that would allow, [0, 1]
  float depth = 1.0f;       // scales every height, of strain and of strokes: age. [0, 4]
  float fine_lines = 0.0f;  // height of lines of a third of the wavelength, as a fraction of
                            // what their compression would allow, [0, 1]: dry and old skin
};

// Replaces the wavelength where a region's mask is (skin is thinner round the eyes than at the
// brow). Sides share one entry: "brow" stands for brow_l and brow_r.
struct BakeRegionWavelength {
  std::string region;
  float wavelength_mm = 5.0f;
};

struct BakeOptions {
  int size = 2048;  // of the maps, texels a side: [64, 4096]
  BakeMaterial skin;
  BakeMaterial cloth{.wavelength_mm = 20.0f,
                     .variation = 0.4f,
                     .share = 0.4f,
                     .max_compression = 0.5f,
                     .threshold = 0.03f,
                     .smoothing_mm = 40.0f,
                     .sharpness = 0.35f,
                     .crossing = 0.3f};
  std::vector<BakeRegionWavelength> wavelengths = {
      {"brow", 8.0f}, {"glabella", 6.5f}, {"nose", 3.5f}, {"eye", 3.5f}, {"mouth", 5.5f}};
  float depth = 1.0f;  // scales every height of every material, [0, 4]
  std::uint32_t seed = 1;
  int threads = 2;  // [1, 64]; the result does not depend on it
};

// No fold is finer than these texels: a wave wants that many to be seen.
inline constexpr float kTexelsAWave = 3.0f;

// What a region's poses fold, wherever that is: proposed as its mask.
struct BakedMask {
  std::string region;
  int width = 0;  // a quarter of the map's: masks are soft
  int height = 0;
  std::vector<float> texels;  // rows from the top, [0, 1]
};

// One wrinkle map in the UV atlas of the surfaces it is drawn on. Planes: rows from the top.
struct BakedMap {
  std::string map;
  bool cloth = false;  // drawn on cloth, else on skin
  int width = 0;
  int height = 0;
  std::vector<float> height_mm;   // over the rest surface; ridges above 0, valleys below
  std::vector<float> derivative;  // two a texel: n.xy / n.z = -dh/d(tangent), -dh/d(bitangent),
                                  // bitangent up the picture (glTF's green): what the renderer adds
  std::vector<float> cavity;      // [0, 1]: how open a valley is to the sky; 1 where it is flat
  std::vector<float> blood;       // for the area, of what is there at rest: see blood.h
  std::vector<std::uint8_t> covered;  // 1 where a triangle is; elsewhere the planes are dilated
  std::vector<BakedMask> masks;       // of the regions whose poses feed the map

  struct Statistics {
    std::int64_t covered_texels = 0;
    std::int64_t folded_texels = 0;       // covered, with a height over a hundredth of a millimetre
    float worst_compression = 0.0f;       // of any triangle before clamping and smoothing, [0, 1)
    float mean_compression = 0.0f;        // over the folded area, smoothed
    float deepest_mm = 0.0f;              // valley under the surface, >= 0
    float highest_mm = 0.0f;              // ridge over it, >= 0
    float steepest = 0.0f;                // length of the largest derivative
    float texel_mm = 0.0f;                // side of a texel on the surface, mean where it folds
    int strokes = 0;                      // fold strokes that cover a texel
    std::int64_t overlapping_texels = 0;  // covered by more than one triangle: the first one won
    float finest_mm = 0.0f;               // wavelengths asked for where it folds
    float coarsest_mm = 0.0f;
    std::int64_t widened_texels = 0;  // folded, where finer folds were asked for than texels show
    float widened_from_mm = 0.0f;     // the worst of them
    float widened_to_mm = 0.0f;
  } statistics;
};

struct BakedMaps {
  std::vector<BakedMap> maps;  // in the order of Character::rig.wrinkle_maps; those that are fed
};

// Bakes every map that a pose or a stroke names.
//
// - A map goes on the meshes of the surface that the rig names for it; where that is any, on skin,
//   or on cloth where there is no skin. Meshes of one kind share one atlas. Where no material is
//   marked as skin, all that is not cloth, eyes or hair is.
// - `progress` (may be empty) is called on the calling thread with what is done, [0, 1], all the
//   while; false cancels.
// - The same input gives the same bytes, whatever `threads` is.
// Errors: kInvalidArgument (a map or region that the rig has not, counts or options out of range,
// a surface that is not there, has no UVs or no triangle of extent, a stroke far off its surface),
// kNonFinite, kLimit (folds or strokes too fine for a surface so large), kUnavailable (cancelled).
// A pose that strains nothing is no error: its map is flat.
[[nodiscard]] Result<BakedMaps> Bake(const Character& character, std::span<const BakePose> poses,
                                     std::span<const BakeStroke> strokes,
                                     const BakeOptions& options,
                                     const std::function<bool(float)>& progress = {});

// The material options of a map.
[[nodiscard]] inline const BakeMaterial& MaterialOf(const BakeOptions& options, bool cloth) {
  return cloth ? options.cloth : options.skin;
}

}  // namespace furrow::character::bake
