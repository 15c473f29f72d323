// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/status.h"
#include "base/text.h"
#include "rig/json/map_file.h"
#include "rig/shapes/shape_map.h"
#include "rig/shapes/shape_names.h"

namespace furrow::rig {
namespace {

using ShapeJson = nlohmann::json;

// Limits on hostile files. The largest map that ships is far below all of them.
constexpr std::size_t kMaxMapPrefixes = 64;
constexpr std::size_t kMaxPerList = 32;
constexpr std::size_t kMaxFactors = 8;
constexpr std::size_t kMaxShapeName = 255;
constexpr float kMaxGain = 16.0f;

// What '*' stands for in the names of a formula or an entry: a side of the vocabulary and of ARKit.
struct MapSide {
  std::string own;
  std::string arkit;
};

bool HasStar(std::string_view text) { return text.find('*') != std::string_view::npos; }

// Reads one file. Every error names the file and the field. Reads JSON in place, because copying
// deeply nested JSON would overflow the stack.
class ShapeMapReader : private MapErrors {
 public:
  using MapErrors::MapErrors;

  Status Read(const ShapeJson& root, ShapeMap* map);

 private:
  // Finds the shape that a formula names; -1: unknown.
  enum class Names : std::uint8_t { kArkit, kOwn };
  struct Entry {
    const ShapeJson* value;
    std::optional<MapSide> side;
    std::string field;
  };

  Status CheckKeys(const ShapeJson& object, const std::string& field,
                   const std::set<std::string>& known) const;
  Status ReadText(const ShapeJson& value, const std::string& field, std::string* text) const;
  Status ReadTexts(const ShapeJson& value, const std::string& field, std::size_t most,
                   std::vector<std::string>* texts) const;
  Status ReadHeader(const ShapeJson& root, ShapeMap* map);
  Status ReadSides(const ShapeJson& root);
  // The two sides of an entry with a '*' in its name, or none. The names of ARKit need no "sides".
  [[nodiscard]] Result<std::vector<std::optional<MapSide>>> SidesOf(const std::string& key,
                                                                    const std::string& field,
                                                                    Names names) const;
  Status ListShapes(const ShapeJson& shapes, ShapeMap* map);
  Status IndexNames(const ShapeMap& map);
  Status AddName(const std::string& name, std::size_t shape, const ShapeMap& map);
  Status ReadShape(const Entry& entry, MapShape* shape) const;
  Status ReadUnless(const Entry& entry, const ShapeJson& value, MapShape* shape) const;
  Status ReadArkit(const ShapeJson& arkit, ShapeMap* map) const;
  Status ReadFormulas(const ShapeJson& value, const Entry& entry, Names names,
                      std::vector<MapFormula>* formulas) const;
  Status ReadFormula(const ShapeJson& value, const Entry& entry, Names names,
                     MapFormula* formula) const;
  Status ReadTerm(const ShapeJson& value, const Entry& entry, Names names, MapTerm* term) const;
  Status ReadFactor(std::string_view word, const Entry& entry, Names names, MapTerm* term) const;

  MapSide left_;
  MapSide right_;
  std::map<std::string, Entry> entries_;      // shapes by name
  std::map<std::string, int> shape_indices_;  // by name
  std::map<std::string, std::size_t> normal_names_;
};

Status ShapeMapReader::CheckKeys(const ShapeJson& object, const std::string& field,
                                 const std::set<std::string>& known) const {
  if (!object.is_object()) return Error(field, "expected an object");
  // Unknown fields are errors: a misspelled field would otherwise have no effect.
  for (const auto& [key, value] : object.items()) {
    if (!known.contains(key)) return Error(field, "unknown field " + Quoted(key));
  }
  return {};
}

Status ShapeMapReader::ReadText(const ShapeJson& value, const std::string& field,
                                std::string* text) const {
  if (!value.is_string()) return Error(field, "expected a string");
  *text = value.get<std::string>();
  if (text->empty()) return Error(field, "is empty");
  if (text->size() > kMaxShapeName) {
    return Error(field, "is longer than 255 bytes", StatusCode::kLimit);
  }
  return {};
}

// One string, or a list of strings.
Status ShapeMapReader::ReadTexts(const ShapeJson& value, const std::string& field, std::size_t most,
                                 std::vector<std::string>* texts) const {
  if (!value.is_array()) return ReadText(value, field, &texts->emplace_back());
  if (value.size() > most) {
    return Error(field, "has more than " + std::to_string(most) + " entries", StatusCode::kLimit);
  }
  for (const ShapeJson& item : value) {
    FURROW_RETURN_IF_ERROR(ReadText(item, field, &texts->emplace_back()));
  }
  return {};
}

Status ShapeMapReader::ReadSides(const ShapeJson& root) {
  left_.arkit = "Left";
  right_.arkit = "Right";
  if (!root.contains("sides")) return {};
  const ShapeJson& sides = root["sides"];
  FURROW_RETURN_IF_ERROR(CheckKeys(sides, "sides", {"left", "right"}));
  if (sides.size() != 2) return Error("sides", "expected {\"left\": ..., \"right\": ...}");
  FURROW_RETURN_IF_ERROR(ReadText(sides["left"], "sides.left", &left_.own));
  FURROW_RETURN_IF_ERROR(ReadText(sides["right"], "sides.right", &right_.own));
  if (left_.own == right_.own) return Error("sides", "left and right must differ");
  return {};
}

Status ShapeMapReader::ReadHeader(const ShapeJson& root, ShapeMap* map) {
  FURROW_RETURN_IF_ERROR(CheckKeys(
      root, "(root)", {"version", "name", "title", "prefixes", "sides", "shapes", "arkit"}));
  for (const char* key : {"version", "name", "shapes"}) {
    if (!root.contains(key)) return Error(key, "is missing");
  }
  if (root["version"] != 1) return Error("version", "expected 1", StatusCode::kUnsupported);
  FURROW_RETURN_IF_ERROR(ReadText(root["name"], "name", &map->name));
  if (root.contains("title")) {
    FURROW_RETURN_IF_ERROR(ReadText(root["title"], "title", &map->title));
  }
  if (root.contains("prefixes")) {
    FURROW_RETURN_IF_ERROR(
        ReadTexts(root["prefixes"], "prefixes", kMaxMapPrefixes, &map->prefixes));
  }
  if (std::ranges::count(map->prefixes, "*") > 0) return Error("prefixes", "'*' needs a literal");
  return ReadSides(root);
}

Result<std::vector<std::optional<MapSide>>> ShapeMapReader::SidesOf(const std::string& key,
                                                                    const std::string& field,
                                                                    Names names) const {
  using Sides = std::vector<std::optional<MapSide>>;
  if (key.empty() || key.size() > kMaxShapeName) {
    return Error(field, "a name needs 1 to 255 bytes", StatusCode::kLimit);
  }
  if (!HasStar(key)) return Sides{std::nullopt};
  if (names == Names::kOwn && left_.own.empty()) {
    return Error(field, "a '*' in a name requires \"sides\"");
  }
  return Sides{left_, right_};
}

// Collects the names before any formula is read, because formulas refer to them.
Status ShapeMapReader::ListShapes(const ShapeJson& shapes, ShapeMap* map) {
  if (!shapes.is_object() || shapes.empty()) {
    return Error("shapes", "expected an object with one field per shape");
  }
  for (const auto& [key, value] : shapes.items()) {
    const std::string field = "shapes." + Quoted(key);
    const auto sides = SidesOf(key, field, Names::kOwn);
    FURROW_RETURN_IF_ERROR(sides);
    for (const auto& side : *sides) {
      const std::string name = side ? WithSide(key, side->own) : key;
      if (!entries_.emplace(name, Entry{&value, side, field}).second) {
        return Error(field, "duplicate shape");
      }
    }
    if (entries_.size() > kMaxMapShapes) {
      return Error("shapes", "has more than 2048 shapes", StatusCode::kLimit);
    }
  }
  for (const auto& [name, entry] : entries_) {
    shape_indices_.emplace(name, static_cast<int>(map->shapes.size()));
    map->shapes.emplace_back().name = name;
  }
  return {};
}

Status ShapeMapReader::AddName(const std::string& name, std::size_t shape, const ShapeMap& map) {
  const auto [found, added] = normal_names_.emplace(NormalShapeName(name, map.prefixes), shape);
  if (added || found->second == shape) return {};
  return Error(entries_.at(map.shapes[shape].name).field,
               Quoted(name) + " also means the shape " + Quoted(map.shapes[found->second].name));
}

// A name must mean one shape, whatever the order of the file.
Status ShapeMapReader::IndexNames(const ShapeMap& map) {
  for (std::size_t i = 0; i < map.shapes.size(); ++i) {
    FURROW_RETURN_IF_ERROR(AddName(map.shapes[i].name, i, map));
    for (const std::string& alias : map.shapes[i].aliases) {
      FURROW_RETURN_IF_ERROR(AddName(alias, i, map));
    }
  }
  return {};
}

Status ShapeMapReader::ReadFactor(std::string_view word, const Entry& entry, Names names,
                                  MapTerm* term) const {
  MapTerm::Factor factor;
  if (word.starts_with("1-")) {
    factor.rest = true;
    word.remove_prefix(2);
  }
  std::string name(word);
  if (HasStar(name)) {
    if (!entry.side) return Error(entry.field, "a '*' in a formula requires a '*' in its name");
    if (names == Names::kOwn && entry.side->own.empty()) {
      return Error(entry.field, "a '*' in a name requires \"sides\"");
    }
    name = WithSide(name, names == Names::kArkit ? entry.side->arkit : entry.side->own);
  }
  if (names == Names::kArkit) {
    factor.shape = FindArkitShape(name);
  } else {
    const auto found = shape_indices_.find(name);
    factor.shape = found == shape_indices_.end() ? -1 : found->second;
  }
  if (factor.shape < 0) {
    return Error(entry.field,
                 Quoted(name) + (names == Names::kArkit ? " is not a blend shape of ARKit"
                                                        : " is not in \"shapes\""));
  }
  term->product.push_back(factor);
  return {};
}

// "0.4 mouthSmileLeft 1-jawOpen": an optional gain, then the factors.
Status ShapeMapReader::ReadTerm(const ShapeJson& value, const Entry& entry, Names names,
                                MapTerm* term) const {
  if (!value.is_string()) return Error(entry.field, "expected a term such as \"0.5 jawOpen\"");
  const auto& text = value.get_ref<const std::string&>();
  std::vector<std::string_view> words;
  SplitWords(text, &words);
  if (!words.empty()) {
    const std::string_view first = words.front();
    const auto parsed = std::from_chars(first.data(), first.data() + first.size(), term->gain);
    if (parsed.ec == std::errc() && parsed.ptr == first.data() + first.size()) {
      words.erase(words.begin());
      if (!(std::fabs(term->gain) <= kMaxGain)) {
        return Error(entry.field, "a gain must be between -16 and 16",
                     StatusCode::kInvalidArgument);
      }
    } else {
      term->gain = 1.0f;
    }
  }
  if (words.empty()) return Error(entry.field, Quoted(text) + " names no shape");
  if (words.size() > kMaxFactors) {
    return Error(entry.field, "has more than 8 factors", StatusCode::kLimit);
  }
  for (const std::string_view word : words) {
    FURROW_RETURN_IF_ERROR(ReadFactor(word, entry, names, term));
  }
  // A neutral face must stay neutral.
  if (std::ranges::all_of(term->product, &MapTerm::Factor::rest)) {
    return Error(entry.field, Quoted(text) + " needs a shape beside 1-...");
  }
  return {};
}

// A term, a list of terms, or {"mean": [terms]}.
Status ShapeMapReader::ReadFormula(const ShapeJson& value, const Entry& entry, Names names,
                                   MapFormula* formula) const {
  const ShapeJson* terms = &value;
  if (value.is_object()) {
    FURROW_RETURN_IF_ERROR(CheckKeys(value, entry.field, {"mean"}));
    if (value.empty()) return Error(entry.field, "is an empty formula");
    formula->mean = true;
    terms = &value["mean"];
  }
  if (!terms->is_array()) {
    return ReadTerm(*terms, entry, names, &formula->sum.emplace_back());
  }
  if (terms->empty() || terms->size() > kMaxPerList) {
    return Error(entry.field, "a formula needs 1 to 32 terms", StatusCode::kLimit);
  }
  for (const ShapeJson& term : *terms) {
    FURROW_RETURN_IF_ERROR(ReadTerm(term, entry, names, &formula->sum.emplace_back()));
  }
  const auto is_share = [](const MapTerm& term) { return term.gain > 0.0f; };
  if (formula->mean && !std::ranges::all_of(formula->sum, is_share)) {
    return Error(entry.field, "the gains of a mean must be above 0", StatusCode::kInvalidArgument);
  }
  return {};
}

// A formula, or {"any": [formulas]}. An empty list: no formula.
Status ShapeMapReader::ReadFormulas(const ShapeJson& value, const Entry& entry, Names names,
                                    std::vector<MapFormula>* formulas) const {
  if (value.is_array() && value.empty()) return {};
  if (!value.is_object() || !value.contains("any")) {
    return ReadFormula(value, entry, names, &formulas->emplace_back());
  }
  FURROW_RETURN_IF_ERROR(CheckKeys(value, entry.field, {"any"}));
  const ShapeJson& list = value["any"];
  if (!list.is_array() || list.empty() || list.size() > kMaxPerList) {
    return Error(entry.field, "\"any\" needs a list of 1 to 32 formulas");
  }
  for (const ShapeJson& item : list) {
    FURROW_RETURN_IF_ERROR(ReadFormula(item, entry, names, &formulas->emplace_back()));
  }
  return {};
}

Status ShapeMapReader::ReadUnless(const Entry& entry, const ShapeJson& value,
                                  MapShape* shape) const {
  std::vector<std::string> names;
  FURROW_RETURN_IF_ERROR(ReadTexts(value, entry.field, kMaxPerList, &names));
  for (const std::string& name : names) {
    const auto found = shape_indices_.find(entry.side ? WithSide(name, entry.side->own) : name);
    if (found == shape_indices_.end() || found->first == shape->name) {
      return Error(entry.field,
                   "\"unless\" must name other shapes of the map, not " + Quoted(name));
    }
    shape->unless.push_back(found->second);
  }
  return {};
}

// A formula, or an object with more about the shape.
Status ShapeMapReader::ReadShape(const Entry& entry, MapShape* shape) const {
  const ShapeJson& value = *entry.value;
  const bool is_formula = !value.is_object() || value.contains("any") || value.contains("mean");
  if (is_formula) return ReadFormulas(value, entry, Names::kArkit, &shape->from_arkit);
  FURROW_RETURN_IF_ERROR(CheckKeys(value, entry.field, {"from", "aliases", "unless"}));
  if (value.contains("from")) {
    FURROW_RETURN_IF_ERROR(ReadFormulas(value["from"], entry, Names::kArkit, &shape->from_arkit));
  } else if (const int own = FindArkitShape(shape->name); own >= 0) {
    // A shape with the name of ARKit's is that shape.
    shape->from_arkit.push_back({.sum = {{.gain = 1.0f, .product = {{own, false}}}}});
  }
  if (value.contains("aliases")) {
    FURROW_RETURN_IF_ERROR(ReadTexts(value["aliases"], entry.field, kMaxPerList, &shape->aliases));
    for (std::string& alias : shape->aliases) {
      if (!HasStar(alias)) continue;
      if (!entry.side) return Error(entry.field, "a '*' in an alias requires a '*' in its name");
      alias = WithSide(alias, entry.side->own);
    }
  }
  return value.contains("unless") ? ReadUnless(entry, value["unless"], shape) : Status();
}

Status ShapeMapReader::ReadArkit(const ShapeJson& arkit, ShapeMap* map) const {
  if (!arkit.is_object()) return Error("arkit", "expected an object");
  std::set<int> seen;
  for (const auto& [key, value] : arkit.items()) {
    const std::string field = "arkit." + Quoted(key);
    const auto sides = SidesOf(key, field, Names::kArkit);
    FURROW_RETURN_IF_ERROR(sides);
    for (const auto& side : *sides) {
      const int shape = FindArkitShape(side ? WithSide(key, side->arkit) : key);
      if (shape < 0) return Error(field, "is not a blend shape of ARKit");
      if (!seen.insert(shape).second) return Error(field, "duplicate shape");
      FURROW_RETURN_IF_ERROR(ReadFormulas(value, Entry{&value, side, field}, Names::kOwn,
                                          &map->to_arkit[static_cast<std::size_t>(shape)]));
    }
  }
  return {};
}

MapFormula MeanOf(const std::vector<int>& shapes) {
  MapFormula formula;
  formula.mean = shapes.size() > 1;
  const float share = 1.0f / static_cast<float>(shapes.size());
  for (const int shape : shapes) formula.sum.push_back({share, {{shape, false}}});
  return formula;
}

bool HasShapeInMean(const MapFormula& formula, int arkit) {
  return formula.mean && std::ranges::any_of(formula.sum, [arkit](const MapTerm& term) {
           return term.product == std::vector{MapTerm::Factor{arkit, false}};
         });
}

// What a file does not say: a shape that equals ARKit's gives it back; several give their mean.
// Substitutes ("unless") come next, then shapes for both sides at once.
void DeriveToArkit(ShapeMap* map) {
  for (int arkit = 0; arkit < kNumArkitShapes; ++arkit) {
    std::vector<MapFormula>& formulas = map->to_arkit[static_cast<std::size_t>(arkit)];
    if (!formulas.empty()) continue;
    std::vector<int> same;
    std::vector<int> in_place;
    std::vector<int> of_both;
    for (std::size_t i = 0; i < map->shapes.size(); ++i) {
      const MapShape& shape = map->shapes[i];
      if (shape.from_arkit.empty()) continue;
      const MapFormula& from = shape.from_arkit.front();
      if (from.RenamedShape() == arkit) {
        (shape.unless.empty() ? same : in_place).push_back(static_cast<int>(i));
      } else if (HasShapeInMean(from, arkit)) {
        of_both.push_back(static_cast<int>(i));
      }
    }
    for (const auto* shapes : {&same, &in_place, &of_both}) {
      if (!shapes->empty()) formulas.push_back(MeanOf(*shapes));
    }
  }
}

Status ShapeMapReader::Read(const ShapeJson& root, ShapeMap* map) {
  FURROW_RETURN_IF_ERROR(ReadHeader(root, map));
  FURROW_RETURN_IF_ERROR(ListShapes(root["shapes"], map));
  for (MapShape& shape : map->shapes) {
    FURROW_RETURN_IF_ERROR(ReadShape(entries_.at(shape.name), &shape));
  }
  FURROW_RETURN_IF_ERROR(IndexNames(*map));
  if (root.contains("arkit")) FURROW_RETURN_IF_ERROR(ReadArkit(root["arkit"], map));
  DeriveToArkit(map);
  return {};
}

}  // namespace

Result<ShapeMap> ParseShapeMap(std::string_view json, std::string_view source_name) {
  ShapeJson root;
  FURROW_RETURN_IF_ERROR(ParseMapText(json, source_name, &root));
  ShapeMap map;
  FURROW_RETURN_IF_ERROR(ShapeMapReader(source_name).Read(root, &map));
  return map;
}

}  // namespace furrow::rig
