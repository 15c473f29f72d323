// SPDX-License-Identifier: Apache-2.0
#include "server/session/peers/reception.h"

#include "protocol/framing/envelope.h"
#include "server/session/access/token_gate.h"
#include "server/session/peers/server_name.h"

namespace furrow::server {

using protocol::DecodeStatus;

namespace {

// True for what only a client sends. A daemon challenges by Ping, but only addresses that are
// proven.
bool IsRequest(protocol::MessageKind kind) {
  using Kind = protocol::MessageKind;
  switch (kind) {
    case Kind::kPing:
    case Kind::kSkeletonOffer:
    case Kind::kPose:
    case Kind::kSubscribeWeights:
    case Kind::kSubscribePictures:
    case Kind::kSubscribePoses:
    case Kind::kUnsubscribe:
    case Kind::kListSubjects: return true;
    default: return false;
  }
}

}  // namespace

bool Reception::Admits(const UdpAddress& address, bool has_peer,
                       std::span<const std::uint8_t> datagram, Time now) {
  reply_.clear();
  protocol::MessageView view;
  const bool is_message = protocol::OpenMessage(datagram, view) == DecodeStatus::kOk;
  const bool is_hello = is_message && view.kind == protocol::MessageKind::kHello;
  if (requires_token_) {
    metrics_->Add(Counter::kRefusedNoToken);
    const bool is_request = !is_message || is_hello || IsRequest(view.kind);
    if (is_request && refusals_.Take(now)) {
      Refuse(datagram, protocol::ErrorCode::kNeedsToken, kNeedsTokenText);
    }
    return false;
  }
  if (!is_hello) {
    metrics_->Add(Counter::kDatagramsUnproven);
    // An answer to an answer could be answered again, for ever.
    const bool is_request = !is_message || IsRequest(view.kind);
    if (is_request && !has_peer && refusals_.Take(now)) {
      Refuse(datagram, protocol::ErrorCode::kUnprovenAddress,
             "the address is not proven: send Hello first");
    }
    return false;
  }
  if (protocol::Decode(view, hello_) != DecodeStatus::kOk) {
    metrics_->Add(Counter::kMessagesMalformed);
    return false;
  }
  const std::uint64_t session = view.header.session;
  if (proof_->Check(address, session, hello_.token, now)) return true;
  encoder_.Encode({.session = session_, .sequence = view.header.sequence},
                  protocol::Welcome{kServerName, proof_->Token(address, session, now)}, reply_);
  if (reply_.size() > datagram.size()) reply_.clear();
  return false;
}

void Reception::RefuseForLimit(std::span<const std::uint8_t> datagram) {
  Refuse(datagram, protocol::ErrorCode::kLimit,
         "this address has its share of the peers; see limits.max_udp_peers");
}

// The answer to a fragment is that to its message. A short message, such as a Ping, gets the code
// alone.
void Reception::Refuse(std::span<const std::uint8_t> datagram, protocol::ErrorCode code,
                       const char* text) {
  protocol::Envelope envelope;
  if (protocol::ReadEnvelope(datagram, envelope) != protocol::EnvelopeStatus::kOk) return;
  for (const char* shown : {text, ""}) {
    encoder_.Encode({.session = session_,
                     .stream = envelope.header.stream,
                     .sequence = envelope.header.sequence},
                    protocol::ErrorMessage{code, shown}, reply_);
    if (reply_.size() <= datagram.size()) return;
  }
  reply_.clear();
}

}  // namespace furrow::server
