// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rig/shapes/arkit_shapes.h"
#include "rig/shapes/shape_vocabulary.h"
#include "wrinkle/shapes/shape_formula.h"
#include "wrinkle/shapes/shape_rules.h"

namespace furrow::rig {

// What the shapes of a face mean in ARKit's terms, whatever their names. The face's own vocabulary
// comes first (the one that explains most of its names), then the others in their order, because
// avatars mix vocabularies: VRM's presets beside ARKit's shapes. Without vocabularies, ARKit's
// names and VRM's presets count.
class ShapeMeanings {
 public:
  // A set of ARKit's shapes, by index.
  using ArkitSet = std::bitset<kNumArkitShapes>;

  // `own` may be null. The arguments need not outlive this object.
  ShapeMeanings(const ShapeVocabulary* own, std::span<const ShapeVocabulary> vocabularies,
                std::span<const std::string> shapes);

  // The first shape that equals ARKit's `name`; -1: none.
  [[nodiscard]] int Find(std::string_view name) const;

  // The group that VRM's override rules limit together with a shape. VRM's presets for blinking,
  // looking and the mouth belong to theirs, and so do shapes that only ARKit's blinks, looks or
  // shapes of jaw, mouth and tongue raise. An emotion belongs to none, even if it only smiles.
  [[nodiscard]] wrinkle::ShapeRule::Group GroupOf(std::size_t shape) const {
    return meanings_[shape].group;
  }
  // GroupOf() of all shapes.
  [[nodiscard]] std::vector<wrinkle::ShapeRule::Group> Groups() const;

  // A shape of the lids that fades as an eye closes, so that the lid does not go through the eye.
  struct LidFade {
    std::size_t shape = 0;
    float share = 1.0f;               // the shape times 1 - share * mean of the blinks
    std::vector<std::size_t> blinks;  // other shapes, one per side that `shape` moves
  };
  // eyeSquint times 1 - 0.8 eyeBlink, and eyeLookDown times 1 - eyeBlink, per side. (On a published
  // avatar, the lids overshoot by 2.4 mm and 0.4 mm otherwise.)
  [[nodiscard]] std::vector<LidFade> LidFades() const;

 private:
  struct Meaning {
    int renamed = -1;  // the shape of ARKit that it equals, by its own or another name; -1: none
    ArkitSet reads;    // those that raise it
    wrinkle::ShapeRule::Group group = wrinkle::ShapeRule::kNoGroup;
  };
  [[nodiscard]] int BlinkOf(int arkit_blink) const;

  std::vector<Meaning> meanings_;
};

// How a face is limited when it is drawn.
struct FaceLimits {
  std::span<const wrinkle::ShapeRule> rules;  // of the face's shapes
  bool fade_lids = true;                      // see ShapeMeanings::LidFades()
};

// The formulas of the targets of a stream, before they become a ShapeProgram.
struct ShapeFormulas {
  // What moves a shape.
  enum class Source : std::uint8_t { kNothing, kStream, kArkit };  // kArkit: computed from ARKit's

  std::vector<wrinkle::ShapeFormula> steps;   // intermediate results
  std::vector<wrinkle::ShapeFormula> shapes;  // one per target
  std::vector<std::size_t> late;              // shapes that read other shapes, in order

  // mouthClose is at most jawOpen.
  void LimitTo(std::size_t mouth_close, std::size_t jaw_open);
  // Limits the shapes of a face, as ShapeMatcher::MatchFace() describes. `sources`: one per shape.
  void Limit(const ShapeMeanings& face, const FaceLimits& limits, std::span<const Source> sources);

 private:
  // Turns a formula into an intermediate result, for those that need its value before a limit.
  [[nodiscard]] wrinkle::ShapeInput AsStep(wrinkle::ShapeFormula formula);
  void LimitMouthClose(const ShapeMeanings& face, std::span<const wrinkle::ShapeRule> rules,
                       std::span<const Source> sources);
  void FadeLids(const ShapeMeanings& face, std::span<const Source> sources);
  void FollowGaze(const ShapeMeanings& face, std::span<const wrinkle::ShapeRule> rules,
                  std::span<const Source> sources);
};

}  // namespace furrow::rig
