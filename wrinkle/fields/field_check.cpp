// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/fields/field_check.h"

#include <algorithm>
#include <cmath>

#include "wrinkle/fields/rig_field.h"

namespace furrow::wrinkle {
namespace {

constexpr std::size_t kMaxNameBytes = 255;

// The number without trailing zeros.
std::string ShortDecimal(float value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

Status CheckLabel(std::string_view label, const std::string& where) {
  if (label.empty()) return InvalidField("the name is empty", where);
  if (label.size() > kMaxNameBytes) {
    return {StatusCode::kLimit,
            "the name has " + std::to_string(label.size()) + " bytes; at most " +
                std::to_string(kMaxNameBytes) + " are accepted",
            where};
  }
  const bool printable = std::all_of(label.begin(), label.end(), [](char c) {
    return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
  });
  return printable ? Status() : InvalidField("the name holds a control byte", where);
}

// Names become parts of "<region>.<map>", of subscription patterns and of OSC addresses. The
// characters excluded here have a meaning there.
Status CheckName(std::string_view name, const std::string& where) {
  FURROW_RETURN_IF_ERROR(CheckLabel(name, where));
  if (name.find_first_of(" .,;:*?\"'/\\[]{}#") == std::string_view::npos) return {};
  return InvalidField("the name '" + std::string(name) +
                          "' holds a blank or one of . , ; : * ? / # or a quote or bracket",
                      where, "use letters, digits, '_' and '-'");
}

void FieldCheck::Range(const std::string& at, std::string_view field, float value, float low,
                       float high) {
  if (!std::isfinite(value)) {
    Set({StatusCode::kNonFinite, "the number is not finite"}, at, field);
  } else if (value < low || value > high) {
    Set({StatusCode::kInvalidArgument, ShortDecimal(value) + " is out of range [" +
                                           ShortDecimal(low) + ", " + ShortDecimal(high) + "]"},
        at, field);
  }
}

void FieldCheck::Direction(const std::string& at, std::string_view field, const glm::vec3& v) {
  Finite(at, field, v);
  const float length = glm::length(v);  // infinite if a square exceeds a float
  Require(length > 1e-6f && std::isfinite(length), at, field,
          "the direction has no length, or one beyond a float");
}

void FieldCheck::Count(const std::string& at, std::string_view field, std::size_t count,
                       std::size_t most) {
  if (count <= most) return;
  Set({StatusCode::kLimit,
       std::to_string(count) + " entries, at most " + std::to_string(most) + " are accepted"},
      at, field);
}

void FieldCheck::Label(const std::string& at, std::string_view field, std::string_view label) {
  if (first_.ok()) Set(CheckLabel(label, {}), at, field);
}

void FieldCheck::Name(const std::string& at, std::string_view field, std::string_view name) {
  if (first_.ok()) Set(CheckName(name, {}), at, field);
}

void FieldCheck::Once(const std::string& at, std::string_view field, std::string_view name,
                      std::unordered_set<std::string_view>* seen) {
  if (seen->insert(name).second) return;
  Set({StatusCode::kInvalidArgument, "the name '" + std::string(name) + "' is given twice"}, at,
      field);
}

void FieldCheck::Require(bool holds, const std::string& at, std::string_view field,
                         const char* otherwise, const char* todo) {
  if (!holds) Set({StatusCode::kInvalidArgument, otherwise, {}, todo}, at, field);
}

// Keeps the first failure. Later ones are often its consequences.
void FieldCheck::Set(const Status& error, const std::string& at, std::string_view field) {
  if (first_.ok() && !error.ok()) first_ = error.At(at + std::string(field));
}

}  // namespace furrow::wrinkle
