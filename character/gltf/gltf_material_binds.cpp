// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_material_binds.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "base/ascii.h"

namespace furrow::character {
namespace {

template <class Vector>
nlohmann::json Numbers(const Vector& vector) {
  nlohmann::json list = nlohmann::json::array();
  for (int i = 0; i < Vector::length(); ++i) list.push_back(vector[i]);
  return list;
}

}  // namespace

std::vector<std::string> MakeMaterialBinds(std::span<const gltf::MaterialBind> from,
                                           std::vector<std::string>* shapes,
                                           std::vector<MaterialBind>* binds) {
  // An expression acts with the morph target of its name, in any case.
  std::unordered_map<std::string, std::uint32_t> index_of;
  for (std::size_t i = 0; i < shapes->size(); ++i) {
    index_of.emplace(AsciiLower((*shapes)[i]), static_cast<std::uint32_t>(i));
  }
  std::vector<std::string> surplus;
  std::unordered_map<std::uint64_t, std::size_t> place_of;  // by shape and material
  for (const gltf::MaterialBind& bind : from) {
    auto found = index_of.find(AsciiLower(bind.shape));
    if (found == index_of.end()) {
      if (shapes->size() >= kMaxShapes) {
        if (std::ranges::find(surplus, bind.shape) == surplus.end()) surplus.push_back(bind.shape);
        continue;
      }
      found = index_of.emplace(AsciiLower(bind.shape), static_cast<std::uint32_t>(shapes->size()))
                  .first;
      shapes->push_back(bind.shape);
    }
    const auto material = static_cast<std::uint32_t>(bind.material);
    const std::uint64_t key = (std::uint64_t{found->second} << 32) | material;
    const auto [place, is_new] = place_of.try_emplace(key, binds->size());
    if (is_new) {
      binds->push_back({found->second, material, bind.base_colour, bind.emission, bind.uv_scale,
                        bind.uv_offset});
    }
  }
  return surplus;
}

nlohmann::json MaterialBindsJson(const Character& character) {
  nlohmann::json list = nlohmann::json::array();
  for (const MaterialBind& bind : character.material_binds) {
    if (bind.shape >= character.shapes.size() || bind.material >= character.materials.size()) {
      continue;
    }
    nlohmann::json entry = {{"shape", character.shapes[bind.shape]}, {"material", bind.material}};
    if (bind.base_colour != glm::vec4(0.0f)) entry["baseColor"] = Numbers(bind.base_colour);
    if (bind.emission != glm::vec3(0.0f)) entry["emission"] = Numbers(bind.emission);
    if (bind.uv_scale != glm::vec2(0.0f)) entry["uvScale"] = Numbers(bind.uv_scale);
    if (bind.uv_offset != glm::vec2(0.0f)) entry["uvOffset"] = Numbers(bind.uv_offset);
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace furrow::character
