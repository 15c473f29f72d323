// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_map_check.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "base/ascii.h"
#include "base/text.h"
#include "rig/shapes/shape_match.h"
#include "rig/shapes/shape_names.h"

namespace furrow::rig {
namespace {

std::vector<std::string> ArkitNames() { return {ArkitShapes().begin(), ArkitShapes().end()}; }

// ARKit to the vocabulary and back.
class RoundTrip {
 public:
  explicit RoundTrip(const ShapeMap& map) {
    for (const MapShape& shape : map.shapes) names_.push_back(shape.name);
    const ShapeMatcher there({ArkitMap(), map});
    const ShapeMatcher back({ArkitMap()}, &map);
    there_ = there.Match(ArkitNames(), names_).program;
    back_ = back.Match(names_, ArkitNames()).program;
  }

  [[nodiscard]] std::vector<float> Of(std::span<const float> coefficients) const {
    std::vector<float> own(names_.size(), 0.0f);
    std::vector<float> result(kNumArkitShapes, 0.0f);
    (void)there_.Run(coefficients, own);  // finite by construction
    (void)back_.Run(own, result);
    return result;
  }

 private:
  // The 52 shapes alone, so that a check needs no shipped files.
  static ShapeMap ArkitMap() {
    ShapeMap map;
    map.name = "arkit";
    for (int i = 0; i < kNumArkitShapes; ++i) {
      MapShape& shape = map.shapes.emplace_back();
      shape.name = ArkitShapes()[static_cast<std::size_t>(i)];
      const MapFormula same{.sum = {{.gain = 1.0f, .product = {{i, false}}}}};
      shape.from_arkit.push_back(same);
      map.to_arkit[static_cast<std::size_t>(i)].push_back(same);
    }
    return map;
  }

  std::vector<std::string> names_;
  wrinkle::ShapeProgram there_;
  wrinkle::ShapeProgram back_;
};

void CheckRoundTrip(const ShapeMap& map, ShapeMapReport* report) {
  const RoundTrip trip(map);
  const auto jaw = static_cast<std::size_t>(FindArkitShape("jawOpen"));
  for (int a = 0; a < kNumArkitShapes; ++a) {
    const auto index = static_cast<std::size_t>(a);
    const std::string name(ArkitShapes()[index]);
    if (map.to_arkit[index].empty()) {
      report->not_covered.push_back(name);
      continue;
    }
    constexpr int kSteps = 8;
    constexpr float kTiny = 1e-6f;
    float before = 0.0f;
    bool falls = false;
    for (int step = 1; step <= kSteps; ++step) {
      std::vector<float> coefficients(kNumArkitShapes, 0.0f);
      coefficients[index] = static_cast<float>(step) / kSteps;
      // A closed mouth exists on an open jaw only.
      if (name == "mouthClose") coefficients[jaw] = 1.0f;
      const float now = trip.Of(coefficients)[index];
      falls |= now < before - kTiny;
      before = now;
    }
    if (falls) {
      report->warnings.push_back(Quoted(name) + " falls while it rises, on the way there and back");
    } else if (before == 0.0f) {
      report->one_way.push_back(name);
    }
  }
}

// Left for right and back in a normal name, at every place: "eyeleftlookright".
std::string MirroredNormalName(std::string_view name) {
  std::string mirrored;
  while (!name.empty()) {
    const bool is_left = name.starts_with("left");
    if (is_left || name.starts_with("right")) {
      mirrored += is_left ? "right" : "left";
      name.remove_prefix(is_left ? 4 : 5);
    } else {
      mirrored += name.front();
      name.remove_prefix(1);
    }
  }
  return mirrored;
}

// What a formula does when ARKit's shapes are raised one by one.
std::vector<float> GainsOf(const std::vector<MapFormula>& formulas, bool mirrored) {
  std::vector<float> gains(kNumArkitShapes, 0.0f);
  if (formulas.empty()) return gains;
  for (const MapTerm& term : formulas.front().sum) {
    for (const MapTerm::Factor& factor : term.product) {
      const int shape = mirrored ? MirroredArkitShape(factor.shape) : factor.shape;
      gains[static_cast<std::size_t>(shape)] += factor.rest ? -term.gain : term.gain;
    }
  }
  return gains;
}

void CheckMirrors(const ShapeMap& map, ShapeMapReport* report) {
  std::map<std::string, const MapShape*> by_name;
  for (const MapShape& shape : map.shapes) {
    by_name.emplace(NormalShapeName(shape.name, map.prefixes), &shape);
  }
  for (const auto& [name, shape] : by_name) {
    const std::string mirrored = MirroredNormalName(name);
    const auto other = by_name.find(mirrored);
    if (other == by_name.end()) {
      // A side inside a word ("brightness") is none.
      if (!name.ends_with("left") && !name.ends_with("right")) continue;
      report->warnings.push_back(Quoted(shape->name) + " has no counterpart on the other side");
    } else if (name < mirrored &&  // each pair once
               GainsOf(shape->from_arkit, true) != GainsOf(other->second->from_arkit, false)) {
      report->warnings.push_back("the formulas of " + Quoted(shape->name) + " and " +
                                 Quoted(other->second->name) + " are not mirror images");
    }
  }
}

// `text` as a JSON string.
std::string JsonText(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + "\"";
}

std::string TermText(const MapTerm& term) {
  char gain[32];
  std::snprintf(gain, sizeof gain, "%.4g ", static_cast<double>(term.gain));
  std::string text = term.gain == 1.0f ? "" : gain;
  for (std::size_t i = 0; i < term.product.size(); ++i) {
    const MapTerm::Factor& factor = term.product[i];
    text += (i == 0 ? "" : " ") + std::string(factor.rest ? "1-" : "") +
            std::string(ArkitShapes()[static_cast<std::size_t>(factor.shape)]);
  }
  return JsonText(text);
}

std::string FormulaText(const std::vector<MapFormula>& formulas) {
  if (formulas.empty()) return "[]";
  const MapFormula& formula = formulas.front();
  std::string terms;
  for (const MapTerm& term : formula.sum) terms += (terms.empty() ? "" : ", ") + TermText(term);
  if (formula.mean) return "{\"mean\": [" + terms + "]}";
  return formula.sum.size() == 1 ? terms : "[" + terms + "]";
}

}  // namespace

ShapeMapReport CheckShapeMap(const ShapeMap& map) {
  ShapeMapReport report;
  report.name = map.name;
  report.num_shapes = map.shapes.size();
  report.num_from_arkit = static_cast<std::size_t>(std::ranges::count_if(
      map.shapes, [](const MapShape& shape) { return !shape.from_arkit.empty(); }));
  CheckRoundTrip(map, &report);
  CheckMirrors(map, &report);
  return report;
}

std::string ToText(const ShapeMapReport& report) {
  std::string text = "shape map " + Quoted(report.name) + "\n";
  text += "  " + Counted(report.num_shapes, "shape") + ", " +
          std::to_string(report.num_from_arkit) + " of them from ARKit\n";
  text += "  " + std::to_string(kNumArkitShapes - report.not_covered.size()) +
          " of ARKit's 52 blend shapes from them";
  for (std::size_t i = 0; i < report.not_covered.size(); ++i) {
    text += (i == 0 ? "; none for: " : ", ") + report.not_covered[i];
  }
  text += "\n";
  for (std::size_t i = 0; i < report.one_way.size(); ++i) {
    text += (i == 0 ? "  only from the vocabulary to ARKit: " : ", ") + report.one_way[i];
  }
  if (!report.one_way.empty()) text += "\n";
  for (const std::string& warning : report.warnings) text += "  warning: " + warning + "\n";
  return text;
}

std::string ProposeShapeMap(const std::string& name, std::span<const std::string> shapes,
                            std::span<const ShapeMap> known) {
  std::vector<ShapeVocabulary> vocabularies(known.begin(), known.end());
  std::string text =
      "// A first shape map. Give each shape with [] the sum of ARKit's shapes that it shows,\n"
      "// such as \"0.5 jawOpen\" or [\"0.4 mouthSmileLeft\", \"0.4 mouthSmileRight\"], or leave "
      "[].\n"
      "{\n  \"version\": 1,\n  \"name\": " +
      JsonText(name) + ",\n  \"shapes\": {";
  std::set<std::string> seen;
  const auto by_fit = [&](const ShapeVocabulary& a, const ShapeVocabulary& b) {
    return a.Fit(shapes).explained > b.Fit(shapes).explained;
  };
  std::ranges::stable_sort(vocabularies, by_fit);
  for (const std::string& shape : shapes) {
    // The reader rejects two names of one normal form, so the first of them stands for both.
    if (shape.empty() || shape.size() > 255 || shape.find('*') != std::string::npos ||
        !seen.insert(NormalShapeName(shape)).second) {
      continue;
    }
    std::string formula = "[]";
    for (const ShapeVocabulary& vocabulary : vocabularies) {
      const int found = vocabulary.Find(shape).shape;
      if (found < 0) continue;
      formula = FormulaText(vocabulary.map().shapes[static_cast<std::size_t>(found)].from_arkit);
      break;
    }
    text += std::string(seen.size() == 1 ? "" : ",") + "\n    " + JsonText(shape) + ": " + formula;
  }
  return text + "\n  }\n}\n";
}

}  // namespace furrow::rig
