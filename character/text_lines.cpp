// SPDX-License-Identifier: Apache-2.0
#include "character/text_lines.h"

#include <charconv>
#include <system_error>

#include "character/asset_path.h"

namespace furrow::character {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{256} << 20;

template <class T>
std::optional<T> ToNumber(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

Result<std::string> ReadTextFile(const std::filesystem::path& path) {
  return ReadFile(path, kMaxFileBytes);
}

bool LineReader::Next(std::string_view* line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  *line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line->empty() && line->back() == '\r') line->remove_suffix(1);
  ++line_number_;
  return true;
}

void SplitWords(std::string_view line, std::vector<std::string_view>* words) {
  words->clear();
  line = line.substr(0, line.find('#'));
  for (std::size_t begin = line.find_first_not_of(" \t"); begin != std::string_view::npos;) {
    const std::size_t end = line.find_first_of(" \t", begin);
    words->push_back(line.substr(begin, end == std::string_view::npos ? end : end - begin));
    begin = line.find_first_not_of(" \t", end);
  }
}

std::optional<float> ToFloat(std::string_view word) { return ToNumber<float>(word); }

std::optional<long> ToInteger(std::string_view word) { return ToNumber<long>(word); }

std::string Where(std::string_view source, int line) {
  return std::string(source) + ":" + std::to_string(line);
}

std::string Quoted(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string text = "'";
  for (const char c : word.substr(0, kLongest))
    text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return text + (word.size() > kLongest ? "...'" : "'");
}

}  // namespace furrow::character
