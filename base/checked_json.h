// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/json_index.h"
#include "base/status.h"

namespace furrow {

// A FlatBuffers schema for untrusted JSON. All strings are required and live as long as the
// program.
struct JsonSchema {
  const char* text = nullptr;  // the schema's source, with a root_type
  const char* root = nullptr;  // the root table's name, such as "Rig"
  const char* file = nullptr;  // the schema file that error messages point to
};

// JSON that conforms to a FlatBuffers schema: no unknown field, no missing required field, no wrong
// type. Errors name file, line and field: "face.rig.json:14: drivers[0].jont".
class CheckedJson {
 public:
  // Parses `json`, which is not kept. `source` is the file name in errors. Errors: those of
  // JsonIndex::Create(), kSchema, and kInternal (the schema is invalid).
  [[nodiscard]] static Result<CheckedJson> Parse(std::string_view json, std::string_view source,
                                                 const JsonSchema& schema);
  CheckedJson(CheckedJson&&) noexcept;
  CheckedJson& operator=(CheckedJson&&) noexcept;
  ~CheckedJson();

  // The FlatBuffers buffer, owned by this object. flatbuffers::GetRoot<T>(buffer()) is the root
  // table.
  [[nodiscard]] const std::uint8_t* buffer() const;
  // Returns `status` with file and line added to its `where`, the path of a field. Ok stays Ok.
  [[nodiscard]] Status Located(const Status& status) const;

 private:
  struct Parsed;
  explicit CheckedJson(std::unique_ptr<Parsed> parsed);
  std::unique_ptr<Parsed> parsed_;
};

}  // namespace furrow
