// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <flatbuffers/reflection.h>

namespace furrow::rig {

// A table of a parsed file together with its type, so that its fields can be found by name.
struct DescribedTable {
  const reflection::Schema* schema = nullptr;
  const reflection::Object* type = nullptr;  // nullptr if the schema has no such type
  const flatbuffers::Table* table = nullptr;
};

// The entry of a schema with this name, or nullptr. (FlatBuffers' own LookupByKey() gives a false
// warning in builds with sanitizers. The lists are short.)
template <class Entry>
[[nodiscard]] const Entry* FindNamed(const flatbuffers::Vector<flatbuffers::Offset<Entry>>& entries,
                                     std::string_view name) {
  for (const Entry* entry : entries) {
    if (entry->name()->string_view() == name) return entry;
  }
  return nullptr;
}

// The types of a FlatBuffers schema, to describe tables at run time.
class SchemaTypes {
 public:
  // `text`: the source of a schema. It has no types if the text is invalid.
  explicit SchemaTypes(const char* text);

  // `table`: returned by code that was generated from the same schema, or GetRoot<Table>().
  // `type`: its full name, such as "furrow.rig.schema.HingeDriver".
  template <class GeneratedTable>
  [[nodiscard]] DescribedTable Describe(const GeneratedTable* table, std::string_view type) const {
    // Generated tables only add functions to flatbuffers::Table, from which they derive privately.
    return {schema_, Find(type), reinterpret_cast<const flatbuffers::Table*>(table)};
  }

 private:
  [[nodiscard]] const reflection::Object* Find(std::string_view type) const;

  flatbuffers::DetachedBuffer buffer_;
  const reflection::Schema* schema_ = nullptr;  // in buffer_
};

}  // namespace furrow::rig
