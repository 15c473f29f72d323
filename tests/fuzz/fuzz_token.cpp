// SPDX-License-Identifier: Apache-2.0
// Tokens as text and as bytes, and key files. Everything accepted keeps the rules of the document
// and is accepted again after it was written. The bytes are sealed with a known key as well, so
// that hostile content behind a good seal is read, too.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "protocol/messages/text.h"
#include "protocol/secure/token/connect_token.h"
#include "protocol/secure/token/key_ring.h"
#include "protocol/secure/token/token_text.h"

namespace s = furrow::protocol::secure;

namespace {

void Require(bool holds) {
  if (!holds) std::abort();
}

void CheckGrant(const s::Grant& grant) {
  Require(grant.roles.valid() && !grant.subjects.empty());
  Require(grant.subjects.size() <= s::kMaxSubjectsBytes);
  Require(grant.audience.size() <= s::kMaxAudienceBytes);
  Require(furrow::protocol::IsPlainText(grant.subjects));
  Require(furrow::protocol::IsPlainText(grant.audience));
  (void)grant.MayPublish("stage-anna");
}

void OpenBytes(s::ByteView data) {
  s::TokenBytes token{};
  std::copy_n(data.begin(), std::min(data.size(), token.size()), token.begin());
  const s::Key key;
  s::TokenHead head;
  if (s::ReadTokenHead(token, head) != s::TokenStatus::kOk) return;
  s::OpenedToken opened;
  if (s::OpenToken(token, key, opened) == s::TokenStatus::kOk) CheckGrant(opened.grant);
  // The same content behind a good seal.
  const std::span<std::uint8_t, s::kTokenBytes> bytes(token);
  s::SealWithNonce(key, head.nonce, bytes.first<s::kTokenPublicBytes>(),
                   bytes.subspan<s::kTokenPublicBytes, s::kTokenPrivateBytes>(),
                   bytes.last<s::kTagBytes>());
  const s::TokenStatus status = s::OpenToken(token, key, opened);
  Require(status != s::TokenStatus::kNotAuthentic);
  if (status == s::TokenStatus::kOk) CheckGrant(opened.grant);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto token = s::ParseToken(text); token.ok()) {
    Require(s::ParseToken(s::ToText(*token)).ok());
  }
  if (const auto ring = s::KeyRing::Parse(text, "keys"); ring.ok()) {
    Require(ring->keys().size() <= s::KeyRing::kMaxKeys);
    const auto again = s::KeyRing::Parse(ring->ToText(), "keys");
    Require(again.ok() && again->ToText() == ring->ToText());
  }
  OpenBytes({data, size});
  return 0;
}
