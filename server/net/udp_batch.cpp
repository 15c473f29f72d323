// SPDX-License-Identifier: Apache-2.0
#include "server/net/udp_batch.h"

#include <cerrno>
#include <cstring>

namespace furrow::server {

UdpBatch::UdpBatch() : buffer_(kSize * kBufferBytes) {
  for (std::size_t i = 0; i < kSize; ++i) {
    slices_[i] = {buffer_.data() + i * kBufferBytes, kBufferBytes};
    headers_[i].msg_hdr.msg_iov = &slices_[i];
    headers_[i].msg_hdr.msg_iovlen = 1;
    headers_[i].msg_hdr.msg_name = &senders_[i];
  }
}

std::size_t UdpBatch::Receive(int socket) {
  for (mmsghdr& header : headers_) header.msg_hdr.msg_namelen = sizeof(sockaddr_storage);
  int received = 0;
  do {
    received = recvmmsg(socket, headers_.data(), kSize, MSG_DONTWAIT, nullptr);
  } while (received < 0 && errno == EINTR);
  // Any other error is of an earlier send (ICMP) and has been taken by asking: the socket lives.
  return received < 0 ? 0 : static_cast<std::size_t>(received);
}

std::span<const std::uint8_t> UdpBatch::bytes(std::size_t i) const {
  return {static_cast<const std::uint8_t*>(slices_[i].iov_base), headers_[i].msg_len};
}

asio::ip::udp::endpoint UdpBatch::sender(std::size_t i) const {
  asio::ip::udp::endpoint endpoint;
  const std::size_t size = headers_[i].msg_hdr.msg_namelen;
  endpoint.resize(size);
  std::memcpy(endpoint.data(), &senders_[i], size);
  return endpoint;
}

}  // namespace furrow::server
