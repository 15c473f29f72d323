// SPDX-License-Identifier: Apache-2.0
#include "base/checked_json.h"

#include <charconv>
#include <utility>

#include <flatbuffers/idl.h>

namespace furrow {
namespace {

// An error of the FlatBuffers parser, such as "12: 34: error: unknown field: drivrs, originally
// at: ...". Line and column are turned into a field path for our own message.
struct ParserError {
  int line = 1;
  int column = 0;
  std::string what;
};

// Splits "line: column: error: what, originally at: ..." and ignores the parts that are absent.
ParserError SplitParserError(std::string_view text) {
  ParserError result;
  const auto number = [&](int* value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
    if (error != std::errc()) return;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    while (!text.empty() && (text.front() == ':' || text.front() == ' ')) text.remove_prefix(1);
  };
  number(&result.line);
  number(&result.column);
  constexpr std::string_view kPrefix = "error: ";
  if (text.starts_with(kPrefix)) text.remove_prefix(kPrefix.size());
  result.what = text.substr(0, text.find(", originally at"));
  return result;
}

// Turns the parser's place into a field. The parser notices a missing field at the end of its
// object, so the object that closed last lacks it.
Status FromParser(const std::string& error, const JsonIndex& index, const std::string& source,
                  const JsonSchema& schema) {
  const ParserError parsed = SplitParserError(error);
  constexpr std::string_view kMissing = "required field is missing: ";
  std::string path;
  std::string what = parsed.what;
  if (what.starts_with(kMissing)) {
    const std::size_t in = what.rfind(" in ");
    const std::string field = what.substr(kMissing.size(), in - kMissing.size());
    const bool of_root = what.substr(in) == std::string(" in ") + schema.root;
    path = of_root ? "" : index.PathClosedBefore(parsed.line, parsed.column);
    path += (path.empty() ? "" : ".") + field;
    what = "the required field is missing";
  } else {
    path = index.PathAt(parsed.line, parsed.column);
  }
  // The parser's message for a struct, such as a vector, with too many or too few numbers. The
  // place is inside the list.
  if (what == "wrong number of unnamed fields in table vector") {
    what = "the list has the wrong number of entries";
    path = path.substr(0, path.rfind('['));
  }
  return {StatusCode::kSchema, what, source + ":" + index.Where(path),
          std::string(schema.file) + " lists the fields"};
}

}  // namespace

struct CheckedJson::Parsed {
  Parsed(std::string_view name, JsonIndex fields, const flatbuffers::IDLOptions& options)
      : source(name), index(std::move(fields)), parser(options) {}
  std::string source;
  JsonIndex index;
  flatbuffers::Parser parser;
};

Result<CheckedJson> CheckedJson::Parse(std::string_view json, std::string_view source,
                                       const JsonSchema& schema) {
  // The index comes first. It bounds size and depth, which the FlatBuffers parser does not.
  Result<JsonIndex> index = JsonIndex::Create(json);
  if (!index.ok()) {
    const Status s = index.status();
    return Status(s.code(), s.what(), std::string(source) + ":" + s.where(), s.todo());
  }
  flatbuffers::IDLOptions options;
  options.strict_json = true;
  auto parsed = std::make_unique<Parsed>(source, std::move(*index), options);
  if (!parsed->parser.Parse(schema.text)) {
    return Status(StatusCode::kInternal,
                  std::string(schema.file) + " does not parse: " + parsed->parser.error_);
  }
  // The copy ends with a zero byte, which the parser requires.
  if (!parsed->parser.ParseJson(std::string(json).c_str())) {
    return FromParser(parsed->parser.error_, parsed->index, parsed->source, schema);
  }
  return CheckedJson(std::move(parsed));
}

CheckedJson::CheckedJson(std::unique_ptr<Parsed> parsed) : parsed_(std::move(parsed)) {}
CheckedJson::CheckedJson(CheckedJson&&) noexcept = default;
CheckedJson& CheckedJson::operator=(CheckedJson&&) noexcept = default;
CheckedJson::~CheckedJson() = default;

const std::uint8_t* CheckedJson::buffer() const {
  return parsed_->parser.builder_.GetBufferPointer();
}

Status CheckedJson::Located(const Status& status) const {
  return {status.code(), status.what(),
          parsed_->source + ":" + parsed_->index.Where(status.where()), status.todo()};
}

}  // namespace furrow
