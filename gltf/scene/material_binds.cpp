// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/material_binds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <glm/common.hpp>
#include <tiny_gltf.h>

#include "base/srgb.h"
#include "base/text.h"
#include "gltf/document/json_value.h"
#include "gltf/limits.h"
#include "gltf/scene/expression_list.h"

namespace furrow::gltf {
namespace {

using tinygltf::Value;
using Version = ExpressionObject::Version;

// The first N numbers of an array, all finite and within `most`. `rest`: of numbers that the array
// does not have, from `required` on.
template <int N>
std::optional<glm::vec<N, float>> Numbers(const Value& list, std::size_t required, float rest,
                                          float most) {
  if (LengthOf(list) < required) return std::nullopt;
  glm::vec<N, float> numbers(rest);
  for (int i = 0; i < std::min<int>(N, static_cast<int>(LengthOf(list))); ++i) {
    const Value& value = list.Get(i);
    if (!value.IsNumber()) return std::nullopt;
    numbers[i] = static_cast<float>(value.GetNumberAsDouble());
    if (!std::isfinite(numbers[i]) || std::abs(numbers[i]) > most) return std::nullopt;
  }
  return numbers;
}

glm::vec4 LinearColour(const glm::vec4& srgb) {
  const glm::vec4 limited = glm::clamp(srgb, 0.0f, 1.0f);
  return {LinearFromSrgb(limited.r), LinearFromSrgb(limited.g), LinearFromSrgb(limited.b),
          limited.a};
}

// What an expression does to a material, as far as it is read.
struct Changes {
  MaterialBind bind;
  bool has_colour = false;
  std::optional<glm::vec3> shade;  // the target
  bool has_transform = false;
  bool has_other_transform = false;  // of another texture than the base colour's (VRM 0.x)
};

class MaterialBindReader {
 public:
  MaterialBindReader(Document* document, std::span<const Material> materials)
      : document_(*document), materials_(materials) {}

  Result<std::vector<MaterialBind>> Run() {
    for (std::size_t i = 0; i < materials_.size(); ++i) {
      by_name_[materials_[i].name].push_back(static_cast<int>(i));
    }
    const std::vector<ExpressionObject> expressions = ListExpressions(document_);
    for (const ExpressionObject& expression : expressions) {
      if (expression.name.empty()) continue;
      FURROW_RETURN_IF_ERROR(expression.version == Version::kVrm1 ? ReadVersion1(*expression.json)
                                                                  : ReadVersion0(*expression.json));
      End(expression.name);
    }
    const tinygltf::Model& model = document_.model();
    if (expressions.empty() && !model.scenes.empty()) {
      FURROW_RETURN_IF_ERROR(ReadPackage(Member(model.scenes.front().extras, kMaterialBindsExtra)));
    }
    Warn();
    return std::move(binds_);
  }

 private:
  Status ReadVersion1(const Value& from) {
    const Value& colours = Member(from, "materialColorBinds");
    const Value& transforms = Member(from, "textureTransformBinds");
    FURROW_RETURN_IF_ERROR(Count(LengthOf(colours) + LengthOf(transforms)));
    for (std::size_t i = 0; i < LengthOf(colours); ++i) {
      const Value& bind = colours.Get(static_cast<int>(i));
      const auto target = Numbers<4>(Member(bind, "targetValue"), 3, 1.0f, kMaxEmission);
      Changes* const changes = ChangesOf(Member(bind, "material"));
      if (changes == nullptr || !Exists(target.has_value())) continue;
      SetColour(TextOf(Member(bind, "type")), *target, changes);
    }
    for (std::size_t i = 0; i < LengthOf(transforms); ++i) {
      const Value& bind = transforms.Get(static_cast<int>(i));
      const auto scale = Numbers<2>(Member(bind, "scale"), 0, 1.0f, kMaxUvChange);
      const auto offset = Numbers<2>(Member(bind, "offset"), 0, 0.0f, kMaxUvChange);
      Changes* const changes = ChangesOf(Member(bind, "material"));
      if (changes == nullptr || !Exists(scale && offset)) continue;
      SetTransform(*scale, *offset, glm::vec2(1.0f), changes);
    }
    return {};
  }

  Status ReadVersion0(const Value& from) {
    const Value& values = Member(from, "materialValues");
    for (std::size_t i = 0; i < LengthOf(values); ++i) {
      const Value& bind = values.Get(static_cast<int>(i));
      const auto named = by_name_.find(TextOf(Member(bind, "materialName")));
      const auto target = Numbers<4>(Member(bind, "targetValue"), 3, 1.0f, kMaxUvChange);
      if (named == by_name_.end()) {
        ++num_missing_;
        continue;
      }
      if (!Exists(target.has_value())) continue;
      // Several materials may have one name.
      FURROW_RETURN_IF_ERROR(Count(named->second.size()));
      for (const int material : named->second) {
        SetProperty0(TextOf(Member(bind, "propertyName")), *target, &At(material));
      }
    }
    return {};
  }

  Status ReadPackage(const Value& list) {
    FURROW_RETURN_IF_ERROR(Count(LengthOf(list)));
    for (std::size_t i = 0; i < LengthOf(list); ++i) {
      const Value& entry = list.Get(static_cast<int>(i));
      const auto colour = Numbers<4>(Member(entry, "baseColor"), 0, 0.0f, 1.0f);
      const auto emission = Numbers<3>(Member(entry, "emission"), 0, 0.0f, kMaxEmission);
      const auto scale = Numbers<2>(Member(entry, "uvScale"), 0, 0.0f, kMaxUvChange);
      const auto offset = Numbers<2>(Member(entry, "uvOffset"), 0, 0.0f, kMaxUvChange);
      const std::string shape = CutText(TextOf(Member(entry, "shape")), kMaxNameBytes);
      Changes* const changes = ChangesOf(Member(entry, "material"));
      if (changes == nullptr || !Exists(colour && emission && scale && offset && !shape.empty())) {
        continue;
      }
      MaterialBind& bind = changes->bind;
      bind.base_colour = *colour;
      bind.emission = *emission;
      bind.uv_scale = *scale;
      bind.uv_offset = *offset;
      End(shape);
    }
    return {};
  }

  Status Count(std::size_t more) {
    num_binds_ += more;
    if (num_binds_ <= kMaxVrmBinds) return {};
    return {
        StatusCode::kLimit,
        "the expressions have more than " + std::to_string(kMaxVrmBinds) + " binds of materials",
        "extensions.VRM"};
  }

  // Counts a bind without usable values; returns `exists`.
  bool Exists(bool exists) {
    num_unusable_ += exists ? 0 : 1;
    return exists;
  }

  // nullptr, counted, if the material does not exist.
  Changes* ChangesOf(const Value& material) {
    const int index = material.IsInt() ? material.GetNumberAsInt() : -1;
    if (index < 0 || index >= static_cast<int>(materials_.size())) {
      ++num_missing_;
      return nullptr;
    }
    return &At(index);
  }

  // Of the present expression.
  Changes& At(int material) {
    Changes& changes = present_[material];
    changes.bind.material = material;
    return changes;
  }

  [[nodiscard]] const Material& MaterialOf(const Changes& changes) const {
    return materials_[static_cast<std::size_t>(changes.bind.material)];
  }

  // `target`: linear.
  void SetColour(const std::string& type, const glm::vec4& target, Changes* to) {
    const Material& material = MaterialOf(*to);
    if (type == "color") {
      to->bind.base_colour += glm::clamp(target, 0.0f, 1.0f) - material.base_colour;
      to->has_colour = true;
    } else if (type == "emissionColor") {
      to->bind.emission += glm::clamp(glm::vec3(target), 0.0f, kMaxEmission) - material.emission;
    } else if (type == "shadeColor") {
      to->shade = glm::clamp(glm::vec3(target), 0.0f, 1.0f);
    } else {
      undrawn_.insert(Quoted(type));
    }
  }

  // Properties of Unity's materials. Its v points up, glTF's down.
  void SetProperty0(const std::string& name, const glm::vec4& target, Changes* to) {
    constexpr std::array<std::pair<std::string_view, const char*>, 5> kColours = {
        {{"_Color", "color"},
         {"_ShadeColor", "shadeColor"},
         {"_EmissionColor", "emissionColor"},
         {"_RimColor", "rimColor"},
         {"_OutlineColor", "outlineColor"}}};
    for (const auto& [property, type] : kColours) {
      if (name == property) {
        SetColour(type, type == std::string_view("emissionColor") ? target : LinearColour(target),
                  to);
        return;
      }
    }
    const glm::vec2 scale(target.x, target.y);
    const glm::vec2 offset(target.z, 1.0f - target.w - target.y);
    if (name == "_MainTex_ST") {
      SetTransform(scale, offset, {1.0f, 1.0f}, to);
    } else if (name == "_MainTex_ST_S") {
      SetTransform(scale, offset, {1.0f, 0.0f}, to);
    } else if (name == "_MainTex_ST_T") {
      SetTransform(scale, offset, {0.0f, 1.0f}, to);
    } else if (name.ends_with("_ST") || name.ends_with("_ST_S") || name.ends_with("_ST_T")) {
      to->has_other_transform = true;
      other_transforms_.insert(Quoted(name));
    } else {
      undrawn_.insert(Quoted(name));
    }
  }

  // Replaces the material's transform uv -> R (s uv) + o by that of the target. As a change of the
  // UVs at rest, uv', that is uv' -> (s1 / s) uv' + o1 - (s1 / s) o, which is linear in the weight
  // as well. `axes`: 1 for axes that the bind changes.
  void SetTransform(const glm::vec2& scale, const glm::vec2& offset, const glm::vec2& axes,
                    Changes* to) {
    const UvTransform& rest = MaterialOf(*to).uv_transform;
    glm::vec2 ratio(1.0f);
    for (int i = 0; i < 2; ++i) {
      if (axes[i] > 0.0f && scale[i] != rest.scale[i]) ratio[i] = scale[i] / rest.scale[i];
    }
    const bool turned = rest.rotation != 0.0f && ratio.x != ratio.y;
    const glm::vec2 moved = axes * (offset - ratio * rest.offset);
    const bool finite = std::isfinite(ratio.x) && std::isfinite(ratio.y) &&
                        std::isfinite(moved.x) && std::isfinite(moved.y) &&
                        std::abs(ratio.x) <= kMaxUvChange && std::abs(ratio.y) <= kMaxUvChange &&
                        std::abs(moved.x) <= kMaxUvChange && std::abs(moved.y) <= kMaxUvChange;
    if (!Exists(!turned && finite)) return;
    to->bind.uv_scale += ratio - 1.0f;
    to->bind.uv_offset += moved;
    to->has_transform = true;
  }

  // Ends the present expression.
  void End(const std::string& name) {
    for (auto& [material, changes] : present_) {
      const std::optional<glm::vec3>& before = MaterialOf(changes).shade_colour;
      if (changes.shade && !changes.has_colour && before) {
        constexpr float kShareOfShade = 0.5f;
        changes.bind.base_colour += glm::vec4(kShareOfShade * (*changes.shade - *before), 0.0f);
      }
      if (changes.has_other_transform && !changes.has_transform) has_lone_transform_ = true;
      MaterialBind& bind = changes.bind;
      bind.base_colour = glm::clamp(bind.base_colour, -1.0f, 1.0f);
      bind.emission = glm::clamp(bind.emission, -kMaxEmission, kMaxEmission);
      bind.uv_scale = glm::clamp(bind.uv_scale, -kMaxUvChange, kMaxUvChange);
      bind.uv_offset = glm::clamp(bind.uv_offset, -kMaxUvChange, kMaxUvChange);
      if (bind.does_nothing()) continue;
      bind.shape = name;
      binds_.push_back(std::move(bind));
    }
    present_.clear();
  }

  void Warn() {
    const auto warn = [&](std::size_t count, const char* what) {
      if (count == 0) return;
      document_.Warn("extensions.VRM",
                     Counted(count, "ignored bind", "ignored binds") + " of expressions " + what);
    };
    warn(num_missing_, "to materials that do not exist");
    warn(num_unusable_, "of materials, with values that cannot be drawn");
    if (has_lone_transform_) undrawn_.merge(other_transforms_);
    if (undrawn_.empty()) return;
    constexpr std::size_t kMostNamed = 8;
    std::string names;
    std::size_t count = 0;
    for (const std::string& name : undrawn_) {
      if (++count > kMostNamed) break;
      names += (names.empty() ? "" : ", ") + name;
    }
    document_.Warn("extensions.VRM",
                   "expressions change properties of materials that are not drawn: " + names +
                       (count > kMostNamed ? ", ..." : ""));
  }

  Document& document_;
  const std::span<const Material> materials_;
  std::map<std::string, std::vector<int>> by_name_;
  std::map<int, Changes> present_;  // of the present expression, by material
  std::vector<MaterialBind> binds_;
  std::size_t num_binds_ = 0;  // stated
  std::size_t num_missing_ = 0;
  std::size_t num_unusable_ = 0;
  std::set<std::string> undrawn_;
  std::set<std::string> other_transforms_;
  bool has_lone_transform_ = false;
};

}  // namespace

bool MaterialBind::does_nothing() const {
  return base_colour == glm::vec4(0.0f) && emission == glm::vec3(0.0f) &&
         uv_scale == glm::vec2(0.0f) && uv_offset == glm::vec2(0.0f);
}

Result<std::vector<MaterialBind>> ReadMaterialBinds(Document* document,
                                                    std::span<const Material> materials) {
  return MaterialBindReader(document, materials).Run();
}

}  // namespace furrow::gltf
