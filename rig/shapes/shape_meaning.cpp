// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_meaning.h"

#include <algorithm>
#include <array>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/ascii.h"
#include "wrinkle/shapes/shape_program.h"

namespace furrow::rig {
namespace {

using wrinkle::ShapeFormula;
using wrinkle::ShapeInput;
using wrinkle::ShapeRule;
using ArkitSet = ShapeMeanings::ArkitSet;

constexpr float kSquintShare = 0.8f;  // of a squint that a full blink takes away
constexpr float kLookShare = 1.0f;    // of a lid's way down

// VRM 1.0's presets and those of VRM 0.x, by group. Emotions have none.
constexpr std::array<std::pair<std::string_view, ShapeRule::Group>, 29> kPresets = {{
    {"blink", ShapeRule::kBlinks},      {"blinkLeft", ShapeRule::kBlinks},
    {"blinkRight", ShapeRule::kBlinks}, {"blink_l", ShapeRule::kBlinks},
    {"blink_r", ShapeRule::kBlinks},    {"lookUp", ShapeRule::kLooks},
    {"lookDown", ShapeRule::kLooks},    {"lookLeft", ShapeRule::kLooks},
    {"lookRight", ShapeRule::kLooks},   {"aa", ShapeRule::kMouths},
    {"ih", ShapeRule::kMouths},         {"ou", ShapeRule::kMouths},
    {"ee", ShapeRule::kMouths},         {"oh", ShapeRule::kMouths},
    {"a", ShapeRule::kMouths},          {"i", ShapeRule::kMouths},
    {"u", ShapeRule::kMouths},          {"e", ShapeRule::kMouths},
    {"o", ShapeRule::kMouths},          {"happy", ShapeRule::kNoGroup},
    {"angry", ShapeRule::kNoGroup},     {"sad", ShapeRule::kNoGroup},
    {"relaxed", ShapeRule::kNoGroup},   {"surprised", ShapeRule::kNoGroup},
    {"neutral", ShapeRule::kNoGroup},   {"joy", ShapeRule::kNoGroup},
    {"sorrow", ShapeRule::kNoGroup},    {"fun", ShapeRule::kNoGroup},
    {"extra", ShapeRule::kNoGroup},
}};

// All of ARKit's shapes with one of these beginnings.
ArkitSet Beginning(std::initializer_list<std::string_view> beginnings) {
  ArkitSet set;
  for (std::size_t i = 0; i < set.size(); ++i) {
    set[i] = std::ranges::any_of(
        beginnings, [&](std::string_view text) { return ArkitShapes()[i].starts_with(text); });
  }
  return set;
}

bool IsWithin(const ArkitSet& part, const ArkitSet& whole) {
  return part.any() && (part & ~whole).none();
}

ShapeRule::Group GroupBy(const ArkitSet& reads) {
  static const ArkitSet kBlink = Beginning({"eyeBlink"});
  static const ArkitSet kLook = Beginning({"eyeLook"});
  static const ArkitSet kMouth = Beginning({"jaw", "mouth", "tongue"});
  if (IsWithin(reads, kBlink)) return ShapeRule::kBlinks;
  if (IsWithin(reads, kLook)) return ShapeRule::kLooks;
  return IsWithin(reads, kMouth) ? ShapeRule::kMouths : ShapeRule::kNoGroup;
}

ArkitSet ReadsOf(const MapShape& shape) {
  ArkitSet reads;
  if (shape.from_arkit.empty()) return reads;
  for (const MapTerm& term : shape.from_arkit.front().sum) {
    for (const MapTerm::Factor& factor : term.product) {
      if (term.gain > 0.0f && !factor.rest) reads.set(static_cast<std::size_t>(factor.shape));
    }
  }
  return reads;
}

// The presets that the shapes of a vocabulary are, in any of its spellings.
class Presets {
 public:
  explicit Presets(const ShapeVocabulary& vocabulary) {
    for (const auto& [name, group] : kPresets) {
      const int shape = vocabulary.Find(name).shape;
      if (shape >= 0) group_of_.emplace(shape, group);
    }
  }
  [[nodiscard]] std::optional<ShapeRule::Group> GroupOf(int shape) const {
    const auto found = group_of_.find(shape);
    return found == group_of_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::unordered_map<int, ShapeRule::Group> group_of_;
};

std::optional<ShapeRule::Group> PresetNamed(std::string_view name) {
  const auto found = std::ranges::find_if(
      kPresets, [&](const auto& preset) { return EqualsIgnoreCase(preset.first, name); });
  return found == kPresets.end() ? std::nullopt : std::optional(found->second);
}

ShapeInput ClampedShape(std::size_t index) {
  return {.from = ShapeInput::From::kShape,
          .use = ShapeInput::Use::kClamped,
          .index = static_cast<std::uint32_t>(index)};
}

}  // namespace

ShapeMeanings::ShapeMeanings(const ShapeVocabulary* own,
                             std::span<const ShapeVocabulary> vocabularies,
                             std::span<const std::string> shapes)
    : meanings_(shapes.size()) {
  std::vector<std::optional<ShapeRule::Group>> presets;
  for (const std::string& name : shapes) presets.push_back(PresetNamed(name));
  std::vector<bool> known(shapes.size(), false);
  const auto learn = [&](const ShapeVocabulary& vocabulary) {
    const Presets of_vocabulary(vocabulary);
    std::vector<int> found_at;
    std::vector<bool> has(vocabulary.map().shapes.size(), false);
    for (const std::string& name : shapes) {
      found_at.push_back(vocabulary.Find(name).shape);
      if (found_at.back() >= 0) has[static_cast<std::size_t>(found_at.back())] = true;
    }
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const int found = found_at[i];
      if (found < 0) continue;
      if (!presets[i]) presets[i] = of_vocabulary.GroupOf(found);
      if (known[i]) continue;
      known[i] = true;
      const MapShape& shape = vocabulary.map().shapes[static_cast<std::size_t>(found)];
      meanings_[i].reads = ReadsOf(shape);
      const bool is_spare = std::ranges::any_of(
          shape.unless, [&](int other) { return has[static_cast<std::size_t>(other)]; });
      if (!shape.from_arkit.empty() && !is_spare) {
        meanings_[i].renamed = shape.from_arkit.front().RenamedShape();
      }
    }
  };
  if (own != nullptr) learn(*own);
  for (const ShapeVocabulary& other : vocabularies) {
    if (&other != own) learn(other);
  }
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const int arkit = known[i] ? -1 : FindArkitShape(shapes[i]);
    if (arkit >= 0) {
      meanings_[i].renamed = arkit;
      meanings_[i].reads.set(static_cast<std::size_t>(arkit));
    }
    meanings_[i].group = presets[i].value_or(GroupBy(meanings_[i].reads));
  }
}

int ShapeMeanings::Find(std::string_view name) const {
  const int arkit = FindArkitShape(name);
  const auto found = std::ranges::find(meanings_, arkit, &Meaning::renamed);
  return arkit < 0 || found == meanings_.end() ? -1 : static_cast<int>(found - meanings_.begin());
}

std::vector<ShapeRule::Group> ShapeMeanings::Groups() const {
  std::vector<ShapeRule::Group> groups;
  for (const Meaning& meaning : meanings_) groups.push_back(meaning.group);
  return groups;
}

// The shape of one side, or else the one that closes both eyes.
int ShapeMeanings::BlinkOf(int arkit_blink) const {
  static const ArkitSet kBlink = Beginning({"eyeBlink"});
  int both = -1;
  for (std::size_t i = 0; i < meanings_.size(); ++i) {
    const ArkitSet& reads = meanings_[i].reads;
    if (!IsWithin(reads, kBlink) || !reads[static_cast<std::size_t>(arkit_blink)]) continue;
    if (reads.count() == 1) return static_cast<int>(i);
    if (both < 0) both = static_cast<int>(i);
  }
  return both;
}

std::vector<ShapeMeanings::LidFade> ShapeMeanings::LidFades() const {
  struct Side {
    int squint, look, blink;  // ARKit's
    int closes;               // of the face; -1: nothing closes this eye
  };
  std::array<Side, 2> sides{};
  ArkitSet squints, looks;
  for (const bool left : {true, false}) {
    const std::string side = left ? "Left" : "Right";
    Side& to = sides[left ? 0 : 1];
    to.squint = FindArkitShape("eyeSquint" + side);
    to.look = FindArkitShape("eyeLookDown" + side);
    to.blink = FindArkitShape("eyeBlink" + side);
    to.closes = BlinkOf(to.blink);
    squints.set(static_cast<std::size_t>(to.squint));
    looks.set(static_cast<std::size_t>(to.look));
  }
  std::vector<LidFade> fades;
  for (std::size_t i = 0; i < meanings_.size(); ++i) {
    const ArkitSet& reads = meanings_[i].reads;
    const bool is_squint = IsWithin(reads, squints);
    if (!is_squint && !IsWithin(reads, looks)) continue;
    LidFade fade{.shape = i, .share = is_squint ? kSquintShare : kLookShare, .blinks = {}};
    for (const Side& side : sides) {
      const int moved = is_squint ? side.squint : side.look;
      if (!reads[static_cast<std::size_t>(moved)] || side.closes < 0) continue;
      fade.blinks.push_back(static_cast<std::size_t>(side.closes));
    }
    if (!fade.blinks.empty()) fades.push_back(std::move(fade));
  }
  return fades;
}

ShapeInput ShapeFormulas::AsStep(ShapeFormula formula) {
  steps.push_back(std::move(formula));
  return {.from = ShapeInput::From::kStep, .index = static_cast<std::uint32_t>(steps.size() - 1)};
}

void ShapeFormulas::LimitTo(std::size_t mouth_close, std::size_t jaw_open) {
  shapes[mouth_close].at_most = ClampedShape(jaw_open);
  late.push_back(mouth_close);
}

void ShapeFormulas::Limit(const ShapeMeanings& face, const FaceLimits& limits,
                          std::span<const Source> sources) {
  FollowGaze(face, limits.rules, sources);
  LimitMouthClose(face, limits.rules, sources);
  if (limits.fade_lids) FadeLids(face, sources);
}

void ShapeFormulas::LimitMouthClose(const ShapeMeanings& face, std::span<const ShapeRule> rules,
                                    std::span<const Source> sources) {
  const int found_close = face.Find("mouthClose");
  const int found_jaw = face.Find("jawOpen");
  if (found_close < 0 || found_jaw < 0) return;
  const auto close = static_cast<std::size_t>(found_close);
  const auto jaw = static_cast<std::size_t>(found_jaw);
  if (sources[close] == Source::kNothing || sources[jaw] == Source::kNothing) return;
  const bool contains_jaw = std::ranges::any_of(
      rules, [&](const ShapeRule& rule) { return rule.shape == close && rule.contains == jaw; });
  if (!contains_jaw || steps.size() >= wrinkle::ShapeProgram::kMaxSteps) {
    LimitTo(close, jaw);
    return;
  }
  // The jaw is open by as much as the stream says, and mouthClose does its part of that.
  ShapeInput open = AsStep(std::move(shapes[jaw]));
  open.use = ShapeInput::Use::kClamped;
  shapes[close].at_most = open;
  shapes[jaw] = {
      .sum = {{.gain = 1.0f, .product = {open}}, {.gain = -1.0f, .product = {ClampedShape(close)}}},
      .clamped = true,
      .at_most = {}};
  late.push_back(close);
  late.push_back(jaw);
}

void ShapeFormulas::FadeLids(const ShapeMeanings& face, std::span<const Source> sources) {
  for (const ShapeMeanings::LidFade& fade : face.LidFades()) {
    if (sources[fade.shape] == Source::kNothing) continue;
    wrinkle::ShapeFade built{.share = fade.share, .by = {}};
    for (const std::size_t blink : fade.blinks) {
      if (sources[blink] != Source::kNothing) built.by.push_back(ClampedShape(blink));
    }
    if (built.by.empty()) continue;
    shapes[fade.shape].fade = std::move(built);
    late.push_back(fade.shape);
  }
}

// A stream's own looks are weights already; only those made from ARKit's gaze are angles.
void ShapeFormulas::FollowGaze(const ShapeMeanings& face, std::span<const ShapeRule> rules,
                               std::span<const Source> sources) {
  constexpr float kLeastInput = 1e-3f;  // degrees
  for (const ShapeRule& rule : rules) {
    if (!rule.gaze || rule.shape >= shapes.size()) continue;
    if (sources[rule.shape] != Source::kArkit) continue;
    if (face.GroupOf(rule.shape) != ShapeRule::kLooks) continue;
    if (steps.size() + 2 > wrinkle::ShapeProgram::kMaxSteps) return;
    const float gain = kFullGaze / std::max(rule.gaze->input, kLeastInput);
    const ShapeInput gaze = AsStep(std::move(shapes[rule.shape]));
    const ShapeInput share =
        AsStep({.sum = {{.gain = gain, .product = {gaze}}}, .clamped = true, .at_most = {}});
    shapes[rule.shape] = {
        .sum = {{.gain = rule.gaze->output, .product = {share}}}, .clamped = true, .at_most = {}};
  }
}

}  // namespace furrow::rig
