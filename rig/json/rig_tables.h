// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <glm/vec3.hpp>

#include "base/status.h"
#include "rig/rig_generated.h"
#include "wrinkle/fields/rig_field.h"

// Helpers to read the FlatBuffers tables of a rig.
namespace furrow::rig {

template <class T>
using TableList = flatbuffers::Vector<flatbuffers::Offset<T>>;

// The text of an optional field; empty if it is absent.
[[nodiscard]] inline std::string Text(const flatbuffers::String* text) {
  return text == nullptr ? std::string() : text->str();
}

[[nodiscard]] inline glm::vec3 ToVec3(const schema::Vec3& v) { return {v.x(), v.y(), v.z()}; }

// Converts an enumeration. The enumerations of the schema and of wrinkle::Rig have the same entries
// in the same order. JSON may give an entry as a number, so the range is checked here.
template <class To, class From>
[[nodiscard]] Status ReadEnum(From from, To* to, const std::string& where) {
  if (from < From::MIN || from > From::MAX) {
    return wrinkle::InvalidField("invalid choice", where);
  }
  *to = static_cast<To>(from);
  return {};
}

// Calls `each(entry, path)` for each entry of an optional list; stops at the first error.
template <class T, class Each>
[[nodiscard]] Status ForEach(const TableList<T>* list, const std::string& path, Each each) {
  if (list == nullptr) return {};
  for (flatbuffers::uoffset_t i = 0; i < list->size(); ++i) {
    FURROW_RETURN_IF_ERROR(each(*list->Get(i), wrinkle::FieldAt(path, i)));
  }
  return {};
}

}  // namespace furrow::rig
