// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "rig/shapes/shape_meaning.h"
#include "rig/shapes/shape_vocabulary.h"
#include "wrinkle/shapes/shape_program.h"
#include "wrinkle/shapes/shape_rules.h"

namespace furrow::rig {

// A vocabulary fits a stream if it explains this many names. Fewer may be coincidence.
inline constexpr int kMinShapes = 3;

// How the blend shapes of a stream move the shapes of a face, or the blend shapes that a rig reads.
struct ShapeMatch {
  // What moves a target.
  enum class By : std::uint8_t {
    kNothing,
    kSameName,     // matched without case
    kNewName,      // the same shape in another spelling or vocabulary
    kFormula,      // by a map's first formula
    kFallback,     // by a later formula, by a part of one, or by another vocabulary's
    kCombination,  // a corrective: a product of other targets, or a tent of one
  };

  std::string stream_map;  // the maps' names; empty: none fits, or none is needed
  std::string target_map;
  wrinkle::ShapeProgram program;     // one weight per target
  std::vector<By> by;                // one per target
  std::vector<std::string> missing;  // targets that nothing moves
  // Targets moved by kFallback: "browDownLeft", or "viseme_aa for jawOpen" if the target replaces
  // a shape that is missing.
  std::vector<std::string> fallbacks;
  std::vector<std::string> unknown;  // names of the stream that its map does not know
  std::size_t num_strangers = 0;     // blend shapes of the stream, if it moves no target of a face

  // The number of targets that are moved otherwise than by their own name.
  [[nodiscard]] int num_mapped() const;
};

// Finds the vocabularies of streams and faces, and translates between them.
//
// 1. A target takes the blend shape of the same name, else the same shape by another name.
// 2. The stream's other blend shapes are translated to ARKit's shapes by the map of the stream, and
//    these to the remaining targets by the map of the targets. A blend shape that a target has
//    taken in step 1 moves nothing else, so that a face that has both ARKit's shapes and visemes
//    does not open its mouth twice.
// 3. Targets that are still missing take complete formulas of the other maps: a face without
//    "jawOpen" opens its mouth by "viseme_aa". These count as fallbacks.
// 4. Correctives ("jawOpen_mouthSmileLeft", "a_x_b", "a__b", "jawOpen50") follow from their
// targets.
class ShapeMatcher {
 public:
  ShapeMatcher() = default;  // no maps: shapes match by equal names only
  // `chosen`: the map of every stream; null: the best of `shipped` per stream.
  explicit ShapeMatcher(std::vector<ShapeMap> shipped, const ShapeMap* chosen = nullptr);

  // Loads the shipped maps, and the map for every stream if `name_or_file` is not empty. Errors:
  // those of LoadShapeMap() and LoadShippedShapeMaps().
  [[nodiscard]] static Result<ShapeMatcher> Create(const std::string& name_or_file);

  // Empty names match nothing. Of equal names, the first counts. The result depends on the order of
  // neither list. mouthClose, unless taken by its own name, is at most jawOpen: alone it would pull
  // the lips apart.
  [[nodiscard]] ShapeMatch Match(std::span<const std::string> stream,
                                 std::span<const std::string> targets) const;

  // The same for the shapes of a face, as they are drawn. Shapes are found by their meaning
  // (ShapeMeanings).
  // - mouthClose is always at most jawOpen: it brings the lips together on an open jaw. Alone, it
  //   would push each lip through the other. If it contains the jaw (ShapeRule::contains), jawOpen
  //   gives way to it.
  // - Lids do not go through the eye: ShapeMeanings::LidFades().
  // - A look of VRM that is computed from ARKit's gaze follows ShapeRule::gaze.
  // - The program applies the face's `rules` to every pose.
  // `is_solved`: the stream's weights were solved from the joints of a face (JointShapes), whose
  // lids they fit together, so lids do not fade.
  [[nodiscard]] ShapeMatch MatchFace(std::span<const std::string> stream,
                                     std::span<const std::string> shapes,
                                     std::span<const wrinkle::ShapeRule> rules = {},
                                     bool is_solved = false) const;

  // What the shapes of a face mean.
  [[nodiscard]] ShapeMeanings MeaningsOf(std::span<const std::string> shapes) const;

  // The names of a face's shapes, followed by ARKit's names of those that mean one of ARKit's.
  [[nodiscard]] std::vector<std::string> AllNamesOf(std::span<const std::string> shapes) const;

  [[nodiscard]] std::span<const ShapeVocabulary> vocabularies() const { return vocabularies_; }
  // The vocabulary of a stream's names; null if none fits.
  [[nodiscard]] const ShapeVocabulary* VocabularyOf(std::span<const std::string> stream) const;

 private:
  // `face`: how the targets are limited; null: they are what a rig reads.
  [[nodiscard]] ShapeMatch MatchTo(std::span<const std::string> stream,
                                   std::span<const std::string> targets,
                                   const FaceLimits* face) const;

  std::vector<ShapeVocabulary> vocabularies_;  // sorted by name, then the chosen one
  bool chosen_ = false;
};

// The program that moves a face's shapes by a stream: ShapeMatcher::MatchFace().program.
[[nodiscard]] wrinkle::ShapeProgram MatchShapes(const ShapeMatcher& matcher,
                                                std::span<const std::string> stream,
                                                std::span<const std::string> targets,
                                                std::span<const wrinkle::ShapeRule> rules = {});

// One line for a log: "shape map 'vrm0' to 'arkit': 23 of 23 blend shapes; by fallback: jawOpen;
// missing: tongueOut". Empty if no map moves anything.
[[nodiscard]] std::string Describe(const ShapeMatch& match);

}  // namespace furrow::rig
