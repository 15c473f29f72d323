// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/secure/handshake/cookie.h"
#include "protocol/secure/noise/handshake.h"
#include "protocol/secure/packet/packet.h"
#include "protocol/secure/token/connect_token.h"

// The packets before a session exists: initiation, retry, response and refused (STANDARD.md section
// 15). Each function of writing and reading works on whole datagrams.
namespace furrow::protocol::secure {

// An initiation fills a datagram, so no answer to it is larger.
inline constexpr std::size_t kInitiationBytes = kMaxDatagramBytes;
inline constexpr std::size_t kInitiationTokenAt = kShortHeaderBytes;
inline constexpr std::size_t kInitiationCookieAt = kInitiationTokenAt + kTokenBytes;
inline constexpr std::size_t kInitiationMessageAt = kInitiationCookieAt + kCookieBytes;
static_assert(kInitiationMessageAt == 284);
// The payload of the first handshake message: u16 size of the hello, the hello, padding.
inline constexpr std::size_t kInitiationPayloadBytes =
    kInitiationBytes - kInitiationMessageAt - kHandshakeOverheadBytes;
inline constexpr std::size_t kMaxHelloBytes = kInitiationPayloadBytes - 2;

using InitiationBytes = std::array<std::uint8_t, kInitiationBytes>;

// Views into the datagram of an initiation.
struct InitiationView {
  explicit InitiationView(std::span<const std::uint8_t, kInitiationBytes> datagram)
      : token(datagram.subspan<kInitiationTokenAt, kTokenBytes>()),
        cookie(datagram.subspan<kInitiationCookieAt, kCookieBytes>()),
        before_message(datagram.first(kInitiationMessageAt)),
        message(datagram.subspan(kInitiationMessageAt)) {}

  TokenView token;
  CookieView cookie;
  ByteView before_message;  // everything before the handshake message
  ByteView message;
};

// The prologue of the handshake: a label and everything before the handshake message. So the first
// message is authentic only with the token, the cookie and the index beside it.
inline constexpr std::size_t kPrologueBytes = 16 + kInitiationMessageAt;
[[nodiscard]] std::array<std::uint8_t, kPrologueBytes> PrologueOf(ByteView before_message);

// Writes everything before the handshake message to `datagram`.
void WriteInitiationHead(std::uint32_t client_index, TokenView token, CookieView cookie,
                         ByteSpan datagram);

// A retry: the index of the client's side, a cookie.
inline constexpr std::size_t kRetryBytes = kShortHeaderBytes + kCookieBytes;
[[nodiscard]] std::array<std::uint8_t, kRetryBytes> WriteRetry(std::uint32_t client_index,
                                                               const Cookie& cookie);
[[nodiscard]] bool ReadRetry(ByteView datagram, std::uint32_t& client_index, Cookie& cookie);

// A response: the index of the client's side, and the second handshake message with the index of
// the server's side as its payload.
inline constexpr std::size_t kResponsePayloadBytes = 4;
inline constexpr std::size_t kResponseBytes =
    kShortHeaderBytes + kHandshakeOverheadBytes + kResponsePayloadBytes;
static_assert(kResponseBytes == 60);
using ResponseBytes = std::array<std::uint8_t, kResponseBytes>;

// Why a server does not do what a packet asks for. The numbers are those of the wire.
enum class Refusal : std::uint8_t {
  kNone = 0,
  kUnknownSession = 1,   // no session has the index of a data or control packet
  kUnknownKey = 2,       // the server does not have the key that sealed the token
  kExpired = 3,          // the token, or its key
  kForgedToken = 4,      // the seal of the token is wrong, or its content is invalid
  kWrongAudience = 5,    // the token is for another server
  kTokenInUse = 6,       // a session from another address uses the token
  kForgedHandshake = 7,  // the client does not know the key of its token, or bytes were changed
  kBusy = 8,             // more handshakes than the server accepts at present
  kFull = 9,             // no session is free
  // Never sent, because the packet does not deserve an answer:
  kBadInitiation = 10,  // wrong size, or a reserved byte that is not 0
  kBadToken = 11,       // not a token, or of an unknown version
};
inline constexpr std::size_t kNumRefusals = 12;
// A phrase for messages and metrics: "the token has expired".
[[nodiscard]] const char* RefusalText(Refusal refusal);
// True if trying again does not help until the token or the server changes. The others are normal
// after a restart of the server, or when many come at once.
[[nodiscard]] bool Lasts(Refusal refusal);

// A hint for the client, which nothing proves: the index (the client's of an initiation, or the
// unknown one of another packet), the reason, 3 zero bytes.
inline constexpr std::size_t kRefusedBytes = kShortHeaderBytes + 4;
[[nodiscard]] std::array<std::uint8_t, kRefusedBytes> WriteRefused(std::uint32_t index,
                                                                   Refusal refusal);
[[nodiscard]] bool ReadRefused(ByteView datagram, std::uint32_t& index, Refusal& refusal);

}  // namespace furrow::protocol::secure
