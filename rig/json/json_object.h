// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

// Writes compact, readable JSON: default values are omitted, and small objects take one line.
namespace furrow::rig {

[[nodiscard]] std::string Quote(std::string_view text);
// The shortest decimal number that reads back as the same float.
[[nodiscard]] std::string Number(float value);
[[nodiscard]] std::string Numbers(const glm::vec3& v);
[[nodiscard]] std::string Numbers(const glm::quat& q);  // [x, y, z, w]
// Encloses items in brackets, on one line if they are short.
[[nodiscard]] std::string Bracketed(char open, const std::vector<std::string>& items, char close);

template <class T, class Each>
std::string OnOneLine(const std::vector<T>& list, Each each) {
  std::string text = "[";
  for (const T& entry : list) text += (text.size() == 1 ? "" : ", ") + each(entry);
  return text + "]";
}

// The fields of one JSON object. Fields with their default value are omitted.
class Object {
 public:
  Object& Raw(const char* name, const std::string& value) {
    fields_.push_back(Quote(name) + ": " + value);
    return *this;
  }
  Object& Text(const char* name, std::string_view value) {
    return value.empty() ? *this : Raw(name, Quote(value));
  }
  Object& Float(const char* name, float value, float otherwise) {
    return value == otherwise ? *this : Raw(name, Number(value));
  }
  // `names`: in the order of the enumeration. `otherwise`: the default.
  template <class T>
  Object& Choice(const char* name, T value, std::initializer_list<const char*> names,
                 T otherwise = T{}) {
    return value == otherwise ? *this : Raw(name, Quote(names.begin()[static_cast<int>(value)]));
  }
  template <class T, class Each>
  Object& List(const char* name, const std::vector<T>& list, Each each) {
    if (list.empty()) return *this;
    return Always(name, list, each);
  }
  template <class T, class Each>
  Object& Always(const char* name, const std::vector<T>& list, Each each) {
    std::vector<std::string> items;
    for (const T& entry : list) items.push_back(each(entry));
    return Raw(name, Bracketed('[', items, ']'));
  }
  [[nodiscard]] std::string str() const { return Bracketed('{', fields_, '}'); }

 private:
  std::vector<std::string> fields_;
};

}  // namespace furrow::rig
