// SPDX-License-Identifier: Apache-2.0
#include "base/process/helper_reply.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace furrow {
namespace {

constexpr std::size_t kMaxTextBytes = 1u << 16;
constexpr std::uint32_t kMaxNotes = 1u << 16;

void AppendNumber(std::uint32_t number, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&number), sizeof number);
}

void AppendText(std::string_view text, std::string* bytes) {
  text = text.substr(0, kMaxTextBytes);
  AppendNumber(static_cast<std::uint32_t>(text.size()), bytes);
  bytes->append(text);
}

bool TakeNumber(std::string_view* bytes, std::uint32_t* number) {
  if (bytes->size() < sizeof *number) return false;
  std::memcpy(number, bytes->data(), sizeof *number);
  bytes->remove_prefix(sizeof *number);
  return true;
}

bool TakeText(std::string_view* bytes, std::string* text) {
  std::uint32_t length = 0;
  if (!TakeNumber(bytes, &length) || length > bytes->size()) return false;
  *text = bytes->substr(0, length);
  bytes->remove_prefix(length);
  return true;
}

Status NoReply() {
  return {StatusCode::kParse, "converting the file failed: the program's answer is incomplete"};
}

// The first byte is a StatusCode; the texts of the status follow.
Status DecodeStatus(std::string_view bytes) {
  const auto code = static_cast<StatusCode>(bytes.front());
  bytes.remove_prefix(1);
  std::array<std::string, 3> texts;
  if (code < StatusCode::kInvalidArgument || code > StatusCode::kInternal) return NoReply();
  for (std::string& text : texts) {
    if (!TakeText(&bytes, &text)) return NoReply();
  }
  return {code, texts[0], texts[1], texts[2]};
}

}  // namespace

std::string EncodeReply(const Result<HelperReply>& reply) {
  std::string bytes(1, static_cast<char>(reply.status().code()));
  if (!reply.ok()) {
    const Status status = reply.status();
    for (const std::string* text : {&status.what(), &status.where(), &status.todo()})
      AppendText(*text, &bytes);
    return bytes;
  }
  const std::size_t notes = std::min<std::size_t>(reply->notes.size(), kMaxNotes);
  AppendNumber(static_cast<std::uint32_t>(notes), &bytes);
  for (std::size_t i = 0; i < notes; ++i) AppendText(reply->notes[i], &bytes);
  return bytes + reply->payload;
}

Result<HelperReply> DecodeReply(std::string_view bytes) {
  if (bytes.empty()) return NoReply();
  if (bytes.front() != '\0') return DecodeStatus(bytes);
  bytes.remove_prefix(1);
  HelperReply reply;
  std::uint32_t notes = 0;
  if (!TakeNumber(&bytes, &notes) || notes > kMaxNotes) return NoReply();
  for (std::uint32_t i = 0; i < notes; ++i) {
    if (!TakeText(&bytes, &reply.notes.emplace_back())) return NoReply();
  }
  reply.payload = bytes;
  return reply;
}

}  // namespace furrow
