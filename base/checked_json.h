// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/json_index.h"
#include "base/status.h"

namespace furrow {

// A FlatBuffers schema for untrusted JSON.
struct JsonSchema {
  const char* text = nullptr;  // the schema's source, with a root_type
  const char* root = nullptr;  // the root table's name, such as "Rig"
  const char* file = nullptr;  // the schema file that error messages point to
};

// JSON that conforms to a FlatBuffers schema: no unknown field, no missing required field, no wrong
// type. Errors name file, line and field: "face.rig.json:14: drivers[0].jont".
class CheckedJson {
 public:
  // `source` is the file name in errors. Errors: those of JsonIndex::Create(), and kSchema.
  [[nodiscard]] static Result<CheckedJson> Parse(std::string_view json, std::string_view source,
                                                 const JsonSchema& schema);
  CheckedJson(CheckedJson&&) noexcept;
  CheckedJson& operator=(CheckedJson&&) noexcept;
  ~CheckedJson();

  // The root table: flatbuffers::GetRoot<T>(buffer()).
  [[nodiscard]] const std::uint8_t* buffer() const;
  // Adds file and line to a failure whose `where` is a field path.
  [[nodiscard]] Status Located(const Status& status) const;

 private:
  struct Parsed;
  explicit CheckedJson(std::unique_ptr<Parsed> parsed);
  std::unique_ptr<Parsed> parsed_;
};

}  // namespace furrow
