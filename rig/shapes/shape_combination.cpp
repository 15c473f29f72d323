// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_combination.h"

#include <algorithm>
#include <utility>

#include "base/ascii.h"
#include "rig/shapes/shape_names.h"

namespace furrow::rig {
namespace {

using wrinkle::ShapeInput;

// More words than any real corrective has; bounds the work on hostile names.
constexpr std::size_t kMaxWords = 16;
constexpr std::size_t kMaxCorrectiveName = 255;

std::string LowerTarget(std::string_view name) {
  return AsciiLower(std::string(ShapeNameCore(name)));
}

// "jawOpen50" -> ("jawOpen", 50). nullopt: does not end in two digits from 01 to 99.
std::optional<std::pair<std::string_view, int>> InBetween(std::string_view name) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const std::size_t size = name.size();
  if (size < 3 || !is_digit(name[size - 1]) || !is_digit(name[size - 2])) return std::nullopt;
  const int percent = (name[size - 2] - '0') * 10 + (name[size - 1] - '0');
  std::string_view base = name.substr(0, size - 2);
  if (base.ends_with('_')) base.remove_suffix(1);
  if (percent == 0 || base.empty() || is_digit(base.back())) return std::nullopt;
  return std::pair(base, percent);
}

std::vector<std::string> SplitAtUnderscores(std::string_view name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    if (c == '_') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

bool IsMark(const std::string& word) { return word.empty() || word == "x" || word == "X"; }

// The sides that the last word of a name gives to all parts.
std::vector<std::string> SidesOfWord(std::string_view word) {
  if (word == "L" || word == "l") return {"L"};
  if (word == "R" || word == "r") return {"R"};
  if (word == "LR" || word == "lr") return {"L", "R"};
  return {};
}

std::string Joined(std::span<const std::string> words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : "_") + word;
  return text;
}

}  // namespace

ShapeCombinations::ShapeCombinations(std::span<const std::string> targets,
                                     const ShapeVocabulary* vocabulary)
    : vocabulary_(vocabulary) {
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (targets[i].empty()) continue;
    by_name_.emplace(LowerTarget(targets[i]), i);
    if (vocabulary_ == nullptr) continue;
    const int shape = vocabulary_->Find(targets[i]).shape;
    if (shape >= 0) by_shape_.emplace(shape, i);
  }
  for (const auto& [name, target] : by_name_) {
    const auto found = InBetween(name);
    if (!found) continue;
    const auto base = TargetOf(found->first);
    if (base && *base != target) in_betweens_[*base].push_back(found->second);
  }
  for (auto& [base, percents] : in_betweens_) std::ranges::sort(percents);
}

std::optional<std::size_t> ShapeCombinations::TargetOf(std::string_view part) const {
  if (part.empty()) return std::nullopt;
  const auto named = by_name_.find(AsciiLower(std::string(part)));
  if (named != by_name_.end()) return named->second;
  if (vocabulary_ == nullptr) return std::nullopt;
  const auto found = by_shape_.find(vocabulary_->Find(part).shape);
  return found == by_shape_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<ShapeInput> ShapeCombinations::InputOf(std::string_view part) const {
  if (const auto between = InBetween(part)) {
    const auto base = TargetOf(between->first);
    if (base && in_betweens_.contains(*base)) {
      const std::vector<int>& percents = in_betweens_.at(*base);
      const auto at = std::ranges::lower_bound(percents, between->second);
      const auto next = std::ranges::upper_bound(percents, between->second);
      return ShapeInput{
          .from = ShapeInput::From::kShape,
          .use = ShapeInput::Use::kTent,
          .index = static_cast<std::uint32_t>(*base),
          .before = at == percents.begin() ? 0.0f : 0.01f * static_cast<float>(at[-1]),
          .at = 0.01f * static_cast<float>(between->second),
          .after = next == percents.end() ? 1.0f : 0.01f * static_cast<float>(*next)};
    }
  }
  const auto target = TargetOf(part);
  if (!target) return std::nullopt;
  return ShapeInput{.from = ShapeInput::From::kShape,
                    .use = ShapeInput::Use::kClamped,
                    .index = static_cast<std::uint32_t>(*target)};
}

std::optional<ShapeCombinations::Product> ShapeCombinations::InputsOf(const std::string& part,
                                                                      const Parts& sides) const {
  if (const auto input = InputOf(part)) return Product{*input};
  Product product;
  for (const std::string& side : sides) {
    const auto input = InputOf(part + "_" + side);
    if (!input) return std::nullopt;
    product.push_back(*input);
  }
  return product.empty() ? std::nullopt : std::optional(product);
}

std::optional<ShapeCombinations::Product> ShapeCombinations::ProductOf(const Parts& parts,
                                                                       const Parts& sides) const {
  Product product;
  for (const std::string& part : parts) {
    const auto inputs = InputsOf(part, sides);
    if (!inputs) return std::nullopt;
    product.insert(product.end(), inputs->begin(), inputs->end());
  }
  return parts.size() < 2 ? std::nullopt : std::optional(product);
}

// The words may belong together in many ways: "Jaw_Open_Mouth_Smile_L". The fewest parts win.
// best[i] is the best product of the words from i on.
std::optional<ShapeCombinations::Product> ShapeCombinations::SplitAnywhere(
    const Parts& words, const Parts& sides) const {
  struct Best {
    std::size_t parts = 0;
    Product product;
  };
  const std::size_t count = words.size();
  std::vector<std::optional<Best>> best(count + 1);
  best[count] = Best{};
  for (std::size_t first = count; first-- > 0;) {
    for (std::size_t end = count; end > first; --end) {
      const bool is_whole = first == 0 && end == count;
      if (is_whole || !best[end]) continue;
      if (best[first] && best[first]->parts <= best[end]->parts + 1) continue;
      const auto inputs = InputsOf(Joined(std::span(words).subspan(first, end - first)), sides);
      if (!inputs) continue;
      Best longer{.parts = best[end]->parts + 1, .product = *inputs};
      longer.product.insert(longer.product.end(), best[end]->product.begin(),
                            best[end]->product.end());
      best[first] = std::move(longer);
    }
  }
  return best[0] ? std::optional(best[0]->product) : std::nullopt;
}

std::optional<ShapeCombinations::Product> ShapeCombinations::Split(const Parts& words,
                                                                   const Parts& sides) const {
  if (std::ranges::none_of(words, IsMark)) return SplitAnywhere(words, sides);
  Parts parts(1);
  for (const std::string& word : words) {
    if (IsMark(word)) {
      parts.emplace_back();
    } else {
      parts.back() += (parts.back().empty() ? "" : "_") + word;
    }
  }
  return ProductOf(parts, sides);
}

std::optional<ShapeCombinations::Product> ShapeCombinations::Find(std::string_view target) const {
  if (target.size() > kMaxCorrectiveName) return std::nullopt;
  const std::string_view core = ShapeNameCore(target);
  if (InBetween(core)) {
    if (const auto input = InputOf(core); input && input->use == ShapeInput::Use::kTent) {
      return Product{*input};
    }
  }
  Parts words = SplitAtUnderscores(core);
  if (words.size() < 2 || words.size() > kMaxWords) return std::nullopt;
  if (auto product = Split(words, {})) return product;
  const Parts sides = SidesOfWord(words.back());
  if (sides.empty()) return std::nullopt;
  words.pop_back();
  return Split(words, sides);
}

}  // namespace furrow::rig
