// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <tiny_gltf.h>

namespace furrow::gltf {

// The member `key` of a JSON object, or else a null value. tinygltf asserts that Get() is called on
// an object, and the file decides what is one.
[[nodiscard]] inline const tinygltf::Value& Member(const tinygltf::Value& object, const char* key) {
  static const tinygltf::Value kNull;
  return object.IsObject() ? object.Get(key) : kNull;
}

// The length of an array; 0 for other values.
[[nodiscard]] inline std::size_t LengthOf(const tinygltf::Value& value) {
  return value.IsArray() ? value.ArrayLen() : 0;
}

// The text of a string; empty for other values.
[[nodiscard]] inline std::string TextOf(const tinygltf::Value& value) {
  return value.IsString() ? value.Get<std::string>() : std::string();
}

}  // namespace furrow::gltf
