// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <glm/vec3.hpp>

#include "rig/json/json_object.h"
#include "wrinkle/fields/field_list.h"

namespace furrow::rig {

template <wrinkle::ListsFields T>
[[nodiscard]] std::string FieldsToJson(const T& from);

// Visits the fields that T lists (wrinkle/fields/field_list.h) and writes each as JSON, except
// optional fields with their default value.
template <class T>
class FieldWriter {
 public:
  explicit FieldWriter(const T& from) : from_(from) {}

  template <class Member>
  void Required(const char* name, Member T::*member) {
    static_assert(!std::is_same_v<Member, std::optional<glm::vec3>>,
                  "a required field always has a value");
    object_.Raw(name, ToJson(from_.*member));
  }
  template <class Member>
  void Optional(const char* name, Member T::*member) {
    const Member& value = from_.*member;
    if (!IsSame(value, usual_.*member)) object_.Raw(name, ToJson(value));
  }
  template <class Enum>
  void Choice(const char* name, Enum T::*member, std::initializer_list<const char*> names) {
    object_.Choice(name, from_.*member, names, usual_.*member);
  }

  [[nodiscard]] std::string str() const { return object_.str(); }

 private:
  static std::string ToJson(const std::string& text) { return Quote(text); }
  static std::string ToJson(float value) { return Number(value); }
  static std::string ToJson(int value) { return std::to_string(value); }
  static std::string ToJson(bool value) { return value ? "true" : "false"; }
  static std::string ToJson(const glm::vec3& v) { return Numbers(v); }
  static std::string ToJson(const std::optional<glm::vec3>& v) { return Numbers(v.value()); }
  template <wrinkle::ListsFields Nested>
  static std::string ToJson(const Nested& nested) {
    return FieldsToJson(nested);
  }
  // Lists of numbers can be long, so they take one line.
  static std::string ToJson(const std::vector<float>& list) { return OnOneLine(list, Number); }
  static std::string ToJson(const std::vector<int>& list) {
    return OnOneLine(list, [](int value) { return std::to_string(value); });
  }
  template <class Item>
  static std::string ToJson(const std::vector<Item>& list) {
    std::vector<std::string> items;
    for (const Item& item : list) items.push_back(ToJson(item));
    return Bracketed('[', items, ']');
  }

  template <class Member>
  static bool IsSame(const Member& a, const Member& b) {
    return a == b;
  }
  template <wrinkle::ListsFields Nested>
  static bool IsSame(const Nested& a, const Nested& b) {
    return FieldsToJson(a) == FieldsToJson(b);
  }
  // A list is empty by default.
  template <class Item>
  static bool IsSame(const std::vector<Item>& list, const std::vector<Item>&) {
    return list.empty();
  }

  const T& from_;
  const T usual_{};
  Object object_;
};

// The fields that T lists, as a JSON object.
template <wrinkle::ListsFields T>
std::string FieldsToJson(const T& from) {
  FieldWriter<T> writer(from);
  T::ListFields(writer);
  return writer.str();
}

}  // namespace furrow::rig
