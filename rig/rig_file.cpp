// SPDX-License-Identifier: Apache-2.0
#include "rig/rig_file.h"

#include <flatbuffers/flatbuffers.h>

#include "base/checked_json.h"
#include "base/data_dir.h"
#include "base/files.h"
#include "base/json_index.h"
#include "base/status.h"
#include "rig/rig_check.h"
#include "rig/rig_generated.h"
#include "rig/rig_reader.h"
#include "rig/rig_schema_text.h"

namespace furrow::rig {

std::string_view RigSchemaText() { return kRigSchemaText; }

Result<wrinkle::Rig> ParseRig(std::string_view json, std::string_view source_name,
                              const std::filesystem::path& folder, const wrinkle::PoseSource& poses,
                              std::set<std::string>* missing) {
  const Result<CheckedJson> checked =
      CheckedJson::Parse(json, source_name, {kRigSchemaText, "Rig", "rig/rig.fbs"});
  FURROW_RETURN_IF_ERROR(checked);
  const auto* tables = flatbuffers::GetRoot<schema::Rig>(checked->buffer());
  // The tables give errors by field; Located() adds file and line from the text.
  Result<wrinkle::Rig> rig = ReadRigTables(*tables, folder, poses, missing);
  if (!rig.ok()) return checked->Located(rig.status());
  if (Status status = CheckRig(*rig); !status.ok()) return checked->Located(status);
  // After the check, because errors name reference poses by their place in the file.
  DropBuildingBlocks(*tables, &*rig);
  return rig;
}

std::filesystem::path FindRigFile(const std::string& name_or_file) {
  return FileOrShipped(name_or_file, "rigs", ".json");
}

Result<wrinkle::Rig> LoadRig(const std::filesystem::path& path, const wrinkle::PoseSource& poses,
                             std::set<std::string>* missing) {
  // The same limit as the parser's, so that a larger file is never read into memory.
  const Result<std::string> text = ReadFile(path, JsonIndex::kMaxBytes);
  // FindRigFile() leaves a name that it does not know as it is.
  if (text.status().code() == StatusCode::kNotFound && !path.has_parent_path()) {
    return NotShipped("rig", "rigs", ".json", path.string());
  }
  FURROW_RETURN_IF_ERROR(text);
  return ParseRig(*text, path.string(), path.parent_path(), poses, missing);
}

Status SaveRig(const wrinkle::Rig& rig, const std::filesystem::path& path) {
  if (const Status s = CheckRig(rig); !s.ok()) {
    return {s.code(), s.what(), path.string() + ": " + s.where(), s.todo()};
  }
  return WriteFileAtomically(path, RigToJson(rig));
}

}  // namespace furrow::rig
