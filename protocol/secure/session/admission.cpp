// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/session/admission.h"

#include <algorithm>

#include "protocol/secure/session/channel.h"

namespace furrow::protocol::secure {
namespace {

template <std::size_t N>
void SetReply(const std::array<std::uint8_t, N>& reply, AdmissionResult& result) {
  static_assert(N <= kResponseBytes);
  std::copy(reply.begin(), reply.end(), result.reply_bytes.begin());
  result.reply_size = N;
}

}  // namespace

Admission::Admission(AdmissionSettings settings, RandomSource& random)
    : settings_(std::move(settings)),
      random_(random),
      cookies_(random),
      handshakes_(settings_.handshakes_per_second),
      attempts_(settings_.attempts_per_second),
      attempts_of_hosts_(settings_.attempts_per_second_of_a_host, random) {}

AdmissionResult Admission::OnInitiation(ByteView datagram, const PeerAddress& from, Now now,
                                        std::uint32_t server_index, AcceptedHandshake& accepted) {
  std::uint32_t client_index = 0;
  if (datagram.size() != kInitiationBytes ||
      !ReadShortHeader(datagram, PacketKind::kInitiation, client_index)) {
    return Refuse(Refusal::kBadInitiation, 0);
  }
  const InitiationView view(datagram.first<kInitiationBytes>());
  KnownToken known;
  if (const Refusal refusal = CheckHead(view.token, now, known); refusal != Refusal::kNone) {
    return Refuse(refusal, client_index);
  }
  AdmissionResult result;
  using Purpose = CookieMaker::Purpose;
  if (!cookies_.Check(view.cookie, Purpose::kInitiation, from, known.head.nonce, now.us)) {
    ++retries_;
    result.outcome = AdmissionOutcome::kRetry;
    SetReply(WriteRetry(client_index,
                        cookies_.Make(Purpose::kInitiation, from, known.head.nonce, now.us)),
             result);
    return result;
  }
  // The response was lost, or the initiation came twice. Whoever repeats the public key of another
  // client receives bytes that are useless without that client's secret.
  PublicKey client_key;
  std::copy_n(view.message.begin(), kPublicKeyBytes, client_key.begin());
  if (const auto found = responses_.find(client_key); found != responses_.end()) {
    result.outcome = AdmissionOutcome::kRepeated;
    SetReply(found->second, result);
    return result;
  }
  ResponseBytes response;
  const Refusal refusal = Shake(view, known, from, now, server_index, accepted, response);
  if (refusal != Refusal::kNone) return Refuse(refusal, client_index);
  accepted.client_index = client_index;
  accepted.client_key = client_key;
  WriteShortHeader(PacketKind::kResponse, client_index, response);
  responses_[client_key] = response;
  ++accepted_;
  result.outcome = AdmissionOutcome::kAccepted;
  SetReply(response, result);
  return result;
}

Refusal Admission::CheckHead(TokenView token, Now now, KnownToken& known) const {
  if (ReadTokenHead(token, known.head) != TokenStatus::kOk) return Refusal::kBadToken;
  known.key = keys_.Find(known.head.key_id);
  if (known.key == nullptr) return Refusal::kUnknownKey;
  const std::uint64_t expires = std::min(known.head.expires, known.key->expires);
  return now.unix_s < expires ? Refusal::kNone : Refusal::kExpired;
}

Refusal Admission::CheckUse(const TokenNonce& nonce, const PeerAddress& from, Now now) const {
  const auto found = uses_.find(nonce);
  if (found == uses_.end() || found->second.host == from.host) return Refusal::kNone;
  const bool is_held = now.us - found->second.last_heard_us < kTokenHoldMicroseconds;
  return is_held ? Refusal::kTokenInUse : Refusal::kNone;
}

Refusal Admission::CheckContent(TokenView token, const KnownToken& known,
                                OpenedToken& opened) const {
  if (OpenToken(token, known.key->key, opened) != TokenStatus::kOk) return Refusal::kForgedToken;
  const std::string& audience = opened.grant.audience;
  if (!audience.empty() && audience != settings_.audience) return Refusal::kWrongAudience;
  return Refusal::kNone;
}

// The part that reads secrets and computes.
Refusal Admission::Shake(const InitiationView& view, const KnownToken& known,
                         const PeerAddress& from, Now now, std::uint32_t server_index,
                         AcceptedHandshake& accepted, ResponseBytes& response) {
  if (const Refusal refusal = CheckUse(known.head.nonce, from, now); refusal != Refusal::kNone) {
    return refusal;
  }
  // The seal costs about as much as the cookie. Before the budgets, because otherwise somebody who
  // has no token at all could use them up with invented ones.
  OpenedToken opened;
  if (const Refusal refusal = CheckContent(view.token, known, opened); refusal != Refusal::kNone) {
    return refusal;
  }
  // The host first: a host that has used up its own budget takes nothing from the others.
  if (!attempts_of_hosts_.Take(from, known.head.nonce, now.us) || !attempts_.Take(now.us)) {
    return Refusal::kBusy;
  }
  Handshake handshake(Handshake::Side::kResponder, opened.key, PrologueOf(view.before_message),
                      random_);
  std::array<std::uint8_t, kInitiationPayloadBytes> payload;
  if (handshake.Read(view.message, payload) != HandshakeStatus::kOk) {
    return Refusal::kForgedHandshake;
  }
  const std::size_t hello_size = LoadLittle<std::uint16_t>(payload.data());
  if (hello_size > kMaxHelloBytes) return Refusal::kForgedHandshake;
  if (server_index == 0) return Refusal::kFull;
  TokenUse& use = UseOf(known.head, from.host);
  // Both budgets, so that one token cannot use up what all share.
  if (!use.handshakes.Take(now.us) || !handshakes_.Take(now.us)) {
    Detach(&use, 0);
    return Refusal::kBusy;
  }
  std::array<std::uint8_t, kResponsePayloadBytes> index_bytes;
  StoreLittle(server_index, index_bytes.data());
  if (handshake.Write(index_bytes, ByteSpan(response).subspan(kShortHeaderBytes)) !=
      HandshakeStatus::kOk) {
    Detach(&use, 0);
    return Refusal::kForgedHandshake;
  }
  use.host = from.host;
  use.last_heard_us = now.us;
  use.sessions.push_back(server_index);
  accepted.keys = handshake.Split();
  accepted.grant = std::move(opened.grant);
  accepted.expires = std::min(known.head.expires, known.key->expires);
  accepted.use = &use;
  accepted.hello.assign(payload.begin() + 2,
                        payload.begin() + 2 + static_cast<std::ptrdiff_t>(hello_size));
  return Refusal::kNone;
}

Refusal Admission::Renew(ByteView renewal, const Hash& handshake_hash, std::uint32_t index, Now now,
                         Grant& grant, std::uint64_t& expires, TokenUse*& use) {
  const TokenView token = renewal.first<kTokenBytes>();
  KnownToken known;
  OpenedToken opened;
  PeerAddress here;
  here.host = use->host;
  Refusal refusal = CheckHead(token, now, known);
  if (refusal == Refusal::kNone) refusal = CheckUse(known.head.nonce, here, now);
  if (refusal == Refusal::kNone) refusal = CheckContent(token, known, opened);
  // Every client can see the tokens of others on the network, so a token alone proves nothing.
  if (refusal == Refusal::kNone &&
      (opened.grant.client_id != grant.client_id ||
       !EqualInConstantTime(RenewalProof(opened.key, handshake_hash), renewal.last<kMacBytes>()))) {
    refusal = Refusal::kForgedHandshake;
  }
  if (refusal != Refusal::kNone) {
    ++refused_[static_cast<std::size_t>(refusal)];
    return refusal;
  }
  if (known.head.nonce != use->nonce) {
    TokenUse& next = UseOf(known.head, use->host);
    next.last_heard_us = now.us;
    next.sessions.push_back(index);
    Detach(use, index);
    use = &next;
  }
  grant = std::move(opened.grant);
  expires = std::min(known.head.expires, known.key->expires);
  return Refusal::kNone;
}

TokenUse& Admission::Resume(const SessionState& state) {
  const TokenHead head{
      .key_id = state.key_id, .expires = state.expires, .nonce = state.token_nonce};
  TokenUse& use = UseOf(head, state.token_host);
  use.last_heard_us = std::max(use.last_heard_us, state.last_heard_us);
  use.sessions.push_back(state.index);
  return use;
}

void Admission::Release(const PublicKey& client_key, TokenUse* use, std::uint32_t index) {
  responses_.erase(client_key);
  Detach(use, index);
}

TokenUse& Admission::UseOf(const TokenHead& head, const std::array<std::uint8_t, 16>& host) {
  const auto [found, is_new] = uses_.try_emplace(head.nonce);
  TokenUse& use = found->second;
  if (is_new) {
    use.nonce = head.nonce;
    use.key_id = head.key_id;
    use.host = host;
    use.handshakes = RateBudget(settings_.handshakes_per_second_of_a_token);
  }
  return use;
}

void Admission::Detach(TokenUse* use, std::uint32_t index) {
  std::erase(use->sessions, index);
  if (use->sessions.empty()) uses_.erase(TokenNonce(use->nonce));
}

AdmissionResult Admission::Refuse(Refusal refusal, std::uint32_t client_index) {
  ++refused_[static_cast<std::size_t>(refusal)];
  AdmissionResult result;
  result.refusal = refusal;
  // A hint only to what looks like a client.
  if (refusal <= Refusal::kFull) SetReply(WriteRefused(client_index, refusal), result);
  return result;
}

}  // namespace furrow::protocol::secure
