// SPDX-License-Identifier: Apache-2.0
#include "character/rig_file.h"

#include <charconv>
#include <utility>

#include <flatbuffers/idl.h>

#include "character/rig_check.h"
#include "character/rig_generated.h"
#include "character/rig_json_index.h"
#include "character/rig_reader.h"
#include "character/rig_schema_text.h"

namespace furrow::character {
namespace {

// FlatBuffers says "12: 34: error: unknown field: drivrs, originally at: ..."; we say where by
// field.
struct ParserComplaint {
  int line = 1;
  int column = 0;
  std::string what;
};

ParserComplaint Dissect(std::string_view text) {
  ParserComplaint complaint;
  const auto number = [&](int* value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
    if (error != std::errc()) return;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    while (!text.empty() && (text.front() == ':' || text.front() == ' ')) text.remove_prefix(1);
  };
  number(&complaint.line);
  number(&complaint.column);
  constexpr std::string_view kPrefix = "error: ";
  if (text.starts_with(kPrefix)) text.remove_prefix(kPrefix.size());
  complaint.what = text.substr(0, text.find(", originally at"));
  return complaint;
}

Status FromParser(const std::string& error, const JsonIndex& index, const std::string& source) {
  const ParserComplaint complaint = Dissect(error);
  constexpr std::string_view kMissing = "required field is missing: ";
  std::string path;
  std::string what = complaint.what;
  if (what.starts_with(kMissing)) {
    const std::size_t in = what.rfind(" in ");
    const std::string field = what.substr(kMissing.size(), in - kMissing.size());
    const bool of_root = what.substr(in) == " in Rig";
    path = of_root ? "" : index.PathClosedBefore(complaint.line, complaint.column);
    path += (path.empty() ? "" : ".") + field;
    what = "the field is missing";
  } else {
    path = index.PathAt(complaint.line, complaint.column);
  }
  if (what == "wrong number of unnamed fields in table vector") {
    what = "the list has too few or too many entries";
    path = path.substr(0, path.rfind('['));
  }
  return {StatusCode::kSchema, what, source + ":" + index.Where(path),
          "character/rig.fbs lists the fields"};
}

Status Located(const Status& status, const JsonIndex& index, const std::string& source) {
  return {status.code(), status.what(), source + ":" + index.Where(status.where()), status.todo()};
}

}  // namespace

std::string_view RigSchemaText() { return kRigSchemaText; }

Result<wrinkle::Rig> ParseRig(std::string_view json, std::string_view source_name,
                              const std::filesystem::path& folder,
                              const wrinkle::PoseSource& poses) {
  const std::string source(source_name);
  const Result<JsonIndex> index = JsonIndex::Create(json);
  if (!index.ok()) {
    const Status s = index.status();
    return Status(s.code(), s.what(), source + ":" + s.where(), s.todo());
  }
  flatbuffers::IDLOptions options;
  options.strict_json = true;
  flatbuffers::Parser parser(options);
  if (!parser.Parse(kRigSchemaText)) {
    return Status(StatusCode::kInternal, "rig.fbs does not parse: " + parser.error_);
  }
  if (!parser.ParseJson(std::string(json).c_str())) {
    return FromParser(parser.error_, *index, source);
  }
  const auto* tables = flatbuffers::GetRoot<schema::Rig>(parser.builder_.GetBufferPointer());
  Result<wrinkle::Rig> rig = ReadRigTables(*tables, folder, poses);
  if (!rig.ok()) return Located(rig.status(), *index, source);
  if (Status status = CheckRig(*rig); !status.ok()) return Located(status, *index, source);
  DropBuildingBlocks(*tables, &*rig);
  return rig;
}

Result<wrinkle::Rig> LoadRig(const std::filesystem::path& path, const wrinkle::PoseSource& poses) {
  const Result<std::string> text = ReadFile(path, JsonIndex::kMaxBytes);
  if (!text.ok()) return text.status();
  return ParseRig(*text, path.string(), path.parent_path(), poses);
}

Status SaveRig(const wrinkle::Rig& rig, const std::filesystem::path& path) {
  if (const Status s = CheckRig(rig); !s.ok()) {
    return {s.code(), s.what(), path.string() + ": " + s.where(), s.todo()};
  }
  return WriteFileAtomically(path, RigToJson(rig));
}

}  // namespace furrow::character
