// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <asio/ip/udp.hpp>
#include <sys/socket.h>

#include "protocol/limits.h"

namespace furrow::server {

// Datagrams that leave together: gathered while a batch of those that came is worked on, then sent
// by one sendmmsg, what goes to one address as one message that the system cuts (UDP_SEGMENT). The
// hot path's other system call; does not allocate.
//
// - What goes to one address keeps its order.
// - A datagram that the system does not take (a full buffer, an address that is gone) is lost, as
//   UDP may, and counted; the others leave.
class UdpSender {
 public:
  UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  // The non-blocking socket to send from. Asks whether the system cuts messages.
  void Open(int socket);

  // What is committed from here on is lost.
  void Close() { socket_ = -1; }

  // Room for one more datagram of at most kMaxDatagramBytes. `key` is the same for, and only for,
  // the same address. Sends what is there first where no more fits.
  [[nodiscard]] std::span<std::uint8_t> Prepare();
  void Commit(std::uint64_t key, const asio::ip::udp::endpoint& to, std::size_t size);
  // Sends all that was committed.
  void Flush();

  struct Counts {
    std::uint64_t sent = 0;
    std::uint64_t lost = 0;
    std::uint64_t calls = 0;  // of the system
  };
  // Since the last call.
  [[nodiscard]] Counts TakeCounts();

 private:
  static constexpr std::size_t kMaxItems = 128;
  static constexpr std::size_t kMaxSegments = 60;  // the system's own limit is 64
  static constexpr std::size_t kMaxCutBytes = 60000;

  struct Item {
    std::uint64_t key = 0;
    std::size_t offset = 0;
    std::size_t size = 0;
    asio::ip::udp::endpoint to;
  };
  struct alignas(cmsghdr) Control {
    std::array<std::uint8_t, CMSG_SPACE(sizeof(std::uint16_t))> bytes;
  };
  // Items [first, last) of order_ as one message.
  struct Message {
    std::size_t first = 0;
    std::size_t last = 0;
  };

  [[nodiscard]] std::size_t EndOfRun(std::size_t first) const;
  void Build();
  void Write(std::size_t message);
  void Send();
  bool Retry(std::size_t message);

  int socket_ = -1;
  bool can_cut_ = false;
  std::vector<std::uint8_t> buffer_;
  std::size_t used_ = 0;
  std::size_t num_items_ = 0;
  std::size_t num_messages_ = 0;
  std::array<Item, kMaxItems> items_;
  std::array<std::size_t, kMaxItems> order_{};  // items by address, in order
  std::array<Message, kMaxItems> messages_{};
  std::array<iovec, kMaxItems> slices_{};
  std::array<mmsghdr, kMaxItems> headers_{};
  std::array<Control, kMaxItems> controls_{};
  Counts counts_;
};

}  // namespace furrow::server
