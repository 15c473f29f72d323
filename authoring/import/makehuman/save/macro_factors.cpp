// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/macro_factors.h"

#include <algorithm>

namespace furrow::authoring {
namespace {

// 10 of the 25 years up to the middle of the slider, and the rest.
constexpr float kChildAge = 0.1875f;
constexpr float kYoungAge = 0.5f;

struct MacroModifier {
  std::string_view name;
  float MacroValues::*value;
};

constexpr std::array<MacroModifier, 11> kMacroModifiers{{
    {"macrodetails/Gender", &MacroValues::gender},
    {"macrodetails/Age", &MacroValues::age},
    {"macrodetails/Caucasian", &MacroValues::caucasian},
    {"macrodetails/Asian", &MacroValues::asian},
    {"macrodetails/African", &MacroValues::african},
    {"macrodetails-universal/Muscle", &MacroValues::muscle},
    {"macrodetails-universal/Weight", &MacroValues::weight},
    {"macrodetails-height/Height", &MacroValues::height},
    {"macrodetails-proportions/BodyProportions", &MacroValues::proportions},
    {"breast/BreastSize", &MacroValues::breast_size},
    {"breast/BreastFirmness", &MacroValues::breast_firmness},
}};

const MacroModifier* FindMacroModifier(std::string_view name) {
  const auto* found = std::find_if(kMacroModifiers.begin(), kMacroModifiers.end(),
                                   [&](const MacroModifier& m) { return m.name == name; });
  return found == kMacroModifiers.end() ? nullptr : found;
}

class ShareTable {
 public:
  explicit ShareTable(MacroFactors* factors) : factors_(*factors) {}

  void Set(std::string_view word, float share) {
    factors_.share[static_cast<std::size_t>(FindMacroWord(word))] = share;
  }

  // `least`, `average` and `most`: the words of a variable with the value `value`.
  void SetThree(std::string_view least, std::string_view average, std::string_view most,
                float value) {
    const float high = std::max(0.0f, 2.0f * value - 1.0f);
    const float low = std::max(0.0f, 1.0f - 2.0f * value);
    Set(least, low);
    Set(average, 1.0f - low - high);
    Set(most, high);
  }

  void SetAges(float age) {
    const float old = std::max(0.0f, (age - kYoungAge) / (1.0f - kYoungAge));
    const float baby = std::max(0.0f, 1.0f - age / kChildAge);
    const float grown = std::clamp((age - kChildAge) / (kYoungAge - kChildAge), 0.0f, 1.0f);
    Set("baby", baby);
    Set("child", 1.0f - baby - grown);
    Set("young", grown - old);
    Set("old", old);
  }

  void SetRaces(float caucasian, float asian, float african) {
    const float sum = caucasian + asian + african;
    const bool none = !(sum > 0.0f);
    Set("caucasian", none ? 1.0f / 3.0f : caucasian / sum);
    Set("asian", none ? 1.0f / 3.0f : asian / sum);
    Set("african", none ? 1.0f / 3.0f : african / sum);
  }

 private:
  MacroFactors& factors_;
};

}  // namespace

int FindMacroWord(std::string_view word) {
  const auto* found = std::find_if(kMacroWords.begin(), kMacroWords.end(),
                                   [&](const MacroWord& w) { return w.word == word; });
  return found == kMacroWords.end() ? -1 : static_cast<int>(found - kMacroWords.begin());
}

float MacroFactors::Of(std::string_view word) const {
  return share[static_cast<std::size_t>(FindMacroWord(word))];
}

bool IsMacroModifier(std::string_view modifier) { return FindMacroModifier(modifier) != nullptr; }

MacroValues MacroValuesOf(const MhmSave& save) {
  MacroValues values;
  for (const MhmSave::Modifier& modifier : save.modifiers) {
    if (const MacroModifier* macro = FindMacroModifier(modifier.name); macro != nullptr)
      values.*macro->value = std::clamp(modifier.value, 0.0f, 1.0f);
  }
  return values;
}

MacroFactors FactorsOf(const MacroValues& values) {
  MacroFactors factors;
  ShareTable table(&factors);
  table.Set("male", values.gender);
  table.Set("female", 1.0f - values.gender);
  table.SetAges(values.age);
  table.SetRaces(values.caucasian, values.asian, values.african);
  table.SetThree("minmuscle", "averagemuscle", "maxmuscle", values.muscle);
  table.SetThree("minweight", "averageweight", "maxweight", values.weight);
  table.SetThree("minheight", "averageheight", "maxheight", values.height);
  table.SetThree("mincup", "averagecup", "maxcup", values.breast_size);
  table.SetThree("minfirmness", "averagefirmness", "maxfirmness", values.breast_firmness);
  table.SetThree("uncommonproportions", "regularproportions", "idealproportions",
                 values.proportions);
  return factors;
}

}  // namespace furrow::authoring
