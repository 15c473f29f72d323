// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/token/key_ring.h"

#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <optional>

#include "base/files.h"
#include "base/text.h"
#include "base/utc_time.h"
#include "protocol/secure/crypto/base64url.h"

namespace furrow::protocol::secure {
namespace {

constexpr std::uint64_t kMaxKeyFileBytes = 64 * 1024;
constexpr std::string_view kFirstLine = "furrow-keys 1";
constexpr std::string_view kComment =
    "# The keys that seal connect tokens. Everybody who has them can make tokens: keep this file\n"
    "# readable by its owner alone (chmod 600). 'furrow token key' changes it.\n";

// One line: key ID created TIME expires TIME BASE64URL.
Result<TokenKey> ParseKey(const std::vector<std::string_view>& words, const std::string& where) {
  if (words.size() != 7 || words[0] != "key" || words[2] != "created" || words[4] != "expires") {
    return Status(StatusCode::kParse, "expected 'key ID created TIME expires TIME KEY'", where);
  }
  TokenKey key;
  if (!ParseKeyId(words[1], key.id)) {
    return Status(StatusCode::kParse,
                  Quoted(words[1]) + " is not an id of 1 to 8 hexadecimal digits", where);
  }
  const auto created = ParseUtc(words[3]);
  const auto expires = ParseUtc(words[5]);
  if (!created || !expires) {
    return Status(
        StatusCode::kParse,
        Quoted(created ? words[5] : words[3]) + " is not a time such as 2026-05-14T09:30:00Z",
        where);
  }
  key.created = *created;
  key.expires = *expires;
  // The message must not repeat what may be most of a key.
  if (!FromBase64Url(words[6], key.key.bytes())) {
    return Status(StatusCode::kParse, "the key is not base64url of 32 bytes", where);
  }
  return key;
}

}  // namespace

const TokenKey* KeyRing::Find(std::uint32_t id) const {
  const auto found =
      std::find_if(keys_.begin(), keys_.end(), [id](const TokenKey& key) { return key.id == id; });
  return found == keys_.end() ? nullptr : &*found;
}

const TokenKey* KeyRing::Newest(std::uint64_t now) const {
  const TokenKey* newest = nullptr;
  for (const TokenKey& key : keys_) {
    // Of keys made in one second, the last of the file.
    if (now < key.expires && (newest == nullptr || key.created >= newest->created)) newest = &key;
  }
  return newest;
}

Result<std::uint32_t> KeyRing::AddNew(std::uint64_t now, std::uint64_t expires,
                                      RandomSource& random) {
  if (keys_.size() >= kMaxKeys) {
    return Status(StatusCode::kLimit, "the file has " + std::to_string(kMaxKeys) + " keys already",
                  "", "remove old ones with 'furrow token key retire'");
  }
  TokenKey key;
  do {
    key.id = random.Number<std::uint32_t>();
  } while (key.id == 0 || Find(key.id) != nullptr);
  key.created = now;
  key.expires = expires;
  key.key = random.MakeKey();
  keys_.push_back(key);
  return key.id;
}

bool KeyRing::Remove(std::uint32_t id) {
  return std::erase_if(keys_, [id](const TokenKey& key) { return key.id == id; }) > 0;
}

std::string KeyRing::ToText() const {
  std::string text = std::string(kFirstLine) + "\n" + std::string(kComment);
  for (const TokenKey& key : keys_) {
    text += "key " + KeyIdText(key.id) + " created " + FormatUtc(key.created) + " expires " +
            FormatUtc(key.expires) + " " + ToBase64Url(key.key.bytes()) + "\n";
  }
  return text;
}

Result<KeyRing> KeyRing::Parse(std::string_view text, std::string_view source) {
  KeyRing ring;
  std::vector<std::string_view> words;
  bool has_first_line = false;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view content = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (content.ends_with('\r')) content.remove_suffix(1);
    const std::string where = Where(source, line);
    if (!has_first_line) {
      if (content != kFirstLine) {
        return Status(StatusCode::kParse,
                      "not a key file: it must begin with '" + std::string(kFirstLine) + "'", where,
                      "make one with 'furrow token key new'");
      }
      has_first_line = true;
      continue;
    }
    SplitWords(content, &words);
    if (words.empty()) continue;
    const auto key = ParseKey(words, where);
    FURROW_RETURN_IF_ERROR(key);
    if (ring.Find(key->id) != nullptr) {
      return Status(StatusCode::kParse, "a second key " + KeyIdText(key->id), where);
    }
    if (ring.keys_.size() >= kMaxKeys) {
      return Status(StatusCode::kLimit, "more than " + std::to_string(kMaxKeys) + " keys", where);
    }
    ring.keys_.push_back(*key);
  }
  if (!has_first_line) {
    return Status(StatusCode::kParse, "the file is empty", std::string(source),
                  "make one with 'furrow token key new'");
  }
  return ring;
}

std::string KeyIdText(std::uint32_t id) {
  char text[16];
  std::snprintf(text, sizeof text, "%08" PRIx32, id);
  return text;
}

bool ParseKeyId(std::string_view text, std::uint32_t& id) {
  if (text.empty() || text.size() > 8) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id, 16);
  return error == std::errc() && end == text.data() + text.size();
}

Result<KeyRing> LoadKeyRing(const std::filesystem::path& path) {
  auto text = ReadSecretFile(path, kMaxKeyFileBytes);
  FURROW_RETURN_IF_ERROR(text);
  auto ring = KeyRing::Parse(*text, path.string());
  Wipe({reinterpret_cast<std::uint8_t*>(text->data()), text->size()});
  return ring;
}

Status SaveKeyRing(const KeyRing& ring, const std::filesystem::path& path) {
  std::string text = ring.ToText();
  const Status status = WriteSecretFile(path, text);
  Wipe({reinterpret_cast<std::uint8_t*>(text.data()), text.size()});
  return status;
}

}  // namespace furrow::protocol::secure
