// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>

#include <glm/geometric.hpp>

#include "base/status.h"
#include "wrinkle/skeleton/finite.h"

namespace furrow::wrinkle {

inline constexpr float kMaxSkeletonSize = 1e6f;  // in the skeleton's own units
inline constexpr float kMaxCoefficient = 1e3f;   // of a blend shape

// Checks that `label` is printable text of 1 to 255 bytes. Errors: kInvalidArgument, kLimit.
[[nodiscard]] Status CheckLabel(std::string_view label, const std::string& where);

// CheckLabel(), and no character that cannot be part of a wrinkle weight's name: blanks, dots,
// quotes, slashes, brackets, and others that patterns and OSC addresses use.
[[nodiscard]] Status CheckName(std::string_view name, const std::string& where);

// Checks fields one by one and keeps the first error; later errors are ignored. Callers give the
// path of a field in two parts: `at` is the path of the table and `field` is the rest (".axis").
// The two are only joined for an error.
class FieldCheck {
 public:
  // kNonFinite for a NaN or infinity, kInvalidArgument outside [low, high].
  void Range(const std::string& at, std::string_view field, float value, float low, float high);
  // kNonFinite if any component is not finite.
  template <class Vector>
  void Finite(const std::string& at, std::string_view field, const Vector& v) {
    if (!AllFinite(v)) Set({StatusCode::kNonFinite, "the numbers are not finite"}, at, field);
  }
  // A finite vector with a length above 1e-6 that a float can hold.
  void Direction(const std::string& at, std::string_view field, const glm::vec3& v);
  // kLimit for more than `most` entries.
  void Count(const std::string& at, std::string_view field, std::size_t count, std::size_t most);
  void Label(const std::string& at, std::string_view field, std::string_view label);
  void Name(const std::string& at, std::string_view field, std::string_view name);
  // Rejects a name that is already in `seen`, and adds it. `seen` only refers to the names.
  void Once(const std::string& at, std::string_view field, std::string_view name,
            std::unordered_set<std::string_view>* seen);
  // kInvalidArgument with the message `otherwise` unless `holds`.
  void Require(bool holds, const std::string& at, std::string_view field, const char* otherwise,
               const char* todo = "");

  // The first error, or Ok.
  [[nodiscard]] Status Take() { return std::move(first_); }

 private:
  void Set(const Status& error, const std::string& at, std::string_view field);

  Status first_;
};

}  // namespace furrow::wrinkle
