// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/text_template.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/text.h"

namespace furrow::authoring {
namespace {

// A line "@each maps" with its comment signs removed.
struct Directive {
  std::string_view word;  // "each", "if", "unless" or "end"
  std::string_view name;
};

std::string_view Trimmed(std::string_view text, std::string_view signs) {
  const std::size_t first = text.find_first_not_of(signs);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(signs) - first + 1);
}

std::optional<Directive> DirectiveOf(std::string_view line) {
  const std::string_view text = Trimmed(line, " \t/#<!->");
  if (!text.starts_with('@') || text.starts_with("@{")) return std::nullopt;
  const std::size_t space = std::min(text.find(' '), text.size());
  const std::string_view word = text.substr(1, space - 1);
  if (word != "each" && word != "if" && word != "unless" && word != "end") return std::nullopt;
  return Directive{word, Trimmed(text.substr(space), " ")};
}

std::vector<std::string_view> Lines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

class Expander {
 public:
  Expander(std::string_view text, std::string_view name) : lines_(Lines(text)), name_(name) {}

  Result<std::string> Run(const TemplateData& data) {
    scopes_.push_back(&data);
    FURROW_RETURN_IF_ERROR(Expand(0, lines_.size()));
    return std::move(out_);
  }

 private:
  [[nodiscard]] Status Error(std::size_t line, std::string what) const {
    return {StatusCode::kParse, std::move(what), Where(name_, line + 1)};
  }

  // The line of the @end that closes the block that starts at `line`.
  Result<std::size_t> EndOf(std::size_t line, std::size_t last) const {
    int depth = 0;
    for (std::size_t i = line; i < last; ++i) {
      const auto directive = DirectiveOf(lines_[i]);
      if (!directive) continue;
      depth += directive->word == "end" ? -1 : 1;
      if (depth == 0) return i;
    }
    return Error(line, "the block has no @end");
  }

  Status Expand(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto directive = DirectiveOf(lines_[i]);
      if (!directive) {
        FURROW_RETURN_IF_ERROR(AppendLine(i));
        continue;
      }
      if (directive->word == "end") return Error(i, "@end without a block");
      const auto end = EndOf(i, last);
      FURROW_RETURN_IF_ERROR(end);
      FURROW_RETURN_IF_ERROR(ExpandBlock(*directive, i, *end));
      i = *end;
    }
    return {};
  }

  Status ExpandBlock(const Directive& directive, std::size_t begin, std::size_t end) {
    const std::string name(directive.name);
    const std::vector<TemplateData>* list = FindList(name);
    const std::string* text = FindText(name);
    if (list == nullptr && (text == nullptr || directive.word == "each")) {
      return Error(begin, "unknown name '" + name + "'");
    }
    if (directive.word == "each") {
      for (const TemplateData& entry : *list) {
        scopes_.push_back(&entry);
        FURROW_RETURN_IF_ERROR(Expand(begin + 1, end));
        scopes_.pop_back();
      }
      return {};
    }
    const bool is_set = list != nullptr ? !list->empty() : !text->empty();
    if (is_set != (directive.word == "if")) return {};
    return Expand(begin + 1, end);
  }

  Status AppendLine(std::size_t number) {
    std::string_view line = lines_[number];
    for (std::size_t at = line.find("@{"); at != std::string_view::npos; at = line.find("@{")) {
      const std::size_t end = line.find('}', at);
      if (end == std::string_view::npos) return Error(number, "'@{' without '}'");
      const std::string name(line.substr(at + 2, end - at - 2));
      const std::string* text = FindText(name);
      if (text == nullptr) return Error(number, "unknown name '" + name + "'");
      out_.append(line.substr(0, at)).append(*text);
      line.remove_prefix(end + 1);
    }
    out_.append(line).push_back('\n');
    return {};
  }

  [[nodiscard]] const std::string* FindText(const std::string& name) const {
    for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope) {
      const auto found = (*scope)->texts.find(name);
      if (found != (*scope)->texts.end()) return &found->second;
    }
    return nullptr;
  }

  [[nodiscard]] const std::vector<TemplateData>* FindList(const std::string& name) const {
    for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope) {
      const auto found = (*scope)->lists.find(name);
      if (found != (*scope)->lists.end()) return &found->second;
    }
    return nullptr;
  }

  std::vector<std::string_view> lines_;
  std::string_view name_;
  std::vector<const TemplateData*> scopes_;
  std::string out_;
};

}  // namespace

Result<std::string> ExpandTemplate(std::string_view text, const TemplateData& data,
                                   std::string_view name) {
  return Expander(text, name).Run(data);
}

}  // namespace furrow::authoring
