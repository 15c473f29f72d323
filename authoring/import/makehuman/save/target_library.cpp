// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/target_library.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/text.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kListed = 8;  // names in a warning
constexpr float kTinyWeight = 1e-5f;

// The groups that macro values move.
constexpr std::array<const char*, 5> kMacroGroups{"macrodetails", "macrodetails-universal",
                                                  "macrodetails-height", "macrodetails-proportions",
                                                  "breast"};

// Splits a relative path without its extension into the parts between separators.
std::vector<std::string> PartsOf(const fs::path& relative) {
  std::string text = relative.generic_string();
  text.resize(text.size() - relative.extension().string().size());
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == '/' || c == '-' || c == '_' || c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  std::erase(parts, "");
  return parts;
}

float WeightOf(const TargetFile& file, const MacroFactors& factors) {
  float weight = 1.0f;
  for (const int word : file.words) weight *= factors.share[static_cast<std::size_t>(word)];
  return weight;
}

std::string Listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kListed); ++i)
    text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kListed) text += " and " + std::to_string(names.size() - kListed) + " more";
  return text;
}

// Moves the shares of words without targets to words that have some.
class ShareMover {
 public:
  ShareMover(const TargetLibrary& library, MacroFactors* factors,
             std::vector<std::string>* warnings)
      : library_(library), factors_(*factors), warnings_(*warnings) {}

  void Run() {
    Move(MacroVariable::kRace, "macrodetails", false);
    Move(MacroVariable::kAge, "macrodetails", true);
    Move(MacroVariable::kGender, "macrodetails", true);
  }

 private:
  void Move(MacroVariable variable, const char* group, bool to_nearest) {
    std::vector<std::size_t> present, missing;
    for (std::size_t i = 0; i < kMacroWords.size(); ++i) {
      if (kMacroWords[i].variable != variable) continue;
      if (library_.HasWord(group, kMacroWords[i].word)) {
        present.push_back(i);
      } else if (factors_.share[i] > kTinyWeight) {
        missing.push_back(i);
      }
    }
    if (present.empty() || missing.empty()) return;
    std::string from;
    float moved = 0.0f;
    float kept = 0.0f;
    for (const std::size_t i : present) kept += factors_.share[i];
    for (const std::size_t i : missing) {
      from += (from.empty() ? "" : ", ") + std::string(kMacroWords[i].word);
      const float share = std::exchange(factors_.share[i], 0.0f);
      moved += share;
      if (to_nearest) factors_.share[Nearest(present, i)] += share;
    }
    if (!to_nearest) {
      for (const std::size_t i : present) {
        factors_.share[i] +=
            moved * (kept > kTinyWeight ? factors_.share[i] / kept
                                        : 1.0f / static_cast<float>(present.size()));
      }
    }
    std::string to;
    for (const std::size_t i : present) {
      if (factors_.share[i] > kTinyWeight)
        to += (to.empty() ? "" : ", ") + std::string(kMacroWords[i].word);
    }
    warnings_.push_back("the data folder has no targets for " + from + "; " +
                        std::to_string(std::lround(100.0f * moved)) + " % of the person become " +
                        to);
  }

  static std::size_t Nearest(const std::vector<std::size_t>& present, std::size_t to) {
    const auto distance = [to](std::size_t i) { return i > to ? i - to : to - i; };
    return *std::min_element(present.begin(), present.end(), [&](std::size_t a, std::size_t b) {
      return distance(a) < distance(b);
    });
  }

  const TargetLibrary& library_;
  MacroFactors& factors_;
  std::vector<std::string>& warnings_;
};

// The group that a modifier's value selects: "nose/nose-hump-decr|incr" gives "nose-nose-hump-decr"
// for a negative value.
std::string GroupOf(const MhmSave::Modifier& modifier) {
  std::string name = modifier.name;
  std::replace(name.begin(), name.end(), '/', '-');
  const std::size_t bar = name.find('|');
  if (bar == std::string::npos) return name;
  const std::size_t hyphen = name.rfind('-', bar);
  if (hyphen == std::string::npos) return {};
  const std::string stem = name.substr(0, hyphen + 1);
  // "low|middle|high" has a middle target, which no modifier of MakeHuman uses.
  return modifier.value < 0.0f ? stem + name.substr(hyphen + 1, bar - hyphen - 1)
                               : stem + name.substr(name.rfind('|') + 1);
}

// One-sided modifiers begin at 0.
bool HasEffect(const MhmSave::Modifier& modifier) {
  const bool two_sided = modifier.name.find('|') != std::string::npos;
  return two_sided ? modifier.value != 0.0f : modifier.value > 0.0f;
}

void ChooseMacros(const TargetLibrary& library, const MacroFactors& factors, TargetChoice* choice) {
  for (const char* group : kMacroGroups) {
    for (const TargetFile& file : library.InGroup(group)) {
      if (const float weight = WeightOf(file, factors); weight > kTinyWeight)
        choice->targets.push_back({file.path, weight});
    }
  }
}

// Extremes that the person has and that no target of their group shows.
std::vector<std::string> MissingMacros(const TargetLibrary& library, const MacroFactors& factors) {
  constexpr std::pair<const char*, std::string_view> kExtremes[] = {
      {"macrodetails-universal", "minmuscle"},
      {"macrodetails-universal", "maxmuscle"},
      {"macrodetails-universal", "minweight"},
      {"macrodetails-universal", "maxweight"},
      {"macrodetails-height", "minheight"},
      {"macrodetails-height", "maxheight"},
      {"macrodetails-proportions", "uncommonproportions"},
      {"macrodetails-proportions", "idealproportions"},
      {"breast", "mincup"},
      {"breast", "maxcup"},
      {"breast", "minfirmness"},
      {"breast", "maxfirmness"}};
  std::vector<std::string> missing;
  for (const auto& [group, word] : kExtremes) {
    const bool needed = std::string_view(group) != "breast" || factors.Of("female") > kTinyWeight;
    if (needed && factors.Of(word) > kTinyWeight && !library.HasWord(group, word))
      missing.emplace_back(word);
  }
  return missing;
}

}  // namespace

void TargetLibrary::Add(const fs::path& path) {
  TargetFile file{path, {}};
  std::string group;
  for (const std::string& part : PartsOf(path)) {
    const int word = FindMacroWord(part);
    if (word < 0) {
      group += (group.empty() ? "" : "-") + part;
      continue;
    }
    // A file for two ages at once would be a file of no person.
    const MacroVariable variable = kMacroWords[static_cast<std::size_t>(word)].variable;
    for (const int other : file.words) {
      if (kMacroWords[static_cast<std::size_t>(other)].variable == variable && other != word)
        return;
    }
    if (std::find(file.words.begin(), file.words.end(), word) == file.words.end())
      file.words.push_back(word);
  }
  groups_[group].push_back(std::move(file));
}

const std::vector<TargetFile>& TargetLibrary::InGroup(const std::string& group) const {
  static const std::vector<TargetFile> kNone;
  const auto found = groups_.find(group);
  return found == groups_.end() ? kNone : found->second;
}

bool TargetLibrary::HasWord(const std::string& group, std::string_view word) const {
  const int index = FindMacroWord(word);
  const std::vector<TargetFile>& files = InGroup(group);
  return std::any_of(files.begin(), files.end(), [index](const TargetFile& file) {
    return std::find(file.words.begin(), file.words.end(), index) != file.words.end();
  });
}

TargetChoice ChooseTargets(const MhmSave& save, const TargetLibrary& library) {
  TargetChoice choice;
  MacroFactors factors = FactorsOf(MacroValuesOf(save));
  ShareMover(library, &factors, &choice.warnings).Run();
  ChooseMacros(library, factors, &choice);
  if (const auto missing = MissingMacros(library, factors); !missing.empty())
    choice.warnings.push_back("the data folder has no targets for " + Listed(missing) +
                              "; the person stays average there");
  std::vector<std::string> skipped;
  for (const MhmSave::Modifier& modifier : save.modifiers) {
    if (IsMacroModifier(modifier.name) || !HasEffect(modifier)) continue;
    const std::vector<TargetFile>& files = library.InGroup(GroupOf(modifier));
    if (files.empty()) {
      skipped.push_back(CutText(modifier.name, 80));
      continue;
    }
    ++choice.modifiers;
    for (const TargetFile& file : files) {
      const float weight = std::abs(modifier.value) * WeightOf(file, factors);
      if (weight > kTinyWeight) choice.targets.push_back({file.path, weight});
    }
  }
  if (!skipped.empty())
    choice.warnings.push_back(Counted(skipped.size(), "modifier") +
                              " without a target in the data folder skipped: " + Listed(skipped));
  return choice;
}

}  // namespace furrow::authoring
