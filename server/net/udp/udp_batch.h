// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <asio/ip/udp.hpp>
#include <sys/socket.h>

#include "protocol/secure/packet/packet.h"

namespace furrow::server {

// Receives up to kSize datagrams with one recvmmsg call. Does not allocate after construction.
class UdpBatch {
 public:
  static constexpr std::size_t kSize = 64;

  UdpBatch();
  UdpBatch(const UdpBatch&) = delete;
  UdpBatch& operator=(const UdpBatch&) = delete;

  // Asks the kernel to count datagrams that the socket buffer had no room for.
  static void CountDropped(int socket);

  // Fills the batch from a non-blocking socket. Returns the number of datagrams; 0: none is
  // waiting.
  std::size_t Receive(int socket);
  // The number of datagrams that the kernel lost since the last call, for lack of buffer space.
  std::uint64_t TakeDropped() { return std::exchange(dropped_, 0); }

  // Datagram `i` of the last Receive(), which sealed ones are opened in. A datagram above the limit
  // of sealed datagrams is cut to one byte more than that.
  [[nodiscard]] std::span<std::uint8_t> bytes(std::size_t i);
  // The address that sent datagram `i`.
  [[nodiscard]] asio::ip::udp::endpoint sender(std::size_t i) const;

 private:
  static constexpr std::size_t kBufferBytes = protocol::secure::kMaxPacketBytes + 1;
  struct alignas(cmsghdr) Control {
    std::array<std::uint8_t, CMSG_SPACE(sizeof(std::uint32_t))> bytes;
  };
  void ReadDropped(msghdr* header);

  std::vector<std::uint8_t> buffer_;
  std::array<mmsghdr, kSize> headers_{};
  std::array<iovec, kSize> slices_{};
  std::array<sockaddr_storage, kSize> senders_{};
  std::array<Control, kSize> controls_{};
  std::size_t used_ = kSize;        // headers to reset before the next call
  std::uint32_t dropped_ever_ = 0;  // the kernel's count, modulo 2^32
  std::uint64_t dropped_ = 0;
};

}  // namespace furrow::server
