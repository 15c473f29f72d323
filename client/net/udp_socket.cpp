// SPDX-License-Identifier: Apache-2.0
#include "client/net/udp_socket.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <poll.h>

#include "client/net/clock.h"
#include "client/net/descriptor.h"

namespace furrow::net {

using client::IoStatus;

UdpSocket::UdpSocket(Descriptor descriptor, const client::Token* token)
    : Socket(client::TransportKind::kUdp),
      descriptor_(std::move(descriptor)),
      buffer_(kBatch * kBufferBytes) {
  // Bursts of many subjects must not overflow the buffers of the load generator itself, whose
  // losses would look like the server's.
  const int bytes = 4 << 20;  // the system may grant less
  setsockopt(descriptor_.get(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
  setsockopt(descriptor_.get(), SOL_SOCKET, SO_SNDBUF, &bytes, sizeof(bytes));
  const int on = 1;
  setsockopt(descriptor_.get(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on));
  ArrivalClock::Enable(descriptor_.get());
  for (std::size_t i = 0; i < kBatch; ++i) {
    slices_[i] = {buffer_.data() + i * kBufferBytes, kBufferBytes};
    headers_[i].msg_hdr.msg_iov = &slices_[i];
    headers_[i].msg_hdr.msg_iovlen = 1;
    headers_[i].msg_hdr.msg_control = &controls_[i];
  }
  if (token != nullptr) secure_.emplace(*token, std::span<const std::uint8_t>());
}

std::string UdpSocket::AwaitSession(std::chrono::milliseconds timeout) {
  if (!secure_) return {};
  constexpr std::chrono::milliseconds kStep(20);
  const std::int64_t end = SteadyNanoseconds() + timeout.count() * 1'000'000;
  while (!connected()) {
    if (std::string why = client::RefusedTokenText(refusal_); !why.empty()) return why;
    if (SteadyNanoseconds() >= end) return "no answer";
    std::span<const std::uint8_t> message;
    (void)Receive(message, kStep);
  }
  Maintain();  // the first packet begins the session at the daemon
  return {};
}

void UdpSocket::Maintain() {
  maintained_us_ = SteadyNanoseconds() / 1000;
  while (const std::size_t size = secure_->Poll({.us = maintained_us_, .unix_s = 0}, packet_)) {
    (void)SendDatagram(std::span<const std::uint8_t>(packet_).first(size));
  }
}

std::span<std::uint8_t> UdpSocket::Open(std::span<std::uint8_t> datagram) {
  const auto event = secure_->OnDatagram(datagram, {.us = SteadyNanoseconds() / 1000, .unix_s = 0});
  if (event.refusal != protocol::secure::Refusal::kNone) refusal_ = event.refusal;
  // The session of AwaitSession() is the first connection, which counts already.
  if (event.connected && std::exchange(began_, true)) ++generation_;
  if (event.inner.empty()) Maintain();
  return event.inner;
}

IoStatus UdpSocket::SendSealed(std::size_t inner_bytes) {
  using protocol::secure::SealStatus;
  const auto packet =
      std::span(packet_).first(inner_bytes + protocol::secure::kPacketOverheadBytes);
  if (secure_->Seal(packet, {.us = SteadyNanoseconds() / 1000, .unix_s = 0}) != SealStatus::kOk) {
    return IoStatus::kNoConnection;
  }
  return SendDatagram(packet);
}

IoStatus UdpSocket::Send(std::span<const std::uint8_t> message) {
  if (message.size() > protocol::kMaxUdpMessageBytes) return IoStatus::kTooLarge;
  // The usual case: a whole message needs neither a fragment header nor a copy.
  const bool fits = message.size() <= protocol::kMaxDatagramBytes;
  if (fits && !secure_) return SendDatagram(message);
  const std::size_t count = protocol::NumDatagrams(message.size());
  const std::uint32_t id = next_message_id_++;
  for (std::size_t i = 0; i < count; ++i) {
    const auto datagram = std::span(packet_).subspan(protocol::secure::kPacketHeaderBytes,
                                                     protocol::kMaxDatagramBytes);
    const std::size_t bytes = protocol::WriteDatagram(message, id, i, datagram);
    const IoStatus status = secure_ ? SendSealed(bytes) : SendDatagram(datagram.first(bytes));
    if (status != IoStatus::kOk) return status;
  }
  return IoStatus::kOk;
}

// ECONNREFUSED reports the fate of an earlier datagram, so this datagram is sent once more.
IoStatus UdpSocket::SendDatagram(std::span<const std::uint8_t> datagram) {
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (send(descriptor_.get(), datagram.data(), datagram.size(), 0) >= 0) return IoStatus::kOk;
    if (errno == EAGAIN || errno == ENOBUFS) return IoStatus::kTimeout;
  }
  return IoStatus::kNoConnection;
}

IoStatus UdpSocket::Receive(std::span<const std::uint8_t>& message,
                            std::chrono::milliseconds timeout) {
  constexpr std::int64_t kMaintainUs = 50'000;
  if (secure_ && SteadyNanoseconds() / 1000 - maintained_us_ >= kMaintainUs) Maintain();
  while (!unbundler_.Next(message)) {
    if (taken_ == filled_) {
      if (std::exchange(drained_, false)) return IoStatus::kTimeout;
      if (timeout.count() > 0) WaitFor(descriptor_.get(), POLLIN, std::exchange(timeout, {}));
      const IoStatus status = Fill();
      if (status != IoStatus::kOk) return status;
    }
    const std::size_t i = taken_++;
    // The time at which the kernel received the datagram, however long it waited for this thread.
    arrived_ns_ = clock_.Arrival(&headers_[i].msg_hdr);
    std::span datagram(buffer_.data() + i * kBufferBytes, headers_[i].msg_len);
    if (secure_) {
      datagram = Open(datagram);
      if (datagram.empty()) continue;
    }
    switch (reassembler_.Push({}, datagram, SteadyNanoseconds() / 1000, message)) {
      case protocol::FragmentStatus::kWhole: (void)unbundler_.Open(datagram); break;
      case protocol::FragmentStatus::kComplete: return IoStatus::kOk;
      default: break;  // an incomplete message or a foreign datagram
    }
  }
  return IoStatus::kOk;
}

IoStatus UdpSocket::Fill() {
  taken_ = 0;
  filled_ = 0;
  for (mmsghdr& header : headers_) header.msg_hdr.msg_controllen = sizeof(Control);
  const int received = recvmmsg(descriptor_.get(), headers_.data(), kBatch, MSG_DONTWAIT, nullptr);
  if (received <= 0) {
    return received < 0 && errno == ECONNREFUSED ? IoStatus::kNoConnection : IoStatus::kTimeout;
  }
  // Directly after the batch: the stamps are converted by the clocks of this moment.
  clock_.Read();
  filled_ = static_cast<std::size_t>(received);
  drained_ = filled_ < kBatch;
  ReadOverrun(&headers_[filled_ - 1].msg_hdr);
  (void)reassembler_.Expire(SteadyNanoseconds() / 1000);
  return IoStatus::kOk;
}

// SO_RXQ_OVFL: after the first loss every datagram carries the total of losses as a 32-bit counter,
// which wraps. The unsigned difference is correct across a wrap.
void UdpSocket::ReadOverrun(msghdr* header) {
  for (cmsghdr* item = CMSG_FIRSTHDR(header); item != nullptr; item = CMSG_NXTHDR(header, item)) {
    if (item->cmsg_level != SOL_SOCKET || item->cmsg_type != SO_RXQ_OVFL) continue;
    std::uint32_t ever = 0;
    std::memcpy(&ever, CMSG_DATA(item), sizeof(ever));
    overrun_ += ever - std::exchange(overrun_ever_, ever);
  }
}

}  // namespace furrow::net
