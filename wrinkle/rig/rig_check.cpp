// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/rig_check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "base/status.h"
#include "wrinkle/drivers/pose/nnls.h"
#include "wrinkle/drivers/pose/pose_driver.h"
#include "wrinkle/drivers/strain/strain.h"
#include "wrinkle/rig/rig_field.h"
#include "wrinkle/skeleton/finite.h"

namespace furrow::wrinkle {
namespace {

constexpr std::size_t kMaxNameBytes = 255;
constexpr float kMaxSize = 1e6f;         // of a skeleton, in its own units
constexpr float kMaxCoefficient = 1e3f;  // of a blend shape

std::string Text(float value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

// The first complaint about a rig; later ones are passed over. A field is given in two parts, the
// path of what it belongs to and its own name, which are put together for a complaint alone.
class Complaints {
 public:
  void Range(const std::string& at, std::string_view field, float value, float low, float high) {
    if (!std::isfinite(value)) {
      Set({StatusCode::kNonFinite, "the number is not finite"}, at, field);
    } else if (value < low || value > high) {
      Set({StatusCode::kInvalidArgument,
           Text(value) + " is out of range [" + Text(low) + ", " + Text(high) + "]"},
          at, field);
    }
  }
  template <class Vector>
  void Finite(const std::string& at, std::string_view field, const Vector& v) {
    if (!AllFinite(v)) Set({StatusCode::kNonFinite, "the numbers are not finite"}, at, field);
  }
  void Direction(const std::string& at, std::string_view field, const glm::vec3& v) {
    Finite(at, field, v);
    const float length = glm::length(v);  // infinite where a square is beyond a float
    Require(length > 1e-6f && std::isfinite(length), at, field,
            "the direction has no length, or one beyond a float");
  }
  void Count(const std::string& at, std::string_view field, std::size_t count, std::size_t most) {
    if (count <= most) return;
    Set({StatusCode::kLimit,
         std::to_string(count) + " entries, at most " + std::to_string(most) + " are accepted"},
        at, field);
  }
  void Label(const std::string& at, std::string_view field, std::string_view label) {
    if (first_.ok()) Set(CheckLabel(label, {}), at, field);
  }
  void Name(const std::string& at, std::string_view field, std::string_view name) {
    if (first_.ok()) Set(CheckName(name, {}), at, field);
  }
  // `name` is one of a list; `seen` holds those before it.
  void Once(const std::string& at, std::string_view field, std::string_view name,
            std::unordered_set<std::string_view>* seen) {
    if (seen->insert(name).second) return;
    Set({StatusCode::kInvalidArgument, "the name '" + std::string(name) + "' is given twice"}, at,
        field);
  }
  void Require(bool holds, const std::string& at, std::string_view field, const char* otherwise,
               const char* todo = "") {
    if (!holds) Set({StatusCode::kInvalidArgument, otherwise, {}, todo}, at, field);
  }
  [[nodiscard]] Status Take() { return std::move(first_); }

 private:
  void Set(const Status& complaint, const std::string& at, std::string_view field) {
    if (first_.ok() && !complaint.ok()) first_ = complaint.At(at + std::string(field));
  }
  Status first_;
};

void CheckReferencePose(const ReferencePose& pose, const std::string& at, Complaints* complaints) {
  complaints->Range(at, ".source_size", pose.source_size, 0.0f, kMaxSize);
  complaints->Count(at, ".joints", pose.joints.size(), kMaxJoints);
  std::unordered_set<std::string_view> joints;
  for (std::size_t i = 0; i < pose.joints.size(); ++i) {
    const JointDelta& delta = pose.joints[i];
    const std::string joint = FieldAt(at + ".joints", i);
    complaints->Label(joint, ".joint", delta.joint);
    complaints->Once(joint, ".joint", delta.joint, &joints);
    complaints->Finite(joint, ".translation", delta.translation);
    complaints->Finite(joint, ".rotation", delta.rotation);
    complaints->Require(std::abs(glm::length(delta.rotation) - 1.0f) <= 1e-3f, joint, ".rotation",
                        "the rotation is not a unit quaternion",
                        "write [x, y, z, w] of length 1, or euler_degrees");
  }
}

void CheckPose(const PoseDriver& pose, const std::string& at, Complaints* complaints) {
  const bool nnls = pose.solve == PoseSolve::kNnls;
  complaints->Require(!pose.points.empty(), at, ".points", "a pose driver needs a control point");
  complaints->Require(!pose.values.empty(), at, ".values", "a pose driver needs a value");
  complaints->Count(at, ".points", pose.points.size(), kMaxControlPoints);
  complaints->Count(at, ".values", pose.values.size(), nnls ? kMaxNnlsValues : kMaxPoseValues);
  complaints->Range(at, ".falloff", pose.falloff, 0.0f, 1000.0f);
  for (std::size_t i = 0; i < pose.points.size(); ++i) {
    const std::string point = FieldAt(at + ".points", i);
    complaints->Label(point, ".joint", pose.points[i].joint);
    complaints->Finite(point, ".offset", pose.points[i].offset);
    complaints->Range(point, ".offset_size", pose.points[i].offset_size, 0.0f, kMaxSize);
  }
  std::unordered_set<std::string_view> names;
  for (std::size_t i = 0; i < pose.values.size(); ++i) {
    const std::string value = FieldAt(at + ".values", i);
    complaints->Name(value, ".name", pose.values[i].name);
    complaints->Once(value, ".name", pose.values[i].name, &names);
  }
}

void CheckHinge(const HingeDriver& hinge, const std::string& at, Complaints* complaints) {
  complaints->Label(at, ".parent", hinge.parent);
  complaints->Label(at, ".joint", hinge.joint);
  if (!hinge.end.empty()) complaints->Label(at, ".end", hinge.end);
  if (hinge.axis) complaints->Direction(at, ".axis", *hinge.axis);
  complaints->Range(at, ".beta_degrees", hinge.beta_degrees, 0.0f, kMaxBetaDegrees);
}

void CheckBall(const BallDriver& ball, const std::string& at, Complaints* complaints) {
  complaints->Label(at, ".parent", ball.parent);
  complaints->Label(at, ".joint", ball.joint);
  if (!ball.end.empty()) complaints->Label(at, ".end", ball.end);
  if (ball.bone != glm::vec3(0.0f)) complaints->Direction(at, ".bone", ball.bone);
  complaints->Direction(at, ".forward", ball.forward);
  complaints->Range(at, ".beta_degrees", ball.beta_degrees, 0.0f, kMaxBetaDegrees);
}

void CheckTwist(const TwistDriver& twist, const std::string& at, Complaints* complaints) {
  complaints->Label(at, ".joint", twist.joint);
  complaints->Count(at, ".through", twist.through.size(), 64);
  for (std::size_t i = 0; i < twist.through.size(); ++i) {
    complaints->Label(FieldAt(at + ".through", i), "", twist.through[i]);
  }
  if (twist.axis) complaints->Direction(at, ".axis", *twist.axis);
  complaints->Range(at, ".full_degrees", twist.full_degrees, 1.0f, 180.0f);
}

void CheckBlendShape(const BlendShapeDriver& shape, const std::string& at, Complaints* complaints) {
  complaints->Label(at, ".blend_shape", shape.blend_shape);
  complaints->Range(at, ".neutral", shape.neutral, -kMaxCoefficient, kMaxCoefficient);
  complaints->Range(at, ".full", shape.full, -kMaxCoefficient, kMaxCoefficient);
  complaints->Require(std::abs(shape.full - shape.neutral) >= 1e-4f, at, ".full",
                      "full and neutral are the same coefficient");
}

void CheckPatchVertex(const StrainDriver::Vertex& vertex, const std::string& at,
                      std::size_t num_joints, Complaints* complaints) {
  complaints->Finite(at, ".position", vertex.position);
  complaints->Count(at, ".joints", vertex.joints.size(), StrainDriver::kMaxInfluences);
  complaints->Require(!vertex.joints.empty(), at, ".joints", "no joint moves the vertex");
  complaints->Require(vertex.joints.size() == vertex.skin_weights.size(), at, ".skin_weights",
                      "a joint needs a skin weight each");
  float sum = 0.0f;
  for (const float skin_weight : vertex.skin_weights) {
    complaints->Range(at, ".skin_weights", skin_weight, 0.0f, 1.0f);
    sum += skin_weight;
  }
  complaints->Require(std::abs(sum - 1.0f) <= 0.01f, at, ".skin_weights",
                      "the skin weights do not sum to 1");
  for (const int joint : vertex.joints) {
    complaints->Require(joint >= 0 && static_cast<std::size_t>(joint) < num_joints, at, ".joints",
                        "there is no such joint in the driver's list");
  }
}

// Whether some triangle has an area to be compressed; indices are known to be good.
bool HasArea(const StrainDriver& strain) {
  for (std::size_t i = 0; i + 2 < strain.triangles.size(); i += 3) {
    const auto corner = [&](std::size_t k) {
      return strain.vertices[static_cast<std::size_t>(strain.triangles[i + k])].position;
    };
    if (MakeRestTriangle(corner(0), corner(1), corner(2), strain.direction)) return true;
  }
  return false;
}

void CheckStrain(const StrainDriver& strain, const std::string& at, Complaints* complaints) {
  complaints->Label(at, ".joint", strain.joint);
  complaints->Count(at, ".joints", strain.joints.size(), kMaxPatchJoints);
  complaints->Count(at, ".vertices", strain.vertices.size(), kMaxPatchVertices);
  complaints->Count(at, ".triangles", strain.triangles.size(), 3 * kMaxPatchTriangles);
  std::unordered_set<std::string_view> joints;
  for (std::size_t i = 0; i < strain.joints.size(); ++i) {
    complaints->Label(FieldAt(at + ".joints", i), "", strain.joints[i]);
    complaints->Once(FieldAt(at + ".joints", i), "", strain.joints[i], &joints);
  }
  for (std::size_t i = 0; i < strain.vertices.size(); ++i) {
    CheckPatchVertex(strain.vertices[i], FieldAt(at + ".vertices", i), strain.joints.size(),
                     complaints);
  }
  complaints->Require(strain.triangles.size() % 3 == 0, at, ".triangles",
                      "a triangle has three vertices");
  bool in_range = true;
  for (const int vertex : strain.triangles) {
    in_range = in_range && vertex >= 0 && static_cast<std::size_t>(vertex) < strain.vertices.size();
  }
  complaints->Require(in_range, at, ".triangles", "a number is not that of a vertex");
  complaints->Direction(at, ".direction", strain.direction);
  complaints->Range(at, ".full_compression", strain.full_compression, 0.01f, 1.0f);
  complaints->Range(at, ".size", strain.size, 0.0f, kMaxSize);
  complaints->Require(!in_range || HasArea(strain), at, ".triangles",
                      "no triangle has an area that could be compressed");
}

void CheckDriver(const Driver& driver, const std::string& at, Complaints* complaints) {
  switch (driver.kind) {
    case Driver::Kind::kPose: return CheckPose(driver.pose, at + ".pose", complaints);
    case Driver::Kind::kHinge: return CheckHinge(driver.hinge, at + ".hinge", complaints);
    case Driver::Kind::kBall: return CheckBall(driver.ball, at + ".ball", complaints);
    case Driver::Kind::kTwist: return CheckTwist(driver.twist, at + ".twist", complaints);
    case Driver::Kind::kBlendShape:
      return CheckBlendShape(driver.blend_shape, at + ".blend_shape", complaints);
    case Driver::Kind::kStrain: return CheckStrain(driver.strain, at + ".strain", complaints);
  }
}

void CheckFeed(const Feed& feed, const std::string& at, Combine combine, Complaints* complaints) {
  complaints->Require(!feed.sources.empty(), at, ".sources", "a feed needs a source");
  complaints->Count(at, ".sources", feed.sources.size(), kMaxSources);
  float gains = 0.0f;
  for (std::size_t i = 0; i < feed.sources.size(); ++i) {
    const float gain = feed.sources[i].gain;
    complaints->Range(FieldAt(at + ".sources", i), ".gain", gain, 0.0f, 100.0f);
    gains += gain;
  }
  complaints->Require(combine != Combine::kMean || gains > 0.0f, at, ".sources",
                      "all gains are 0, which leaves no mean");
}

void CheckRegion(const Region& region, const std::string& at, Complaints* complaints) {
  complaints->Require(region.mask.channel >= 0 && region.mask.channel <= 3, at, ".mask.channel",
                      "there is no such channel");
  complaints->Range(at, ".mask.smooth_width", region.mask.smooth_width, 1e-4f, 1.0f);
  complaints->Range(at, ".mask.spread_degrees", region.mask.spread_degrees, 1.0f, 180.0f);
  complaints->Range(at, ".mask.above", region.mask.above, 0.0f, 10.0f);
  complaints->Range(at, ".mask.below", region.mask.below, 0.0f, 10.0f);
  complaints->Range(at, ".mask.radius", region.mask.radius, 1e-3f, 10.0f);
  complaints->Require(region.mask.above + region.mask.below > 0.0f, at, ".mask.below",
                      "the mask has no length: above and below are 0");
  complaints->Count(at, ".neighbours", region.neighbours.size(), kMaxRegions);
  complaints->Count(at, ".feeds", region.feeds.size(), kMaxWrinkleMaps);
  std::unordered_set<std::string_view> maps;
  for (std::size_t i = 0; i < region.feeds.size(); ++i) {
    const std::string feed = FieldAt(at + ".feeds", i);
    complaints->Name(feed, ".map", region.feeds[i].map);
    complaints->Once(feed, ".map", region.feeds[i].map, &maps);
    CheckFeed(region.feeds[i], feed, region.combine, complaints);
  }
}

void CheckMap(const WrinkleMap& map, const std::string& at, Complaints* complaints) {
  complaints->Range(at, ".amplitude", map.amplitude, 0.0f, 100.0f);
  complaints->Range(at, ".derivative_scale", map.derivative_scale, 1e-4f, kMaxDerivativeScale);
  complaints->Range(at, ".height_mm", map.height_mm, 1e-4f, 1000.0f);
  complaints->Range(at, ".colour_scale", map.colour_scale, 0.1f, 10.0f);
  complaints->Require(map.opposes != map.name, at, ".opposes", "a map cannot oppose itself");
}

void CheckFilter(const Filter& filter, Complaints* complaints) {
  const std::string at = "filter";
  complaints->Range(at, ".min_cutoff_hz", filter.min_cutoff_hz, 1e-3f, 1000.0f);
  complaints->Range(at, ".beta", filter.beta, 0.0f, 1000.0f);
  complaints->Range(at, ".derivative_cutoff_hz", filter.derivative_cutoff_hz, 1e-3f, 1000.0f);
  complaints->Range(at, ".slew_per_second", filter.slew_per_second, 0.0f, 1e6f);
  complaints->Range(at, ".hold_seconds", filter.hold_seconds, 0.0f, 3600.0f);
  complaints->Range(at, ".decay_seconds", filter.decay_seconds, 0.0f, 3600.0f);
}

// At most `most` items, each with a name of its own, checked by `check_name` and then by `check`.
template <class Item, class Check>
void CheckList(const std::string& list, const std::vector<Item>& items, std::size_t most,
               void (Complaints::*check_name)(const std::string&, std::string_view,
                                              std::string_view),
               Check check, Complaints* complaints) {
  complaints->Count(list, "", items.size(), most);
  std::unordered_set<std::string_view> names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string at = FieldAt(list, i);
    (complaints->*check_name)(at, ".name", items[i].name);
    complaints->Once(at, ".name", items[i].name, &names);
    check(items[i], at, complaints);
  }
}

// A mask slides with a ball joint's driver.
void CheckSlides(const Rig& rig, Complaints* complaints) {
  for (std::size_t i = 0; i < rig.regions.size(); ++i) {
    const Mask& mask = rig.regions[i].mask;
    if (mask.kind != Mask::Kind::kSliding) continue;
    const bool is_ball = std::any_of(rig.drivers.begin(), rig.drivers.end(), [&](const Driver& d) {
      return d.name == mask.ball && d.kind == Driver::Kind::kBall;
    });
    complaints->Require(is_ball, FieldAt("regions", i), ".mask.ball",
                        "a sliding mask names a ball driver of the rig");
  }
}

}  // namespace

Status CheckLabel(std::string_view label, const std::string& where) {
  if (label.empty()) return InvalidField("the name is empty", where);
  if (label.size() > kMaxNameBytes) {
    return {StatusCode::kLimit, "the name is longer than 255 bytes", where};
  }
  const bool printable = std::all_of(label.begin(), label.end(), [](char c) {
    return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
  });
  return printable ? Status() : InvalidField("the name holds a control byte", where);
}

Status CheckName(std::string_view name, const std::string& where) {
  FURROW_RETURN_IF_ERROR(CheckLabel(name, where));
  if (name.find_first_of(" .,;:*?\"'/\\[]{}#") == std::string_view::npos) return {};
  return InvalidField("the name '" + std::string(name) +
                          "' holds a blank or one of . , ; : * ? / # or a quote or bracket",
                      where, "use letters, digits, '_' and '-'");
}

Status CheckRigFields(const Rig& rig) {
  Complaints complaints;
  CheckList("reference_poses", rig.reference_poses, kMaxReferencePoses, &Complaints::Label,
            CheckReferencePose, &complaints);
  CheckList("drivers", rig.drivers, kMaxRigDrivers, &Complaints::Name, CheckDriver, &complaints);
  CheckList("wrinkle_maps", rig.wrinkle_maps, kMaxWrinkleMaps, &Complaints::Name, CheckMap,
            &complaints);
  CheckList("regions", rig.regions, kMaxRegions, &Complaints::Name, CheckRegion, &complaints);
  CheckSlides(rig, &complaints);
  CheckFilter(rig.filter, &complaints);
  return complaints.Take();
}

}  // namespace furrow::wrinkle
