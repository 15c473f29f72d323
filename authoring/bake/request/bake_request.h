// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/request/fabric.h"

// The input of a bake: poses, strokes and options.
namespace furrow::authoring {

inline constexpr float kMetresPerMillimetre = 0.001f;

// One pose that feeds a wrinkle map, in one region of the surface.
struct BakePose {
  std::string map;  // name of a wrinkle map of Character::rig
  // Name of a region of Character::rig; empty: the whole surface. A region with a texture mask
  // takes the pose only inside the mask. A region masked by skinning takes it wherever the pose
  // compresses the surface.
  std::string region;
  // One per joint of Character::skeleton: posed position = skin_matrix * rest position (model
  // space).
  std::vector<glm::mat4> skin_matrices;
  // For cloth: skin matrices from the pose that the clothes were cut for to this pose, both
  // included, in small steps. They tell whether a pose of another map is further on the same way.
  // Joints that the pose does not name stay as the clothes were cut. Empty: from rest.
  std::vector<std::vector<glm::mat4>> path = {};
  // One per shape of the character, applied before skinning; shapes beyond the end rest.
  std::vector<float> shape_weights = {};
  float weight = 1.0f;  // scales the compression of this pose, (0, 1]
};

// A line drawn on the rest pose. It adds a fold, sets the direction of folds, or prevents folds.
struct BakeStroke {
  enum class Kind {
    kFold,       // one crease: a valley with a ridge on either side
    kDirection,  // folds from strain near the line run along it
    kExclude,    // no folds from strain near the line
  };
  std::string name;
  Kind kind = Kind::kFold;
  std::string muscle;             // the muscle that causes the fold; a note for people, not used
  std::vector<std::string> maps;  // wrinkle maps that the stroke belongs to; at least one
  std::string region;  // a region of the rig, whose mask limits the stroke; empty: everywhere
  // At least two points: metres, model space, rest pose. Each point is projected onto the surface.
  std::vector<glm::vec3> points;
  bool smooth = true;  // true: a Catmull-Rom spline through the points; false: straight segments
  // kFold: distance from valley to ridge, half a wavelength. Other kinds: distance over which the
  // stroke's effect fades. (0, 200]
  float width_mm = 2.0f;
  float depth_mm = 0.5f;  // kFold: depth of the valley, [-50, 50]; negative: a bulge
  float ridge = 0.35f;    // kFold: height of the ridges as a fraction of the depth, [0, 1]
  float taper = 0.6f;     // fraction of the length over which the ends fade, (0, 1]
  bool personal = false;  // a mark of this face alone: TransferStrokes() leaves it out
  // kDirection: wavelength of the folds near the line, [0.2, 200]; 0: unchanged.
  float wavelength_mm = 0.0f;
};

// How a material folds. `max_compression`, `threshold`, `smoothing_mm` and `depth` apply to skin
// and cloth, the others to skin: cloth folds as its fabric does. Wavelengths are distances from
// valley to valley on the surface at rest.
struct BakeMaterial {
  float wavelength_mm = 5.0f;     // [0.2, 200]
  float variation = 0.4f;         // local variation of wavelength and depth, [0, 0.5]
  float share = 0.3f;             // fraction of the compression that becomes folds; the rest
                                  // shortens the material. 1: arc length is preserved. [0, 1]
  float max_compression = 0.45f;  // larger compressions, artefacts of skinning, count as this;
                                  // (0, 0.9]
  float threshold = 0.02f;        // compression below this makes no fold, [0, 0.5]
  float smoothing_mm = 6.0f;      // radius over which strain is averaged, [0, 200]
  float sharpness = 0.7f;         // shape of the valleys: 0 nearly a sine, 1 a narrow crease
  float crossing = 0.15f;  // height of the second set of folds, which crosses the first where the
                           // surface is compressed in both directions; fraction of full height,
                           // [0, 1]
  float depth = 1.0f;  // multiplier for the height of folds and strokes, [0, 4]; older skin: > 1
  float grain = 0.3f;  // how much the skin's own lines and pores vary the height of folds, as a
                       // fraction of it, [0, 1]; 0: smooth flanks
  float fine_lines = 0.0f;  // height of lines with a third of the wavelength (dry or old skin);
                            // fraction of full height, [0, 1]
};

// The wavelength inside the mask of a region, for skin that is thinner or thicker than elsewhere.
// An entry covers both sides: "brow" applies to brow_l and brow_r.
struct BakeRegionWavelength {
  std::string region;
  float wavelength_mm = 5.0f;  // [0.2, 200]
};

// The options of a bake. CheckBake() checks the ranges.
struct BakeOptions {
  int size = 2048;  // width and height of the maps, texels, [64, 4096]
  BakeMaterial skin;
  BakeMaterial cloth{.max_compression = 0.5f, .threshold = 0.03f, .smoothing_mm = 40.0f};
  Fabric fabric = kFabrics[0];  // of all cloth but that of these regions
  std::vector<RegionFabric> fabrics = {
      {"knee", kFabrics[1]}, {"hip", kFabrics[1]}, {"ankle", kFabrics[1]}};
  float ease = 0.15f;  // how much wider cloth is than the surface that it lies on, [0, 0.3]
  // Where clothes are cut otherwise. Sleeves are long and wide for their arm; no sleeves are tight
  // all along it, nor trousers all over the hips; a bent knee draws trousers up as a whole, too.
  // Trousers are a little longer than the leg above the shoe.
  std::vector<RegionEase> eases = {{"elbow", {.looser = 1.6f, .least = 0.2f, .feeds = 1.5f}},
                                   {"hip", {.least = 0.3f}},
                                   {"knee", {.feeds = 0.4f}},
                                   {"ankle", {.least = 0.4f, .stacks = 0.3f}}};
  std::vector<BakeRegionWavelength> wavelengths = {
      {"brow", 8.0f}, {"glabella", 6.5f}, {"nose", 3.5f}, {"eye", 3.5f}, {"mouth", 5.5f}};
  float depth = 1.0f;      // multiplier for every height of both materials, [0, 4]
  std::uint32_t seed = 1;  // of the random variation; equal seeds give equal maps
  int threads = 2;         // [1, 64]; does not change the result
};

// A fold needs at least this many texels per wavelength to be visible. Finer folds are widened.
inline constexpr float kTexelsPerWave = 3.0f;

// The material of a map: `options.cloth` if `cloth` is true, else `options.skin`.
[[nodiscard]] inline const BakeMaterial& MaterialOf(const BakeOptions& options, bool cloth) {
  return cloth ? options.cloth : options.skin;
}

}  // namespace furrow::authoring
