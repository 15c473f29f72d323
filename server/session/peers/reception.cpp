// SPDX-License-Identifier: Apache-2.0
#include "server/session/peers/reception.h"

#include "protocol/framing/envelope.h"
#include "server/session/peers/server_name.h"

namespace furrow::server {

using protocol::DecodeStatus;

bool Reception::Admits(const UdpAddress& address, std::span<const std::uint8_t> datagram,
                       Time now) {
  reply_.clear();
  protocol::MessageView view;
  const bool is_hello = protocol::OpenMessage(datagram, view) == DecodeStatus::kOk &&
                        view.kind == protocol::MessageKind::kHello;
  if (!is_hello) {
    Refuse(datagram);
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

// Tells a sender that it has to prove its address, for example after a restart of the daemon. The
// answer to a fragment is that to its message. A short message, such as a Ping, gets the code
// alone.
void Reception::Refuse(std::span<const std::uint8_t> datagram) {
  metrics_->Add(Counter::kDatagramsUnproven);
  protocol::Envelope envelope;
  if (protocol::ReadEnvelope(datagram, envelope) != protocol::EnvelopeStatus::kOk) return;
  for (const char* text : {"the address is not proven: send Hello first", ""}) {
    encoder_.Encode({.session = session_,
                     .stream = envelope.header.stream,
                     .sequence = envelope.header.sequence},
                    protocol::ErrorMessage{protocol::ErrorCode::kUnprovenAddress, text}, reply_);
    if (reply_.size() <= datagram.size()) return;
  }
  reply_.clear();
}

}  // namespace furrow::server
