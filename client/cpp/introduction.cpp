// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/introduction.h"

#include <utility>

namespace furrow::client {

Introduction::Introduction(Transport* transport, std::string program, std::uint64_t session)
    : transport_(transport),
      program_(std::move(program)),
      session_(session),
      proven_(transport->kind() == TransportKind::kTcp) {}

// A lost message is sent again by the caller, so failures do not matter here and below.
void Introduction::SendHello() {
  const protocol::Hello hello{
      .client = program_, .token = token_, .bundles = transport_->takes_bundles()};
  encoder_.Encode({.session = session_}, hello, bytes_);
  (void)transport_->Send(bytes_);
}

void Introduction::Restart() {
  proven_ = transport_->kind() == TransportKind::kTcp;
  token_ = 0;
}

bool Introduction::OnWelcome(const protocol::Welcome& welcome) {
  if (proven_) return false;
  if (welcome.token == 0) {
    proven_ = true;
    return true;
  }
  token_ = welcome.token;
  SendHello();
  return false;
}

void Introduction::OnPing(const protocol::Ping& ping) {
  encoder_.Encode({.session = session_}, protocol::Pong{ping.time_us, 0}, bytes_);
  (void)transport_->Send(bytes_);
}

bool SendsElsewhere(const protocol::ErrorMessage& error) {
  return !error.host.empty() && (error.code == protocol::ErrorCode::kUnknownSubject ||
                                 error.code == protocol::ErrorCode::kSubjectTaken);
}

void RememberOthers(const protocol::Welcome& welcome, const Introduction& introduction,
                    Transport& transport) {
  if (!introduction.proven() || welcome.token != 0) return;
  std::vector<Elsewhere> others;
  for (const std::string& text : welcome.others) {
    if (auto server = ParseElsewhere(text)) others.push_back(*std::move(server));
  }
  transport.Remember(others);
}

}  // namespace furrow::client
