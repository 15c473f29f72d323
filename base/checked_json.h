// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/json_index.h"
#include "base/status.h"

namespace furrow {

// A schema that JSON from outside is checked against.
struct JsonSchema {
  const char* text = nullptr;  // a .fbs with a root_type
  const char* root = nullptr;  // its name: "Rig"
  const char* file = nullptr;  // where its fields are listed: "rig/rig.fbs"
};

// JSON that has been checked against a FlatBuffers schema: every field known, there when required
// and of the right type. Errors name file, line and field: "face.rig.json:14: drivers[0].jont".
class CheckedJson {
 public:
  // `source` stands for the file in errors. Errors: JsonIndex::Create()'s, kSchema.
  [[nodiscard]] static Result<CheckedJson> Parse(std::string_view json, std::string_view source,
                                                 const JsonSchema& schema);
  CheckedJson(CheckedJson&&) noexcept;
  CheckedJson& operator=(CheckedJson&&) noexcept;
  ~CheckedJson();

  // The root table: flatbuffers::GetRoot<T>(buffer()).
  [[nodiscard]] const std::uint8_t* buffer() const;
  // A failure whose `where` is a field, with file and line.
  [[nodiscard]] Status Located(const Status& status) const;

 private:
  struct Parsed;
  explicit CheckedJson(std::unique_ptr<Parsed> parsed);
  std::unique_ptr<Parsed> parsed_;
};

}  // namespace furrow
