// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/vrm_look_at.h"

#include <algorithm>
#include <string>

#include <tiny_gltf.h>

#include "base/ascii.h"
#include "gltf/document/json_value.h"

namespace furrow::gltf {
namespace {

using tinygltf::Value;

constexpr double kMaxDegrees = 180.0;

// The words of a file for how its eyes are moved.
struct Kind {
  const char* version1;
  const char* version0;
  float output;  // the default of a range
};
constexpr Kind kByBones = {"bone", "Bone", 10.0f};
constexpr Kind kByExpressions = {"expression", "BlendShape", 1.0f};

bool IsWord(const Value& type, const char* word) {
  return type.IsString() && EqualsIgnoreCase(type.Get<std::string>(), word);
}

void ReadNumber(const Value& from, double most, float* to) {
  if (!from.IsNumber()) return;
  const double number = from.GetNumberAsDouble();
  if (number >= 0.0 && number <= most) *to = static_cast<float>(number);
}

// The names of a range's two numbers differ between the versions.
VrmLookAt::Range ReadRange(const Value& from, const char* input, const char* output,
                           float default_output) {
  VrmLookAt::Range range{.input = 90.0f, .output = default_output};
  ReadNumber(Member(from, input), kMaxDegrees, &range.input);
  ReadNumber(Member(from, output), kMaxDegrees, &range.output);
  return range;
}

std::optional<VrmLookAt> Read(const Document& document, const Kind& kind) {
  const auto& extensions = document.model().extensions;
  if (const auto found = extensions.find("VRMC_vrm"); found != extensions.end()) {
    const Value& from = Member(found->second, "lookAt");
    if (!IsWord(Member(from, "type"), kind.version1)) return std::nullopt;
    const auto range = [&](const char* name) {
      return ReadRange(Member(from, name), "inputMaxValue", "outputScale", kind.output);
    };
    return VrmLookAt{range("rangeMapHorizontalInner"), range("rangeMapHorizontalOuter"),
                     range("rangeMapVerticalDown"), range("rangeMapVerticalUp")};
  }
  if (const auto found = extensions.find("VRM"); found != extensions.end()) {
    const Value& from = Member(found->second, "firstPerson");
    if (!IsWord(Member(from, "lookAtTypeName"), kind.version0)) return std::nullopt;
    const auto range = [&](const char* name) {
      return ReadRange(Member(from, name), "xRange", "yRange", kind.output);
    };
    return VrmLookAt{range("lookAtHorizontalInner"), range("lookAtHorizontalOuter"),
                     range("lookAtVerticalDown"), range("lookAtVerticalUp")};
  }
  return std::nullopt;
}

VrmLookAt::Range Limited(VrmLookAt::Range range) {
  range.output = std::min(range.output, 1.0f);
  return range;
}

}  // namespace

std::optional<VrmLookAt> ReadVrmLookAt(const Document& document) {
  return Read(document, kByBones);
}

std::optional<VrmLookAt> ReadVrmLookAtExpressions(const Document& document) {
  auto look_at = Read(document, kByExpressions);
  if (!look_at) return look_at;
  for (VrmLookAt::Range* range : {&look_at->inner, &look_at->outer, &look_at->down, &look_at->up}) {
    *range = Limited(*range);
  }
  return look_at;
}

VrmLookAt::Range ReadGazeRange(const Value& from) {
  return Limited(ReadRange(from, "inputMaxValue", "outputScale", kByExpressions.output));
}

}  // namespace furrow::gltf
