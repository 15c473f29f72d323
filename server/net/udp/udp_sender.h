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
#include "server/net/udp/datagram_sealer.h"

namespace furrow::server {

// Whether a message may share a datagram with other messages to the same address.
enum class Packing : std::uint8_t {
  kSeparate,
  kBundled,  // a whole message, to a peer that accepts bundles (protocol/framing/bundle.h)
};

// Collects outgoing messages and sends them with few system calls. Messages for one address are
// packed into bundles; the datagrams for one address leave as one large message that the kernel
// splits (UDP_SEGMENT); sendmmsg sends many of those at once. Does not allocate after construction.
//
// - Messages to one address keep their order.
// - A datagram that the kernel does not accept (full buffer, unreachable address) is lost and
//   counted. The others are sent.
class UdpSender {
 public:
  UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  // Sets the non-blocking socket to send from and checks whether it supports UDP_SEGMENT.
  void Open(int socket);

  // Seals what goes to secure sessions; outlives this object. Without it they get nothing.
  void SetSealer(DatagramSealer* sealer) { sealer_ = sealer; }

  // Messages committed from now on are lost.
  void Close() { socket_ = -1; }

  // Returns space for one message or fragment of at most kMaxDatagramBytes. Flushes first if the
  // buffer is full.
  [[nodiscard]] std::span<std::uint8_t> Prepare();
  // Adds the `size` bytes written to the space from Prepare(). Equal keys mean equal addresses.
  // `session`: 0, or the secure session whose client gets the datagram, sealed, where it is then.
  void Commit(std::uint64_t key, const asio::ip::udp::endpoint& to, std::size_t size,
              Packing packing = Packing::kSeparate, std::uint32_t session = 0);
  // Sends everything that was committed.
  void Flush();

  struct Counts {
    std::uint64_t sent = 0;     // datagrams
    std::uint64_t lost = 0;     // datagrams
    std::uint64_t bundled = 0;  // messages that shared a datagram
    std::uint64_t calls = 0;    // system calls
  };
  // The counts since the last call.
  [[nodiscard]] Counts TakeCounts();

 private:
  // Enough for the weights of one subject for a thousand subscribers, or of sixty subjects for
  // sixty. 1 MiB of messages still fits into a second-level cache.
  static constexpr std::size_t kMaxItems = 4096;
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 20;
  static constexpr std::size_t kMaxAddresses = 1024;
  static constexpr std::size_t kSlots = 2 * kMaxAddresses;
  static constexpr std::size_t kMaxMessages = 128;  // per sendmmsg call
  static constexpr std::size_t kMaxSegments = 60;   // the kernel's limit is 64
  static constexpr std::size_t kMaxSlices = 1000;   // per message; the kernel's limit is 1,024
  static constexpr std::size_t kMaxSegmentedBytes = 60000;
  static constexpr std::uint16_t kNone = 0xFFFF;

  // A committed message or fragment.
  struct Item {
    std::uint32_t offset = 0;
    std::uint16_t size = 0;
    std::uint16_t next = kNone;  // next item for the same address
    Packing packing = Packing::kSeparate;
  };
  struct Address {
    std::uint64_t key = 0;
    std::size_t slot = 0;
    std::uint16_t first = kNone;  // first item
    std::uint16_t last = kNone;
    std::uint32_t session = 0;
    asio::ip::udp::endpoint to;
  };
  // Slices [first, last), which hold `items` items.
  struct Datagram {
    std::size_t address = 0;
    std::size_t first = 0;
    std::size_t last = 0;
    std::size_t size = 0;
    std::size_t items = 0;
  };
  // Datagrams [first, last), one message of sendmmsg.
  struct Message {
    std::size_t first = 0;
    std::size_t last = 0;
  };
  struct alignas(cmsghdr) Control {
    std::array<std::uint8_t, CMSG_SPACE(sizeof(std::uint16_t))> bytes;
  };

  [[nodiscard]] Address& FindOrAdd(std::uint64_t key, const asio::ip::udp::endpoint& to,
                                   std::uint32_t session);
  void Pack(std::size_t address);
  void SealLast(Address& address);
  void Append(Datagram& datagram, const Item& item);
  [[nodiscard]] std::size_t EndOfRun(std::size_t first) const;
  void Write(std::size_t message);
  int Call(std::size_t at, std::size_t num_messages);
  void Send(std::size_t num_messages);
  bool Retry(std::size_t message);
  void CountSent(const Datagram& datagram);

  int socket_ = -1;
  DatagramSealer* sealer_ = nullptr;
  bool can_segment_ = false;
  std::vector<std::uint8_t> buffer_;
  std::size_t used_ = 0;
  std::size_t num_items_ = 0;
  std::size_t num_addresses_ = 0;
  std::size_t num_slices_ = 0;
  std::size_t num_datagrams_ = 0;
  std::vector<std::uint8_t> sealed_;  // sealed datagrams; empty until the first
  std::size_t num_sealed_ = 0;        // bytes
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
