// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/handshake/handshake_packets.h"

#include <algorithm>
#include <string_view>

namespace furrow::protocol::secure {
namespace {
constexpr std::string_view kLabel = "furrow secure 1\n";
static_assert(kLabel.size() + kInitiationMessageAt == kPrologueBytes);
}  // namespace

std::array<std::uint8_t, kPrologueBytes> PrologueOf(ByteView before_message) {
  std::array<std::uint8_t, kPrologueBytes> prologue;
  auto* const end = std::copy(kLabel.begin(), kLabel.end(), prologue.begin());
  std::copy(before_message.begin(), before_message.end(), end);
  return prologue;
}

void WriteInitiationHead(std::uint32_t client_index, TokenView token, CookieView cookie,
                         ByteSpan datagram) {
  WriteShortHeader(PacketKind::kInitiation, client_index, datagram);
  std::copy(token.begin(), token.end(), datagram.begin() + kInitiationTokenAt);
  std::copy(cookie.begin(), cookie.end(), datagram.begin() + kInitiationCookieAt);
}

std::array<std::uint8_t, kRetryBytes> WriteRetry(std::uint32_t client_index, const Cookie& cookie) {
  std::array<std::uint8_t, kRetryBytes> datagram;
  WriteShortHeader(PacketKind::kRetry, client_index, datagram);
  std::copy(cookie.begin(), cookie.end(), datagram.begin() + kShortHeaderBytes);
  return datagram;
}

bool ReadRetry(ByteView datagram, std::uint32_t& client_index, Cookie& cookie) {
  if (datagram.size() != kRetryBytes ||
      !ReadShortHeader(datagram, PacketKind::kRetry, client_index)) {
    return false;
  }
  std::copy_n(datagram.begin() + kShortHeaderBytes, kCookieBytes, cookie.begin());
  return true;
}

bool Lasts(Refusal refusal) {
  return refusal != Refusal::kNone && refusal != Refusal::kUnknownSession &&
         refusal != Refusal::kBusy;
}

const char* RefusalText(Refusal refusal) {
  switch (refusal) {
    case Refusal::kNone: return "not refused";
    case Refusal::kUnknownSession: return "the server does not know the session";
    case Refusal::kUnknownKey: return "the server does not have the key of the token";
    case Refusal::kExpired: return "the token or its key has expired";
    case Refusal::kForgedToken: return "the token was changed, or sealed with another key";
    case Refusal::kWrongAudience: return "the token is for another server";
    case Refusal::kTokenInUse:
      return "the token is in use from another address; each address needs a token of its own";
    case Refusal::kForgedHandshake: return "the handshake does not prove the key of the token";
    case Refusal::kBusy: return "the server has too many new clients at the moment";
    case Refusal::kFull: return "the server has no free session";
    case Refusal::kBadInitiation: return "the initiation is malformed";
    case Refusal::kBadToken: return "the token is malformed or of an unknown version";
  }
  return "unknown reason";
}

std::array<std::uint8_t, kRefusedBytes> WriteRefused(std::uint32_t index, Refusal refusal) {
  std::array<std::uint8_t, kRefusedBytes> datagram{};
  WriteShortHeader(PacketKind::kRefused, index, datagram);
  datagram[kShortHeaderBytes] = static_cast<std::uint8_t>(refusal);
  return datagram;
}

bool ReadRefused(ByteView datagram, std::uint32_t& index, Refusal& refusal) {
  if (datagram.size() != kRefusedBytes || !ReadShortHeader(datagram, PacketKind::kRefused, index)) {
    return false;
  }
  refusal = static_cast<Refusal>(datagram[kShortHeaderBytes]);
  return refusal >= Refusal::kUnknownSession && refusal <= Refusal::kFull;
}

}  // namespace furrow::protocol::secure
