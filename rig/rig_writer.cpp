// SPDX-License-Identifier: Apache-2.0
// RigToJson(): what a person would have written: defaults left out, small things on one line.
#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "rig/rig_file.h"

namespace furrow::character {
namespace {

using wrinkle::Rig;

std::string Quote(std::string_view text) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += {'\\', c};
    } else if (byte < 0x20) {
      quoted += std::string("\\u00") + kHex[byte >> 4] + kHex[byte & 15];
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

// The shortest decimal that reads back as the same float.
std::string Number(float value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string Numbers(const glm::vec3& v) {
  return "[" + Number(v.x) + ", " + Number(v.y) + ", " + Number(v.z) + "]";
}

std::string Numbers(const glm::quat& q) {
  return "[" + Number(q.x) + ", " + Number(q.y) + ", " + Number(q.z) + ", " + Number(q.w) + "]";
}

std::string Indented(std::string_view text) {
  std::string indented;
  for (const char c : text) {
    indented += c;
    if (c == '\n') indented += "  ";
  }
  return indented;
}

std::string Bracketed(char open, const std::vector<std::string>& items, char close) {
  constexpr std::size_t kLineWidth = 90;
  std::size_t width = 0;
  bool many_lines = false;
  for (const std::string& item : items) {
    width += item.size() + 2;
    many_lines |= item.find('\n') != std::string::npos;
  }
  std::string text(1, open);
  const bool one_line = !many_lines && width < kLineWidth;
  for (std::size_t i = 0; i < items.size(); ++i) {
    text += i == 0 ? "" : ",";
    text += one_line ? (i == 0 ? "" : " ") : "\n  ";
    text += Indented(items[i]);
  }
  return text + (one_line ? "" : "\n") + close;
}

template <class T, class Each>
std::string OnOneLine(const std::vector<T>& list, Each each) {
  std::string text = "[";
  for (const T& entry : list) text += (text.size() == 1 ? "" : ", ") + each(entry);
  return text + "]";
}

// The fields of one object; a field that has its default is not written.
class Object {
 public:
  Object& Raw(const char* name, const std::string& value) {
    fields_.push_back(Quote(name) + ": " + value);
    return *this;
  }
  Object& Text(const char* name, std::string_view value) {
    return value.empty() ? *this : Raw(name, Quote(value));
  }
  Object& Float(const char* name, float value, float otherwise) {
    return value == otherwise ? *this : Raw(name, Number(value));
  }
  // `names` in the enumeration's order; the first is the default unless told.
  template <class T>
  Object& Choice(const char* name, T value, std::initializer_list<const char*> names,
                 T otherwise = T{}) {
    return value == otherwise ? *this : Raw(name, Quote(names.begin()[static_cast<int>(value)]));
  }
  template <class T, class Each>
  Object& List(const char* name, const std::vector<T>& list, Each each) {
    if (list.empty()) return *this;
    return Always(name, list, each);
  }
  template <class T, class Each>
  Object& Always(const char* name, const std::vector<T>& list, Each each) {
    std::vector<std::string> items;
    for (const T& entry : list) items.push_back(each(entry));
    return Raw(name, Bracketed('[', items, ']'));
  }
  [[nodiscard]] std::string str() const { return Bracketed('{', fields_, '}'); }

 private:
  std::vector<std::string> fields_;
};

std::string ToJson(const wrinkle::JointDelta& delta) {
  Object object;
  object.Text("joint", delta.joint);
  if (delta.rotation != glm::quat(1, 0, 0, 0)) object.Raw("rotation", Numbers(delta.rotation));
  if (delta.translation != glm::vec3(0)) object.Raw("translation", Numbers(delta.translation));
  return object.str();
}

std::string ToJson(const wrinkle::ReferencePose& pose) {
  return Object()
      .Text("name", pose.name)
      .Float("source_size", pose.source_size, 0.0f)
      .Always("joints", pose.joints, [](const auto& delta) { return ToJson(delta); })
      .str();
}

std::string ToJson(const wrinkle::ControlPoint& point) {
  Object object;
  object.Text("joint", point.joint).Choice("kind", point.kind, {"tail", "origin", "offset"});
  if (point.offset != glm::vec3(0)) object.Raw("offset", Numbers(point.offset));
  return object.Float("offset_size", point.offset_size, 0.0f).str();
}

std::string ToJson(const wrinkle::PoseDriver& pose) {
  const auto value = [](const wrinkle::PoseDriver::Value& v) {
    return Object().Text("name", v.name).Text("reference_pose", v.reference_pose).str();
  };
  return Object()
      .Always("points", pose.points, [](const auto& point) { return ToJson(point); })
      .Always("values", pose.values, value)
      .Choice("solve", pose.solve, {"projection", "nnls"})
      .Float("falloff", pose.falloff, 0.0f)
      .str();
}

std::string ToJson(const wrinkle::HingeDriver& hinge) {
  Object object;
  object.Text("parent", hinge.parent).Text("joint", hinge.joint).Text("end", hinge.end);
  if (hinge.axis) object.Raw("axis", Numbers(*hinge.axis));
  return object.Float("beta_degrees", hinge.beta_degrees, 30.0f).str();
}

std::string ToJson(const wrinkle::BallDriver& ball) {
  Object object;
  object.Text("parent", ball.parent).Text("joint", ball.joint).Text("end", ball.end);
  if (ball.bone != glm::vec3(0)) object.Raw("bone", Numbers(ball.bone));
  if (ball.forward != glm::vec3(0, 0, 1)) object.Raw("forward", Numbers(ball.forward));
  return object.Float("beta_degrees", ball.beta_degrees, 30.0f)
      .Choice("mode", ball.mode, {"smooth", "thesis"})
      .str();
}

std::string ToJson(const wrinkle::TwistDriver& twist) {
  Object object;
  object.Text("joint", twist.joint);
  if (twist.axis) object.Raw("axis", Numbers(*twist.axis));
  return object.Float("full_degrees", twist.full_degrees, 90.0f)
      .List("through", twist.through, Quote)
      .str();
}

std::string ToJson(const wrinkle::BlendShapeDriver& shape) {
  return Object()
      .Text("blend_shape", shape.blend_shape)
      .Float("neutral", shape.neutral, 0.0f)
      .Float("full", shape.full, 1.0f)
      .str();
}

std::string ToJson(const wrinkle::StrainDriver& strain) {
  const auto vertex = [](const wrinkle::StrainDriver::Vertex& v) {
    return Object()
        .Raw("position", Numbers(v.position))
        .Raw("joints", OnOneLine(v.joints, [](int i) { return std::to_string(i); }))
        .Raw("skin_weights", OnOneLine(v.skin_weights, Number))
        .str();
  };
  return Object()
      .Text("joint", strain.joint)
      .Raw("direction", Numbers(strain.direction))
      .Float("full_compression", strain.full_compression, 0.25f)
      .Float("size", strain.size, 0.0f)
      .Always("joints", strain.joints, Quote)
      .Always("vertices", strain.vertices, vertex)
      .Raw("triangles", OnOneLine(strain.triangles, [](int i) { return std::to_string(i); }))
      .str();
}

std::string ToJson(const wrinkle::Driver& driver) {
  using Kind = wrinkle::Driver::Kind;
  Object object;
  object.Text("name", driver.name);
  switch (driver.kind) {
    case Kind::kPose: object.Raw("pose", ToJson(driver.pose)); break;
    case Kind::kHinge: object.Raw("hinge", ToJson(driver.hinge)); break;
    case Kind::kBall: object.Raw("ball", ToJson(driver.ball)); break;
    case Kind::kTwist: object.Raw("twist", ToJson(driver.twist)); break;
    case Kind::kBlendShape: object.Raw("blend_shape", ToJson(driver.blend_shape)); break;
    case Kind::kStrain: object.Raw("strain", ToJson(driver.strain)); break;
  }
  return object.str();
}

std::string ToJson(const wrinkle::Mask& mask) {
  constexpr std::array kChannels = {"r", "g", "b", "a"};
  Object object;
  object.Choice("kind", mask.kind, {"texture", "skinning", "sliding"})
      .Text("texture", mask.texture);
  if (mask.channel != 0) object.Raw("channel", Quote(kChannels.at(mask.channel)));
  return object.Choice("lambda", mask.lambda, {"smooth", "binary", "linear"})
      .Float("smooth_width", mask.smooth_width, 0.25f)
      .Text("ball", mask.ball)
      .Float("spread_degrees", mask.spread_degrees, 100.0f)
      .Float("above", mask.above, 0.15f)
      .Float("below", mask.below, 0.4f)
      .Float("radius", mask.radius, 0.5f)
      .str();
}

std::string ToJson(const wrinkle::Feed& feed) {
  const auto source = [](const wrinkle::Feed::Source& s) {
    return Object().Text("from", s.driver + "." + s.value).Float("gain", s.gain, 1.0f).str();
  };
  return Object().Text("map", feed.map).Always("sources", feed.sources, source).str();
}

std::string ToJson(const wrinkle::Region& region) {
  using wrinkle::Modulation;
  return Object()
      .Text("name", region.name)
      .Raw("mask", ToJson(region.mask))
      .Always("feeds", region.feeds, [](const auto& feed) { return ToJson(feed); })
      .Choice("combine", region.combine, {"max", "sum", "mean"})
      .Choice("modulation", region.modulation, {"linear", "cosine", "cubic"}, Modulation::kCosine)
      .List("neighbours", region.neighbours, Quote)
      .str();
}

std::string ToJson(const wrinkle::WrinkleMap& map) {
  return Object()
      .Text("name", map.name)
      .Text("normal", map.normal)
      .Text("derivative", map.derivative)
      .Float("derivative_scale", map.derivative_scale, 1.0f)
      .Text("height", map.height)
      .Float("height_mm", map.height_mm, 1.0f)
      .Text("colour", map.colour)
      .Float("colour_scale", map.colour_scale, 1.0f)
      .Text("cavity", map.cavity)
      .Float("amplitude", map.amplitude, 1.0f)
      .Text("opposes", map.opposes)
      .Choice("surface", map.surface, {"any", "skin", "cloth"})
      .str();
}

std::string ToJson(const wrinkle::Filter& filter) {
  const wrinkle::Filter usual;
  Object object;
  if (!filter.enabled) object.Raw("enabled", "false");
  return object.Float("min_cutoff_hz", filter.min_cutoff_hz, usual.min_cutoff_hz)
      .Float("beta", filter.beta, usual.beta)
      .Float("derivative_cutoff_hz", filter.derivative_cutoff_hz, usual.derivative_cutoff_hz)
      .Float("slew_per_second", filter.slew_per_second, usual.slew_per_second)
      .Float("hold_seconds", filter.hold_seconds, usual.hold_seconds)
      .Float("decay_seconds", filter.decay_seconds, usual.decay_seconds)
      .str();
}

// Neighbours of one profile stand together in a group.
std::vector<std::vector<wrinkle::Export>> Groups(const std::vector<wrinkle::Export>& exports) {
  std::vector<std::vector<wrinkle::Export>> groups;
  for (const wrinkle::Export& entry : exports) {
    if (groups.empty() || groups.back().front().profile != entry.profile) groups.emplace_back();
    groups.back().push_back(entry);
  }
  return groups;
}

std::string ToJson(const std::vector<wrinkle::Export>& group) {
  const auto name = [](const wrinkle::Export& entry) {
    return Object().Text("weight", entry.weight).Text("name", entry.name).str();
  };
  return Object().Text("profile", group.front().profile).Always("names", group, name).str();
}

}  // namespace

std::string DriverToJson(const wrinkle::Driver& driver) { return ToJson(driver) + "\n"; }

std::string RigToJson(const Rig& rig) {
  const auto each = [](const auto& entry) { return ToJson(entry); };
  Object object;
  object.Raw("version", "1").Text("name", rig.name).Text("anchor", rig.anchor);
  object.List("reference_poses", rig.reference_poses, each)
      .List("drivers", rig.drivers, each)
      .List("regions", rig.regions, each)
      .List("wrinkle_maps", rig.wrinkle_maps, each)
      .Raw("filter", ToJson(rig.filter))
      .List("export", Groups(rig.exports), each);
  return object.str() + "\n";
}

}  // namespace furrow::character
