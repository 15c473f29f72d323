// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "base/status.h"
#include "rig/json/described_table.h"
#include "wrinkle/fields/field_list.h"
#include "wrinkle/fields/rig_field.h"

namespace furrow::rig {

// Reads the fields of one table by name. The first error stays, and later fields are not read.
// Fields that the file omits get the schema's default, or keep their value if the schema has none.
class TableReader {
 public:
  // `at` is the path of the table: "drivers[3].hinge".
  TableReader(const DescribedTable& from, std::string at) : from_(from), at_(std::move(at)) {}

  void Read(const char* name, std::string* to);
  void Read(const char* name, float* to);
  void Read(const char* name, int* to);
  void Read(const char* name, bool* to);
  void Read(const char* name, glm::vec3* to);
  void Read(const char* name, std::optional<glm::vec3>* to);
  void Read(const char* name, std::vector<std::string>* to);
  void Read(const char* name, std::vector<float>* to);
  void Read(const char* name, std::vector<int>* to);
  template <wrinkle::ListsFields T>
  void Read(const char* name, T* to);
  template <wrinkle::ListsFields T>
  void Read(const char* name, std::vector<T>* to);
  // The number of a choice, in [0, count). JSON may give a choice as any number.
  [[nodiscard]] std::optional<int> ReadChoice(const char* name, std::size_t count);

  // The first error, or Ok.
  [[nodiscard]] Status Take() { return std::move(status_); }

 private:
  // The field, or nullptr after an error. It is an error if the schema has no such field.
  // `element`: of a list. FindTables() also rejects structs, which have another layout.
  const reflection::Field* Find(const char* name, reflection::BaseType type,
                                reflection::BaseType element = reflection::None);
  const reflection::Field* FindTables(const char* name, reflection::BaseType type,
                                      reflection::BaseType element = reflection::None);
  const reflection::Field* Unknown(const char* name);
  [[nodiscard]] bool IsStruct(const reflection::Field& field) const;
  [[nodiscard]] std::string Path(const char* name) const { return at_ + "." + name; }
  template <class T>
  void ReadNested(const reflection::Field& field, const flatbuffers::Table* table,
                  const std::string& at, T* to);

  DescribedTable from_;
  std::string at_;
  Status status_;
};

// Visits the fields that T lists (wrinkle/fields/field_list.h) and reads each.
template <class T>
class FieldReader {
 public:
  FieldReader(TableReader* from, T* to) : from_(from), to_(to) {}

  template <class Member>
  void Required(const char* name, Member T::*member) {
    from_->Read(name, &(to_->*member));
  }
  template <class Member>
  void Optional(const char* name, Member T::*member) {
    from_->Read(name, &(to_->*member));
  }
  template <class Enum>
  void Choice(const char* name, Enum T::*member, std::initializer_list<const char*> names) {
    const std::optional<int> choice = from_->ReadChoice(name, names.size());
    if (choice) to_->*member = static_cast<Enum>(*choice);
  }

 private:
  TableReader* from_;
  T* to_;
};

// Reads all fields that T lists. Errors: kInvalidArgument (a choice out of range), kInternal (the
// list does not match the schema). The error's `where` is the path of the field.
template <wrinkle::ListsFields T>
[[nodiscard]] Status ReadFields(const DescribedTable& from, const std::string& at, T* to) {
  TableReader table(from, at);
  FieldReader<T> reader(&table, to);
  T::ListFields(reader);
  return table.Take();
}

template <class T>
void TableReader::ReadNested(const reflection::Field& field, const flatbuffers::Table* table,
                             const std::string& at, T* to) {
  const auto type = static_cast<flatbuffers::uoffset_t>(field.type()->index());
  status_ = ReadFields({from_.schema, from_.schema->objects()->Get(type), table}, at, to);
}

template <wrinkle::ListsFields T>
void TableReader::Read(const char* name, T* to) {
  const reflection::Field* field = FindTables(name, reflection::Obj);
  if (field == nullptr) return;
  const flatbuffers::Table* table = flatbuffers::GetFieldT(*from_.table, *field);
  if (table != nullptr) ReadNested(*field, table, Path(name), to);
}

template <wrinkle::ListsFields T>
void TableReader::Read(const char* name, std::vector<T>* to) {
  const reflection::Field* field = FindTables(name, reflection::Vector, reflection::Obj);
  if (field == nullptr) return;
  const auto* list =
      flatbuffers::GetFieldV<flatbuffers::Offset<flatbuffers::Table>>(*from_.table, *field);
  if (list == nullptr) return;
  to->clear();
  for (flatbuffers::uoffset_t i = 0; i < list->size() && status_.ok(); ++i) {
    ReadNested(*field, list->Get(i), wrinkle::FieldAt(Path(name), i), &to->emplace_back());
  }
}

}  // namespace furrow::rig
