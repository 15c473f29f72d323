// SPDX-License-Identifier: Apache-2.0
#include "rig/json/described_table.h"

#include <flatbuffers/idl.h>

namespace furrow::rig {

SchemaTypes::SchemaTypes(const char* text) {
  flatbuffers::Parser parser;
  if (!parser.Parse(text)) return;
  parser.Serialize();
  buffer_ = parser.builder_.Release();
  schema_ = reflection::GetSchema(buffer_.data());
}

const reflection::Object* SchemaTypes::Find(std::string_view type) const {
  return schema_ == nullptr ? nullptr : FindNamed(*schema_->objects(), type);
}

}  // namespace furrow::rig
