// SPDX-License-Identifier: Apache-2.0
// RigToJson(): omits defaults and writes small objects on one line, as a person would.
#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "rig/json/field_writer.h"
#include "rig/json/json_object.h"
#include "rig/rig_file.h"

namespace furrow::rig {
namespace {

using wrinkle::Rig;

std::string ToJson(const wrinkle::JointDelta& delta) {
  Object object;
  object.Text("joint", delta.joint);
  if (delta.rotation != glm::quat(1, 0, 0, 0)) object.Raw("rotation", Numbers(delta.rotation));
  if (delta.translation != glm::vec3(0)) object.Raw("translation", Numbers(delta.translation));
  return object.str();
}

std::string ToJson(const wrinkle::ShapeValue& shape) {
  return Object().Text("blend_shape", shape.blend_shape).Float("value", shape.value, 1.0f).str();
}

std::string ToJson(const wrinkle::ReferencePose& pose) {
  const auto each = [](const auto& entry) { return ToJson(entry); };
  Object object;
  object.Text("name", pose.name).Float("source_size", pose.source_size, 0.0f);
  // Without any list, the reader would not accept the rest pose.
  if (pose.shapes.empty() || !pose.joints.empty()) object.Always("joints", pose.joints, each);
  return object.List("shapes", pose.shapes, each).str();
}

std::string ToJson(const wrinkle::SizeReference& reference) {
  const auto joint = [](const wrinkle::SizeReference::Joint& place) {
    return Object().Text("joint", place.name).Raw("position", Numbers(place.position)).str();
  };
  return Object()
      .Float("size", reference.size, 0.0f)
      .Always("joints", reference.joints, joint)
      .str();
}

// The reference poses of a rig as JSON. A list of joints has one unit of length. A mix of two units
// is written as the mix of two poses, which the reader omits again.
class PoseWriter {
 public:
  explicit PoseWriter(const std::vector<wrinkle::ReferencePose>& poses) : poses_(poses) {
    for (const wrinkle::ReferencePose& pose : poses) names_.insert(pose.name);
  }

  std::vector<std::string> Write() {
    std::vector<std::string> texts;
    for (const wrinkle::ReferencePose& pose : poses_) {
      wrinkle::ReferencePose scaled = pose;
      wrinkle::ReferencePose unscaled;
      for (wrinkle::JointDelta& delta : scaled.joints) {
        if (delta.unscaled_translation == glm::vec3(0)) continue;
        unscaled.joints.push_back(
            {.joint = delta.joint, .translation = delta.unscaled_translation});
        delta.unscaled_translation = glm::vec3(0);
      }
      if (unscaled.joints.empty()) {
        texts.push_back(ToJson(pose));
        continue;
      }
      scaled.name = NewName(pose.name, "scaled");
      unscaled.name = NewName(pose.name, "not scaled");
      texts.push_back(ToJson(scaled));
      texts.push_back(ToJson(unscaled));
      const auto part = [](const std::string& name) { return Object().Text("pose", name).str(); };
      texts.push_back(Object()
                          .Text("name", pose.name)
                          .Always("mix", std::vector{scaled.name, unscaled.name}, part)
                          .str());
    }
    return texts;
  }

 private:
  // Names have at most 255 bytes, so long ones cannot be extended.
  std::string NewName(const std::string& pose, const std::string& what) {
    std::string name = (pose.size() < 200 ? pose : "mix") + " (" + what + ")";
    while (!names_.insert(name).second) name += "'";
    return name;
  }

  const std::vector<wrinkle::ReferencePose>& poses_;
  std::set<std::string> names_;
};

std::string ToJson(const wrinkle::Driver& driver) {
  const std::string kind(wrinkle::DriverKindName(driver.kind));
  const std::string fields =
      wrinkle::VisitFields(driver, [](const auto& of_kind) { return FieldsToJson(of_kind); });
  return Object().Text("name", driver.name).Raw(kind.c_str(), fields).str();
}

std::string ToJson(const wrinkle::Mask& mask) {
  // CheckRigFields() limits the channel to 0 to 3.
  constexpr std::array kChannels = {"r", "g", "b", "a"};
  Object object;
  object.Choice("kind", mask.kind, {"texture", "skinning", "sliding"})
      .Text("texture", mask.texture);
  if (mask.channel != 0) object.Raw("channel", Quote(kChannels.at(mask.channel)));
  return object.Choice("lambda", mask.lambda, {"smooth", "binary", "linear"})
      .Float("smooth_width", mask.smooth_width, 0.25f)
      .Text("driver", mask.driver)
      .Float("spread_degrees", mask.spread_degrees, 100.0f)
      .Float("above", mask.above, 0.15f)
      .Float("below", mask.below, 0.4f)
      .Float("radius", mask.radius, 0.5f)
      .str();
}

// The numbers of a curve take one line: [[0, 0], [0.3, 0.4], [1, 1]].
std::string CurveJson(const std::vector<wrinkle::CurvePoint>& curve) {
  return OnOneLine(curve, [](const wrinkle::CurvePoint& p) {
    return "[" + Number(p.x) + ", " + Number(p.y) + "]";
  });
}

// A curve replaces the named modulation, so only one of the two is written.
void AddModulation(std::optional<wrinkle::Modulation> modulation,
                   const std::vector<wrinkle::CurvePoint>& curve, Object* object) {
  constexpr std::array kNames = {"linear", "cosine", "cubic"};  // wrinkle::Modulation
  if (!curve.empty()) {
    object->Raw("curve", CurveJson(curve));
  } else if (modulation) {
    object->Raw("modulation", Quote(kNames.at(static_cast<std::size_t>(*modulation))));
  }
}

std::string ToJson(const wrinkle::Feed& feed) {
  const auto source = [](const wrinkle::Feed::Source& s) {
    return Object().Text("from", s.driver + "." + s.value).Float("gain", s.gain, 1.0f).str();
  };
  Object object;
  object.Text("map", feed.map).Always("sources", feed.sources, source);
  if (!feed.angles.empty()) {
    object.Raw("angles", CurveJson(feed.angles));
  } else {
    AddModulation(feed.modulation, feed.curve, &object);
  }
  return object.str();
}

std::string ToJson(const wrinkle::Region& region) {
  Object object;
  object.Text("name", region.name)
      .Raw("mask", ToJson(region.mask))
      .Always("feeds", region.feeds, [](const auto& feed) { return ToJson(feed); })
      .Choice("combine", region.combine, {"max", "sum", "mean", "sum_modulated"});
  const bool is_default = region.modulation == wrinkle::Modulation::kCosine;
  AddModulation(is_default ? std::nullopt : std::optional(region.modulation), region.curve,
                &object);
  return object.List("neighbours", region.neighbours, Quote).str();
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
  // The defaults of the struct and of rig.fbs are the same.
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

// Groups consecutive exports of the same profile.
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
  if (rig.size_reference != nullptr) object.Raw("size_reference", ToJson(*rig.size_reference));
  object
      .List("reference_poses", PoseWriter(rig.reference_poses).Write(),
            [](const std::string& text) { return text; })
      .List("drivers", rig.drivers, each)
      .List("regions", rig.regions, each)
      .List("wrinkle_maps", rig.wrinkle_maps, each)
      .Raw("filter", ToJson(rig.filter))
      .List("export", Groups(rig.exports), each);
  return object.str() + "\n";
}

}  // namespace furrow::rig
