// SPDX-License-Identifier: Apache-2.0
#include "gltf/container/uri.h"

#include <array>
#include <cstddef>
#include <string>

#include "base/asset_path.h"
#include "base/text.h"

namespace furrow::gltf {
namespace {

constexpr std::string_view kBase64Marker = ";base64,";

constexpr std::array<std::int8_t, 256> MakeBase64Table() {
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::int8_t, 256> table{};
  table.fill(-1);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
    table[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::int8_t>(i);
  }
  return table;
}

int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// The text of a URI without %xx escapes. Decoding comes before the check of the name, so that
// "%2e%2e/" cannot pass it.
Result<std::string> DecodePercentEscapes(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      text += uri[i];
      continue;
    }
    const int high = i + 1 < uri.size() ? HexDigit(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? HexDigit(uri[i + 2]) : -1;
    if (high < 0 || low < 0) {
      return Status(StatusCode::kInvalidArgument,
                    "the file name " + Quoted(uri) + " has a broken percent escape");
    }
    text += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return text;
}

}  // namespace

bool IsDataUri(std::string_view uri) { return uri.starts_with("data:"); }

Result<std::vector<std::uint8_t>> DecodeDataUri(std::string_view uri) {
  static constexpr std::array<std::int8_t, 256> kTable = MakeBase64Table();
  const Status broken(StatusCode::kParse, "is not a base64 data URI");
  const std::size_t marker = uri.find(kBase64Marker);
  if (!IsDataUri(uri) || marker == std::string_view::npos) return broken;
  std::string_view text = uri.substr(marker + kBase64Marker.size());
  // Padding is optional: some exporters leave it out.
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  if (text.size() % 4 == 1) return broken;  // 6 bits do not make a byte
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int num_bits = 0;
  for (const char c : text) {
    const int value = kTable[static_cast<unsigned char>(c)];
    if (value < 0) return broken;
    // At most 13 bits are pending; the mask keeps the shift from overflowing.
    bits = (bits << 6 | static_cast<std::uint32_t>(value)) & 0xFFFF;
    num_bits += 6;
    if (num_bits < 8) continue;
    num_bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> num_bits & 0xFF));
  }
  return bytes;
}

Result<std::filesystem::path> FindExternalFile(std::string_view uri,
                                               const std::optional<std::filesystem::path>& folder) {
  if (!folder) {
    return Status(StatusCode::kUnsupported, "refers to the external file " + Quoted(uri) +
                                                ", but there is no folder to search");
  }
  const Result<std::string> name = DecodePercentEscapes(uri);
  FURROW_RETURN_IF_ERROR(name);
  return FindAsset(*name, *folder);
}

}  // namespace furrow::gltf
