// SPDX-License-Identifier: Apache-2.0
#include "server/net/udp/udp_sender.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <netinet/in.h>
#include <netinet/udp.h>

#include "protocol/framing/bundle.h"
#include "protocol/secure/packet/packet.h"

namespace furrow::server {

UdpSender::UdpSender()
    : buffer_(kBufferBytes),
      items_(kMaxItems),
      addresses_(kMaxAddresses),
      slots_(kSlots),
      datagrams_(kMaxItems),
      slices_(kMaxItems) {}

void UdpSender::Open(int socket) {
  socket_ = socket;
  int size = 0;
  socklen_t length = sizeof(size);
  // Kernels before 4.18 do not know the option.
  can_segment_ = getsockopt(socket, SOL_UDP, UDP_SEGMENT, &size, &length) == 0;
}

std::span<std::uint8_t> UdpSender::Prepare() {
  // Every limit of the arrays is checked here, so that Commit() and Flush() need no checks.
  const bool is_full = num_items_ == kMaxItems || num_addresses_ == kMaxAddresses ||
                       used_ + protocol::kMaxDatagramBytes > kBufferBytes;
  if (is_full) Flush();
  return std::span(buffer_).subspan(used_, protocol::kMaxDatagramBytes);
}

void UdpSender::Commit(std::uint64_t key, const asio::ip::udp::endpoint& to, std::size_t size,
                       Packing packing, std::uint32_t session) {
  // Items of one address form a linked list in order. Sorting by address happens in Flush() by
  // walking the lists, without moving a byte.
  const auto index = static_cast<std::uint16_t>(num_items_++);
  items_[index] = {static_cast<std::uint32_t>(used_), static_cast<std::uint16_t>(size), kNone,
                   packing};
  used_ += size;
  Address& address = FindOrAdd(key, to, session);
  (address.last == kNone ? address.first : items_[address.last].next) = index;
  address.last = index;
}

// An open-addressed hash table. Keys are consecutive peer ids, so collisions are rare.
UdpSender::Address& UdpSender::FindOrAdd(std::uint64_t key, const asio::ip::udp::endpoint& to,
                                         std::uint32_t session) {
  std::size_t slot = key % kSlots;
  // Ends, because at most half of the slots are used.
  for (; slots_[slot] != 0; slot = (slot + 1) % kSlots) {
    Address& address = addresses_[slots_[slot] - 1u];
    if (address.key == key) return address;
  }
  addresses_[num_addresses_] = {key, slot, kNone, kNone, session, to};
  slots_[slot] = static_cast<std::uint16_t>(num_addresses_ + 1);
  return addresses_[num_addresses_++];
}

// Packs the items for one address into datagrams, and seals those of a secure session.
void UdpSender::Pack(std::size_t address) {
  const Item* before = nullptr;
  const bool is_secure = addresses_[address].session != 0;
  for (std::uint16_t i = addresses_[address].first; i != kNone; i = items_[i].next) {
    const Item& item = items_[i];
    const bool joins =
        before != nullptr && before->packing == Packing::kBundled &&
        item.packing == Packing::kBundled &&
        datagrams_[num_datagrams_ - 1].size + item.size <= protocol::kMaxDatagramBytes;
    if (joins) {
      // Sets a flag in the envelope of the message before, which tells the reader that another
      // follows.
      protocol::MarkFollowed(std::span(buffer_).subspan(before->offset, before->size));
    } else {
      if (is_secure && before != nullptr) SealLast(addresses_[address]);
      datagrams_[num_datagrams_++] = {address, num_slices_, num_slices_, 0, 0};
    }
    Append(datagrams_[num_datagrams_ - 1], item);
    before = &item;
  }
  if (is_secure && before != nullptr) SealLast(addresses_[address]);
}

// Replaces the last datagram by its sealed form. Without a session it is lost.
void UdpSender::SealLast(Address& address) {
  Datagram& datagram = datagrams_[num_datagrams_ - 1];
  // Each sealed datagram has at least one item, so this is the most that one flush needs.
  if (sealed_.empty()) {
    sealed_.resize(kBufferBytes + kMaxItems * protocol::secure::kPacketOverheadBytes);
  }
  const std::size_t size = datagram.size + protocol::secure::kPacketOverheadBytes;
  const auto packet = std::span(sealed_).subspan(num_sealed_, size);
  std::size_t at = protocol::secure::kPacketHeaderBytes;
  for (std::size_t i = datagram.first; i < datagram.last; ++i) {
    std::memcpy(packet.data() + at, slices_[i].iov_base, slices_[i].iov_len);
    at += slices_[i].iov_len;
  }
  num_slices_ = datagram.first;
  if (sealer_ == nullptr || !sealer_->Seal(address.session, packet, address.to)) {
    --num_datagrams_;
    ++counts_.lost;
    return;
  }
  num_sealed_ += size;
  slices_[num_slices_++] = {packet.data(), size};
  datagram.last = num_slices_;
  datagram.size = size;
}

// Adds an item to the last datagram. Items that lie side by side in the buffer share a slice.
void UdpSender::Append(Datagram& datagram, const Item& item) {
  std::uint8_t* const bytes = buffer_.data() + item.offset;
  iovec* const last = datagram.items > 0 ? &slices_[num_slices_ - 1] : nullptr;
  if (last != nullptr && static_cast<std::uint8_t*>(last->iov_base) + last->iov_len == bytes) {
    last->iov_len += item.size;
  } else {
    slices_[num_slices_++] = {bytes, item.size};
  }
  datagram.last = num_slices_;
  datagram.size += item.size;
  ++datagram.items;
}

// The end of the run of datagrams that one message can carry. UDP_SEGMENT needs the same address
// and equal sizes; only the last datagram may be smaller.
std::size_t UdpSender::EndOfRun(std::size_t first) const {
  const Datagram& head = datagrams_[first];
  std::size_t bytes = head.size;
  std::size_t last = first + 1;
  while (can_segment_ && last < num_datagrams_ && last - first < kMaxSegments) {
    const Datagram& next = datagrams_[last];
    bytes += next.size;
    if (next.address != head.address || next.size > head.size || bytes > kMaxSegmentedBytes ||
        next.last - head.first > kMaxSlices) {
      break;
    }
    ++last;
    // A smaller datagram joins the run, but ends it.
    if (next.size < head.size) break;
  }
  return last;
}

// Fills the header of one message from its run of datagrams. The kernel gathers the slices and cuts
// the result into datagrams of `head.size` bytes (udp(7), UDP_SEGMENT).
void UdpSender::Write(std::size_t message) {
  const auto [first, last] = messages_[message];
  const Datagram& head = datagrams_[first];
  Address& address = addresses_[head.address];
  msghdr& header = headers_[message].msg_hdr;
  header = {};
  header.msg_name = address.to.data();
  header.msg_namelen = static_cast<socklen_t>(address.to.size());
  header.msg_iov = &slices_[head.first];
  header.msg_iovlen = datagrams_[last - 1].last - head.first;
  // A single datagram needs no segment size.
  if (last - first < 2) return;
  header.msg_control = &controls_[message];
  header.msg_controllen = sizeof(Control);
  cmsghdr* item = CMSG_FIRSTHDR(&header);
  item->cmsg_level = SOL_UDP;
  item->cmsg_type = UDP_SEGMENT;
  item->cmsg_len = CMSG_LEN(sizeof(std::uint16_t));
  const auto size = static_cast<std::uint16_t>(head.size);
  std::memcpy(CMSG_DATA(item), &size, sizeof(size));
}

void UdpSender::Flush() {
  if (num_items_ == 0) return;
  for (std::size_t i = 0; i < num_addresses_; ++i) {
    Pack(i);
    // Clears only what was used: the table is larger than what most flushes need.
    slots_[addresses_[i].slot] = 0;
  }
  for (std::size_t first = 0; first < num_datagrams_;) {
    std::size_t count = 0;
    for (; count < kMaxMessages && first < num_datagrams_; ++count) {
      messages_[count] = {first, EndOfRun(first)};
      first = messages_[count].last;
      Write(count);
    }
    Send(count);
  }
  num_items_ = num_addresses_ = num_slices_ = num_datagrams_ = used_ = num_sealed_ = 0;
}

// sendmmsg() from message `at` on. One message, the usual case below 20,000 poses per second, takes
// 0.3 us less with sendmsg().
int UdpSender::Call(std::size_t at, std::size_t num_messages) {
  const auto count = static_cast<unsigned>(num_messages - at);
  if (count > 1) return sendmmsg(socket_, &headers_[at], count, MSG_DONTWAIT);
  return sendmsg(socket_, &headers_[at].msg_hdr, MSG_DONTWAIT) < 0 ? -1 : 1;
}

void UdpSender::Send(std::size_t num_messages) {
  std::size_t at = 0;
  while (at < num_messages) {
    ++counts_.calls;
    const int sent = Call(at, num_messages);
    // sendmmsg() stops at the first message that fails. It returns the error only if that message
    // is the first of the call, so the failed one is always headers_[at].
    if (sent < 0 && errno == EINTR) continue;
    for (int i = 0; i < sent; ++i, ++at) {
      const auto [first, last] = messages_[at];
      for (std::size_t k = first; k < last; ++k) CountSent(datagrams_[k]);
    }
    if (sent > 0) continue;
    if (!Retry(at)) counts_.lost += messages_[at].last - messages_[at].first;
    ++at;
  }
}

// Sends the datagrams of a failed message one by one if the kernel refused to split it, which
// happens on interfaces without checksum offload, and stops using UDP_SEGMENT. False: another
// error.
bool UdpSender::Retry(std::size_t message) {
  const auto [first, last] = messages_[message];
  if (last - first < 2 || (errno != EIO && errno != EINVAL && errno != EOPNOTSUPP)) return false;
  can_segment_ = false;
  // A copy: the headers after this one have not been sent yet.
  msghdr header = headers_[message].msg_hdr;
  header.msg_control = nullptr;
  header.msg_controllen = 0;
  for (std::size_t i = first; i < last; ++i) {
    const Datagram& datagram = datagrams_[i];
    header.msg_iov = &slices_[datagram.first];
    header.msg_iovlen = datagram.last - datagram.first;
    ++counts_.calls;
    if (sendmsg(socket_, &header, MSG_DONTWAIT) < 0) {
      ++counts_.lost;
    } else {
      CountSent(datagram);
    }
  }
  return true;
}

void UdpSender::CountSent(const Datagram& datagram) {
  ++counts_.sent;
  if (datagram.items > 1) counts_.bundled += datagram.items;
}

UdpSender::Counts UdpSender::TakeCounts() { return std::exchange(counts_, {}); }

}  // namespace furrow::server
