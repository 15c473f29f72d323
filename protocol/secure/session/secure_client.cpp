// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/session/secure_client.h"

#include <algorithm>
#include <array>

#include "protocol/messages/bytes.h"

namespace furrow::protocol::secure {

SecureClient::SecureClient(const ClientToken& token, ByteView hello, RandomSource& random)
    : token_(token), random_(random) {
  hello = hello.first(std::min(hello.size(), kMaxHelloBytes));
  hello_.assign(hello.begin(), hello.end());
}

void SecureClient::Begin(std::int64_t due_us) {
  std::array<std::uint8_t, kInitiationMessageAt> head;
  const auto index = random_.Number<std::uint32_t>();
  WriteInitiationHead(index, token_.bytes, cookie_, head);
  attempt_.emplace(token_.key, PrologueOf(head), random_);
  attempt_->index = index;
  attempt_->due_us = due_us;
  std::array<std::uint8_t, kInitiationPayloadBytes> payload{};
  StoreLittle(static_cast<std::uint16_t>(hello_.size()), payload.data());
  std::copy(hello_.begin(), hello_.end(), payload.begin() + 2);
  std::copy(head.begin(), head.end(), attempt_->datagram.begin());
  // The first message of a fresh handshake cannot fail.
  (void)attempt_->handshake.Write(payload,
                                  ByteSpan(attempt_->datagram).subspan(kInitiationMessageAt));
}

bool SecureClient::ShouldReconnect(std::int64_t now_us) const {
  if (!channel_) return true;
  return unknown_at_server_ || now_us - last_heard_us_ >= kReconnectMicroseconds;
}

std::size_t SecureClient::Poll(Now now, ByteSpan packet) {
  if (channel_ && now.us - last_heard_us_ >= kLostMicroseconds) channel_.reset();
  if (!attempt_ && ShouldReconnect(now.us)) {
    attempt_began_us_ = now.us;
    Begin(now.us);
  }
  if (attempt_ && now.us >= attempt_->due_us) {
    attempt_->due_us = now.us + attempt_->interval_us;
    attempt_->interval_us = Lasts(last_refusal_)
                                ? kRefusedRepeatMicroseconds
                                : std::min(2 * attempt_->interval_us, kLastRepeatMicroseconds);
    std::copy(attempt_->datagram.begin(), attempt_->datagram.end(), packet.begin());
    return attempt_->datagram.size();
  }
  return channel_ ? SendControl(now, packet) : 0;
}

std::size_t SecureClient::SendControl(Now now, ByteSpan packet) {
  if (path_answer_) {
    const Cookie cookie = *path_answer_;
    path_answer_.reset();
    return channel_->SealControl(ControlType::kPathAnswer, cookie, packet, now.us);
  }
  if (renewing_ && now.us >= next_renewal_us_) {
    next_renewal_us_ = now.us + kRenewRepeatMicroseconds;
    std::array<std::uint8_t, kRenewBytes> content;
    const Mac proof = RenewalProof(token_.key, channel_->handshake_hash);
    std::copy(proof.begin(), proof.end(),
              std::copy(token_.bytes.begin(), token_.bytes.end(), content.begin()));
    return channel_->SealControl(ControlType::kRenew, content, packet, now.us);
  }
  if (now.us >= next_probe_us_) {
    next_probe_us_ = now.us + kProbeRepeatMicroseconds;
    // Padded, so that a server may challenge a new address with a packet of the same size.
    return channel_->SealControl(ControlType::kProbe, Cookie{}, packet, now.us);
  }
  return 0;
}

ClientEvent SecureClient::OnDatagram(ByteSpan datagram, Now now) {
  ClientEvent event;
  if (datagram.empty()) return event;
  switch (static_cast<PacketKind>(datagram[0] & ~int{kPhaseBit})) {
    case PacketKind::kRetry: OnRetry(datagram, now, event); break;
    case PacketKind::kResponse: OnResponse(datagram, now, event); break;
    case PacketKind::kRefused: OnRefused(datagram, now, event); break;
    case PacketKind::kData:
    case PacketKind::kControl: OnPacket(datagram, now, event); break;
    case PacketKind::kInitiation: break;  // for servers
  }
  return event;
}

void SecureClient::OnRetry(ByteView datagram, Now now, ClientEvent& event) {
  std::uint32_t index = 0;
  Cookie cookie;
  if (!ReadRetry(datagram, index, cookie) || !attempt_ || index != attempt_->index) {
    event.open_status = OpenStatus::kBadHeader;
    return;
  }
  // Somebody who sends retries without end must not make this side compute without end.
  if (now.us < next_retry_us_) return;
  next_retry_us_ = now.us + kRetryMicroseconds;
  cookie_ = cookie;
  last_refusal_ = Refusal::kNone;
  Begin(now.us);
}

void SecureClient::OnResponse(ByteView datagram, Now now, ClientEvent& event) {
  std::uint32_t index = 0;
  std::array<std::uint8_t, kResponsePayloadBytes> payload;
  if (datagram.size() != kResponseBytes ||
      !ReadShortHeader(datagram, PacketKind::kResponse, index) || !attempt_ ||
      index != attempt_->index) {
    event.open_status = OpenStatus::kBadHeader;
    return;
  }
  if (attempt_->handshake.Read(datagram.subspan(kShortHeaderBytes), payload) !=
      HandshakeStatus::kOk) {
    event.open_status = OpenStatus::kNotAuthentic;
    return;
  }
  peer_index_ = LoadLittle<std::uint32_t>(payload.data());
  index_ = index;
  channel_.emplace(attempt_->handshake.Split(), peer_index_, now.us);
  attempt_.reset();
  last_heard_us_ = now.us;
  next_probe_us_ = now.us;  // the server's session begins with our first packet
  unknown_at_server_ = false;
  path_answer_.reset();
  renewing_ = false;  // the new session has the newest token
  last_refusal_ = Refusal::kNone;
  event.connected = true;
}

void SecureClient::OnRefused(ByteView datagram, Now now, ClientEvent& event) {
  std::uint32_t index = 0;
  Refusal refusal = Refusal::kNone;
  if (!ReadRefused(datagram, index, refusal)) {
    event.open_status = OpenStatus::kBadHeader;
    return;
  }
  if (refusal == Refusal::kUnknownSession) {
    // The session stays in use until a new one has begun, because anybody can write this hint.
    if (channel_ && index == peer_index_ && now.us - attempt_began_us_ >= kProbeMicroseconds) {
      unknown_at_server_ = true;
    }
  } else if (attempt_ && index == attempt_->index) {
    last_refusal_ = refusal;
    event.refusal = refusal;
  }
}

void SecureClient::OnPacket(ByteSpan datagram, Now now, ClientEvent& event) {
  PacketHeader header;
  if (!ReadPacketHeader(datagram, header)) {
    event.open_status = OpenStatus::kBadHeader;
    return;
  }
  if (!channel_ || header.index != index_) {
    event.open_status = OpenStatus::kUnknownSession;
    return;
  }
  OpenedPacket packet;
  event.open_status = channel_->opener.Open(datagram, now.us, packet);
  if (event.open_status == OpenStatus::kExhausted) channel_.reset();
  if (event.open_status != OpenStatus::kOk) return;
  last_heard_us_ = now.us;
  next_probe_us_ = std::max(next_probe_us_, now.us + kProbeMicroseconds);
  // The session lives: the attempt to replace it is over.
  attempt_.reset();
  unknown_at_server_ = false;
  if (packet.kind == PacketKind::kData) {
    event.inner = packet.inner;
    return;
  }
  ControlMessage message;
  if (ReadControl(packet.inner, message)) OnControl(message, event);
}

void SecureClient::OnControl(const ControlMessage& message, ClientEvent& event) {
  switch (message.type) {
    case ControlType::kPathChallenge:
      path_answer_.emplace();
      std::copy(message.content.begin(), message.content.end(), path_answer_->begin());
      return;
    case ControlType::kRenewed:
      event.refusal = static_cast<Refusal>(message.content[kRenewedBytes - 1]);
      event.renewed = event.refusal == Refusal::kNone;
      renewing_ = false;
      return;
    case ControlType::kClose: channel_.reset(); return;
    case ControlType::kProbe:
    case ControlType::kProbeAnswer:
    case ControlType::kPathAnswer:
    case ControlType::kRenew: return;
  }
}

SealStatus SecureClient::Seal(ByteSpan packet, Now now) {
  if (!channel_) return SealStatus::kNotConnected;
  const SealStatus status = channel_->sealer.Seal(PacketKind::kData, packet, now.us);
  if (status == SealStatus::kExhausted) channel_.reset();
  return status;
}

void SecureClient::Renew(const ClientToken& token) {
  token_ = token;
  cookie_ = {};      // cookies belong to a token
  attempt_.reset();  // so does an initiation
  renewing_ = channel_.has_value();
  next_renewal_us_ = 0;
}

std::size_t SecureClient::Close(Now now, ByteSpan packet) {
  if (!channel_) return 0;
  const std::size_t size = channel_->SealControl(ControlType::kClose, {}, packet, now.us);
  channel_.reset();
  attempt_.reset();
  return size;
}

}  // namespace furrow::protocol::secure
