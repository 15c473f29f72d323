// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

// A struct with a field of every type that wrinkle/fields/field_list.h allows, and its schema.
namespace furrow::rig {

inline constexpr char kSampleSchema[] = R"(
namespace test;
struct Vec3 { x: float; y: float; z: float; }
struct Vec4 { x: float; y: float; z: float; w: float; }
enum Shade : byte { light, dark, black }
table Part {
  label: string (required);
  size: float = 2;
  shade: Shade = dark;
}
table Sample {
  title: string (required);
  centre: Vec3 (required);
  names: [string] (required);
  parts: [Part] (required);
  note: string;
  ratio: float = 0.5;
  count: int = -3;
  on: bool = true;
  place: Vec3;
  axis: Vec3;
  shade: Shade;
  more_names: [string];
  numbers: [int];
  shares: [float];
  part: Part;
  more_parts: [Part];
  turn: Vec4;
}
root_type Sample;
)";

enum class Shade { kLight, kDark, kBlack };

struct Part {
  std::string label;
  float size = 2.0f;
  Shade shade = Shade::kDark;

  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Required("label", &Part::label);
    fields.Optional("size", &Part::size);
    fields.Choice("shade", &Part::shade, {"light", "dark", "black"});
  }
};

struct Sample {
  std::string title;
  glm::vec3 centre{0.0f};
  std::vector<std::string> names;
  std::vector<Part> parts;
  std::string note;
  float ratio = 0.5f;
  int count = -3;
  bool on = true;
  glm::vec3 place{1.0f, 2.0f, 3.0f};
  std::optional<glm::vec3> axis;
  Shade shade = Shade::kLight;
  std::vector<std::string> more_names;
  std::vector<int> numbers;
  std::vector<float> shares;
  Part part;
  std::vector<Part> more_parts;

  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Required("title", &Sample::title);
    fields.Required("centre", &Sample::centre);
    fields.Required("names", &Sample::names);
    fields.Required("parts", &Sample::parts);
    fields.Optional("note", &Sample::note);
    fields.Optional("ratio", &Sample::ratio);
    fields.Optional("count", &Sample::count);
    fields.Optional("on", &Sample::on);
    fields.Optional("place", &Sample::place);
    fields.Optional("axis", &Sample::axis);
    fields.Choice("shade", &Sample::shade, {"light", "dark", "black"});
    fields.Optional("more_names", &Sample::more_names);
    fields.Optional("numbers", &Sample::numbers);
    fields.Optional("shares", &Sample::shares);
    fields.Optional("part", &Sample::part);
    fields.Optional("more_parts", &Sample::more_parts);
  }
};

// The least JSON that the schema accepts.
inline constexpr char kLeastSample[] =
    R"({"title": "a", "centre": [0, 0, 0], "names": [], "parts": []})";

// JSON in which no field has its default. FieldsToJson() writes it like this.
inline constexpr char kFullSample[] = R"({
  "title": "a \"title\"",
  "centre": [0, -0.25, 1e+20],
  "names": ["x", ""],
  "parts": [{"label": "p"}, {"label": "q", "size": -1, "shade": "black"}],
  "note": "n",
  "ratio": 0.1,
  "count": -2147483648,
  "on": false,
  "place": [0, 0, 0],
  "axis": [0, 0, 1],
  "shade": "dark",
  "more_names": ["y"],
  "numbers": [3, -1],
  "shares": [0.333, 2],
  "part": {"label": "r", "shade": "light"},
  "more_parts": [{"label": "s"}]
})";

}  // namespace furrow::rig
