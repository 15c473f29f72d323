// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <glm/vec3.hpp>

#include "base/status.h"
#include "rig/rig_generated.h"
#include "wrinkle/fields/rig_field.h"

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
    FURROW_RETURN_IF_ERROR(each(*list->Get(i), wrinkle::FieldAt(path, i)));
  }
  return {};
}

}  // namespace furrow::character
