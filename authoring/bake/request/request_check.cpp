// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/request/request_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/status.h"

namespace furrow::authoring {
namespace {

Status Refuse(std::string what, std::string where) {
  return Status(StatusCode::kInvalidArgument, std::move(what), std::move(where));
}

bool HasMap(const wrinkle::Rig& rig, const std::string& name) {
  return std::any_of(rig.wrinkle_maps.begin(), rig.wrinkle_maps.end(),
                     [&](const wrinkle::WrinkleMap& map) { return map.name == name; });
}

bool HasRegion(const wrinkle::Rig& rig, const std::string& name) {
  return std::any_of(rig.regions.begin(), rig.regions.end(),
                     [&](const wrinkle::Region& region) { return region.name == name; });
}

std::string Text(float value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%g", static_cast<double>(value));
  return text;
}

// False for NaN.
bool In(float value, float low, float high) { return value >= low && value <= high; }

Status CheckNames(const wrinkle::Rig& rig, const std::string& map, const std::string& region,
                  const std::string& where) {
  if (!HasMap(rig, map)) return Refuse("the rig has no wrinkle map '" + map + "'", where);
  if (!region.empty() && !HasRegion(rig, region)) {
    return Refuse("the rig has no region '" + region + "'", where);
  }
  return Status();
}

Status CheckMatrices(const character::Character& character, std::span<const glm::mat4> matrices,
                     const std::string& where) {
  const auto joints = static_cast<std::size_t>(character.skeleton.num_joints());
  if (matrices.size() != joints) {
    return Refuse(std::to_string(matrices.size()) + " skin matrices for " + std::to_string(joints) +
                      " joints",
                  where);
  }
  for (std::size_t joint = 0; joint < joints; ++joint) {
    for (int k = 0; k < 16; ++k) {
      if (std::isfinite(matrices[joint][k / 4][k % 4])) continue;
      return Status(StatusCode::kNonFinite,
                    "the skin matrix of joint '" + character.skeleton.joint_names()[joint] +
                        "' is not finite",
                    where);
    }
  }
  return Status();
}

// Numbers are checked once here, before any solver sees them.
Status CheckPose(const character::Character& character, const BakePose& pose,
                 const std::string& where) {
  FURROW_RETURN_IF_ERROR(CheckNames(character.rig, pose.map, pose.region, where));
  FURROW_RETURN_IF_ERROR(CheckMatrices(character, pose.skin_matrices, where));
  for (const std::vector<glm::mat4>& step : pose.path) {
    FURROW_RETURN_IF_ERROR(CheckMatrices(character, step, where + ".path"));
  }
  if (!In(pose.weight, 1e-6f, 1.0f)) {
    return Refuse("the weight is " + Text(pose.weight) + "; it must be in (0, 1]", where);
  }
  if (pose.shape_weights.size() > character.shapes.size()) {
    return Refuse("more shape weights (" + std::to_string(pose.shape_weights.size()) +
                      ") than shapes (" + std::to_string(character.shapes.size()) + ")",
                  where);
  }
  if (!std::all_of(pose.shape_weights.begin(), pose.shape_weights.end(),
                   [](float weight) { return std::isfinite(weight); })) {
    return Status(StatusCode::kNonFinite, "a shape weight is not finite", where);
  }
  return Status();
}

Status CheckFabric(const Fabric& fabric) {
  struct Number {
    const char* name;
    float value, least, most;
  };
  for (const Number& number : {Number{"bending stiffness", fabric.bending, 0.1f, 1000.0f},
                               Number{"weight", fabric.weight, 20.0f, 2000.0f},
                               Number{"thickness", fabric.thickness, 0.05f, 5.0f},
                               Number{"membrane stiffness", fabric.stretching, 10.0f, 1e5f}}) {
    if (In(number.value, number.least, number.most)) continue;
    return Refuse("the " + std::string(number.name) + " of fabric '" + std::string(fabric.name) +
                      "' is " + Text(number.value) + "; it must be in [" + Text(number.least) +
                      ", " + Text(number.most) + "]",
                  "options.fabric");
  }
  return Status();
}

Status CheckStroke(const wrinkle::Rig& rig, const BakeStroke& stroke, const std::string& where) {
  if (stroke.maps.empty()) return Refuse("the stroke has no wrinkle map", where);
  for (const std::string& map : stroke.maps) {
    FURROW_RETURN_IF_ERROR(CheckNames(rig, map, stroke.region, where));
  }
  if (stroke.points.size() < 2) return Refuse("a stroke needs at least 2 points", where);
  for (const glm::vec3& p : stroke.points) {
    if (!std::isfinite(p.x + p.y + p.z)) {
      return Status(StatusCode::kNonFinite,
                    "point " + std::to_string(&p - stroke.points.data()) + " is not finite", where);
    }
  }
  return CheckStrokeNumbers(stroke, where);
}

Status CheckMaterial(const BakeMaterial& m, const std::string& where) {
  const struct {
    const char* name;
    float value, low, high;
  } kRanges[] = {{"wavelength_mm", m.wavelength_mm, 0.2f, 200.0f},
                 {"variation", m.variation, 0.0f, 0.5f},
                 {"share", m.share, 0.0f, 1.0f},
                 {"max_compression", m.max_compression, 1e-3f, 0.9f},
                 {"threshold", m.threshold, 0.0f, 0.5f},
                 {"smoothing_mm", m.smoothing_mm, 0.0f, 200.0f},
                 {"sharpness", m.sharpness, 0.0f, 1.0f},
                 {"crossing", m.crossing, 0.0f, 1.0f},
                 {"depth", m.depth, 0.0f, 4.0f},
                 {"grain", m.grain, 0.0f, 1.0f},
                 {"fine_lines", m.fine_lines, 0.0f, 1.0f}};
  for (const auto& range : kRanges) {
    if (!In(range.value, range.low, range.high)) {
      return Refuse(std::string(range.name) + " is " + Text(range.value) + "; it must be in [" +
                        Text(range.low) + ", " + Text(range.high) + "]",
                    where);
    }
  }
  return Status();
}

Status CheckOptions(const BakeOptions& options) {
  if (options.size < 64 || options.size > 4096) {
    return Refuse("size is " + std::to_string(options.size) + "; it must be in [64, 4096] texels",
                  "options");
  }
  if (!In(options.depth, 0.0f, 4.0f)) {
    return Refuse("depth is " + Text(options.depth) + "; it must be in [0, 4]", "options");
  }
  if (options.threads < 1 || options.threads > 64) {
    return Refuse("threads is " + std::to_string(options.threads) + "; it must be in [1, 64]",
                  "options");
  }
  for (const BakeRegionWavelength& region : options.wavelengths) {
    if (!In(region.wavelength_mm, 0.2f, 200.0f)) {
      return Refuse("wavelength_mm is " + Text(region.wavelength_mm) + "; it must be in [0.2, 200]",
                    "options, region '" + region.region + "'");
    }
  }
  FURROW_RETURN_IF_ERROR(CheckMaterial(options.skin, "options.skin"));
  FURROW_RETURN_IF_ERROR(CheckFabric(options.fabric));
  for (const RegionFabric& region : options.fabrics) {
    FURROW_RETURN_IF_ERROR(CheckFabric(region.fabric));
  }
  if (!In(options.ease, 0.0f, 0.3f)) {
    return Refuse("the ease is " + Text(options.ease) + "; it must be in [0, 0.3]", "options.ease");
  }
  for (const RegionEase& region : options.eases) {
    const std::string where = "options.eases, region '" + region.region + "'";
    if (!In(region.ease.looser, 1.0f, 4.0f)) {
      return Refuse("looser is " + Text(region.ease.looser) + "; it must be in [1, 4]", where);
    }
    if (!In(region.ease.least, 0.0f, 1.0f)) {
      return Refuse("least is " + Text(region.ease.least) + "; it must be in [0, 1]", where);
    }
    if (!In(region.ease.feeds, 0.0f, 4.0f)) {
      return Refuse("feeds is " + Text(region.ease.feeds) + "; it must be in [0, 4]", where);
    }
    if (!In(region.ease.stacks, 0.0f, 0.8f)) {
      return Refuse("stacks is " + Text(region.ease.stacks) + "; it must be in [0, 0.8]", where);
    }
  }
  return CheckMaterial(options.cloth, "options.cloth");
}

}  // namespace

Status CheckStrokeNumbers(const BakeStroke& stroke, const std::string& at) {
  constexpr float kAboveZero = 1e-3f;
  constexpr float kDeepest =
      4.0f;  // maximum depth of a fold in widths; the walls then rise at 85 degrees
  // 0 means unset; any valid value passes the check below.
  const float wavelength = stroke.wavelength_mm == 0.0f ? 1.0f : stroke.wavelength_mm;
  const struct {
    const char* field;
    float value, low, high;
    const char* interval;
  } kRanges[] = {{".width_mm", stroke.width_mm, kAboveZero, 200.0f, "(0, 200]"},
                 {".depth_mm", stroke.depth_mm, -50.0f, 50.0f, "[-50, 50]"},
                 {".ridge", stroke.ridge, 0.0f, 1.0f, "[0, 1]"},
                 {".taper", stroke.taper, kAboveZero, 1.0f, "(0, 1]"},
                 {".wavelength_mm", wavelength, 0.2f, 200.0f, "[0.2, 200], or 0"}};
  for (const auto& range : kRanges) {
    if (In(range.value, range.low, range.high)) continue;
    if (!std::isfinite(range.value)) {
      return {StatusCode::kNonFinite, "the number is not finite", at + range.field};
    }
    return Refuse("the number " + Text(range.value) + " is not in " + range.interval,
                  at + range.field);
  }
  const bool is_fold = stroke.kind == BakeStroke::Kind::kFold;
  if (is_fold && std::abs(stroke.depth_mm) > kDeepest * stroke.width_mm) {
    return Refuse("stroke '" + stroke.name + "' is deeper than four times its width",
                  at + ".depth_mm");
  }
  return {};
}

Status CheckBake(const character::Character& character, std::span<const BakePose> poses,
                 std::span<const BakeStroke> strokes, const BakeOptions& options) {
  FURROW_RETURN_IF_ERROR(CheckOptions(options));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::string where = "poses[" + std::to_string(i) + "]";
    FURROW_RETURN_IF_ERROR(CheckPose(character, poses[i], where));
  }
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const std::string& name = strokes[i].name;
    const std::string where =
        "strokes[" + std::to_string(i) + "]" + (name.empty() ? std::string() : " '" + name + "'");
    FURROW_RETURN_IF_ERROR(CheckStroke(character.rig, strokes[i], where));
  }
  return Status();
}

}  // namespace furrow::authoring
