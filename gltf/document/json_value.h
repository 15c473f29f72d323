// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tiny_gltf.h>

namespace furrow::gltf {

// The member `key` of a JSON object, or else a null value. tinygltf asserts that Get() is called on
// an object, and the file decides what is one.
[[nodiscard]] inline const tinygltf::Value& Member(const tinygltf::Value& object, const char* key) {
  static const tinygltf::Value kNull;
  return object.IsObject() ? object.Get(key) : kNull;
}

}  // namespace furrow::gltf
