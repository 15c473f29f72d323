// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/arkit_face.h"

#include <algorithm>
#include <cstdint>

#include "base/ascii.h"
#include "rig/shapes/arkit_shapes.h"
#include "rig/shapes/rig_shapes.h"

namespace furrow::authoring {
namespace {

// A bit per part of the face.
std::uint8_t PartOf(std::string_view name) {
  if (name.starts_with("brow")) return 1;
  if (name.starts_with("eye") || name.starts_with("cheekSquint")) return 2;
  return 4;
}

std::vector<bool> ShapesWithTargets(const character::Character& character) {
  std::vector<bool> moved(character.shapes.size(), false);
  for (const character::Mesh& mesh : character.meshes) {
    for (const character::MorphTarget& target : mesh.morph_targets) {
      moved[static_cast<std::size_t>(target.shape)] = true;
    }
  }
  return moved;
}

}  // namespace

ArkitFace::ArkitFace(const character::Character& character, const rig::ShapeMatcher& matcher) {
  const std::vector<std::string> names = rig::ArkitAndRigShapes(character.rig);
  rig::ShapeMatch match = matcher.Match(names, character.shapes);
  description_ = rig::Describe(match);
  program_ = std::move(match.program);
  drawn_ = rig::MatchShapes(matcher, names, character.shapes, character.shape_rules);
  for (std::size_t i = 0; i < names.size(); ++i) names_.emplace(AsciiLower(names[i]), i);
  usable_ = ShapesWithTargets(character);
  std::vector<std::uint8_t> parts(usable_.size(), 0);
  for (const std::string_view name : rig::ArkitShapes()) {
    const std::vector<float> weights = Weights(name);
    for (std::size_t s = 0; s < weights.size(); ++s) {
      if (weights[s] != 0.0f) parts[s] |= PartOf(name);
    }
  }
  for (std::size_t s = 0; s < usable_.size(); ++s) {
    if ((parts[s] & (parts[s] - 1)) != 0) usable_[s] = false;  // more than one part
  }
}

bool ArkitFace::Has(std::string_view name) const {
  const std::vector<float> weights = Weights(name);
  return std::any_of(weights.begin(), weights.end(), [](float w) { return w != 0.0f; });
}

std::vector<float> ArkitFace::Run(const wrinkle::ShapeProgram& program,
                                  std::span<const Coefficient> coefficients) const {
  std::vector<float> values(names_.size(), 0.0f);
  for (const auto& [name, value] : coefficients) {
    const auto found = names_.find(AsciiLower(name));
    if (found != names_.end()) values[found->second] = value;
  }
  std::vector<float> weights(usable_.size(), 0.0f);
  // Coefficients that are not finite move nothing: Run() writes nothing then.
  (void)program.Run(values, weights);
  return weights;
}

std::vector<float> ArkitFace::DrawnWeights(std::span<const Coefficient> coefficients) const {
  return Run(drawn_, coefficients);
}

std::vector<float> ArkitFace::Weights(std::span<const Coefficient> coefficients) const {
  std::vector<float> weights = Run(program_, coefficients);
  for (std::size_t s = 0; s < weights.size(); ++s) {
    if (!usable_[s]) weights[s] = 0.0f;
  }
  return weights;
}

std::vector<float> ArkitFace::Weights(std::string_view name) const {
  const Coefficient one(std::string(name), 1.0f);
  return Weights(std::span(&one, 1));
}

std::vector<std::string> MissingOfShapeFace(const ArkitFace& face) {
  constexpr const char* kNeeded[] = {"browInnerUp",    "browDownLeft",  "browDownRight",
                                     "eyeBlinkLeft",   "eyeBlinkRight", "mouthSmileLeft",
                                     "mouthSmileRight"};
  std::vector<std::string> missing;
  for (const char* name : kNeeded) {
    if (!face.Has(name)) missing.emplace_back(name);
  }
  return missing;
}

bool HasShapeFace(const ArkitFace& face) { return MissingOfShapeFace(face).empty(); }

}  // namespace furrow::authoring
