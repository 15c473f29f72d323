// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "authoring/import/makehuman/formats/mhm.h"

namespace furrow::authoring {

// MakeHuman's macro variables. Each has a few words that occur in the names of target files, for
// example "female-young-averagemuscle-maxweight-...".
enum class MacroVariable {
  kGender,
  kAge,
  kRace,
  kMuscle,
  kWeight,
  kHeight,
  kBreastSize,
  kBreastFirmness,
  kProportions,
};
inline constexpr std::size_t kNumMacroVariables = 9;

struct MacroWord {
  std::string_view word;
  MacroVariable variable;
};

// All words, those of a variable together. Ages and races are in the order that ReplaceMissing()
// uses.
inline constexpr std::array<MacroWord, 27> kMacroWords{{
    {"male", MacroVariable::kGender},
    {"female", MacroVariable::kGender},
    {"baby", MacroVariable::kAge},
    {"child", MacroVariable::kAge},
    {"young", MacroVariable::kAge},
    {"old", MacroVariable::kAge},
    {"caucasian", MacroVariable::kRace},
    {"asian", MacroVariable::kRace},
    {"african", MacroVariable::kRace},
    {"minmuscle", MacroVariable::kMuscle},
    {"averagemuscle", MacroVariable::kMuscle},
    {"maxmuscle", MacroVariable::kMuscle},
    {"minweight", MacroVariable::kWeight},
    {"averageweight", MacroVariable::kWeight},
    {"maxweight", MacroVariable::kWeight},
    {"minheight", MacroVariable::kHeight},
    {"averageheight", MacroVariable::kHeight},
    {"maxheight", MacroVariable::kHeight},
    {"mincup", MacroVariable::kBreastSize},
    {"averagecup", MacroVariable::kBreastSize},
    {"maxcup", MacroVariable::kBreastSize},
    {"minfirmness", MacroVariable::kBreastFirmness},
    {"averagefirmness", MacroVariable::kBreastFirmness},
    {"maxfirmness", MacroVariable::kBreastFirmness},
    {"uncommonproportions", MacroVariable::kProportions},
    {"regularproportions", MacroVariable::kProportions},
    {"idealproportions", MacroVariable::kProportions},
}};

// The index in kMacroWords of `word`; -1 if it is none.
[[nodiscard]] int FindMacroWord(std::string_view word);

// The share of every macro word in one person, in [0, 1]. The shares of a variable sum to 1.
struct MacroFactors {
  std::array<float, kMacroWords.size()> share{};

  // Precondition: `word` is one of kMacroWords.
  [[nodiscard]] float Of(std::string_view word) const;
};

// The macro values of a person, all in [0, 1]. The defaults are MakeHuman's.
struct MacroValues {
  float gender = 0.5f;  // 0 female, 1 male
  float age = 0.5f;     // 0: 1 year, 0.1875: 10 years, 0.5: 25 years, 1: 90 years
  float muscle = 0.5f;
  float weight = 0.5f;
  float height = 0.5f;
  float breast_size = 0.5f;
  float breast_firmness = 0.5f;
  float proportions = 0.5f;
  // Any positive sum; the shares are these numbers divided by their sum.
  float caucasian = 1.0f / 3.0f;
  float asian = 1.0f / 3.0f;
  float african = 1.0f / 3.0f;
};

// The macro values of a save. Values below 0 count as 0.
[[nodiscard]] MacroValues MacroValuesOf(const MhmSave& save);

// True if `modifier` ("macrodetails/Age") sets a macro value.
[[nodiscard]] bool IsMacroModifier(std::string_view modifier);

// The shares that follow from the values: ages blend linearly between their anchors; of the other
// variables the "max" word has the share 2v - 1 and the "min" word 1 - 2v where positive, and the
// "average" word the rest. Races of sum 0 count as equal.
[[nodiscard]] MacroFactors FactorsOf(const MacroValues& values);

}  // namespace furrow::authoring
