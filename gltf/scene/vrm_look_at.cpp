// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/vrm_look_at.h"

#include <string>

#include <tiny_gltf.h>

#include "base/ascii.h"
#include "gltf/document/json_value.h"

namespace furrow::gltf {
namespace {

using tinygltf::Value;

constexpr double kMaxDegrees = 180.0;

bool IsBone(const Value& type) {
  return type.IsString() && EqualsIgnoreCase(type.Get<std::string>(), "bone");
}

void ReadDegrees(const Value& from, float* to) {
  if (!from.IsNumber()) return;
  const double degrees = from.GetNumberAsDouble();
  if (degrees >= 0.0 && degrees <= kMaxDegrees) *to = static_cast<float>(degrees);
}

// The names of a range's two numbers differ between the versions.
VrmLookAt::Range ReadRange(const Value& from, const char* input, const char* output) {
  VrmLookAt::Range range;
  ReadDegrees(Member(from, input), &range.input);
  ReadDegrees(Member(from, output), &range.output);
  return range;
}

}  // namespace

std::optional<VrmLookAt> ReadVrmLookAt(const Document& document) {
  const auto& extensions = document.model().extensions;
  if (const auto found = extensions.find("VRMC_vrm"); found != extensions.end()) {
    const Value& from = Member(found->second, "lookAt");
    if (!IsBone(Member(from, "type"))) return std::nullopt;
    const auto range = [&](const char* name) {
      return ReadRange(Member(from, name), "inputMaxValue", "outputScale");
    };
    return VrmLookAt{range("rangeMapHorizontalInner"), range("rangeMapHorizontalOuter"),
                     range("rangeMapVerticalDown"), range("rangeMapVerticalUp")};
  }
  if (const auto found = extensions.find("VRM"); found != extensions.end()) {
    const Value& from = Member(found->second, "firstPerson");
    if (!IsBone(Member(from, "lookAtTypeName"))) return std::nullopt;
    const auto range = [&](const char* name) {
      return ReadRange(Member(from, name), "xRange", "yRange");
    };
    return VrmLookAt{range("lookAtHorizontalInner"), range("lookAtHorizontalOuter"),
                     range("lookAtVerticalDown"), range("lookAtVerticalUp")};
  }
  return std::nullopt;
}

}  // namespace furrow::gltf
