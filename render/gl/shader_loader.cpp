// SPDX-License-Identifier: Apache-2.0
#include "render/gl/shader_loader.h"

#include <algorithm>
#include <charconv>

#include "base/status.h"

namespace furrow::render {
namespace {

// Removes the first line from `text` and returns it without its line end.
std::string_view TakeLine(std::string_view* text) {
  const std::size_t end = std::min(text->find('\n'), text->size());
  const std::string_view line = text->substr(0, end);
  text->remove_prefix(std::min(end + 1, text->size()));
  return line;
}

// Replaces #include lines by the files that they name. Each file is included once, which also ends
// include cycles.
class Expander {
 public:
  Expander(std::span<const ShaderFile> files, ShaderSource* out) : files_(files), out_(out) {}

  Status Append(std::string_view name, const std::string& included_from) {
    if (std::find(out_->files.begin(), out_->files.end(), name) != out_->files.end()) return {};
    const auto file = std::find_if(files_.begin(), files_.end(),
                                   [&](const ShaderFile& f) { return f.name == name; });
    if (file == files_.end()) {
      return {StatusCode::kNotFound, "no shader file '" + std::string(name) + "'", included_from};
    }
    const std::size_t source = out_->files.size();
    out_->files.emplace_back(name);
    AppendLineDirective(1, source);
    std::string_view text = file->text;
    for (int line_number = 1; !text.empty(); ++line_number) {
      const std::string_view line = TakeLine(&text);
      if (!line.starts_with("#include")) {
        out_->text.append(line).push_back('\n');
        continue;
      }
      const std::string place = std::string(name) + ":" + std::to_string(line_number);
      FURROW_RETURN_IF_ERROR(Include(line, place));
      AppendLineDirective(line_number + 1, source);
    }
    return {};
  }

 private:
  Status Include(std::string_view line, const std::string& place) {
    const std::size_t first = line.find('"');
    const std::size_t last = line.rfind('"');
    if (first == std::string_view::npos || last == first) {
      return {StatusCode::kParse, "#include without a quoted name", place};
    }
    return Append(line.substr(first + 1, last - first - 1), place);
  }

  // Makes the driver's messages refer to the line and the number of the original file.
  // NameSources() replaces the number by the name.
  void AppendLineDirective(int line, std::size_t source) {
    out_->text += "#line " + std::to_string(line) + " " + std::to_string(source) + "\n";
  }

  std::span<const ShaderFile> files_;
  ShaderSource* out_;
};

}  // namespace

Result<ShaderSource> ExpandShader(std::string_view name, std::span<const std::string> defines,
                                  std::span<const ShaderFile> files) {
  ShaderSource source;
  source.text = "#version 450 core\n";
  for (const std::string& define : defines) source.text += "#define " + define + "\n";
  Expander expander(files, &source);
  FURROW_RETURN_IF_ERROR(expander.Append(name, {}));
  return source;
}

std::string NameSources(std::string_view log, std::span<const std::string> files) {
  std::string named;
  while (!log.empty()) {
    const std::string_view line = TakeLine(&log);
    std::size_t source = 0;
    const char* end = line.data() + line.size();
    const auto parsed = std::from_chars(line.data(), end, source);
    const bool is_source = parsed.ec == std::errc() && parsed.ptr != end && source < files.size() &&
                           (*parsed.ptr == ':' || *parsed.ptr == '(');
    if (is_source) {
      named.append(files[source]).append(parsed.ptr, end);
    } else {
      named.append(line);
    }
    named.push_back('\n');
  }
  return named;
}

}  // namespace furrow::render
