// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <asio/ip/udp.hpp>
#include <sys/socket.h>

#include "protocol/messages/limits.h"

namespace furrow::server {

// Whether what is sent may share a datagram with what else goes to its address.
enum class Packing : std::uint8_t {
  kAlone,
  kShared,  // a whole message of the wire, to a peer that takes bundles (protocol/framing/bundle.h)
};

// What leaves together: gathered while a batch of what came is worked on, then sent by sendmmsg,
// messages for one address packed into bundles, and its datagrams as one that the system cuts
// (UDP_SEGMENT). The hot path's other system call; does not allocate.
//
// - What goes to one address keeps its order.
// - A datagram that the system does not take (a full buffer, an address that is gone) is lost, as
//   UDP may, and counted; the others leave.
class UdpSender {
 public:
  UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  // The non-blocking socket to send from. Asks whether the system cuts datagrams.
  void Open(int socket);

  // What is committed from here on is lost.
  void Close() { socket_ = -1; }

  // Room for one more message or fragment of at most kMaxDatagramBytes. Sends what is there first
  // where no more fits.
  [[nodiscard]] std::span<std::uint8_t> Prepare();
  // `key` is the same for, and only for, the same address.
  void Commit(std::uint64_t key, const asio::ip::udp::endpoint& to, std::size_t size,
              Packing packing = Packing::kAlone);
  // Sends all that was committed.
  void Flush();

  struct Counts {
    std::uint64_t sent = 0;     // datagrams
    std::uint64_t lost = 0;     // datagrams
    std::uint64_t bundled = 0;  // messages that left in a datagram with others
    std::uint64_t calls = 0;    // of the system
  };
  // Since the last call.
  [[nodiscard]] Counts TakeCounts();

 private:
  // A subject's weights for a thousand subscribers, or those of sixty subjects for sixty: 1 MiB of
  // them, which a processor's second cache still holds.
  static constexpr std::size_t kMaxItems = 4096;
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 20;
  static constexpr std::size_t kMaxAddresses = 1024;
  static constexpr std::size_t kSlots = 2 * kMaxAddresses;
  static constexpr std::size_t kMaxMessages = 128;  // of one sendmmsg
  static constexpr std::size_t kMaxSegments = 60;   // the system's own limit is 64
  static constexpr std::size_t kMaxSlices = 1000;   // of a message; the system's own limit is 1,024
  static constexpr std::size_t kMaxCutBytes = 60000;
  static constexpr std::uint16_t kNone = 0xFFFF;

  // What was committed.
  struct Item {
    std::uint32_t offset = 0;
    std::uint16_t size = 0;
    std::uint16_t next = kNone;  // of the same address
    Packing packing = Packing::kAlone;
  };
  struct Address {
    std::uint64_t key = 0;
    std::size_t slot = 0;
    std::uint16_t first = kNone;  // item
    std::uint16_t last = kNone;
    asio::ip::udp::endpoint to;
  };
  // Slices [first, last), which are so many items.
  struct Datagram {
    std::size_t address = 0;
    std::size_t first = 0;
    std::size_t last = 0;
    std::size_t size = 0;
    std::size_t items = 0;
  };
  // Datagrams [first, last) as one of sendmmsg's messages.
  struct Message {
    std::size_t first = 0;
    std::size_t last = 0;
  };
  struct alignas(cmsghdr) Control {
    std::array<std::uint8_t, CMSG_SPACE(sizeof(std::uint16_t))> bytes;
  };

  [[nodiscard]] Address& FindOrAdd(std::uint64_t key, const asio::ip::udp::endpoint& to);
  void Pack(std::size_t address);
  void Append(Datagram& datagram, const Item& item);
  [[nodiscard]] std::size_t EndOfRun(std::size_t first) const;
  void Write(std::size_t message);
  void Send(std::size_t num_messages);
  bool Retry(std::size_t message);
  void CountSent(const Datagram& datagram);

  int socket_ = -1;
  bool can_cut_ = false;
  std::vector<std::uint8_t> buffer_;
  std::size_t used_ = 0;
  std::size_t num_items_ = 0;
  std::size_t num_addresses_ = 0;
  std::size_t num_slices_ = 0;
  std::size_t num_datagrams_ = 0;
  std::vector<Item> items_;
  std::vector<Address> addresses_;
  std::vector<std::uint16_t> slots_;  // 1 + index in addresses_, hashed by key; 0: free
  std::vector<Datagram> datagrams_;
  std::vector<iovec> slices_;
  std::array<Message, kMaxMessages> messages_{};
  std::array<mmsghdr, kMaxMessages> headers_{};
  std::array<Control, kMaxMessages> controls_{};
  Counts counts_;
};

}  // namespace furrow::server
