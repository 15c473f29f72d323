// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/session/secure_server.h"

#include <algorithm>
#include <utility>

#include "protocol/messages/bytes.h"

namespace furrow::protocol::secure {

struct SecureServer::Session {
  Session(AcceptedHandshake&& accepted, std::uint32_t session_index, const PeerAddress& from,
          Now now)
      : index(session_index),
        channel(accepted.keys, accepted.client_index, now.us),
        address(from),
        grant(std::move(accepted.grant)),
        expires(accepted.expires),
        client_key(accepted.client_key),
        use(accepted.use),
        hello(std::move(accepted.hello)),
        last_heard_us(now.us),
        last_challenge_us(now.us - kChallengeMicroseconds) {}

  Session(const SessionState& state, TokenUse* token)
      : index(state.index),
        channel(state.sealer, state.opener, state.handshake_hash),
        address(state.address),
        grant(state.grant),
        expires(state.expires),
        client_key(state.client_key),
        use(token),
        confirmed(true),
        last_heard_us(state.last_heard_us),
        last_challenge_us(state.last_heard_us) {}

  [[nodiscard]] SessionState state() const {
    return {.index = index,
            .sealer = channel.sealer.state(),
            .opener = channel.opener.state(),
            .handshake_hash = channel.handshake_hash,
            .address = address,
            .grant = grant,
            .expires = expires,
            .client_key = client_key,
            .token_nonce = use->nonce,
            .key_id = use->key_id,
            .token_host = use->host,
            .last_heard_us = last_heard_us};
  }

  // Cookies of a path belong to one session.
  [[nodiscard]] CookieMaker::Context PathContext() const {
    return ByteView(channel.handshake_hash).first<CookieMaker::kContextBytes>();
  }

  std::uint32_t index;
  Channel channel;
  PeerAddress address;
  Grant grant;
  std::uint64_t expires;
  PublicKey client_key;
  TokenUse* use;
  std::vector<std::uint8_t> hello;
  bool confirmed = false;
  std::int64_t last_heard_us;
  std::int64_t last_challenge_us;
};

SecureServer::SecureServer(SecureServerSettings settings, RandomSource& random)
    : settings_(std::move(settings)),
      admission_(settings_.admission, random),
      generation_(random.Number<std::uint16_t>()) {
  settings_.max_sessions = std::min<std::size_t>(settings_.max_sessions, 0xFFFF);
}

SecureServer::~SecureServer() = default;

void SecureServer::SetKeys(KeyRing keys) {
  admission_.SetKeys(std::move(keys));
  for (const auto& session : sessions_) {
    if (session != nullptr && !admission_.HasKey(session->use->key_id)) End(*session, true);
  }
}

ServerEvent SecureServer::OnDatagram(ByteSpan datagram, const PeerAddress& from, Now now) {
  ServerEvent event;
  if (datagram.empty()) return event;
  if (datagram[0] == static_cast<std::uint8_t>(PacketKind::kInitiation)) {
    OnInitiation(datagram, from, now, event);
  } else {
    OnPacket(datagram, from, now, event);
  }
  if (event.open_status != OpenStatus::kOk) {
    ++dropped_[static_cast<std::size_t>(event.open_status)];
  }
  return event;
}

void SecureServer::OnInitiation(ByteSpan datagram, const PeerAddress& from, Now now,
                                ServerEvent& event) {
  const std::uint32_t index = FreeIndex();
  AcceptedHandshake accepted;
  const AdmissionResult result = admission_.OnInitiation(datagram, from, now, index, accepted);
  event.refusal = result.refusal;
  event.reply_size = result.reply_size;
  std::copy_n(result.reply_bytes.begin(), result.reply_size, event.reply_bytes.begin());
  if (result.outcome != AdmissionOutcome::kAccepted) return;
  const std::size_t place = index & 0xFFFF;
  TokenUse& use = *accepted.use;
  if (place == sessions_.size()) {
    sessions_.emplace_back();
  } else {
    free_places_.pop_back();
  }
  sessions_[place] = std::make_unique<Session>(std::move(accepted), index, from, now);
  ++num_sessions_;
  ++generation_;
  LimitUnconfirmed(use);
}

// A place for one more session, with a new number; 0 if all are taken. Takes effect only when the
// session is stored.
std::uint32_t SecureServer::FreeIndex() const {
  std::size_t place = sessions_.size();
  if (!free_places_.empty()) {
    place = free_places_.back();
  } else if (place >= settings_.max_sessions) {
    return 0;
  }
  return (1 + generation_ % 0xFFFF) << 16 | static_cast<std::uint32_t>(place);
}

SecureServer::Session* SecureServer::Find(std::uint32_t index) const {
  const std::size_t place = index & 0xFFFF;
  if (place >= sessions_.size() || sessions_[place] == nullptr) return nullptr;
  return sessions_[place]->index == index ? sessions_[place].get() : nullptr;
}

void SecureServer::OnPacket(ByteSpan datagram, const PeerAddress& from, Now now,
                            ServerEvent& event) {
  PacketHeader header;
  if (!ReadPacketHeader(datagram, header)) {
    event.open_status = OpenStatus::kBadHeader;
    return;
  }
  Session* const session = Find(header.index);
  if (session == nullptr || now.unix_s >= session->expires) {
    // The server was started again, or the session has ended. The hint is smaller than the packet.
    event.open_status = OpenStatus::kUnknownSession;
    event.refusal = Refusal::kUnknownSession;
    const auto hint = WriteRefused(header.index, Refusal::kUnknownSession);
    std::copy(hint.begin(), hint.end(), event.reply_bytes.begin());
    event.reply_size = hint.size();
    return;
  }
  const std::size_t received = datagram.size();
  OpenedPacket packet;
  event.open_status = session->channel.opener.Open(datagram, now.us, packet);
  if (event.open_status != OpenStatus::kOk) {
    if (event.open_status == OpenStatus::kExhausted) End(*session, /*report=*/true);
    return;
  }
  event.session = session->index;
  session->last_heard_us = session->use->last_heard_us = now.us;
  if (!session->confirmed) Confirm(*session, event);
  if (packet.kind == PacketKind::kData) {
    event.inner = packet.inner;
  } else {
    OnControl(*session, packet, from, now, event);
  }
  if (!event.closed && from != session->address) Challenge(*session, received, from, now, event);
}

void SecureServer::OnControl(Session& session, const OpenedPacket& packet, const PeerAddress& from,
                             Now now, ServerEvent& event) {
  ControlMessage message;
  if (!ReadControl(packet.inner, message)) return;
  switch (message.type) {
    case ControlType::kProbe: return Reply(session, ControlType::kProbeAnswer, {}, now, event);
    case ControlType::kPathAnswer:
      if (admission_.cookies().Check(message.content.first<kCookieBytes>(),
                                     CookieMaker::Purpose::kPath, from, session.PathContext(),
                                     now.us)) {
        session.address = from;
        session.use->host = from.host;
      }
      return;
    case ControlType::kRenew: return Renew(session, message.content, now, event);
    case ControlType::kClose: event.closed = true; return End(session, /*report=*/false);
    case ControlType::kProbeAnswer:
    case ControlType::kPathChallenge:
    case ControlType::kRenewed: return;  // of a server only
  }
}

void SecureServer::Renew(Session& session, ByteView renewal, Now now, ServerEvent& event) {
  const Refusal refusal = admission_.Renew(renewal, session.channel.handshake_hash, session.index,
                                           now, session.grant, session.expires, session.use);
  event.renewed = refusal == Refusal::kNone;
  // Otherwise two tokens in turn could open sessions without end and move them all to one token.
  if (event.renewed) LimitConfirmed(session, /*replaces=*/false);
  std::array<std::uint8_t, kRenewedBytes> content;
  StoreLittle(session.expires, content.data());
  content.back() = static_cast<std::uint8_t>(refusal);
  Reply(session, ControlType::kRenewed, content, now, event);
}

// Asks the client at a new address for a proof that it receives there. Until then, everything goes
// to the former address. The challenge is smaller than the packet that caused it, which it replaces
// another answer for.
void SecureServer::Challenge(Session& session, std::size_t received, const PeerAddress& from,
                             Now now, ServerEvent& event) {
  event.reply_size = 0;
  if (received < ControlPacketBytes(kCookieBytes)) return;
  if (now.us - session.last_challenge_us < kChallengeMicroseconds) return;
  session.last_challenge_us = now.us;
  const Cookie cookie =
      admission_.cookies().Make(CookieMaker::Purpose::kPath, from, session.PathContext(), now.us);
  Reply(session, ControlType::kPathChallenge, cookie, now, event);
}

// The client has the response: its session begins. An earlier session of the same token from the
// same address and port has been replaced by it.
void SecureServer::Confirm(Session& session, ServerEvent& event) {
  session.confirmed = true;
  event.opened = true;
  event.hello = std::move(session.hello);
  session.hello = {};
  LimitConfirmed(session, /*replaces=*/true);
}

// Ends the other sessions of the session's token that are too many, first those that were silent
// for longest. `replaces`: also one from the same address and port.
void SecureServer::LimitConfirmed(const Session& session, bool replaces) {
  std::vector<Session*> others;
  for (const std::uint32_t index : session.use->sessions) {
    Session* const other = Find(index);
    if (other != &session && other->confirmed) others.push_back(other);
  }
  std::sort(others.begin(), others.end(),
            [](const Session* a, const Session* b) { return a->last_heard_us > b->last_heard_us; });
  for (std::size_t i = 0; i < others.size(); ++i) {
    const bool is_replaced = replaces && others[i]->address == session.address;
    if (is_replaced || i + 1 >= settings_.max_sessions_of_a_token) End(*others[i], true);
  }
}

// A holder of a token cannot fill the table with handshakes that it does not continue.
void SecureServer::LimitUnconfirmed(const TokenUse& use) {
  Session* oldest = nullptr;
  std::size_t count = 0;
  for (const std::uint32_t index : use.sessions) {
    Session* const session = Find(index);
    if (session->confirmed) continue;
    ++count;
    if (oldest == nullptr || session->last_heard_us < oldest->last_heard_us) oldest = session;
  }
  if (count > kMaxUnconfirmedOfAToken) End(*oldest, true);
}

void SecureServer::Reply(Session& session, ControlType type, ByteView content, Now now,
                         ServerEvent& event) {
  event.reply_size = session.channel.SealControl(type, content, event.reply_bytes, now.us);
}

SealStatus SecureServer::Seal(std::uint32_t index, ByteSpan packet, Now now, PeerAddress& to) {
  Session* const session = Find(index);
  if (session == nullptr || !session->confirmed || now.unix_s >= session->expires) {
    return SealStatus::kNotConnected;
  }
  to = session->address;
  return session->channel.sealer.Seal(PacketKind::kData, packet, now.us);
}

SecureServer::Info SecureServer::InfoOf(std::uint32_t index) const {
  const Session* const session = Find(index);
  if (session == nullptr) return {};
  return {&session->grant, session->use->key_id, session->expires};
}

const PeerAddress* SecureServer::AddressOf(std::uint32_t index) const {
  const Session* const session = Find(index);
  return session == nullptr ? nullptr : &session->address;
}

void SecureServer::Close(std::uint32_t index) {
  if (Session* const session = Find(index)) End(*session, /*report=*/false);
}

std::vector<SessionState> SecureServer::TakeAll() {
  std::vector<SessionState> states;
  for (const auto& session : sessions_) {
    if (session == nullptr) continue;
    if (session->confirmed) states.push_back(session->state());
    End(*session, /*report=*/false);
  }
  return states;
}

bool SecureServer::Resume(const SessionState& state, Now now) {
  const std::size_t place = state.index & 0xFFFF;
  if (place >= settings_.max_sessions || state.index >> 16 == 0 || now.unix_s >= state.expires ||
      !admission_.HasKey(state.key_id)) {
    return false;
  }
  if (place < sessions_.size() && sessions_[place] != nullptr) return false;
  while (sessions_.size() <= place) {
    free_places_.push_back(static_cast<std::uint16_t>(sessions_.size()));
    sessions_.emplace_back();
  }
  sessions_[place] = std::make_unique<Session>(state, &admission_.Resume(state));
  std::erase(free_places_, static_cast<std::uint16_t>(place));
  ++num_sessions_;
  return true;
}

void SecureServer::Expire(Now now) {
  for (const auto& session : sessions_) {
    if (session == nullptr) continue;
    const std::int64_t limit = session->confirmed ? kSilenceMicroseconds : kUnconfirmedMicroseconds;
    if (now.us - session->last_heard_us >= limit || now.unix_s >= session->expires) {
      End(*session, /*report=*/true);
    }
  }
}

std::vector<std::uint32_t> SecureServer::TakeClosed() { return std::exchange(closed_, {}); }

void SecureServer::End(Session& session, bool report) {
  if (report && session.confirmed) closed_.push_back(session.index);
  admission_.Release(session.client_key, session.use, session.index);
  const auto place = static_cast<std::uint16_t>(session.index & 0xFFFF);
  sessions_[place].reset();
  free_places_.push_back(place);
  --num_sessions_;
}

}  // namespace furrow::protocol::secure
