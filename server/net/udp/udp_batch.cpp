// SPDX-License-Identifier: Apache-2.0
#include "server/net/udp/udp_batch.h"

#include <cerrno>
#include <cstring>

namespace furrow::server {

UdpBatch::UdpBatch() : buffer_(kSize * kBufferBytes) {
  for (std::size_t i = 0; i < kSize; ++i) {
    slices_[i] = {buffer_.data() + i * kBufferBytes, kBufferBytes};
    headers_[i].msg_hdr.msg_iov = &slices_[i];
    headers_[i].msg_hdr.msg_iovlen = 1;
    headers_[i].msg_hdr.msg_name = &senders_[i];
    headers_[i].msg_hdr.msg_control = &controls_[i];
  }
}

std::size_t UdpBatch::Receive(int socket) {
  // recvmmsg() overwrites both lengths, but only in the headers that it used.
  for (mmsghdr& header : std::span(headers_).first(used_)) {
    header.msg_hdr.msg_namelen = sizeof(sockaddr_storage);
    header.msg_hdr.msg_controllen = sizeof(Control);
  }
  int received = 0;
  do {
    // MSG_DONTWAIT alone decides about waiting. The timeout of recvmmsg() is unreliable (see its
    // manual page, BUGS).
    received = recvmmsg(socket, headers_.data(), kSize, MSG_DONTWAIT, nullptr);
  } while (received < 0 && errno == EINTR);
  // Other errors belong to an earlier send (ICMP). Reading them clears them; the socket still
  // works.
  used_ = received > 0 ? static_cast<std::size_t>(received) : 0;
  if (received <= 0) return 0;
  // Each datagram carries the running total, so the last one has the newest.
  ReadDropped(&headers_[static_cast<std::size_t>(received) - 1].msg_hdr);
  return static_cast<std::size_t>(received);
}

void UdpBatch::CountDropped(int socket) {
  const int on = 1;  // optional: without it nothing is counted
  setsockopt(socket, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on));
}

// Once a datagram was lost, each datagram carries the total. It only decreases by wrapping around.
void UdpBatch::ReadDropped(msghdr* header) {
  for (cmsghdr* item = CMSG_FIRSTHDR(header); item != nullptr; item = CMSG_NXTHDR(header, item)) {
    if (item->cmsg_level != SOL_SOCKET || item->cmsg_type != SO_RXQ_OVFL) continue;
    std::uint32_t ever = 0;
    std::memcpy(&ever, CMSG_DATA(item), sizeof(ever));
    // Unsigned 32-bit subtraction gives the right difference across the wrap.
    dropped_ += ever - std::exchange(dropped_ever_, ever);
  }
}

std::span<std::uint8_t> UdpBatch::bytes(std::size_t i) {
  return {static_cast<std::uint8_t*>(slices_[i].iov_base), headers_[i].msg_len};
}

asio::ip::udp::endpoint UdpBatch::sender(std::size_t i) const {
  asio::ip::udp::endpoint endpoint;
  const std::size_t size = headers_[i].msg_hdr.msg_namelen;
  endpoint.resize(size);
  std::memcpy(endpoint.data(), &senders_[i], size);
  return endpoint;
}

}  // namespace furrow::server
