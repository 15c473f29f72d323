// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_match.h"

#include <algorithm>
#include <array>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/ascii.h"
#include "base/status.h"
#include "base/text.h"
#include "rig/shapes/formula_builder.h"
#include "rig/shapes/shape_combination.h"

namespace furrow::rig {
namespace {

using By = ShapeMatch::By;
using wrinkle::ShapeFormula;
using wrinkle::ShapeInput;

ShapeInput Coefficient(std::size_t index) {
  return {.from = ShapeInput::From::kBlendShape, .index = static_cast<std::uint32_t>(index)};
}

// The shape of ARKit that a name of a vocabulary renames; -1: it is something else; nullopt: the
// vocabulary does not know the name.
std::optional<int> RenamedBy(const ShapeVocabulary* vocabulary, std::string_view name) {
  const int found = vocabulary == nullptr ? -1 : vocabulary->Find(name).shape;
  if (found < 0) return std::nullopt;
  const auto& formulas = vocabulary->map().shapes[static_cast<std::size_t>(found)].from_arkit;
  return formulas.empty() ? -1 : formulas.front().RenamedShape();
}

// Two vocabularies may use one name for different shapes: SRanipal's Jaw_Open is ARKit's jawOpen
// less mouthClose. Such names go through the formulas.
bool MeanTheSame(const ShapeVocabulary* from, std::string_view stream_name,
                 const ShapeVocabulary* to, std::string_view target) {
  const std::optional<int> theirs = RenamedBy(from, stream_name);
  const std::optional<int> ours = RenamedBy(to, target);
  return from == to || !theirs || !ours || *theirs == *ours;
}

// "mouthRollLower + mouthRollUpper"
std::string ShapesOf(const MapFormula& formula) {
  std::string text;
  for (const MapTerm& term : formula.sum) {
    for (const MapTerm::Factor& factor : term.product) {
      if (factor.rest) continue;
      text += (text.empty() ? "" : " + ") +
              std::string(ArkitShapes()[static_cast<std::size_t>(factor.shape)]);
    }
  }
  return text;
}

// Matches one stream with one set of targets, in the steps that shape_match.h describes.
class Matching {
 public:
  Matching(std::span<const std::string> stream, std::span<const std::string> targets)
      : stream_(stream),
        targets_(targets),
        taken_(stream.size(), false),
        formulas_{.shapes = std::vector<ShapeFormula>(targets.size())} {
    match_.by.assign(targets.size(), By::kNothing);
  }

  void TakeEqualNames();
  // `vocabulary` says which names mean the same shape; `from` and `to` are those of the stream and
  // of the targets. All may be null.
  void TakeNewNames(const ShapeVocabulary* vocabulary, const ShapeVocabulary* from,
                    const ShapeVocabulary* to);
  void TranslateToArkit(const ShapeVocabulary& stream);
  // `stands_in`: the vocabulary is not the targets' own, so it only fills gaps, by whole formulas.
  void TranslateToTargets(const ShapeVocabulary& targets, bool stands_in);
  [[nodiscard]] bool HasOpenTargets() const {
    for (std::size_t t = 0; t < targets_.size(); ++t) {
      if (IsOpen(t)) return true;
    }
    return false;
  }
  // For what a rig reads: its mouthClose keeps the stream's own value.
  void LimitMouthClose(const ShapeVocabulary& targets);
  void LimitFace(const ShapeMeanings& face, const FaceLimits& limits);
  void Combine(const ShapeVocabulary* targets);
  [[nodiscard]] ShapeMatch Finish(const ShapeVocabulary* stream, const ShapeVocabulary* targets) &&;

 private:
  [[nodiscard]] bool IsOpen(std::size_t target) const {
    return match_.by[target] == By::kNothing && !targets_[target].empty();
  }
  void Set(std::size_t target, By by, ShapeFormula formula) {
    match_.by[target] = by;
    formulas_.shapes[target] = std::move(formula);
  }
  // For each shape of the vocabulary, the blend shape of the stream that means it: the one in the
  // vocabulary's own spelling, or else the first in the alphabet. Leaves out taken ones.
  [[nodiscard]] std::vector<std::optional<std::size_t>> StreamByShape(
      const ShapeVocabulary& vocabulary) const;
  // Whether each shape of the vocabulary is among the targets.
  [[nodiscard]] std::vector<bool> HasTarget(const ShapeVocabulary& vocabulary) const;
  // The target that is ARKit's shape by another name or its own.
  [[nodiscard]] std::optional<std::size_t> TargetOf(const ShapeVocabulary& targets,
                                                    int arkit) const;

  std::span<const std::string> stream_;
  std::span<const std::string> targets_;
  std::vector<bool> taken_;  // per blend shape of the stream
  ShapeInputs arkit_{kNumArkitShapes};
  std::array<bool, kNumArkitShapes> arkit_by_fallback_{};
  ShapeFormulas formulas_;
  // What a target replaces: a shape of ARKit that is missing, such as "jawOpen".
  std::unordered_map<std::size_t, std::string> stands_in_for_;
  ShapeMatch match_;
};

void Matching::TakeEqualNames() {
  std::unordered_map<std::string, std::size_t> by_name;
  for (std::size_t i = 0; i < stream_.size(); ++i) {
    if (!stream_[i].empty()) by_name.emplace(AsciiLower(stream_[i]), i);
  }
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    const auto found = by_name.find(AsciiLower(targets_[t]));
    if (found == by_name.end()) continue;
    taken_[found->second] = true;
    Set(t, By::kSameName, SameAs(Coefficient(found->second)));
  }
  // A second blend shape of the same name moves nothing.
  for (std::size_t i = 0; i < stream_.size(); ++i) {
    const auto first = by_name.find(AsciiLower(stream_[i]));
    if (first == by_name.end() || first->second != i) taken_[i] = true;
  }
}

std::vector<std::optional<std::size_t>> Matching::StreamByShape(
    const ShapeVocabulary& vocabulary) const {
  const std::size_t num_shapes = vocabulary.map().shapes.size();
  std::vector<std::optional<std::size_t>> by_shape(num_shapes);
  std::vector<bool> exact(num_shapes, false);
  for (std::size_t i = 0; i < stream_.size(); ++i) {
    if (taken_[i]) continue;
    const ShapeVocabulary::Found found = vocabulary.Find(stream_[i]);
    if (found.shape < 0) continue;
    const auto shape = static_cast<std::size_t>(found.shape);
    auto& chosen = by_shape[shape];
    const bool is_better = !chosen || (found.exact != exact[shape]
                                           ? found.exact
                                           : AsciiLower(stream_[i]) < AsciiLower(stream_[*chosen]));
    if (!is_better) continue;
    chosen = i;
    exact[shape] = found.exact;
  }
  return by_shape;
}

void Matching::TakeNewNames(const ShapeVocabulary* vocabulary, const ShapeVocabulary* from,
                            const ShapeVocabulary* to) {
  if (vocabulary == nullptr) return;
  const auto by_shape = StreamByShape(*vocabulary);
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    const int shape = vocabulary->Find(targets_[t]).shape;
    if (!IsOpen(t) || shape < 0) continue;
    const auto& source = by_shape[static_cast<std::size_t>(shape)];
    if (!source || !MeanTheSame(from, stream_[*source], to, targets_[t])) continue;
    taken_[*source] = true;
    Set(t, By::kNewName, SameAs(Coefficient(*source)));
  }
}

void Matching::TranslateToArkit(const ShapeVocabulary& stream) {
  const auto by_shape = StreamByShape(stream);
  ShapeInputs inputs(by_shape.size());
  for (std::size_t i = 0; i < by_shape.size(); ++i) {
    if (by_shape[i]) inputs[i] = Coefficient(*by_shape[i]);
  }
  for (std::size_t a = 0; a < arkit_.size(); ++a) {
    auto built = BuildFormula(stream.map().to_arkit[a], inputs);
    if (!built) continue;
    arkit_by_fallback_[a] = built->fallback;
    if (built->renames) {
      arkit_[a] = built->formula.sum[0].product[0];
      continue;
    }
    arkit_[a] = ShapeInput{.from = ShapeInput::From::kStep,
                           .index = static_cast<std::uint32_t>(formulas_.steps.size())};
    formulas_.steps.push_back(std::move(built->formula));
  }
}

std::vector<bool> Matching::HasTarget(const ShapeVocabulary& vocabulary) const {
  std::vector<bool> has(vocabulary.map().shapes.size(), false);
  for (const std::string& target : targets_) {
    const int shape = vocabulary.Find(target).shape;
    if (shape >= 0) has[static_cast<std::size_t>(shape)] = true;
  }
  return has;
}

void Matching::TranslateToTargets(const ShapeVocabulary& targets, bool stands_in) {
  const std::vector<bool> has = HasTarget(targets);
  std::array<bool, kNumArkitShapes> used{};
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    const int found = IsOpen(t) ? targets.Find(targets_[t]).shape : -1;
    if (found < 0) continue;
    const MapShape& shape = targets.map().shapes[static_cast<std::size_t>(found)];
    const auto is_present = [&](int other) { return has[static_cast<std::size_t>(other)]; };
    if (std::ranges::any_of(shape.unless, is_present)) continue;
    auto built = BuildFormula(shape.from_arkit, arkit_, /*only_complete=*/stands_in);
    if (!built) continue;
    bool fallback = built->fallback || stands_in;
    for (const MapFormula& formula : shape.from_arkit) {
      for (const MapTerm& term : formula.sum) {
        for (const MapTerm::Factor& factor : term.product) {
          const auto a = static_cast<std::size_t>(factor.shape);
          used[a] = true;
          fallback |= built->renames && arkit_by_fallback_[a];
        }
      }
    }
    // A new name for a value that the stream sends; everything else is computed.
    const bool is_new_name =
        built->renames && built->formula.sum[0].product[0].from == ShapeInput::From::kBlendShape;
    const By by = is_new_name ? By::kNewName : By::kFormula;
    Set(t, fallback ? By::kFallback : by, std::move(built->formula));
    if (stands_in) stands_in_for_[t] = ShapesOf(shape.from_arkit.front());
  }
  // What has moved a target is not used by the next vocabulary.
  for (std::size_t a = 0; a < used.size(); ++a) {
    if (used[a]) arkit_[a].reset();
  }
}

std::optional<std::size_t> Matching::TargetOf(const ShapeVocabulary& targets, int arkit) const {
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    const int found = targets.Find(targets_[t]).shape;
    if (found < 0 || match_.by[t] == By::kNothing) continue;
    const auto& formulas = targets.map().shapes[static_cast<std::size_t>(found)].from_arkit;
    if (!formulas.empty() && formulas.front().RenamedShape() == arkit) return t;
  }
  return std::nullopt;
}

void Matching::LimitMouthClose(const ShapeVocabulary& targets) {
  const auto close = TargetOf(targets, FindArkitShape("mouthClose"));
  const auto jaw = TargetOf(targets, FindArkitShape("jawOpen"));
  if (!close || !jaw || match_.by[*close] == By::kSameName) return;
  formulas_.LimitTo(*close, *jaw);
}

void Matching::LimitFace(const ShapeMeanings& face, const FaceLimits& limits) {
  std::vector<ShapeFormulas::Source> sources;
  for (const By by : match_.by) {
    const bool computed = by == By::kFormula || by == By::kFallback;
    sources.push_back(by == By::kNothing ? ShapeFormulas::Source::kNothing
                      : computed         ? ShapeFormulas::Source::kArkit
                                         : ShapeFormulas::Source::kStream);
  }
  formulas_.Limit(face, limits, sources);
}

void Matching::Combine(const ShapeVocabulary* targets) {
  if (std::ranges::none_of(targets_, [](const std::string& name) {
        return name.find('_') != std::string::npos || (!name.empty() && name.back() <= '9');
      })) {
    return;
  }
  const ShapeCombinations combinations(targets_, targets);
  std::vector<std::pair<std::size_t, ShapeCombinations::Product>> found;
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    if (!IsOpen(t) || (targets != nullptr && targets->Find(targets_[t]).shape >= 0)) continue;
    auto product = combinations.Find(targets_[t]);
    const auto is_moved = [&](const ShapeInput& input) {
      return match_.by[input.index] != By::kNothing;
    };
    if (product && std::ranges::all_of(*product, is_moved)) found.emplace_back(t, *product);
  }
  // Set afterwards: a corrective does not depend on correctives.
  for (auto& [target, product] : found) {
    Set(target, By::kCombination,
        {.sum = {{.gain = 1.0f, .product = std::move(product)}},
         .clamped = false,
         .at_most = {},
         .is_corrective = true});
    formulas_.late.push_back(target);
  }
}

ShapeMatch Matching::Finish(const ShapeVocabulary* stream, const ShapeVocabulary* targets) && {
  std::vector<std::pair<std::size_t, ShapeFormula>> formulas;
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    if (match_.by[t] == By::kFallback) {
      const auto missing = stands_in_for_.find(t);
      match_.fallbacks.push_back(
          missing == stands_in_for_.end() ? targets_[t] : targets_[t] + " for " + missing->second);
    }
    if (IsOpen(t)) match_.missing.push_back(targets_[t]);
    if (match_.by[t] == By::kNothing || std::ranges::count(formulas_.late, t) > 0) continue;
    formulas.emplace_back(t, std::move(formulas_.shapes[t]));
  }
  for (const std::size_t t : formulas_.late)
    formulas.emplace_back(t, std::move(formulas_.shapes[t]));
  auto program = wrinkle::ShapeProgram::Create(targets_.size(), formulas_.steps, formulas);
  // The formulas are in order by construction; equal names are the safe answer to a fault here.
  match_.program =
      program.ok() ? *std::move(program) : wrinkle::ShapeProgram::ByName(stream_, targets_);
  if (targets != nullptr) match_.target_map = targets->map().name;
  if (stream != nullptr) {
    match_.stream_map = stream->map().name;
    for (const std::string& name : stream_) {
      if (stream->Find(name).shape < 0) match_.unknown.push_back(name);
    }
  }
  return std::move(match_);
}

// "a, b and 3 more". Names come from senders, so a log line has a limit.
std::string JoinNames(std::span<const std::string> names) {
  constexpr std::size_t kListed = 8;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kListed; ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > kListed) text += " and " + std::to_string(names.size() - kListed) + " more";
  return text;
}

}  // namespace

int ShapeMatch::num_mapped() const {
  return static_cast<int>(std::ranges::count_if(
      by, [](By how) { return how != By::kNothing && how != By::kSameName; }));
}

ShapeMatcher::ShapeMatcher(std::vector<ShapeMap> shipped, const ShapeMap* chosen)
    : chosen_(chosen != nullptr) {
  std::ranges::sort(shipped, {}, &ShapeMap::name);
  for (ShapeMap& map : shipped) vocabularies_.emplace_back(std::move(map));
  // A chosen map may also describe the user's own face, so it joins the maps for targets.
  if (chosen_) vocabularies_.emplace_back(*chosen);
}

Result<ShapeMatcher> ShapeMatcher::Create(const std::string& name_or_file) {
  auto shipped = LoadShippedShapeMaps();
  FURROW_RETURN_IF_ERROR(shipped);
  if (name_or_file.empty()) return ShapeMatcher(*std::move(shipped));
  const auto chosen = LoadShapeMap(name_or_file);
  FURROW_RETURN_IF_ERROR(chosen);
  return ShapeMatcher(*std::move(shipped), &*chosen);
}

const ShapeVocabulary* ShapeMatcher::VocabularyOf(std::span<const std::string> stream) const {
  return chosen_ ? &vocabularies_.back() : BestVocabulary(vocabularies_, stream, kMinShapes);
}

ShapeMatch ShapeMatcher::Match(std::span<const std::string> stream,
                               std::span<const std::string> targets) const {
  return MatchTo(stream, targets, nullptr);
}

ShapeMatch ShapeMatcher::MatchFace(std::span<const std::string> stream,
                                   std::span<const std::string> shapes,
                                   std::span<const wrinkle::ShapeRule> rules,
                                   bool is_solved) const {
  const FaceLimits limits{.rules = rules, .fade_lids = !is_solved};
  ShapeMatch match = MatchTo(stream, shapes, &limits);
  const bool moves = std::ranges::any_of(match.by, [](By how) { return how != By::kNothing; });
  if (!moves && !shapes.empty()) match.num_strangers = stream.size();
  return match;
}

ShapeMeanings ShapeMatcher::MeaningsOf(std::span<const std::string> shapes) const {
  return {BestVocabulary(vocabularies_, shapes, 1), vocabularies_, shapes};
}

std::vector<std::string> ShapeMatcher::AllNamesOf(std::span<const std::string> shapes) const {
  std::vector<std::string> names(shapes.begin(), shapes.end());
  const ShapeVocabulary* own = BestVocabulary(vocabularies_, shapes, 1);
  for (const std::string& shape : shapes) {
    const int arkit = RenamedBy(own, shape).value_or(-1);
    if (arkit >= 0) names.emplace_back(ArkitShapes()[static_cast<std::size_t>(arkit)]);
  }
  return names;
}

ShapeMatch ShapeMatcher::MatchTo(std::span<const std::string> stream,
                                 std::span<const std::string> targets,
                                 const FaceLimits* face) const {
  Matching matching(stream, targets);
  matching.TakeEqualNames();
  // Most streams have the rig's own names. Translating costs a millisecond or more.
  if (!matching.HasOpenTargets() && face == nullptr) {
    return std::move(matching).Finish(nullptr, nullptr);
  }
  const ShapeVocabulary* from = VocabularyOf(stream);
  const ShapeVocabulary* to = BestVocabulary(vocabularies_, targets, 1);
  // The targets' own map first: it knows the spelling that is asked for.
  matching.TakeNewNames(to, from, to);
  matching.TakeNewNames(from, from, to);
  if (from != nullptr) matching.TranslateToArkit(*from);
  if (to != nullptr) matching.TranslateToTargets(*to, /*stands_in=*/false);
  for (const ShapeVocabulary& other : vocabularies_) {
    if (&other != to) matching.TranslateToTargets(other, /*stands_in=*/true);
  }
  if (face == nullptr) {
    if (to != nullptr) matching.LimitMouthClose(*to);
    matching.Combine(to);
    return std::move(matching).Finish(from, to);
  }
  const ShapeMeanings meanings(to, vocabularies_, targets);
  matching.LimitFace(meanings, *face);
  matching.Combine(to);
  ShapeMatch match = std::move(matching).Finish(from, to);
  match.program.SetRules({face->rules, meanings.Groups()});
  return match;
}

wrinkle::ShapeProgram MatchShapes(const ShapeMatcher& matcher, std::span<const std::string> stream,
                                  std::span<const std::string> targets,
                                  std::span<const wrinkle::ShapeRule> rules) {
  return matcher.MatchFace(stream, targets, rules).program;
}

std::string Describe(const ShapeMatch& match) {
  if (match.num_strangers > 0) {
    return "none of its " + Counted(match.by.size(), "blend shape") + " follows the stream's " +
           std::to_string(match.num_strangers) + "; 'furrow shape-map propose' writes a map";
  }
  if (match.num_mapped() == 0) return {};
  std::size_t moved = 0;
  for (const By how : match.by) moved += how == By::kNothing ? 0 : 1;
  const std::string maps = match.stream_map.empty() ? match.target_map : match.stream_map;
  std::string text = "shape map '" + maps + "'";
  if (!match.target_map.empty() && match.target_map != maps) {
    text += " to '" + match.target_map + "'";
  }
  text += ": " + std::to_string(moved) + " of " + Counted(match.by.size(), "blend shape");
  if (!match.fallbacks.empty()) text += "; by fallback: " + JoinNames(match.fallbacks);
  if (!match.missing.empty()) text += "; missing: " + JoinNames(match.missing);
  return text;
}

}  // namespace furrow::rig
