// SPDX-License-Identifier: Apache-2.0
#include "rig/json/field_reader.h"

#include "rig/json/rig_tables.h"

namespace furrow::rig {
namespace {

// The list of numbers in a field; empty if the file omits it.
template <class Number>
void ReadNumbers(const flatbuffers::Table& table, const reflection::Field& field,
                 std::vector<Number>* to) {
  const auto* list = flatbuffers::GetFieldV<Number>(table, field);
  if (list != nullptr) to->assign(list->begin(), list->end());
}

}  // namespace

// A mismatch of a list of fields and the schema is a fault of the program, not of the file.
const reflection::Field* TableReader::Unknown(const char* name) {
  status_ = {StatusCode::kInternal,
             std::string("the schema has no field '") + name + "' of the program's type",
             Path(name)};
  return nullptr;
}

const reflection::Field* TableReader::Find(const char* name, reflection::BaseType type,
                                           reflection::BaseType element) {
  if (!status_.ok()) return nullptr;
  const reflection::Field* field =
      from_.type == nullptr ? nullptr : FindNamed(*from_.type->fields(), name);
  const bool matches =
      field != nullptr && field->type()->base_type() == type && field->type()->element() == element;
  return matches ? field : Unknown(name);
}

bool TableReader::IsStruct(const reflection::Field& field) const {
  const auto type = static_cast<flatbuffers::uoffset_t>(field.type()->index());
  return from_.schema->objects()->Get(type)->is_struct();
}

const reflection::Field* TableReader::FindTables(const char* name, reflection::BaseType type,
                                                 reflection::BaseType element) {
  const reflection::Field* field = Find(name, type, element);
  if (field == nullptr || !IsStruct(*field)) return field;
  return Unknown(name);
}

// A null pointer below is an optional field that the file omits: the parser has already rejected
// files without the required ones.
void TableReader::Read(const char* name, std::string* to) {
  const reflection::Field* field = Find(name, reflection::String);
  if (field == nullptr) return;
  const flatbuffers::String* text = flatbuffers::GetFieldS(*from_.table, *field);
  if (text != nullptr) *to = text->str();
}

void TableReader::Read(const char* name, float* to) {
  const reflection::Field* field = Find(name, reflection::Float);
  if (field != nullptr) *to = flatbuffers::GetFieldF<float>(*from_.table, *field);
}

void TableReader::Read(const char* name, int* to) {
  const reflection::Field* field = Find(name, reflection::Int);
  if (field != nullptr) *to = flatbuffers::GetFieldI<std::int32_t>(*from_.table, *field);
}

void TableReader::Read(const char* name, bool* to) {
  const reflection::Field* field = Find(name, reflection::Bool);
  if (field != nullptr) *to = flatbuffers::GetFieldI<std::uint8_t>(*from_.table, *field) != 0;
}

void TableReader::Read(const char* name, std::optional<glm::vec3>* to) {
  const reflection::Field* field = Find(name, reflection::Obj);
  if (field == nullptr) return;
  const auto type = static_cast<flatbuffers::uoffset_t>(field->type()->index());
  const auto size = static_cast<std::size_t>(from_.schema->objects()->Get(type)->bytesize());
  if (!IsStruct(*field) || size != sizeof(schema::Vec3)) {
    Unknown(name);
    return;
  }
  const auto* v = from_.table->GetStruct<const schema::Vec3*>(field->offset());
  if (v != nullptr) *to = ToVec3(*v);
}

void TableReader::Read(const char* name, glm::vec3* to) {
  std::optional<glm::vec3> v;
  Read(name, &v);
  *to = v.value_or(*to);
}

void TableReader::Read(const char* name, std::vector<std::string>* to) {
  const reflection::Field* field = Find(name, reflection::Vector, reflection::String);
  if (field == nullptr) return;
  const auto* list =
      flatbuffers::GetFieldV<flatbuffers::Offset<flatbuffers::String>>(*from_.table, *field);
  if (list == nullptr) return;
  to->clear();
  for (const flatbuffers::String* text : *list) to->push_back(text->str());
}

void TableReader::Read(const char* name, std::vector<float>* to) {
  const reflection::Field* field = Find(name, reflection::Vector, reflection::Float);
  if (field != nullptr) ReadNumbers(*from_.table, *field, to);
}

void TableReader::Read(const char* name, std::vector<int>* to) {
  const reflection::Field* field = Find(name, reflection::Vector, reflection::Int);
  if (field != nullptr) ReadNumbers(*from_.table, *field, to);
}

std::optional<int> TableReader::ReadChoice(const char* name, std::size_t count) {
  const reflection::Field* field = Find(name, reflection::Byte);
  if (field == nullptr) return std::nullopt;
  const int choice = flatbuffers::GetFieldI<std::int8_t>(*from_.table, *field);
  if (choice < 0 || static_cast<std::size_t>(choice) >= count) {
    status_ = wrinkle::InvalidField("invalid choice", Path(name));
    return std::nullopt;
  }
  return choice;
}

}  // namespace furrow::rig
