// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/token/connect_token.h"

#include <algorithm>

#include "protocol/messages/bytes.h"
#include "protocol/messages/pattern.h"
#include "protocol/messages/text.h"

namespace furrow::protocol::secure {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic = {'F', 'R', 'T', 'K'};
constexpr std::uint8_t kVersion = 1;

// Offsets in the public part.
constexpr std::size_t kVersionAt = 4;
constexpr std::size_t kReservedAt = 5;
constexpr std::size_t kKeyIdAt = 8;
constexpr std::size_t kExpiresAt = 12;
constexpr std::size_t kNonceAt = 20;
static_assert(kNonceAt + kTokenNonceBytes == kTokenPublicBytes);

// Offsets in the private part.
constexpr std::size_t kClientIdAt = 0;
constexpr std::size_t kKeyAt = 8;
constexpr std::size_t kRolesAt = 40;
constexpr std::size_t kPrivateReservedAt = 42;
constexpr std::size_t kRateAt = 44;
constexpr std::size_t kAudienceAt = 48;
constexpr std::size_t kSubjectsAt = 96;
static_assert(kAudienceAt + 1 + kMaxAudienceBytes == kSubjectsAt);
static_assert(kSubjectsAt + 1 + kMaxSubjectsBytes == kTokenPrivateBytes);

using PrivatePart = Secret<kTokenPrivateBytes>;

bool IsZero(ByteView bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte == 0; });
}

// A text field: one byte with the length, the text, zeros.
void WriteText(std::string_view text, ByteSpan field) {
  field[0] = static_cast<std::uint8_t>(text.size());
  std::copy(text.begin(), text.end(), field.begin() + 1);
}

bool ReadText(ByteView field, std::string& text) {
  const std::size_t size = field[0];
  if (size >= field.size() || !IsZero(field.subspan(1 + size))) return false;
  text.assign(reinterpret_cast<const char*>(field.data()) + 1, size);
  return IsPlainText(text);
}

void WriteHead(const TokenHead& head, ByteSpan out) {
  std::copy(kMagic.begin(), kMagic.end(), out.begin());
  out[kVersionAt] = kVersion;
  StoreLittle(head.key_id, &out[kKeyIdAt]);
  StoreLittle(head.expires, &out[kExpiresAt]);
  std::copy(head.nonce.begin(), head.nonce.end(), out.begin() + kNonceAt);
}

ByteSpan AudienceOf(ByteSpan part) { return part.subspan(kAudienceAt, 1 + kMaxAudienceBytes); }
ByteSpan SubjectsOf(ByteSpan part) { return part.subspan(kSubjectsAt, 1 + kMaxSubjectsBytes); }

void WritePrivate(const Grant& grant, const Key& key, ByteSpan part) {
  StoreLittle(grant.client_id, &part[kClientIdAt]);
  std::copy_n(key.bytes().begin(), kKeyBytes, part.begin() + kKeyAt);
  StoreLittle(grant.roles.bits(), &part[kRolesAt]);
  StoreLittle(grant.packets_per_second, &part[kRateAt]);
  WriteText(grant.audience, AudienceOf(part));
  WriteText(grant.subjects, SubjectsOf(part));
}

TokenStatus ReadPrivate(ByteSpan part, OpenedToken& opened) {
  Grant& grant = opened.grant;
  grant.client_id = LoadLittle<std::uint64_t>(&part[kClientIdAt]);
  opened.key = Key(ByteView(part).subspan<kKeyAt, kKeyBytes>());
  grant.roles = Roles(LoadLittle<std::uint16_t>(&part[kRolesAt]));
  grant.packets_per_second = LoadLittle<std::uint32_t>(&part[kRateAt]);
  if (!IsZero(part.subspan(kPrivateReservedAt, 2))) return TokenStatus::kBadReserved;
  if (!grant.roles.valid()) return TokenStatus::kBadRoles;
  if (!ReadText(AudienceOf(part), grant.audience)) return TokenStatus::kBadAudience;
  if (!ReadText(SubjectsOf(part), grant.subjects) || grant.subjects.empty()) {
    return TokenStatus::kBadSubjects;
  }
  return TokenStatus::kOk;
}

Status CheckText(const std::string& text, std::size_t most, const char* name) {
  if (text.size() > most) {
    return {StatusCode::kInvalidArgument, std::string(name) + " has " +
                                              std::to_string(text.size()) +
                                              " bytes; the limit is " + std::to_string(most)};
  }
  if (!IsPlainText(text)) {
    return {StatusCode::kInvalidArgument,
            std::string(name) + " must be UTF-8 text without control characters"};
  }
  return {};
}

Status CheckGrant(const Grant& grant) {
  if (!grant.roles.valid())
    return {StatusCode::kInvalidArgument, "a token needs at least one role"};
  if (grant.subjects.empty()) {
    return {StatusCode::kInvalidArgument, "the pattern of subjects is empty", "",
            "use '*' for all subjects"};
  }
  FURROW_RETURN_IF_ERROR(CheckText(grant.subjects, kMaxSubjectsBytes, "the pattern of subjects"));
  return CheckText(grant.audience, kMaxAudienceBytes, "the name of the server");
}

}  // namespace

bool Grant::MayPublish(std::string_view subject) const {
  return roles.Has(Role::kPublish) && MatchesPattern(subjects, subject);
}

bool Grant::MayWatch(std::string_view subject) const {
  return roles.Has(Role::kWatch) && MatchesPattern(subjects, subject);
}

const char* TokenStatusText(TokenStatus status) {
  switch (status) {
    case TokenStatus::kOk: return "ok";
    case TokenStatus::kBadMagic: return "not a token";
    case TokenStatus::kBadVersion: return "a token of an unknown version";
    case TokenStatus::kBadReserved: return "a reserved byte is not 0";
    case TokenStatus::kNotAuthentic: return "sealed with another key, or changed";
    case TokenStatus::kBadRoles: return "no role, or an undefined role";
    case TokenStatus::kBadSubjects: return "the pattern of subjects is empty or malformed";
    case TokenStatus::kBadAudience: return "the name of the server is malformed";
  }
  return "unknown";
}

TokenStatus ReadTokenHead(TokenView token, TokenHead& head) {
  if (!std::equal(kMagic.begin(), kMagic.end(), token.begin())) return TokenStatus::kBadMagic;
  if (token[kVersionAt] != kVersion) return TokenStatus::kBadVersion;
  if (!IsZero(token.subspan(kReservedAt, kKeyIdAt - kReservedAt))) return TokenStatus::kBadReserved;
  head.key_id = LoadLittle<std::uint32_t>(&token[kKeyIdAt]);
  head.expires = LoadLittle<std::uint64_t>(&token[kExpiresAt]);
  std::copy_n(token.begin() + kNonceAt, kTokenNonceBytes, head.nonce.begin());
  return TokenStatus::kOk;
}

TokenStatus OpenToken(TokenView token, const Key& token_key, OpenedToken& opened) {
  TokenHead head;
  if (const TokenStatus status = ReadTokenHead(token, head); status != TokenStatus::kOk) {
    return status;
  }
  PrivatePart part(token.subspan<kTokenPublicBytes, kTokenPrivateBytes>());
  if (!OpenWithNonce(token_key, head.nonce, token.first<kTokenPublicBytes>(), part.bytes(),
                     token.last<kTagBytes>())) {
    return TokenStatus::kNotAuthentic;
  }
  return ReadPrivate(part.bytes(), opened);
}

Result<ClientToken> MakeToken(std::uint32_t key_id, const Key& token_key, std::uint64_t expires,
                              const Grant& grant, RandomSource& random) {
  FURROW_RETURN_IF_ERROR(CheckGrant(grant));
  ClientToken token;
  token.key = random.MakeKey();
  TokenHead head{key_id, expires, {}};
  random.Fill(head.nonce);
  const std::span<std::uint8_t, kTokenBytes> bytes(token.bytes);
  WriteHead(head, bytes.first<kTokenPublicBytes>());
  const auto part = bytes.subspan<kTokenPublicBytes, kTokenPrivateBytes>();
  WritePrivate(grant, token.key, part);
  SealWithNonce(token_key, head.nonce, bytes.first<kTokenPublicBytes>(), part,
                bytes.last<kTagBytes>());
  return token;
}

}  // namespace furrow::protocol::secure
