// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <glm/vec3.hpp>

#include "character/rig_generated.h"
#include "wrinkle/rig_field.h"
#include "wrinkle/status.h"

// What the readers of a rig's FlatBuffers tables share.
namespace furrow::character {

template <class T>
using TableList = flatbuffers::Vector<flatbuffers::Offset<T>>;

// The text of a field that may be absent: empty then.
[[nodiscard]] inline std::string Text(const flatbuffers::String* text) {
  return text == nullptr ? std::string() : text->str();
}

[[nodiscard]] inline glm::vec3 ToVec3(const schema::Vec3& v) { return {v.x(), v.y(), v.z()}; }

// `each(entry, path)` for a list that may be absent; stops at the first failure.
template <class T, class Each>
[[nodiscard]] Status ForEach(const TableList<T>* list, const std::string& path, Each each) {
  if (list == nullptr) return {};
  for (flatbuffers::uoffset_t i = 0; i < list->size(); ++i) {
    if (Status status = each(*list->Get(i), wrinkle::FieldAt(path, i)); !status.ok()) return status;
  }
  return {};
}

}  // namespace furrow::character
