// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

// Small glTF files for tests. They do not use gltf/write, so that writer and reader cannot share a
// fault.
namespace furrow::gltf {

inline std::string U32(std::size_t value) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xFF);
  return bytes;
}

inline std::string PackGlb(std::string json, const std::string& binary) {
  json.append((4 - json.size() % 4) % 4, ' ');
  return "glTF" + U32(2) + U32(28 + json.size() + binary.size()) + U32(json.size()) + "JSON" +
         json + U32(binary.size()) + std::string("BIN\0", 4) + binary;
}

// Tests change `json` and `binary` freely before they call Glb().
struct HandMadeGltf {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}},
                         {"nodes", nlohmann::json::array()},
                         {"animations",
                          {{{"name", "take"},
                            {"samplers", nlohmann::json::array()},
                            {"channels", nlohmann::json::array()}}}}};
  std::string binary;

  template <class T>
  int AddAccessor(const std::vector<T>& values, const char* type, int component_type,
                  std::size_t components) {
    const std::size_t offset = binary.size();
    binary.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}});
    binary.append((4 - binary.size() % 4) % 4, '\0');
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", component_type},
                                 {"count", values.size() / components},
                                 {"type", type}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  int AddFloats(const std::vector<float>& values, const char* type) {
    const std::size_t components = type == std::string_view("MAT4")   ? 16
                                   : type == std::string_view("VEC4") ? 4
                                   : type == std::string_view("VEC3") ? 3
                                                                      : 1;
    return AddAccessor(values, type, 5126, components);
  }

  void AddChannel(int node, const char* path, const char* interpolation, int times, int values) {
    nlohmann::json& animation = json["animations"][0];
    animation["samplers"].push_back(
        {{"input", times}, {"output", values}, {"interpolation", interpolation}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", node}, {"path", path}}}});
  }

  [[nodiscard]] std::string Glb() const {
    nlohmann::json whole = json;
    whole["buffers"] = {{{"byteLength", binary.size()}}};
    return PackGlb(whole.dump(), binary);
  }
};

// A root and a child. The child turns by 90 degrees about Z in one second, and the root moves along
// X.
inline HandMadeGltf TwoJoints() {
  HandMadeGltf gltf;
  gltf.json["nodes"] = {{{"name", "root"}, {"children", {1}}},
                        {{"name", "child"}, {"translation", {0, 1, 0}}}};
  const int times = gltf.AddFloats({0.0f, 1.0f}, "SCALAR");
  const float h = 0.70710678f;
  gltf.AddChannel(1, "rotation", "LINEAR", times, gltf.AddFloats({0, 0, 0, 1, 0, 0, h, h}, "VEC4"));
  gltf.AddChannel(0, "translation", "LINEAR", times, gltf.AddFloats({0, 0, 0, 2, 0, 0}, "VEC3"));
  return gltf;
}

}  // namespace furrow::gltf
